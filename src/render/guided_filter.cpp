#include "render/guided_filter.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>

namespace crescente::render {
namespace {

constexpr int passes = 4;         // of a 5 x 5 kernel, with steps of 1, 2, 4 and 8 corners
constexpr int kernel_radius = 2;
constexpr int neighbourhood = 3;  // corners to each side that show an unknown variance
constexpr float deviations = 4;   // light that differs by more than so many standard deviations is other light
static_assert(filter_reach == neighbourhood + kernel_radius * ((1 << passes) - 1));

// All without branches, so that the compiler does many corners of a row at a time.
[[gnu::always_inline]] inline float mix(float a, float b, float t) { return a * (1 - t) + b * t; }
[[gnu::always_inline]] inline float squared(float v) { return v * v; }
[[gnu::always_inline]] inline float larger(float a, float b) { return a > b ? a : b; }
[[gnu::always_inline]] inline float bisquare(float x) { return squared(larger(1 - x, 0)); }  // zero from x = 1 on

struct Numbers {  // of a guide
    float x, y, z, nx, ny, nz, roughness;
    std::uint32_t surface;
};

[[gnu::always_inline]] inline Alikeness alike(const Numbers& a, const Numbers& b) {
    const float dx = b.x - a.x, dy = b.y - a.y, dz = b.z - a.z;
    const float distance = dx * dx + dy * dy + dz * dz;
    const float off_plane = a.nx * dx + a.ny * dy + a.nz * dz;
    const float cosine = larger(a.nx * b.nx + a.ny * b.ny + a.nz * b.nz, 0);
    constexpr float steepest = 0.3f;  // sine of the angle by which the way to a neighbour may leave the surface
    const float level = bisquare(squared(off_plane) / (squared(steepest) * distance + 1e-30f));
    float sharp = squared(cosine);  // to the 32nd power
    sharp = squared(sharp), sharp = squared(sharp), sharp = squared(sharp), sharp = squared(sharp);
    const float diffuse = a.surface == b.surface ? sharp * level : 0.0f;
    // Normals that are apart by an angle turn reflected directions by twice that.
    return {diffuse, diffuse * bisquare(8 * larger(1 - cosine, 0) / squared(a.roughness))};
}

Numbers numbers(const Guide& g) { return {g.position[0], g.position[1], g.position[2], g.normal[0], g.normal[1], g.normal[2], g.roughness, g.surface}; }

[[gnu::always_inline]] inline float likely(float luminance_a, float variance_a, float luminance_b, float variance_b) {
    return bisquare(squared(luminance_a - luminance_b) / (squared(deviations) * (variance_a + variance_b) + 1e-20f));
}

// An array for each number, row by row.
struct Guides {
    std::vector<float> x, y, z, nx, ny, nz, roughness;
    std::vector<std::uint32_t> surface;

    explicit Guides(const std::vector<Guide>& guides) {
        for (auto* plane : {&x, &y, &z, &nx, &ny, &nz, &roughness}) plane->reserve(guides.size());
        surface.reserve(guides.size());
        for (const Guide& guide : guides) {
            const Numbers n = numbers(guide);
            x.push_back(n.x), y.push_back(n.y), z.push_back(n.z), nx.push_back(n.nx), ny.push_back(n.ny), nz.push_back(n.nz);
            roughness.push_back(n.roughness), surface.push_back(n.surface);
        }
    }
};
struct GuideRow {  // from some point of a row on
    const float *x, *y, *z, *nx, *ny, *nz, *roughness;
    const std::uint32_t* surface;

