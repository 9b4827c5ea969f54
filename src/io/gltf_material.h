// Materials of a glTF file as physical materials: factors, and the mean of the textures that they are multiplied with.
#pragma once

#include <map>
#include <optional>

#include "io/gltf_document.h"
#include "io/image_mean.h"
#include "scene/material.h"

namespace crescente::io {

class GltfMaterials {
public:
    explicit GltfMaterials(GltfDocument& document) : document_(document) {}

    // Nothing: the material of primitives that name none.
    scene::Material read(std::optional<std::size_t> which);

    void warn_of_textures();  // once, after the last

private:
    std::optional<ImageMean> mean(const Json& owner, const Place& place, std::string_view key, double alpha_cutoff = 0.5);

    GltfDocument& document_;
    std::map<std::pair<std::size_t, double>, std::optional<ImageMean>> means_;  // by image and cutoff
    std::map<std::size_t, bool> textures_;                                       // seen: whether a mean stands in
    std::size_t pixels_left_ = std::size_t{1} << 27;                             // decoding is bounded over the whole file
};

}  // namespace crescente::io
