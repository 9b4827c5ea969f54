// Materials of a glTF file as physical materials with their textures.
#pragma once

#include <map>
#include <optional>
#include <set>

#include "io/gltf_document.h"
#include "scene/material.h"

namespace crescente::io {

class GltfMaterials {
public:
    explicit GltfMaterials(GltfDocument& document);

    // Nothing: the material of primitives that name none. Pictures are named, not read (io/texture_files.h).
    scene::Material read(std::optional<std::size_t> which);

    void warn_of_textures();  // once, after the last

private:
    // The texture that a member of an object names; nothing: none, or a problem, which is told.
    std::optional<scene::Texture> texture(const Json& owner, const Place& place, std::string_view key);
    std::shared_ptr<const scene::TextureImage> image(std::size_t which);

    GltfDocument& document_;
    std::map<std::size_t, std::shared_ptr<const scene::TextureImage>> images_;
    std::map<std::int64_t, std::shared_ptr<const scene::TextureImage>> pieces_;  // by buffer view
    std::set<std::optional<std::size_t>> colored_;  // materials that some primitive with vertex colours has
    std::size_t glossy_textures_ = 0, without_source_ = 0;
    std::set<std::string> other_sources_;  // extensions in which textures have their pictures
};

}  // namespace crescente::io
