#include "scene/studio.h"

#include <functional>
#include <string>

namespace crescente::scene {
namespace {

using math::Affine;
using math::Bounds;
using math::Vec3;
using math::gray;

constexpr const char* ground_name = "studio ground";

// Calls visit with points in world space that enclose all that is visible and bounded: vertices of meshes, corners of other shapes' boxes.
void for_each_outline_point(const Scene& scene, const std::function<void(Vec3)>& visit) {
    for_each_appearance(scene, [&](std::uint32_t node, const Affine& to_world, const std::vector<MaterialId>&) {
        const geometry::Shape& shape = scene.shapes[scene.nodes[node].shape.value].shape;
        if (const auto* mesh = std::get_if<geometry::Mesh>(&shape)) {
            for (const Vec3 p : mesh->positions) visit(to_world.point(p));
            return;
        }
        const Bounds box = geometry::bounds(shape);
        for (int i = 0; i < 8 && box.bounded(); ++i) visit(to_world.point(box.corner(i)));
    });
}

Vec3 direction_of(double azimuth_degrees, double elevation_degrees) {
    const double a = azimuth_degrees * math::pi / 180, e = elevation_degrees * math::pi / 180;
    return {std::sin(a) * std::cos(e), std::sin(e), std::cos(a) * std::cos(e)};
}

// Moves the camera along its view direction, and sideways, until the scene fills the frame but for a margin.
void frame(const Scene& scene, Camera& camera, Vec3 towards_camera, double aspect, double radius) {
    constexpr double margin = 0.86;  // share of the frame that the model takes
    const Vec3 forward = -towards_camera;
    const Vec3 right = normalize(cross(forward, camera.up)), up = cross(right, forward);
    const double tan_y = std::tan(camera.field_of_view / 2) * margin, tan_x = tan_y * aspect;
    for (int pass = 0; pass < 4; ++pass) {
        double distance = 0.05 * radius;
        for_each_outline_point(scene, [&](Vec3 p) {
            const Vec3 d = p - camera.target;
            distance = std::max({distance, std::abs(dot(d, right)) / tan_x - dot(d, forward), std::abs(dot(d, up)) / tan_y - dot(d, forward)});
        });
        camera.position = camera.target + towards_camera * distance;
        double left = 1e300, rightmost = -1e300, low = 1e300, high = -1e300;
        for_each_outline_point(scene, [&](Vec3 p) {
            const Vec3 d = p - camera.position;
            const double depth = std::max(dot(d, forward), 1e-9 * radius);
            left = std::min(left, dot(d, right) / depth), rightmost = std::max(rightmost, dot(d, right) / depth);
            low = std::min(low, dot(d, up) / depth), high = std::max(high, dot(d, up) / depth);
        });
        const Vec3 shift = (right * (left + rightmost) + up * (low + high)) * (0.5 * distance);
        camera.target += shift;
        camera.position += shift;
    }
}

// An evenly bright rectangle, or disk, that faces the model. Angles in degrees, azimuth from the camera's, to its right; lengths in radii of the model.
struct Panel {
    const char* name;
    double azimuth, elevation, distance, width, height;
    double irradiance;  // of what faces it at the model
    math::Rgb color;
    int points = 9;     // that lower levels see of it
    bool round = false;  // a disk as wide as that
};

// Panels, the radiance of what surrounds them, as light and in mirrors alike, and the backdrop.
struct Set {
    std::vector<Panel> panels;
    float zenith, horizon, nadir;
    float backdrop_bottom, backdrop_top;
    int directions = 20;
};

Set set_of(Studio studio) {
    constexpr math::Rgb warm{1.0f, 0.97f, 0.93f}, cool{0.93f, 0.96f, 1.0f}, white{1, 1, 1};
    switch (studio) {
        case Studio::standard:  // a round key light, a rim from behind, light from all of the upper half
            return {{{"key", -42, 46, 5, 2.2, 2.2, 2.9, warm, 16, true}, {"rim", 150, 38, 5, 1.6, 1.6, 1.0, cool, 5, true}}, 0.55f, 0.27f, 0.1f, 0.55f, 0.75f};
        case Studio::softbox:  // one large window of light, the other side lifted
            return {{{"soft box", -45, 42, 4, 2.6, 2.6, 3.2, white, 16}, {"reflector", 70, 15, 4.5, 2.5, 2.5, 0.5, white}}, 0.27f, 0.18f, 0.075f, 0.5f, 0.72f};
        case Studio::three_point:  // key, fill, rim
            return {{{"key", -40, 42, 4.5, 1.4, 1.4, 3.0, warm}, {"fill", 55, 18, 5, 2.6, 2.6, 0.9, white}, {"rim", 160, 42, 4.5, 0.7, 2.6, 2.6, cool}},
                    0.125f, 0.0875f, 0.0375f, 0.3f, 0.5f};
        case Studio::overhead:  // a strip above, across the view
            return {{{"strip", 0, 84, 3.2, 5, 1.1, 3.6, white, 16}, {"front", 0, 20, 5, 3, 1, 0.9, white}}, 0.21f, 0.12f, 0.06f, 0.35f, 0.6f};
        case Studio::tent:  // white cloth on all sides: hardly a shadow, and for glossy things nothing dark to mirror
            return {{{"left", -85, 30, 2.8, 3.4, 3.4, 1.2, white}, {"right", 85, 30, 2.8, 3.4, 3.4, 1.2, white}, {"back", 180, 30, 2.8, 3.4, 3.4, 0.9, white},
                     {"top", 0, 86, 2.8, 3.4, 3.4, 1.6, white}},
                    0.495f, 0.45f, 0.315f, 0.85f, 0.95f};
        case Studio::turntable:  // the same light from every side, so that a model that turns, or is walked around, stays as it is; strips for edges to mirror
            return {{{"top", 0, 88, 3.2, 2.6, 2.6, 2.2, white, 16, true}, {"strip 1", -60, 28, 4.2, 1, 3, 1.1, white}, {"strip 2", 60, 28, 4.2, 1, 3, 1.1, white},
                     {"strip 3", 180, 28, 4.2, 1, 3, 0.8, white}},
                    0.4f, 0.3f, 0.12f, 0.7f, 0.85f};
    }
    return {};
}

void add_panel(Scene& scene, const Panel& panel, Vec3 center, double radius, double camera_azimuth) {
    const Vec3 from = direction_of(camera_azimuth + panel.azimuth, panel.elevation);
    const double distance = panel.distance * radius;
    Light light;
    light.name = panel.name;
    light.kind = panel.round ? LightKind::disk : LightKind::rectangle;
    light.position = center + from * distance;
    light.direction = -from;
    light.width = panel.width * radius, light.height = panel.height * radius, light.radius = panel.width * radius / 2;
    light.points = panel.points;
    light.intensity = panel.irradiance * distance * distance;
    light.color = panel.color;
    light.visible = false;  // the backdrop is what the camera sees behind the model
    scene.lights.push_back(light);
}

}  // namespace

bool can_be_framed(const math::Bounds& everything) {
    constexpr double largest = 1e100;  // metres
    return everything.bounded() && everything.largest_coordinate() < largest;
}

bool is_studio_ground(const Node& node) { return node.name == ground_name; }

std::optional<Studio> studio_of(const Scene& scene) {
    for (std::size_t i = 0; i < std::size(studio_names); ++i) {
        const auto studio = static_cast<Studio>(i);
        const Set set = set_of(studio);
        if (std::equal(set.panels.begin(), set.panels.end(), scene.lights.begin(), scene.lights.end(), [](const Panel& panel, const Light& light) { return panel.name == light.name; })) return studio;
    }
    return {};
}

Ground ground_of(const Scene& scene) {
    for (const NodeId root : scene.roots) {
        const Node& node = scene.nodes[root.value];
        if (!is_studio_ground(node) || !node.visible) continue;
        const auto* model = node.materials.empty() ? nullptr : std::get_if<PhysicalMaterial>(&scene.materials[node.materials[0].value].model);
        return model && model->catcher ? Ground::catcher : Ground::studio;
    }
    return Ground::none;
}

math::Bounds bounds_without_ground(const Scene& scene) {
    Bounds box;
    for_each_appearance(scene, [&](std::uint32_t node, const Affine& to_world, const std::vector<MaterialId>&) {
        if (is_studio_ground(scene.nodes[node])) return;
        const Bounds shape = geometry::bounds(scene.shapes[scene.nodes[node].shape.value].shape);
        if (shape.bounded()) box.include(math::transform(to_world, shape));
    });
    return box;
}

Placement::Placement(const Scene& scene) : box(bounds_without_ground(scene)) {
    center = box.bounded() ? box.center() : Vec3{};
    // Never so small that the camera's place could not be told from the target's.
    radius = box.bounded() ? std::max({length(box.diagonal()) / 2, 1e-9, 1e-9 * box.largest_coordinate()}) : 1.0;
    if (!scene.camera) return;
    const Vec3 towards_camera = scene.camera->position - scene.camera->target;
    azimuth = std::atan2(towards_camera.x, towards_camera.z) * 180 / math::pi;
}

bool shines(const Scene& scene) {
    const auto emits = [](const Material& material) {
        if (const auto* m = std::get_if<PhysicalMaterial>(&material.model)) return !is_black(m->emissive);
        const auto& m = std::get<ClassicMaterial>(material.model);
        return !is_black(m.emission) || !is_black(m.ambient);
    };
    return !scene.lights.empty() || (scene.environment && scene.environment->lights()) ||
           std::any_of(scene.materials.begin(), scene.materials.end(), emits);
}

void add_camera(Scene& scene) {
    const Placement at(scene);
    Camera camera;
    camera.field_of_view = 28 * math::pi / 180;
    camera.target = at.center;
    frame(scene, camera, direction_of(32, 22), double(scene.settings.width) * camera.pixel_aspect / scene.settings.height, at.radius);
    scene.camera = camera;
}

void add_studio_lights(Scene& scene, const Placement& at, Studio studio) {
    const Set set = set_of(studio);
    for (const Panel& panel : set.panels) add_panel(scene, panel, at.center, at.radius, at.azimuth);
    if (scene.environment) return;
    Environment around;
    around.zenith = gray(set.zenith), around.horizon = gray(set.horizon), around.nadir = gray(set.nadir);
    around.strength = 1;
    around.directions = set.directions;
    around.backdrop = true;
    around.backdrop_bottom = gray(set.backdrop_bottom), around.backdrop_top = gray(set.backdrop_top);
    scene.environment = around;
}

void add_ground(Scene& scene, const Placement& at, Ground ground) {
    // Seen from below, a ground would hide the model.
    if (ground == Ground::none || !at.box.bounded() || !(scene.camera->position.y > at.box.lower.y)) return;
    Material material{ground_name, PhysicalMaterial{}};
    auto& model = std::get<PhysicalMaterial>(material.model);
    model.base_color = gray(0.5f);
    model.roughness = 0.3;
    model.ior = 1.4;
    model.catcher = ground == Ground::catcher;
    const MaterialId id{static_cast<std::uint32_t>(scene.materials.size())};
    scene.materials.push_back(std::move(material));
    geometry::Disk disk;
    disk.radius = 40 * at.radius;
    const ShapeId shape{static_cast<std::uint32_t>(scene.shapes.size())};
    scene.shapes.push_back({ground_name, disk});
    Node node;
    node.name = ground_name;
    // A hair below the model, so that the two never share a surface.
    node.transform = Affine::translation({at.center.x, at.box.lower.y - 1e-4 * at.radius, at.center.z});
    node.shape = shape;
    node.materials = {id};
    scene.roots.push_back({static_cast<std::uint32_t>(scene.nodes.size())});
    scene.nodes.push_back(std::move(node));
}

void add_studio(Scene& scene) {
    if (!scene.camera) add_camera(scene);
    if (shines(scene)) return;
    const Placement at(scene);
    add_studio_lights(scene, at, Studio::standard);
    add_ground(scene, at, Ground::studio);
}

}  // namespace crescente::scene
