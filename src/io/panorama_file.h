// Reads pictures of all that surrounds a scene: equirectangular, HDR or not.
#pragma once

#include <filesystem>
#include <memory>

#include "base/error.h"
#include "io/json_text.h"
#include "scene/environment.h"

namespace crescente::io {

struct ReadPanorama {
    std::shared_ptr<const scene::Panorama> panorama;
    Problems warnings;  // negative samples, which are taken for 0; a picture that is not twice as wide as high
};

// Any format that OpenImageIO knows; decoded in a process of its own (io/isolated.h). Samples of 8 and 16 bits are by the sRGB curve (IEC 61966-2-1), others linear; grey is all three
// colours, and alpha is left out. Errors: missing, damaged, of more than 2^27 pixels, more than 64 times as wide as high or as high as wide, of two channels or more than four, samples that are no finite numbers (input); no OpenImageIO in this
// build (unsupported); no memory for it (resource).
Expected<ReadPanorama> read_panorama(const std::filesystem::path& file);

// Reads the picture that the environment names, if it names one, and puts it there with its whole path; or makes the sky that it says. A path that is not absolute is taken from
// `folder`. Returns warnings. Errors: as read_panorama, as scene::daylight_of, both.
Expected<Problems> load_panorama(scene::Environment& environment, const std::filesystem::path& folder);

// The same for an environment that `json` gave, at a place in the file of `problems`, from whose folder its path is taken. What is wrong, and warnings, are told in `problems`.
void load_panorama(scene::Environment& environment, const Json& json, const Place& place, ProblemList& problems);

}  // namespace crescente::io
