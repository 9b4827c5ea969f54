// Materials of Assimp as physical materials.
#pragma once

#ifdef CRESCENTE_WITH_ASSIMP

#include <cstddef>
#include <filesystem>
#include <optional>

#include <assimp/material.h>

#include "scene/material.h"

namespace crescente::io {

// A plausible physical material of the same look: colours, gloss and transparency of the old models (Wavefront MTL, Phong), or
// metallic and roughness where the file has them. Nothing for Assimp's own grey, which means that the file names no material.
// Its textures are those that a physical material knows, in files of the folder or below, which are named and not read.
std::optional<scene::Material> physical_material(const aiMaterial& material, const std::filesystem::path& folder);

std::size_t texture_count(const aiMaterial& material);

}  // namespace crescente::io

#endif
