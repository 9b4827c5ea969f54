#include "render/guided_filter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace crescente::render {
namespace {

constexpr int passes = 4;           // of a 5 x 5 kernel, with steps of 1, 2, 4 and 8 corners
constexpr int neighbourhood = 3;    // corners to each side that show an unknown variance
constexpr float deviations = 4;     // light that differs by more than so many standard deviations is other light

float mix(float a, float b, float t) { return a * (1 - t) + b * t; }
float squared(float v) { return v * v; }

// Zero from x = 1 on.
float bisquare(float x) { return x < 1 ? squared(1 - x) : 0; }

template <class Visit>
void for_each_around(const GuidedGrid& grid, int x, int y, int radius, int step, Visit&& visit) {
    for (int j = -radius; j <= radius; ++j) {
        const int v = y + j * step;
        if (v < 0 || v >= grid.height) continue;
        for (int i = -radius; i <= radius; ++i) {
            const int u = x + i * step;
            if (u < 0 || u >= grid.width) continue;
            visit(i, j, static_cast<std::size_t>(v) * grid.width + u);
        }
    }
}

// Calls work(x, y, index) for each point that there is.
template <class Work>
void for_each_point(const GuidedGrid& grid, parallel::Pool& pool, Work&& work) {
    pool.for_each(static_cast<std::size_t>(grid.height), [&](std::size_t y) {
        for (int x = 0; x < grid.width; ++x) {
            const std::size_t p = y * static_cast<std::size_t>(grid.width) + x;
            if (grid.guides[p].surface != Guide::nothing) work(x, static_cast<int>(y), p);
        }
    });
}

// Few samples say little of their own variance: neighbours of the same surface together say more. Where nothing at all is known of it, the neighbours' light shows
// how it varies, and what sticks out far from them is held to that: else it would stand alone, as a bright dot.
void smooth_variances(GuidedGrid& grid, parallel::Pool& pool) {
    std::vector<FilteredLight> next = grid.light;
    for_each_point(grid, pool, [&](int x, int y, std::size_t p) {
        const FilteredLight& here = grid.light[p];
        const bool unknown = here.variance < 0;
        float weights = 0, sum = 0, squares = 0, of_known = 0, variances = 0;
        for_each_around(grid, x, y, unknown ? neighbourhood : 1, 1, [&](int, int, std::size_t q) {
            const FilteredLight& light = grid.light[q];
            const float weight = alikeness(grid.guides[p], grid.guides[q]).glossy;
            if (q != p) weights += weight, sum += weight * light.luminance, squares += weight * squared(light.luminance);
            if (light.variance >= 0) of_known += weight, variances += weight * light.variance;
        });
        if (!unknown) {
            next[p].variance = variances / of_known;
            return;
        }
        if (weights < 1) {
            next[p].variance = squared(here.luminance);
            return;
        }
        const float mean = sum / weights;
        next[p].variance = std::max(0.0f, squares / weights - squared(mean));
        const float most = mean + 3 * std::sqrt(next[p].variance);
        if (here.luminance <= most) return;
        const float share = most / here.luminance;
        next[p].diffuse *= gray(share), next[p].glossy *= gray(share), next[p].luminance = most;
    });
    grid.light.swap(next);
}

}  // namespace

Alikeness alikeness(const Guide& a, const Guide& b) {
    if (a.surface != b.surface) return {};
    float cosine = 0, off_plane = 0, distance = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const float d = b.position[i] - a.position[i];
        cosine += a.normal[i] * b.normal[i];
        off_plane += a.normal[i] * d;
        distance += d * d;
    }
    if (cosine <= 0) return {};
    float sharp = cosine * cosine;  // to the 32nd power
    sharp *= sharp, sharp *= sharp, sharp *= sharp, sharp *= sharp;
    constexpr float steepest = 0.3f;  // sine of the angle by which the way to a neighbour may leave the surface
    if (distance > 0) sharp *= bisquare(squared(off_plane) / (squared(steepest) * distance));
    // Normals that are apart by an angle turn reflected directions by twice that.
    return {sharp, sharp * bisquare(8 * std::max(0.0f, 1 - cosine) / squared(a.roughness))};
}

float likelihood(const FilteredLight& a, const FilteredLight& b) {
    return bisquare(squared(a.luminance - b.luminance) / (squared(deviations) * (a.variance + b.variance) + 1e-20f));
}

void filter(GuidedGrid& grid, parallel::Pool& pool) {
    smooth_variances(grid, pool);
    std::vector<FilteredLight> next = grid.light;
    constexpr float kernel[] = {3.0f / 8, 1.0f / 4, 1.0f / 16};  // cubic B-spline, by distance
    for (int pass = 0; pass < passes; ++pass) {
        for_each_point(grid, pool, [&](int x, int y, std::size_t p) {
            const FilteredLight& here = grid.light[p];
            next[p] = here;
            if (here.variance <= grid.guides[p].aim) return;
            const float glossy_share = here.luminance > 0 ? std::clamp(luminance(here.glossy) / here.luminance, 0.0f, 1.0f) : 0;
            Rgb diffuse, glossy;
            float variance = 0, diffuse_weights = 0, glossy_weights = 0;
            for_each_around(grid, x, y, 2, 1 << pass, [&](int i, int j, std::size_t q) {
                const Alikeness alike = alikeness(grid.guides[p], grid.guides[q]);
                if (alike.diffuse == 0) return;
                const FilteredLight& light = grid.light[q];
                const float weight = kernel[std::abs(i)] * kernel[std::abs(j)] * likelihood(here, light);
                diffuse_weights += weight * alike.diffuse, glossy_weights += weight * alike.glossy;
                diffuse += weight * alike.diffuse * light.diffuse, glossy += weight * alike.glossy * light.glossy;
                variance += squared(weight * mix(alike.diffuse, alike.glossy, glossy_share)) * light.variance;
            });
            next[p].diffuse = diffuse * (1 / diffuse_weights), next[p].glossy = glossy * (1 / glossy_weights);
            next[p].luminance = luminance(next[p].diffuse + next[p].glossy);
            next[p].variance = variance / squared(mix(diffuse_weights, glossy_weights, glossy_share));
        });
        grid.light.swap(next);
    }
}

}  // namespace crescente::render
