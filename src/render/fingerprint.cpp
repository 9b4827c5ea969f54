#include "render/fingerprint.h"

#include <concepts>

#include "base/byte_archive.h"
#include "base/checksum.h"
#include "geometry/face_archive.h"

namespace crescente::render {
namespace {

// An archive (base/byte_archive.h) that keeps only a checksum of what is written to it.
struct Hasher {
    std::uint64_t hash = 0;

    template <class T>
    void raw(const T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        hash = checksum({reinterpret_cast<const char*>(values), count * sizeof(T)}, hash);
    }
    template <class Container>
    void size(const Container& of, std::size_t) {
        const std::uint64_t count = of.size();
        raw(&count, 1);
    }
    bool good() const { return true; }
    void fail() {}
};

template <class T>
void add(Hasher& a, const T& number) {
    a.raw(&number, 1);
}
template <class T>
void add(Hasher& a, const std::vector<T>& numbers) {
    a.size(numbers, 1);
    a.raw(numbers.data(), numbers.size());
}
template <class T>
void add(Hasher& a, const std::vector<std::vector<T>>& rows) {
    a.size(rows, 1);
    for (const auto& row : rows) add(a, row);
}
template <class Owner>
void add_fields(Hasher& a, const Owner& owner) {
    for (const auto& field : Owner::fields()) {
        const FieldValue value = field.get(owner);
        add(a, value.index());
        std::visit([&](const auto& v) {
            using Value = std::remove_cvref_t<decltype(v)>;
            if constexpr (std::same_as<Value, std::string>) a.raw(v.data(), v.size());
            else if constexpr (std::same_as<Value, std::vector<std::string>>) {
                for (const std::string& name : v) add(a, name.size()), a.raw(name.data(), name.size());
            }
            else add(a, v);
        }, value);
    }
}
void add(Hasher& a, const std::vector<geometry::Curve>& curves) {
    a.size(curves, 1);
    for (const geometry::Curve& curve : curves) {
        add_fields(a, curve);
        add(a, curve.points), add(a, curve.weights), add(a, curve.knots);
    }
}

// What a shape has besides its fields. A new kind needs a line here.
struct AddArrays {
    Hasher& a;

    template <class Kind>
        requires std::same_as<Kind, geometry::Sphere> || std::same_as<Kind, geometry::Box> || std::same_as<Kind, geometry::Cone> ||
                 std::same_as<Kind, geometry::Cylinder> || std::same_as<Kind, geometry::Torus> || std::same_as<Kind, geometry::Disk> ||
                 std::same_as<Kind, geometry::Plane>
    void operator()(const Kind&) const {}
    void operator()(const geometry::Polygon& s) const { add(a, s.loops); }
    void operator()(const geometry::Mesh& s) const {
        add(a, s.positions), add(a, s.triangles), add(a, s.normals), add(a, s.slots);
        for (const auto& coordinates : s.coordinates) {
            if (!coordinates.empty()) add(a, coordinates);
        }
        if (!s.colors.empty()) add(a, s.colors);
        if (!s.tangents.empty()) add(a, s.tangents);
    }
    void operator()(const geometry::Bicubic& s) const { add(a, s.points), add(a, s.weights); }
    void operator()(const geometry::Nurbs& s) const { add(a, s.points), add(a, s.weights), add(a, s.knots_u), add(a, s.knots_v); }
    void operator()(const geometry::Revolution& s) const { add(a, s.profile), add(a, s.directrix); }
    void operator()(const geometry::Extrusion& s) const { add(a, s.profile); }
    void operator()(const geometry::Ruled& s) const { add(a, s.from), add(a, s.to); }
    void operator()(const geometry::Brep& s) const {
        for (std::uint32_t i = 0; i < s.face_count(); ++i) {
            geometry::Face plain = s.face(i);
            geometry::face(a, plain);
        }
    }
};

}  // namespace

Fingerprint fingerprint_of(const scene::Scene& scene) {
    Hasher shapes, objects, materials, lights, camera, surroundings;
    shapes.size(scene.shapes, 1);
    for (const scene::NamedShape& named : scene.shapes) {
        add(shapes, named.shape.index());
        std::visit([&](const auto& shape) { add_fields(shapes, shape); }, named.shape);
        std::visit(AddArrays{shapes}, named.shape);
    }
    objects.size(scene.nodes, 1);
    for (const scene::Node& node : scene.nodes) {
        if (node.motion) add(objects, *node.motion);
        add(objects, node.transform), add(objects, node.shape), add(objects, node.materials), add(objects, node.children), add(objects, node.visible);
    }
    add(objects, scene.roots);
    materials.size(scene.materials, 1);
    for (const scene::Material& material : scene.materials) {
        add(materials, material.model.index());
        std::visit([&](const auto& model) { add_fields(materials, model); }, material.model);
        for (const scene::TextureBinding& binding : material.textures) {
            materials.raw(binding.target.data(), binding.target.size());
            add_fields(materials, binding.texture);
            add(materials, binding.texture.image ? binding.texture.image->content() : 0);
        }
    }
    lights.size(scene.lights, 1);
    for (const scene::Light& light : scene.lights) {
        scene::Light nameless = light;
        nameless.profile.clear();
        add_fields(lights, nameless);
        if (light.measured) add(lights, light.measured->content());
    }
    if (scene.camera) add_fields(camera, *scene.camera);
    if (scene.environment) {
        scene::Environment nameless = *scene.environment;
        nameless.image.clear();
        add_fields(surroundings, nameless);
        add(surroundings, nameless.panorama ? nameless.panorama->content() : std::uint64_t{0});
    }
    return {{shapes.hash, objects.hash, materials.hash, lights.hash, camera.hash, surroundings.hash}};
}

}  // namespace crescente::render
