#include "io/packed_scene.h"

#include "base/byte_archive.h"

namespace crescente::io {
namespace {

// All that its field table has, so that nothing is forgotten.
template <class Archive, class Owner>
void fields(Archive& a, Owner& owner) {
    for (const auto& f : Owner::fields()) {
        FieldValue content = f.get(owner);
        std::visit([&a](auto& v) { value(a, v); }, content);
        if (const auto* choice = std::get_if<std::int64_t>(&content); choice && !f.info.choices.empty() && !(*choice >= 0 && *choice < static_cast<std::int64_t>(f.info.choices.size()))) {
            a.fail();
            return;
        }
        f.set(owner, content);
    }
}

template <class Archive>
void material(Archive& a, scene::Material& v) {
    value(a, v.name), fields(a, std::get<scene::PhysicalMaterial>(v.model));
    list(a, v.textures, 8, [&](scene::TextureBinding& b) {
        scene::Texture& t = b.texture;
        value(a, b.target), fields(a, t);
        scene::ImageSource source;
        if (t.image) source = t.image->source();
        bool has_image = t.image != nullptr;
        value(a, has_image), value(a, source.file), value(a, source.place);
        if (has_image && !t.image) t.image = std::make_shared<const scene::TextureImage>(std::move(source));
    });
}

template <class Archive>
void light(Archive& a, scene::Light& v) {
    value(a, v.name), fields(a, v);
}

template <class Archive>
void shape(Archive& a, scene::NamedShape& v) {
    value(a, v.name);
    if (!std::holds_alternative<geometry::Mesh>(v.shape)) v.shape = geometry::Mesh{};
    auto& mesh = std::get<geometry::Mesh>(v.shape);
    array(a, mesh.positions), array(a, mesh.triangles), array(a, mesh.normals), array(a, mesh.slots);
    array(a, mesh.coordinates[0]), array(a, mesh.colors), array(a, mesh.tangents);
}

template <class Archive>
void loaded(Archive& a, Loaded& v) {
    constexpr std::size_t least = 8;  // bytes: each element holds a text, whose length takes as many
    scene::Scene& s = v.scene;
    problems(a, v.warnings);
    value(a, s.name), value(a, s.unit.name), value(a, s.unit.metres);
    list(a, s.shapes, least, [&](scene::NamedShape& one) { shape(a, one); });
    list(a, s.materials, least, [&](scene::Material& m) { material(a, m); });
    list(a, s.nodes, least, [&](scene::Node& n) {
        value(a, n.name), value(a, n.transform), value(a, n.shape), array(a, n.materials), array(a, n.children), value(a, n.visible);
    });
    array(a, s.roots);
    list(a, s.lights, least, [&](scene::Light& one) { light(a, one); });
    bool has_camera = s.camera.has_value();
    value(a, has_camera);
    if (has_camera && !s.camera) s.camera.emplace();
    if (has_camera) value(a, *s.camera);
}

}  // namespace

std::string pack(const Expected<Loaded>& result) {
    ByteWriter writer;
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
    ByteReader reader{bytes};
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
