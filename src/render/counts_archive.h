// Counts as bytes, and back. Every member by name, so that a new one cannot be forgotten here: it makes another checkpoint_version.
#pragma once

#include "base/byte_archive.h"
#include "render/counts.h"

namespace crescente::render {

template <class Archive>
void counts(Archive& a, RayCounts& c) {
    auto& [camera, reflected, refracted, shadow, path] = c;
    value(a, camera), value(a, reflected), value(a, refracted), value(a, shadow), value(a, path);
}
template <class Archive>
void counts(Archive& a, TestCounts& c) {
    auto& [box_tests, shape_tests, shadow_cache_hits, kept_rays, shortcut_rays, shortcut_wrong] = c;
    value(a, box_tests), value(a, shape_tests), value(a, shadow_cache_hits), value(a, kept_rays), value(a, shortcut_rays), value(a, shortcut_wrong);
}

}  // namespace crescente::render
