#include "render/emitters.h"

#include <algorithm>
#include <limits>
#include <string>
#include <unordered_map>

#include "render/world.h"

namespace crescente::render {
namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();

LuminousShape shape_of(const scene::Light& light) {
    if (light.kind == scene::LightKind::sphere) return LuminousShape::sphere(light.position, light.radius, false);
    const Vec3 up = scene::upward_of(light), side = cross(up, normalize(light.direction));  // side x up: where it shines
    if (light.kind == scene::LightKind::disk) return LuminousShape::ellipse(light.position, up * light.radius, cross(normalize(light.direction), up) * light.radius, 0, light.two_sided);
    const Vec3 a = side * light.width, b = up * light.height;
    return LuminousShape::rectangle(light.position - (a + b) * 0.5, a, b, light.two_sided);
}

LightBounds bounds_of(const LuminousShape& shape, double power) {
    const bool all_around = !shape.flat();
    return {shape.bounds(), all_around ? Vec3{0, 0, 1} : shape.normal(), all_around ? -1.0 : 1.0, shape.two_sided(), power};
}

// What a material sends out of its own. The ambient radiance of classic materials stands for light between surfaces, and lights nothing.
Rgb emission_of(const World& world, std::uint32_t material) { return world.lobes[material].shining; }

LuminousShape parallelogram(Vec3 corner, Vec3 a, Vec3 b, bool two_sided) {
    const bool upright = std::abs(dot(a, b)) <= 1e-12 * length(a) * length(b);
    return upright ? LuminousShape::rectangle(corner, a, b, two_sided) : LuminousShape::parallelogram(corner, a, b, two_sided);
}

// What can be sampled of shapes, at their place, primitive by primitive; nothing for kinds that are only found by rays.
struct Pieces {
    const Affine& at;
    bool two_sided;
    std::vector<std::pair<std::uint32_t, LuminousShape>> found{};  // by primitive

    // Mirroring swaps the sides.
    LuminousShape oriented(LuminousShape (*make)(Vec3, Vec3, Vec3, bool), Vec3 corner, Vec3 a, Vec3 b) const {
        const Vec3 x = at.vector(a), y = at.vector(b);
        return at.determinant() < 0 ? make(at.point(corner), y, x, two_sided) : make(at.point(corner), x, y, two_sided);
    }

    void operator()(const geometry::Mesh& mesh) {
        for (std::uint32_t i = 0; i < mesh.triangles.size(); ++i) {
            const auto& [p, q, r] = mesh.triangles[i];
            const Vec3 corner = mesh.positions[p];
            found.emplace_back(i, oriented(LuminousShape::triangle, corner, mesh.positions[q] - corner, mesh.positions[r] - corner));
        }
    }
    void operator()(const geometry::Sphere& sphere) {
        const double x = length(at.x), y = length(at.y), z = length(at.z), off = 1e-9 * x * x;
        const bool similar = std::abs(x - y) <= 1e-9 * x && std::abs(x - z) <= 1e-9 * x && std::abs(dot(at.x, at.y)) <= off &&
                             std::abs(dot(at.y, at.z)) <= off && std::abs(dot(at.z, at.x)) <= off;
        if (similar) found.emplace_back(0, LuminousShape::sphere(at.origin, sphere.radius * x, two_sided));
    }
    void operator()(const geometry::Disk& disk) {
        const Vec3 a = at.vector({0, 0, disk.radius}), b = at.vector({disk.radius, 0, 0});
        const bool mirrored = at.determinant() < 0;
        found.emplace_back(0, LuminousShape::ellipse(at.origin, mirrored ? b : a, mirrored ? a : b, disk.inner_radius / disk.radius, two_sided));
    }
    void operator()(const geometry::Box& box) {
        const Vec3 extent = box.upper - box.lower;
        for (std::uint32_t face = 0; face < 6; ++face) {
            const int axis = static_cast<int>(face / 2), second = (axis + 1) % 3, third = (axis + 2) % 3;
            Vec3 corner = box.lower, a{}, b{};
            if (face % 2) corner[axis] = box.upper[axis];
            a[second] = extent[second], b[third] = extent[third];
            found.emplace_back(face, face % 2 ? oriented(parallelogram, corner, a, b) : oriented(parallelogram, corner, b, a));
        }
    }
    void operator()(const geometry::Polygon& polygon) {
        if (polygon.loops.size() != 1) return;
        const auto& p = polygon.loops[0];
        if (p.size() == 3) found.emplace_back(0, oriented(LuminousShape::triangle, p[0], p[1] - p[0], p[2] - p[0]));
        if (p.size() != 4) return;
        const Vec3 gap = p[0] + p[2] - p[1] - p[3];
        if (length(gap) <= 1e-12 * length(p[2] - p[0])) found.emplace_back(0, oriented(parallelogram, p[0], p[1] - p[0], p[3] - p[0]));
    }
    template <class Other>
    void operator()(const Other&) {}
};

}  // namespace

