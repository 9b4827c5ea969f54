#include "render/texture_image_filter.h"

#include <algorithm>
#include <cmath>

namespace crescente::render {
namespace {

using scene::Rgba;
using scene::Texture;
using scene::TextureImage;
using scene::Wrap;

void add(Rgba& sum, const Rgba& value, float weight) { sum.r += value.r * weight, sum.g += value.g * weight, sum.b += value.b * weight, sum.a += value.a * weight; }

// In this form equal values stay what they are.
Rgba between(const Rgba& p, const Rgba& q, float t) { return {p.r + (q.r - p.r) * t, p.g + (q.g - p.g) * t, p.b + (q.b - p.b) * t, p.a + (q.a - p.a) * t}; }

// The texel that stands for number `i` of a row without end.
int wrapped(double i, int size, Wrap wrap) {
    if (i >= 0 && i < size) return static_cast<int>(i);
    switch (wrap) {
        case Wrap::repeat: return static_cast<int>(i - std::floor(i / size) * size);
        case Wrap::clamp: return static_cast<int>(std::clamp(i, 0.0, size - 1.0));
        case Wrap::mirror: {
            const double within = i - std::floor(i / (2.0 * size)) * (2.0 * size);
            return static_cast<int>(within < size ? within : 2.0 * size - 1 - within);
        }
    }
    return 0;
}

Rgba nearest(const Texture& t, int level, double u, double v) {
    const TextureImage& image = *t.image;
    const int width = image.width(level), height = image.height(level);
    return image.texel(level, wrapped(std::floor(u * width), width, t.wrap_u), wrapped(std::floor(v * height), height, t.wrap_v));
}

Rgba bilinear(const Texture& t, int level, double u, double v) {
    const TextureImage& image = *t.image;
    const int width = image.width(level), height = image.height(level);
    const double x = u * width - 0.5, y = v * height - 0.5, x0 = std::floor(x), y0 = std::floor(y);
    const auto fx = static_cast<float>(x - x0), fy = static_cast<float>(y - y0);
    const int left = wrapped(x0, width, t.wrap_u), right = wrapped(x0 + 1, width, t.wrap_u);
    const int top = wrapped(y0, height, t.wrap_v), bottom = wrapped(y0 + 1, height, t.wrap_v);
    const auto [a, b, c, d] = image.texels(level, left, right, top, bottom);
    return between(between(a, b, fx), between(c, d, fx), fy);
}

}  // namespace

Rgba filtered_image(const Texture& t, const TexturePlace& place, bool blurred) {
    const TextureImage& image = *t.image;
    // A place so far out that its numbers have no fractions, or none at all, is anywhere.
    constexpr double farthest = 1e9;
    const auto tame = [](double c) { return std::abs(c) < farthest ? c : 0; };
    const double u = tame(place.at.x), v = tame(place.at.y);
    const auto texels = [&](const Vec3& axis) {
        const double x = axis.x * image.width(), y = axis.y * image.height();
        return std::sqrt(x * x + y * y);
    };
    const double a = texels(place.axes[0]), b = texels(place.axes[1]);
    const Vec3& along = a > b ? place.axes[0] : place.axes[1];
    const double major = std::max(a, b);
    if (!(major > 1) && t.filter == scene::TextureFilter::nearest) return nearest(t, 0, u, v);
    if (!(major > 1)) return bilinear(t, 0, u, v);
    if (!std::isfinite(major)) return image.texel(image.level_count() - 1, 0, 0);
    if (blurred) return nearest(t, static_cast<int>(std::min(std::log2(major) + 0.5, image.level_count() - 1.0)), u, v);
    constexpr double most_taps = 16;
    const double minor = std::max({std::min(a, b), major / most_taps, 1.0});
    const int taps = static_cast<int>(std::ceil(major / minor));
    const double coarseness = std::min(std::log2(minor), image.level_count() - 1.0);
    const int level = static_cast<int>(coarseness);
    const auto rest = static_cast<float>(coarseness - level);
    Rgba sum{0, 0, 0, 0};
    for (int i = 0; i < taps; ++i) {
        const double at = (i + 0.5) / taps - 0.5;
        const double x = tame(u + along.x * at), y = tame(v + along.y * at);
        const float weight = 1.0f / static_cast<float>(taps);
        const Rgba fine = bilinear(t, level, x, y);
        add(sum, rest > 0 ? between(fine, bilinear(t, level + 1, x, y), rest) : fine, weight);
    }
    return sum;
}

}  // namespace crescente::render
