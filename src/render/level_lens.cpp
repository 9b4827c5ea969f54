#include "render/level_lens.h"

#include <algorithm>
#include <cmath>

#include "render/film.h"
#include "render/lens_sampler.h"

namespace crescente::render {
namespace {

constexpr int around = 4;  // pixels on each side, whose samples tell of a pixel

class LensRounds {
public:
    LensRounds(Growth& growth, const Stage& stage)
        : tile_(growth.tile()),
          world_(growth.world()),
          pixels_(lens_pixels_of(growth.tile(), growth.settings())),
          columns_(growth.world()),
          count_(columns_.count()),
          bound_(static_cast<std::uint32_t>(stage.parameter)),
          most_(static_cast<std::uint32_t>(growth.settings().samples)),
          sampler_(growth.world(), growth.tile().rays, growth.tile().tests) {}

    bool run(const Deadline& deadline) {
        const std::size_t pixels = pixels_.count();
        if (tile_.lens_pixels.empty()) show_trees();
        tile_.lens_samples.resize(pixels);
        tile_.lens_estimates.resize(pixels * count_);
        if ((tile_.lens_piloted || bound_ > pilot) && most_ > pilot) find_needed();
        while (tile_.cursor < pixels) {
            chunk_.clear();
            const std::size_t end = std::min(tile_.cursor + chunk_size, pixels);
            for (std::size_t i = tile_.cursor; i < end; ++i) {
                chunk_.push_back(static_cast<std::uint32_t>(i));
                forget_too_many(chunk_.back());
            }
            const bool complete = sample_chunk(deadline);
            for (const std::uint32_t i : chunk_) show(i);
            if (!complete) return false;
            tile_.cursor = end;
            if (deadline.passed() && end < pixels) return false;
        }
        tile_.lens_piloted = tile_.lens_piloted || bound_ >= pilot;
        return true;
    }

private:
    void show_trees() {
        std::vector<float> clear = develop_clear(tile_);
        tile_.lens_pixels = develop(tile_);
        if (columns_.apart) clear.resize(tile_.lens_pixels.size()), tile_.lens_clear = std::move(clear);
    }

    // How many samples each pixel should have, by the pilots: its own, and all those around it together. A small bright thing far out of focus is spread over many pixels, in most of
    // which none of the first samples happens to meet it.
    void find_needed() {
        const int width = pixels_.width, height = pixels_.height;
        std::vector<Spread> spreads;
        for (std::size_t i = 0; i < pixels_.count(); ++i) spreads.push_back(lens_spread(world_, columns_, &tile_.lens_estimates[i * count_]));
        struct Sum {
            double mean = 0, variance = 0;
        };
        const auto at = [&](int x, int y) { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x); };
        std::vector<Sum> rows(spreads.size());
        for (int y = 0; y < height; ++y) {
            for (int x = 0; x < width; ++x) {
                for (int i = std::max(0, x - around); i <= std::min(width - 1, x + around); ++i) {
                    const Spread& s = spreads[at(i, y)];
                    rows[at(x, y)].mean += s.mean, rows[at(x, y)].variance += static_cast<double>(s.deviation) * s.deviation;
                }
            }
        }
        needed_.resize(spreads.size());
        for (int y = 0; y < height; ++y) {
            const int top = std::max(0, y - around), bottom = std::min(height - 1, y + around);
            for (int x = 0; x < width; ++x) {
                Sum sum;
                for (int j = top; j <= bottom; ++j) sum.mean += rows[at(x, j)].mean, sum.variance += rows[at(x, j)].variance;
                const int count = (bottom - top + 1) * (std::min(width - 1, x + around) - std::max(0, x - around) + 1);
                const Spread together{static_cast<float>(sum.mean / count), static_cast<float>(std::sqrt(sum.variance / count))};
                const std::uint32_t needed = samples_needed(world_, std::max(samples_wanted(world_, spreads[at(x, y)], 1, 1), samples_wanted(world_, together, 1, 1)));
                needed_[at(x, y)] = is_own(pixels_.x0 + x, pixels_.y0 + y) ? needed : pilot;
            }
        }
    }
    bool is_own(int x, int y) const { return x >= tile_.x0 && x < tile_.x0 + tile_.width && y >= tile_.y0 && y < tile_.y0 + tile_.height; }

