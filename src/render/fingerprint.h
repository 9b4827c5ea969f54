// Whether two scenes give the same ray trees, in a few numbers: what the trees depend on, the settings aside.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "scene/scene.h"

namespace crescente::render {

// Checksums of the parts of a scene. Names do not count, nor what is derived; everything that an index may name does, whether it is seen or not. The same
// on every machine that keeps numbers alike (little endian, IEEE 754).
struct Fingerprint {
    static constexpr std::array<std::string_view, 6> names = {"shapes", "objects", "materials", "lights", "camera", "surroundings"};
    std::array<std::uint64_t, names.size()> parts{};  // by name

    bool operator==(const Fingerprint&) const = default;
};

Fingerprint fingerprint_of(const scene::Scene& scene);

}  // namespace crescente::render
