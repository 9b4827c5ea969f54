// Counted work: what was traced and tried.
#pragma once

#include <cstdint>

namespace crescente::render {

struct RayCounts {
    std::uint64_t camera = 0, reflected = 0, refracted = 0, shadow = 0, path = 0;  // path: drawn by sampling

    std::uint64_t total() const { return camera + reflected + refracted + shadow + path; }
    RayCounts& operator+=(const RayCounts& other) {
        camera += other.camera, reflected += other.reflected, refracted += other.refracted, shadow += other.shadow, path += other.path;
        return *this;
    }
};

inline RayCounts operator-(const RayCounts& a, const RayCounts& b) {
    return {a.camera - b.camera, a.reflected - b.reflected, a.refracted - b.refracted, a.shadow - b.shadow, a.path - b.path};
}

struct TestCounts {
    std::uint64_t box_tests = 0, shape_tests = 0;         // box tests: kay-kajiya only
    std::uint64_t shadow_cache_hits = 0;
    std::uint64_t kept_rays = 0;  // tried after edits against the instances alone that came or went
    std::uint64_t shortcut_rays = 0, shortcut_wrong = 0;  // coherent sub-pixel rays: answered by the pixel's own objects, and how often that was not the nearest

    TestCounts& operator+=(const TestCounts& other) {
        box_tests += other.box_tests, shape_tests += other.shape_tests, shadow_cache_hits += other.shadow_cache_hits;
        kept_rays += other.kept_rays;
        shortcut_rays += other.shortcut_rays, shortcut_wrong += other.shortcut_wrong;
        return *this;
    }
};

}  // namespace crescente::render
