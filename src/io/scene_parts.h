// The parts of a scene file that stand alone: shapes, materials, transforms.
#pragma once

#include "io/json_fields.h"
#include "scene/material_library.h"
#include "scene/scene.h"

namespace crescente::io {

// {"sphere": {"radius": 1}}. Nothing if the kind is wrong; wrong fields are told and left at their defaults.
std::optional<geometry::Shape> read_shape(const Json& json, const Measure& measure, const Place& place, ProblemList& problems);

// The material of the library that is named; null, told: there is none.
const scene::LibraryMaterial* read_library_material(const Json& json, const Place& place, ProblemList& problems);

// {"model": "classic", ...} or {"library": "gold satin", ...}. The name is the caller's.
scene::Material read_material(const Json& json, const Measure& measure, const Place& place, ProblemList& problems);

// The same where an object names its material: with the name that it says, or that of the library.
scene::Material read_own_material(const Json& json, const Measure& measure, const Place& place, ProblemList& problems);

// A step or a list of steps, the first applied first.
math::Affine read_transform(const Json& json, const Measure& measure, const Place& place, ProblemList& problems);

// How lengths of the scene are written: in its unit where that is one of the format, else in metres.
Measure measure_of(const scene::Scene& scene);

// Adds the material's members to the object, but for its name.
void write_material(const scene::Material& material, const Measure& measure, nlohmann::ordered_json& object);

}  // namespace crescente::io
