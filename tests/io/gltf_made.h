// glTF files made in tests, and what is read of them.
#pragma once

#include "io/gltf.h"
#include "reader_check.h"

namespace crescente::io {

inline const scene::PhysicalMaterial& physical(const scene::Scene& scene, std::size_t i) {
    return std::get<scene::PhysicalMaterial>(scene.materials.at(i).model);
}

inline const scene::Texture& texture(const scene::Material& material, const std::string& target) {
    for (const scene::TextureBinding& binding : material.textures) {
        if (binding.target == target) return binding.texture;
    }
    static const scene::Texture none;
    ADD_FAILURE() << material.name << " has no texture for " << target;
    return none;
}

// A file made here: its parts can be replaced by what a test wants to see.
struct Made {
    std::string bytes;  // the buffer
    std::string views, accessors;
    int view_count = 0, accessor_count = 0;

    template <class T>
    int accessor(const std::vector<T>& values, int component_type, const std::string& type, int components, const std::string& more = {}) {
        while (bytes.size() % 4 != 0) bytes.push_back('\0');
        const std::size_t offset = bytes.size();
        bytes.append(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T));
        views += (view_count ? "," : "") + std::string(R"({"buffer":0,"byteOffset":)") + std::to_string(offset) + R"(,"byteLength":)" +
                 std::to_string(values.size() * sizeof(T)) + "}";
        accessors += (accessor_count ? "," : "") + std::string(R"({"bufferView":)") + std::to_string(view_count++) + R"(,"componentType":)" +
                     std::to_string(component_type) + R"(,"type":")" + type + R"(","count":)" +
                     std::to_string(values.size() / static_cast<std::size_t>(components)) + more + "}";
        return accessor_count++;
    }

    std::string glb(const std::string& rest) const {
        std::string json = R"({"asset":{"version":"2.0"},"buffers":[{"byteLength":)" + std::to_string(bytes.size()) + R"(}],"bufferViews":[)" + views +
                           R"(],"accessors":[)" + accessors + "]" + (rest.empty() ? "" : ",") + rest + "}";
        std::string body = bytes;
        while (json.size() % 4 != 0) json.push_back(' ');
        while (body.size() % 4 != 0) body.push_back('\0');
        const auto word = [](std::size_t v) {
            const auto v32 = static_cast<std::uint32_t>(v);
            return std::string(reinterpret_cast<const char*>(&v32), 4);
        };
        return "glTF" + word(2) + word(28 + json.size() + body.size()) + word(json.size()) + "JSON" + json + word(body.size()) +
               std::string("BIN\0", 4) + body;
    }
};

inline Expected<Loaded> read(const std::string& bytes) { return read_gltf(bytes, "test.glb", "/nowhere"); }

inline const std::vector<float> square{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0};
inline const std::string one_node = R"("scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}])";

inline std::string mesh_with(const std::string& primitives) { return R"("meshes":[{"primitives":[)" + primitives + "]}]," + one_node; }

}  // namespace crescente::io
