// Textures of a material in a scene file: {"base_color": {"image": "oak.png", "projection": "box"}}.
#pragma once

#include <filesystem>

#include "io/json_fields.h"
#include "io/scene_words.h"
#include "scene/material.h"

namespace crescente::io {

// Besides the fields of scene::Texture.
std::span<const Word> texture_words();

// The material's textures: an object by what each acts on, of one texture or a list of them. Pictures are named, not read (io/texture_files.h); their relative paths
// begin in the folder of the problems' file.
void read_textures(const Json& json, scene::Material& material, const Measure& measure, const Place& place, ProblemList& problems);

nlohmann::ordered_json write_textures(const scene::Material& material, const Measure& measure);

// Of the textures of a material with this model.
nlohmann::ordered_json textures_schema(const scene::Material& model);

}  // namespace crescente::io