    GuideRow(const Guides& g, std::size_t p) : x(&g.x[p]), y(&g.y[p]), z(&g.z[p]), nx(&g.nx[p]), ny(&g.ny[p]), nz(&g.nz[p]), roughness(&g.roughness[p]), surface(&g.surface[p]) {}
    [[gnu::always_inline]] Numbers operator[](std::size_t i) const { return {x[i], y[i], z[i], nx[i], ny[i], nz[i], roughness[i], surface[i]}; }
};
enum Quantity { diffuse_r, diffuse_g, diffuse_b, glossy_r, glossy_g, glossy_b, seen, variance, quantities };
using Light = std::array<std::vector<float>, quantities>;

Light split(const std::vector<FilteredLight>& light) {
    Light planes;
    for (auto& plane : planes) plane.resize(light.size());
    for (std::size_t p = 0; p < light.size(); ++p) {
        const FilteredLight& l = light[p];
        const float values[] = {l.diffuse.r, l.diffuse.g, l.diffuse.b, l.glossy.r, l.glossy.g, l.glossy.b, l.luminance, l.variance};
        for (std::size_t k = 0; k < quantities; ++k) planes[k][p] = values[k];
    }
    return planes;
}

void join(const Light& planes, std::vector<FilteredLight>& light) {
    for (std::size_t p = 0; p < light.size(); ++p) {
        const auto at = [&](Quantity k) { return planes[k][p]; };
        light[p] = {{at(diffuse_r), at(diffuse_g), at(diffuse_b)}, {at(glossy_r), at(glossy_g), at(glossy_b)}, at(seen), at(variance)};
    }
}

// Calls add(first, end, offset, i, j) for each neighbour of a row's corners that lies on the grid: of corners first to end, at that offset.
template <class Add>
void for_each_neighbour(int width, int height, int y, int radius, int step, Add&& add) {
    for (int j = -radius; j <= radius; ++j) {
        if (y + j * step < 0 || y + j * step >= height) continue;
        for (int i = -radius; i <= radius; ++i) {
            const std::ptrdiff_t row = static_cast<std::ptrdiff_t>(y) * width;
            const int first = std::max(0, -i * step), end = std::min(width, width - i * step);
            if (first < end) add(static_cast<std::size_t>(row + first), static_cast<std::size_t>(row + end), static_cast<std::ptrdiff_t>(j) * step * width + i * step, i, j);
        }
    }
}

// Few samples say little of their own variance: neighbours of the same surface together say more. Where nothing at all is known of it, the neighbours' light shows
// how it varies, and what sticks out far from them is held to that: else it would stand alone, as a bright dot.
void smooth_variances(const GuidedGrid& grid, const Guides& guides, Light& light, parallel::Pool& pool) {
    Light next = light;
    pool.for_each(static_cast<std::size_t>(grid.height), [&](std::size_t y) {
        const auto width = static_cast<std::size_t>(grid.width), row = y * width;
        const bool any_unknown = std::any_of(&light[variance][row], &light[variance][row] + width, [](float v) { return v < 0; });
        std::vector<float> sums(5 * width);
        for_each_neighbour(grid.width, grid.height, static_cast<int>(y), any_unknown ? neighbourhood : 1, 1,
                           [&](std::size_t first, std::size_t end, std::ptrdiff_t offset, int i, int j) {
            const bool near = std::abs(i) <= 1 && std::abs(j) <= 1, other = offset != 0;
            const GuideRow here(guides, first), there(guides, first + static_cast<std::size_t>(offset));
            const float *const other_seen = &light[seen][first + static_cast<std::size_t>(offset)], *const other_variance = &light[variance][first + static_cast<std::size_t>(offset)];
            float* const row_sums = sums.data() + (first - row);
            const std::size_t count = end - first;
#pragma GCC ivdep
            for (std::size_t k = 0; k < count; ++k) {
                const float weight = alike(here[k], there[k]).glossy, v = other_variance[k], l = other_seen[k];
                const float known = near && v >= 0 ? weight : 0.0f, from_others = other ? weight : 0.0f;
                row_sums[k] += from_others, row_sums[k + width] += from_others * l, row_sums[k + 2 * width] += from_others * l * l;
                row_sums[k + 3 * width] += known, row_sums[k + 4 * width] += known * v;
            }
        });
        const float *const weights = sums.data(), *const sum = weights + width, *const squares = sum + width, *const of_known = squares + width, *const variances = of_known + width;
        for (std::size_t x = 0; x < width; ++x) {
            const std::size_t p = row + x;
            if (light[variance][p] >= 0) {
                next[variance][p] = variances[x] / of_known[x];
                continue;
            }
            if (weights[x] < 1) {
                next[variance][p] = squared(light[seen][p]);
                continue;
            }
            const float mean = sum[x] / weights[x];
            next[variance][p] = larger(squares[x] / weights[x] - squared(mean), 0);
            const float most = mean + 3 * std::sqrt(next[variance][p]);
            if (light[seen][p] <= most) continue;
            for (std::size_t k = 0; k <= seen; ++k) next[k][p] *= most / light[seen][p];
        }
    });
    light.swap(next);
}

// Of shares, whose noise is far below what the spread of their light has one expect: by how much, in the mean of five by five of them, corners are off the saddle through their eight neighbours
// (Immerkaer 1996, "Fast Noise Variance Estimation"). What rises evenly, as a penumbra does, is no noise. Where there are no such neighbours all is left as it is.
void find_variances_of_shares(GuidedGrid& grid, Light& light, parallel::Pool& pool) {
    constexpr int mask[3][3] = {{1, -2, 1}, {-2, 4, -2}, {1, -2, 1}}, radius = 2;
    const float to_deviation = std::sqrt(std::numbers::pi_v<float> / 2) / 6;  // of normal noise, by the mask's sum of squares, 36
    const auto width = static_cast<std::size_t>(grid.width);
    std::vector<float> ripples(grid.guides.size(), -1);
    pool.for_each(static_cast<std::size_t>(grid.height), [&](std::size_t y) {
        if (y == 0 || y + 1 == static_cast<std::size_t>(grid.height)) return;
        for (std::size_t x = 1; x + 1 < width; ++x) {
            const std::size_t p = y * width + x;
            float off = 0;
            bool alike = grid.guides[p].surface != Guide::nothing;
            for (std::size_t j = 0; j < 3; ++j) {
                for (std::size_t i = 0; i < 3; ++i) {
                    const std::size_t q = p + j * width + i - width - 1;
                    alike = alike && grid.guides[q].surface == grid.guides[p].surface;
                    off += static_cast<float>(mask[j][i]) * light[seen][q];
                }
            }
            if (alike) ripples[p] = std::abs(off);
        }
    });
    pool.for_each(static_cast<std::size_t>(grid.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < grid.width; ++x) {
            float sum = 0, count = 0;
            for (int v = std::max(0, y - radius); v <= std::min(grid.height - 1, y + radius); ++v) {
                for (int u = std::max(0, x - radius); u <= std::min(grid.width - 1, x + radius); ++u) {
                    const float ripple = ripples[static_cast<std::size_t>(v) * width + static_cast<std::size_t>(u)];
                    if (ripple >= 0) sum += ripple, ++count;
                }
            }
            const std::size_t p = row * width + static_cast<std::size_t>(x);
            light[variance][p] = count > 0 ? squared(sum / count * to_deviation) : 0;
            grid.guides[p].aim *= light[variance][p];
        }
    });
}

// One pass of the wavelet transform for the corners of a row.
void filter_row(const GuidedGrid& grid, const Guides& guides, const Light& light, int y, int step, Light& next) {
    constexpr float kernel[] = {3.0f / 8, 1.0f / 4, 1.0f / 16};  // cubic B-spline, by distance
    const auto width = static_cast<std::size_t>(grid.width), row = static_cast<std::size_t>(y) * width;
    const auto goes_on = [&](std::size_t p) { return grid.guides[p].surface != Guide::nothing && light[variance][p] > grid.guides[p].aim; };
    bool any = false;
    for (std::size_t p = row; p < row + width && !any; ++p) any = goes_on(p);
    if (!any) return;
    std::vector<float> glossy_share(width), sums(9 * width);
    for (std::size_t x = 0; x < width; ++x) {
        const std::size_t p = row + x;
        const float glossy = luminance(Rgb{light[glossy_r][p], light[glossy_g][p], light[glossy_b][p]});
        glossy_share[x] = light[seen][p] > 0 ? std::clamp(glossy / light[seen][p], 0.0f, 1.0f) : 0;
    }
    for_each_neighbour(grid.width, grid.height, y, kernel_radius, step, [&](std::size_t first, std::size_t end, std::ptrdiff_t offset, int i, int j) {
        const float share = kernel[std::abs(i)] * kernel[std::abs(j)];
        const std::size_t other = first + static_cast<std::size_t>(offset), count = end - first;
        const GuideRow here(guides, first), there(guides, other);
        const float *const l = &light[seen][first], *const v = &light[variance][first], *const ol = &light[seen][other], *const ov = &light[variance][other];
        const float *const dr = &light[diffuse_r][other], *const dg = &light[diffuse_g][other], *const db = &light[diffuse_b][other];
        const float *const gr = &light[glossy_r][other], *const gg = &light[glossy_g][other], *const gb = &light[glossy_b][other];
        const float* const glossy_shares = &glossy_share[first - row];
        float* const row_sums = &sums[first - row];
#pragma GCC ivdep
        for (std::size_t k = 0; k < count; ++k) {
            const Alikeness a = alike(here[k], there[k]);
            const float weight = share * likely(l[k], v[k], ol[k], ov[k]);
            const float diffuse = weight * a.diffuse, glossy = weight * a.glossy;
            row_sums[k] += diffuse * dr[k], row_sums[k + width] += diffuse * dg[k], row_sums[k + 2 * width] += diffuse * db[k];
            row_sums[k + 3 * width] += glossy * gr[k], row_sums[k + 4 * width] += glossy * gg[k], row_sums[k + 5 * width] += glossy * gb[k];
            row_sums[k + 6 * width] += diffuse, row_sums[k + 7 * width] += glossy;
            row_sums[k + 8 * width] += squared(mix(diffuse, glossy, glossy_shares[k])) * ov[k];
        }
    });
    for (std::size_t x = 0; x < width; ++x) {
        const std::size_t p = row + x;
        if (!goes_on(p)) continue;
        const float diffuse_weights = sums[x + 6 * width], glossy_weights = sums[x + 7 * width];
        for (std::size_t k = 0; k < 3; ++k) next[k][p] = sums[x + k * width] / diffuse_weights, next[k + 3][p] = sums[x + (k + 3) * width] / glossy_weights;
        const Rgb sent{next[diffuse_r][p], next[diffuse_g][p], next[diffuse_b][p]}, mirrored{next[glossy_r][p], next[glossy_g][p], next[glossy_b][p]};
        next[seen][p] = grid.shares ? share_of(sent) + luminance(mirrored) : luminance(sent + mirrored);
        next[variance][p] = sums[x + 8 * width] / squared(mix(diffuse_weights, glossy_weights, glossy_share[x]));
    }
}

}  // namespace

Alikeness alikeness(const Guide& a, const Guide& b) { return alike(numbers(a), numbers(b)); }

float likelihood(const FilteredLight& a, const FilteredLight& b) { return likely(a.luminance, a.variance, b.luminance, b.variance); }

float share_of(Rgb caught) { return caught.b > 0 ? std::min(1.0f, caught.g / caught.b) : 1; }

void filter(GuidedGrid& grid, parallel::Pool& pool) {
    const Guides guides(grid.guides);
    Light light = split(grid.light);
    if (grid.shares) find_variances_of_shares(grid, light, pool);
    else smooth_variances(grid, guides, light, pool);
    for (int pass = 0; pass < passes; ++pass) {
        Light next = light;
        pool.for_each(static_cast<std::size_t>(grid.height), [&](std::size_t y) { filter_row(grid, guides, light, static_cast<int>(y), 1 << pass, next); });
        light.swap(next);
    }
    join(light, grid.light);
}

}  // namespace crescente::render
