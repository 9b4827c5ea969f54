#include "io/packed_scene.h"

#include <cstring>
#include <type_traits>

namespace crescente::io {
namespace {

struct Writer {
    std::string bytes;

    template <class T>
    void raw(T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        if (count > 0) bytes.append(reinterpret_cast<const char*>(values), count * sizeof(T));
    }
    template <class Container>
    void size(Container& of, std::size_t) {
        std::uint64_t count = of.size();
        raw(&count, 1);
    }
    bool good() const { return true; }
};

struct Reader {
    std::string_view bytes;
    bool whole = true;

    template <class T>
    void raw(T* values, std::size_t count) {
        static_assert(std::is_trivially_copyable_v<T>);
        whole = whole && count <= bytes.size() / sizeof(T);
        if (!whole || count == 0) return;
        std::memcpy(values, bytes.data(), count * sizeof(T));
        bytes.remove_prefix(count * sizeof(T));
    }
    // An element takes at least `least` bytes: no count may be larger than what is left can hold.
    template <class Container>
    void size(Container& of, std::size_t least) {
        std::uint64_t count = 0;
        raw(&count, 1);
        whole = whole && count <= bytes.size() / least;
        if (whole) of.resize(count);
    }
    bool good() const { return whole; }
};

// One description of each type for both directions.
template <class Archive, class T>
void value(Archive& a, T& v) {
    a.raw(&v, 1);
}
template <class Archive>
void value(Archive& a, bool& v) {  // any other byte than 0 or 1 would be undefined as a bool
    unsigned char byte = v;
    a.raw(&byte, 1);
    v = byte != 0;
}
template <class Archive>
void value(Archive& a, std::string& v) {
    a.size(v, 1);
    if (a.good()) a.raw(v.data(), v.size());
}
template <class Archive, class T>
void array(Archive& a, std::vector<T>& v) {  // of plain values
    a.size(v, sizeof(T));
    if (a.good()) a.raw(v.data(), v.size());
}
template <class Archive, class T, class Each>
void list(Archive& a, std::vector<T>& v, Each&& each) {
    a.size(v, 8);  // each holds a text, whose length takes 8
    for (std::size_t i = 0; i < v.size() && a.good(); ++i) each(v[i]);
}

template <class Archive>
void problems(Archive& a, Problems& v) {
    list(a, v, [&](Problem& p) {
        for (std::string* part : {&p.file, &p.place, &p.reason, &p.hint}) value(a, *part);
    });
}

template <class Archive>
void material(Archive& a, scene::Material& v) {
    auto& m = std::get<scene::PhysicalMaterial>(v.model);
    value(a, v.name), value(a, m.base_color), value(a, m.metallic), value(a, m.roughness), value(a, m.emissive), value(a, m.ior);
    value(a, m.transmission), value(a, m.attenuation), value(a, m.opacity), value(a, m.double_sided);
}

template <class Archive>
void light(Archive& a, scene::Light& v) {
    value(a, v.name), value(a, v.kind), value(a, v.position), value(a, v.direction), value(a, v.color), value(a, v.intensity);
    value(a, v.inner_angle), value(a, v.outer_angle), value(a, v.gradient), value(a, v.exponent), value(a, v.falloff);
    value(a, v.constant), value(a, v.linear), value(a, v.quadratic), value(a, v.range), value(a, v.shadows), value(a, v.highlights);
}

template <class Archive>
void shape(Archive& a, scene::NamedShape& v) {
    value(a, v.name);
    if (!std::holds_alternative<geometry::Mesh>(v.shape)) v.shape = geometry::Mesh{};
    auto& mesh = std::get<geometry::Mesh>(v.shape);
    array(a, mesh.positions), array(a, mesh.triangles), array(a, mesh.normals), array(a, mesh.slots);
}

template <class Archive>
void loaded(Archive& a, Loaded& v) {
    scene::Scene& s = v.scene;
    problems(a, v.warnings);
    value(a, s.name), value(a, s.unit.name), value(a, s.unit.metres);
    list(a, s.shapes, [&](scene::NamedShape& one) { shape(a, one); });
    list(a, s.materials, [&](scene::Material& m) { material(a, m); });
    list(a, s.nodes, [&](scene::Node& n) {
        value(a, n.name), value(a, n.transform), value(a, n.shape), array(a, n.materials), array(a, n.children), value(a, n.visible);
    });
    array(a, s.roots);
    list(a, s.lights, [&](scene::Light& one) { light(a, one); });
    bool has_camera = s.camera.has_value();
    value(a, has_camera);
    if (has_camera && !s.camera) s.camera.emplace();
    if (has_camera) value(a, *s.camera);
}

}  // namespace

std::string pack(const Expected<Loaded>& result) {
    Writer writer;
    bool good = result.has_value();
    value(writer, good);
    if (good) {
        Loaded copy = *result;
        loaded(writer, copy);
    } else {
        Error copy = result.error();
        value(writer, copy.kind);
        problems(writer, copy.problems);
    }
    return std::move(writer.bytes);
}

std::optional<Expected<Loaded>> unpack(std::string_view bytes) {
    Reader reader{bytes};
    bool good = false;
    value(reader, good);
    if (good) {
        Loaded result;
        loaded(reader, result);
        if (reader.good() && reader.bytes.empty()) return Expected<Loaded>(std::move(result));
        return std::nullopt;
    }
    Error error;
    value(reader, error.kind);
    problems(reader, error.problems);
    if (reader.good() && reader.bytes.empty() && !error.problems.empty()) return Expected<Loaded>(tl::unexpected(std::move(error)));
    return std::nullopt;
}

}  // namespace crescente::io
