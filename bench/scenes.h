// Scenes that the benchmarks share.
#pragma once

#include <string>

#include "scene/scene.h"

namespace crescente::bench {

// A sphere of about a million triangles whose radius waves, with smooth normals, a light and a camera that it fills.
scene::Scene bumpy_sphere();

// The folder of the project.
std::string root();

// A file of scenes/, furnished as the program would. Ends the program with the reason if it cannot be read.
scene::Scene load(const std::string& file_name);

}  // namespace crescente::bench
