#include "render/estimates.h"

#include <bit>
#include <cmath>

#include "render/forest.h"
#include "render/world.h"

namespace crescente::render {
namespace {

// Two positive numbers in 32 bits: the upper halves of floats, 3 digits each, which is enough to decide by.
std::uint32_t packed(float a, float b) { return (std::bit_cast<std::uint32_t>(a) & 0xffff0000) | std::bit_cast<std::uint32_t>(b) >> 16; }
Spread unpacked(std::uint32_t v) { return {std::bit_cast<float>(v & 0xffff0000), std::bit_cast<float>(v << 16)}; }

const Estimate* estimates_of(const World& world, const Tile& tile, std::uint32_t node) { return tile.estimates.data() + node * estimate_groups(world); }

}  // namespace

std::size_t estimate_groups(const World& world) { return world.emitters.groups() + 1; }

Rgb scale_of_group(const World& world, std::size_t group) { return group < world.emitters.groups() ? world.emitters.scale(group) : Rgb{1, 1, 1}; }

void add_sample(Estimate& estimate, std::uint32_t index, Rgb diffuse, Rgb glossy) {
    estimate.diffuse += diffuse, estimate.glossy += glossy;
    if (index >= pilot) return;
    const float sample = luminance(diffuse + glossy);
    const float squares = std::bit_cast<float>(estimate.spread) + sample * sample;
    if (index + 1 < pilot) {
        estimate.spread = std::bit_cast<std::uint32_t>(squares);
        return;
    }
    const float mean = luminance(estimate.diffuse + estimate.glossy) / pilot;
    const float variance = std::max(0.0f, squares / pilot - mean * mean) * pilot / (pilot - 1);
    estimate.spread = packed(std::max(0.0f, mean), std::sqrt(variance));
}

Rgb sampled_radiance(const World& world, const Tile& tile, std::uint32_t node) {
    const Estimate* estimates = estimates_of(world, tile, node);
    Rgb sum;
    for (std::size_t g = 0; g < estimate_groups(world); ++g) sum += (estimates[g].diffuse + estimates[g].glossy) * scale_of_group(world, g);
    return sum * (1.0f / static_cast<float>(tile.samples[node]));
}

std::uint32_t samples_needed(const World& world, const Tile& tile, std::uint32_t node) {
    // A pixel is the mean of four corners, each with samples of its own.
    return samples_needed(world, spread_of(world, estimates_of(world, tile, node)), max_component(influence(tile, node)), 4);
}

Spread spread_of(const World& world, const Estimate* estimates) {
    Spread sum;
    for (std::size_t g = 0; g < estimate_groups(world); ++g) {
        const Spread spread = unpacked(estimates[g].spread);
        const float scale = max_component(scale_of_group(world, g));
        sum.mean += scale * spread.mean, sum.deviation += scale * spread.deviation;
    }
    return sum;
}

std::uint32_t samples_needed(const World& world, const Spread& spread, double influence, double mean_of) {
    const scene::Settings& settings = world.scene.settings;
    const double dark = 0.02 * std::exp2(-settings.exposure);  // errors below this, for noise 1, are not seen in dark pixels either
    const double ratio = influence * spread.deviation / (settings.noise * (influence * spread.mean + dark));
    const double wanted = ratio * ratio / mean_of;
    std::uint32_t samples = pilot;
    while (samples < wanted && samples < static_cast<std::uint32_t>(settings.samples)) samples *= 2;
    return std::min(samples, std::max(pilot, static_cast<std::uint32_t>(settings.samples)));
}

}  // namespace crescente::render
