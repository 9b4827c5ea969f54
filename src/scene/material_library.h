// Materials by name, for every front end: metals from measured optical constants, plastics, paints, glasses, rubber, ceramic, wood, leather and cloth.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "scene/material.h"

namespace crescente::scene {

struct LibraryMaterial {
    std::string name, group;
    std::string note;  // source of the constants, or what it stands for
    PhysicalMaterial material;
    std::vector<TextureBinding> textures{};  // procedures, at their true size
};

// All of them, group by group.
std::span<const LibraryMaterial> material_library();

// The names, in the same order.
const std::vector<std::string>& library_names();

// The material of exactly that name, or nothing.
const LibraryMaterial* find_in_library(std::string_view name);

}  // namespace crescente::scene