Emitters::Emitters(const World& world, const Emitters* before) : environment_(world.environment) {
    add_lights(world);
    add_objects(world);
    for (Group& group : groups_) {
        if (before) {
            const auto same = std::find_if(before->groups_.begin(), before->groups_.end(), [&](const Group& old) { return old.hierarchy && old.members == group.members; });
            if (same != before->groups_.end()) {
                group.hierarchy = same->hierarchy;
                continue;
            }
        }
        std::vector<LightBounds> bounds;
        for (const Member& m : group.members) bounds.push_back(bounds_of(m.shape, luminance(m.radiance) * m.shape.area()));
        group.hierarchy = std::make_shared<const LightHierarchy>(bounds);
    }
    environment_group_ = static_cast<std::uint32_t>(groups_.size());
    if (!environment_.shines()) return;
    groups_.push_back(Group(Kind::environment));
    groups_.back().scale = gray(static_cast<float>(environment_.strength()));
}

void Emitters::add_lights(const World& world) {
    std::size_t alone = 0;
    for (const Light& light : world.luminous) alone += light.source().group.empty();
    std::unordered_map<std::string, std::uint32_t> by_name;
    std::vector<std::uint32_t> group_of;
    std::vector<std::uint32_t> size;
    for (const Light& light : world.luminous) {
        // What cannot be together in one group, because it must be told of the whole, is in its name.
        const scene::Light& source = light.source();
        const bool by_itself = source.group.empty() && alone <= most_lights;
        std::string name = source.group + '\n' + (source.shadows ? 's' : ' ') + (source.highlights ? 'h' : ' ');
        for (const auto* links : {&source.only, &source.except}) {
            name += '\n';
            for (const std::string& object : *links) name += std::to_string(object.size()) + ' ' + object;
        }
        auto group = static_cast<std::uint32_t>(groups_.size());
        if (!by_itself) group = by_name.try_emplace(name, group).first->second;
        if (group == groups_.size()) {
            groups_.push_back(Group(Kind::lights));
            groups_.back().shadows = source.shadows, groups_.back().highlights = source.highlights;
            groups_.back().receivers = light.receivers();
            size.push_back(0);
        }
        ++size[group];
        group_of.push_back(group);
    }
    auto group = group_of.begin();
    for (const Light& light : world.luminous) {
        Group& in = groups_[*group];
        Rgb radiance = gray(static_cast<float>(1 / scene::visible_area(light.source())));
        if (size[*group] == 1) in.scale = light.color();
        else radiance = radiance * light.color();
        in.visible.push_back(light.source().visible);
        in.members.push_back({shape_of(light.source()), radiance});
        ++group;
    }
}

void Emitters::add_objects(const World& world) {
    const auto materials = static_cast<std::uint32_t>(world.lobes.size());
    group_of_material_.assign(materials, none);
    radiance_of_material_.assign(materials, {});
    std::vector<std::uint32_t> emissive;
    std::vector<bool> used(materials);
    for (const std::uint32_t m : world.slots) used[m] = true;
    for (std::uint32_t m = 0; m < materials; ++m) {
        if (used[m] && !is_black(emission_of(world, m))) emissive.push_back(m);
    }
    if (emissive.empty()) return;
    const bool together = emissive.size() > most_materials;
    for (const std::uint32_t m : emissive) {
        if (!together || m == emissive.front()) groups_.push_back(Group(Kind::objects));
        group_of_material_[m] = static_cast<std::uint32_t>(groups_.size() - 1);
        if (!together) groups_.back().scale = emission_of(world, m);
        radiance_of_material_[m] = together ? emission_of(world, m) : gray(1);
    }
    for (std::uint32_t i = 0; i < world.instances.size(); ++i) {
        const auto slots = world.slots_of(i);
        if (std::any_of(slots.begin(), slots.end(), [&](std::uint32_t m) { return group_of_material_[m] != none; })) add_object(world, i);
    }
}