    std::uint32_t goal(std::uint32_t i) const { return bound_ <= pilot ? bound_ : std::min(bound_, needed_[i]); }

    // After an edit a pixel may have more samples than a fresh render would have given it. What the pilot showed still holds.
    void forget_too_many(std::uint32_t i) {
        const std::uint32_t samples = tile_.lens_samples[i];
        const std::uint32_t needed = most_ <= pilot ? most_ : samples > pilot ? needed_[i] : samples;
        if (samples <= needed) return;
        tile_.lens_samples[i] = 0;
        for (std::size_t c = 0; c < count_; ++c) {
            Estimate& estimate = tile_.lens_estimates[i * count_ + c];
            estimate = {{}, {}, tile_.lens_piloted ? estimate.spread : 0};
        }
    }

    // One sample of each after the other. Whether there was time for all.
    bool sample_chunk(const Deadline& deadline) {
        while (true) {
            wanting_.clear(), samples_.clear();
            for (const std::uint32_t i : chunk_) {
                if (tile_.lens_samples[i] >= goal(i)) continue;
                wanting_.push_back(i);
                samples_.push_back({x_of(i), y_of(i), tile_.lens_samples[i]});
            }
            if (wanting_.empty()) return true;
            light_.resize(wanting_.size() * count_);
            sampler_.sample(samples_, light_);
            for (std::size_t k = 0; k < wanting_.size(); ++k) {
                const std::uint32_t i = wanting_[k];
                for (std::size_t c = 0; c < count_; ++c) {
                    Estimate& estimate = tile_.lens_estimates[i * count_ + c];
                    const SampledLight& light = light_[k * count_ + c];
                    const std::uint32_t after_pilot = std::max<std::uint32_t>(pilot, tile_.lens_samples[i]);
                    add_sample(estimate, tile_.lens_piloted ? after_pilot : tile_.lens_samples[i], light.diffuse, light.glossy);
                }
                ++tile_.lens_samples[i];
            }
            if (deadline.passed()) return false;
        }
    }

    int x_of(std::uint32_t i) const { return pixels_.x0 + static_cast<int>(i) % pixels_.width; }
    int y_of(std::uint32_t i) const { return pixels_.y0 + static_cast<int>(i) / pixels_.width; }

    void show(std::uint32_t i) {
        const int x = x_of(i), y = y_of(i);
        if (tile_.lens_samples[i] == 0 || !is_own(x, y)) return;
        const LensPixel pixel = lens_pixel(world_, columns_, &tile_.lens_estimates[i * count_], tile_.lens_samples[i]);
        const std::size_t own = static_cast<std::size_t>(y - tile_.y0) * static_cast<std::size_t>(tile_.width) + static_cast<std::size_t>(x - tile_.x0);
        tile_.lens_pixels[own] = pixel.color;
        if (columns_.apart) tile_.lens_clear[own] = pixel.clear;
    }

    Tile& tile_;
    const World& world_;
    const LensPixels pixels_;
    const LensColumns columns_;
    const std::size_t count_;  // of columns
    const std::uint32_t bound_, most_;
    LensSampler sampler_;
    std::vector<std::uint32_t> needed_;  // by pixel, once the pilots are complete
    std::vector<std::uint32_t> chunk_, wanting_;
    std::vector<PixelSample> samples_;
    std::vector<SampledLight> light_;
};

}  // namespace

LensPixels lens_pixels_of(const Tile& tile, const scene::Settings& settings) {
    const int x0 = std::max(0, tile.x0 - around), y0 = std::max(0, tile.y0 - around);
    return {x0, y0, std::min(settings.width, tile.x0 + tile.width + around) - x0, std::min(settings.height, tile.y0 + tile.height + around) - y0};
}

bool advance_lens(Growth& growth, const Stage& stage, const Deadline& deadline) { return LensRounds(growth, stage).run(deadline); }

}  // namespace crescente::render
