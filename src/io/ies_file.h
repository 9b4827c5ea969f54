// Reads measured lamps: IES LM-63 (1986, 1991, 1995 and 2002).
#pragma once

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "io/json_text.h"
#include "scene/light.h"

namespace crescente::io {

// Candela values with the file's multiplier and ballast factor; of type C. Tilt factors are left out with no effect where the file says NONE, and refused otherwise. Errors (input), with the line: missing, not of this
// format, numbers missing, wrong or out of range, angles that do not rise or do not end where they may, photometry of type A or B.
Expected<std::shared_ptr<const scene::LightProfile>> read_ies_file(const std::filesystem::path& file);
Expected<std::shared_ptr<const scene::LightProfile>> read_ies(std::string_view text, const std::string& file);

// Reads the file that the light names, if it names one, and puts it there with its whole path. A path that is not absolute is taken from the folder of the file of `problems`, where
// `json` gave it at `place`. What is wrong is told in `problems`.
void load_profile(scene::Light& light, const Json& json, const Place& place, ProblemList& problems);

}  // namespace crescente::io