void Emitters::add_object(const World& world, std::uint32_t instance) {
    const accel::Instance& object = world.instances[instance];
    const auto* mesh = std::get_if<geometry::Mesh>(object.shape);
    Pieces pieces{object.to_world, object.one_sided.empty()};
    std::visit(pieces, *object.shape);
    ObjectPlaces places{instance, {}};
    if (pieces.found.empty()) {
        for (const std::uint32_t m : world.slots_of(instance)) {
            if (group_of_material_[m] != none) groups_[group_of_material_[m]].unsampled.push_back({world.identity[instance], object.to_world, radiance_of_material_[m]});
        }
    }
    for (const auto& [primitive, shape] : pieces.found) {
        const std::uint32_t slot = mesh && !mesh->slots.empty() ? mesh->slots[primitive] : 0;
        const std::uint32_t material = world.material(instance, slot), group = group_of_material_[material];
        if (group == none || !(shape.area() > 0)) continue;
        if (world.textured_material(material)) {  // whose light is another at every place
            const Unsampled found{world.identity[instance], object.to_world, radiance_of_material_[material]};
            auto& all = groups_[group].unsampled;
            if (all.empty() || all.back() != found) all.push_back(found);
            continue;
        }
        places.by_primitive.resize(primitive + 1, {none, none});
        places.by_primitive[primitive] = {group, static_cast<std::uint32_t>(groups_[group].members.size())};
        groups_[group].members.push_back({shape, radiance_of_material_[material]});
    }
    objects_.push_back(std::move(places));
}

std::optional<EmitterSample> Emitters::sample(std::size_t group, Vec3 point, const std::array<double, 3>& u) const {
    const Group& g = groups_[group];
    if (g.kind == Kind::environment) {
        const Environment::Sample chosen = environment_.sample(u[0], u[1]);
        if (!(chosen.pdf > 0)) return std::nullopt;
        return EmitterSample{chosen.direction, std::numeric_limits<double>::infinity(), environment_.radiance(chosen.direction), chosen.pdf};
    }
    const auto choice = g.hierarchy->choose(point, u[2]);
    if (!choice) return std::nullopt;
    const Member& member = g.members[choice->member];
    const auto seen = member.shape.sample(point, u[0], u[1]);
    if (!seen) return std::nullopt;
    return EmitterSample{seen->direction, seen->distance, member.radiance, seen->pdf * choice->chance};
}

Emitted Emitters::told(Place at, Vec3 from, Vec3 point, double distance) const {
    const Group& g = groups_[at.group];
    const Member& member = g.members[at.member];
    const double pdf = member.shape.pdf(from, point);
    return {at.group, member.radiance, pdf > 0 ? pdf * g.hierarchy->chance(at.member, from) : 0, distance, true};
}

std::optional<Emitted> Emitters::environment(Vec3 direction) const {
    if (environment_group_ >= groups_.size()) return std::nullopt;
    return Emitted{environment_group_, environment_.radiance(direction), environment_.pdf(direction), std::numeric_limits<double>::infinity(), true};
}

std::optional<Emitted> Emitters::surface(std::uint32_t instance, std::uint32_t primitive, std::uint32_t material, Vec3 point, Vec3 from) const {
    if (material >= group_of_material_.size() || group_of_material_[material] == none) return std::nullopt;
    const double distance = length(point - from);
    const auto object = std::lower_bound(objects_.begin(), objects_.end(), instance, [](const ObjectPlaces& o, std::uint32_t i) { return o.instance < i; });
    if (object != objects_.end() && object->instance == instance && primitive < object->by_primitive.size() && object->by_primitive[primitive].group != none) {
        return told(object->by_primitive[primitive], from, point, distance);
    }
    return Emitted{group_of_material_[material], radiance_of_material_[material], 0, distance, true};
}

bool Emitters::same_samples(std::size_t group, const Emitters& before, std::size_t group_before) const {
    const Group &a = groups_[group], &b = before.groups_[group_before];
    return a.kind == b.kind && a.shadows == b.shadows && a.highlights == b.highlights && same_receivers(a.receivers, b.receivers) && a.members == b.members && a.unsampled == b.unsampled &&
           (a.kind != Kind::environment || environment_.same_radiance(before.environment_));
}

}  // namespace crescente::render
