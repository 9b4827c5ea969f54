#include "render/estimates.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "render/forest.h"
#include "render/world.h"

namespace crescente::render {
namespace {

// Two positive numbers in 32 bits: the upper halves of floats, 3 digits each, which is enough to decide by.
std::uint32_t packed(float a, float b) { return (std::bit_cast<std::uint32_t>(a) & 0xffff0000) | std::bit_cast<std::uint32_t>(b) >> 16; }
Spread unpacked(std::uint32_t v) { return {std::bit_cast<float>(v & 0xffff0000), std::bit_cast<float>(v << 16)}; }

// While the pilot is under way, or with its last sample.
Spread spread_so_far(const Estimate& estimate, std::uint32_t samples) {
    const auto count = static_cast<float>(samples);
    const float mean = luminance(estimate.diffuse + estimate.glossy) / count;
    const float variance = std::max(0.0f, std::bit_cast<float>(estimate.spread) / count - mean * mean);
    return {std::max(0.0f, mean), std::sqrt(samples > 1 ? variance * count / (count - 1) : variance)};
}

const Estimate* estimates_of(const World& world, const Tile& tile, std::uint32_t node) { return tile.estimates.data() + node * estimate_groups(world); }

}  // namespace

Spread spread_of(const Estimate& estimate, std::uint32_t samples) {
    return samples >= pilot ? unpacked(estimate.spread) : spread_so_far(estimate, samples);
}

std::size_t estimate_groups(const World& world) { return world.emitters.groups() + 1; }

Rgb scale_of_group(const World& world, std::size_t group) { return group < world.emitters.groups() ? world.emitters.scale(group) : Rgb{1, 1, 1}; }

void add_sample(Estimate& estimate, std::uint32_t index, Rgb diffuse, Rgb glossy) {
    estimate.diffuse += diffuse, estimate.glossy += glossy;
    if (index >= pilot) return;
    const float sample = luminance(diffuse + glossy);
    estimate.spread = std::bit_cast<std::uint32_t>(std::bit_cast<float>(estimate.spread) + sample * sample);
    if (index + 1 < pilot) return;
    const Spread spread = spread_so_far(estimate, pilot);
    estimate.spread = packed(spread.mean, spread.deviation);
}

SampledParts sampled_parts(const World& world, const Tile& tile, std::uint32_t node) {
    const Estimate* estimates = estimates_of(world, tile, node);
    const std::uint32_t samples = tile.samples[node];
    SampledParts parts;
    float deviation = 0;  // deviations are added as if the groups erred together
    for (std::size_t g = 0; g < estimate_groups(world); ++g) {
        const Rgb scale = scale_of_group(world, g);
        parts.diffuse += estimates[g].diffuse * scale, parts.glossy += estimates[g].glossy * scale;
        deviation += max_component(scale) * spread_of(estimates[g], samples).deviation;
    }
    const float share = 1.0f / static_cast<float>(samples);
    parts.diffuse *= gray(share), parts.glossy *= gray(share);
    if (samples >= fewest_to_tell) parts.deviation = deviation;
    return parts;
}

Rgb sampled_radiance(const World& world, const Tile& tile, std::uint32_t node) {
    const Estimate* estimates = estimates_of(world, tile, node);
    Rgb sum;
    for (std::size_t g = 0; g < estimate_groups(world); ++g) sum += (estimates[g].diffuse + estimates[g].glossy) * scale_of_group(world, g);
    return sum * (1.0f / static_cast<float>(tile.samples[node]));
}

Spread spread_of(const World& world, const Estimate* estimates, std::uint32_t samples) {
    Spread sum;
    for (std::size_t g = 0; g < estimate_groups(world); ++g) {
        const Spread spread = spread_of(estimates[g], samples);
        const float scale = max_component(scale_of_group(world, g));
        sum.mean += scale * spread.mean, sum.deviation += scale * spread.deviation;
    }
    return sum;
}

double samples_wanted(const World& world, const Spread& spread, double influence, double mean_of) {
    const scene::Settings& settings = world.scene.settings;
    const double dark = 0.02 * std::exp2(-settings.exposure);  // errors below this, for noise 1, are not seen in dark pixels either
    const double ratio = influence * spread.deviation / (settings.noise * (influence * spread.mean + dark));
    return ratio * ratio / mean_of;
}

double samples_wanted(const World& world, const Tile& tile, std::uint32_t node, unsigned depth) {
    if (tile.samples[node] < fewest_to_tell) return std::numeric_limits<double>::infinity();
    // A pixel is the mean of its parts, and a part that of its corners, each with samples of its own. With n parts to a side the squares of the corners' weights,
    // added, come to the square of (n - 1/2) / n^2: the pixel is as noisy as the mean of so many. Some corners have less weight, where parts are split further.
    const double parts = std::exp2(depth), alike = parts * parts / (parts - 0.5);
    return samples_wanted(world, spread_of(world, estimates_of(world, tile, node), tile.samples[node]), max_component(influence(tile, node)), alike * alike);
}

std::uint32_t samples_needed(const World& world, double wanted) {
    const auto bound = static_cast<std::uint32_t>(world.scene.settings.samples);
    std::uint32_t samples = pilot;
    while (samples < wanted && samples < bound) samples *= 2;
    return std::min(samples, std::max(pilot, bound));
}

std::uint32_t samples_needed(const World& world, const Tile& tile, std::uint32_t node, unsigned depth) { return samples_needed(world, samples_wanted(world, tile, node, depth)); }

}  // namespace crescente::render
