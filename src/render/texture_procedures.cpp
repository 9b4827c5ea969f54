#include "render/texture_procedures.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "math/mix_bits.h"

namespace crescente::render {
namespace {

using scene::Texture;
using scene::TextureKind;
using scene::TextureProjection;

// How far the footprint reaches along a way of the texture's space.
double reach(const TexturePlace& place, Vec3 way) { return std::hypot(dot(place.axes[0], way), dot(place.axes[1], way)); }
double whole_reach(const TexturePlace& place) { return std::max({reach(place, {1, 0, 0}), reach(place, {0, 1, 0}), reach(place, {0, 0, 1})}); }

// The mean over [x - w/2, x + w/2] of the wave that is 1 in even cells and -1 in odd ones.
double square_wave(double x, double w) {
    // Its integral is a triangle wave; at a width of less than rounding, its derivative.
    const auto integral = [](double at) { return 1 - std::abs(at - 2 * std::floor(at / 2) - 1); };
    const double width = std::max(w, 1e-6);
    return (integral(x + width / 2) - integral(x - width / 2)) / width;
}

// Squares, or cubes in a block.
double checker(const Texture& texture, const TexturePlace& place) {
    const Vec3 x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};
    double wave = square_wave(place.at.x, reach(place, x)) * square_wave(place.at.y, reach(place, y));
    if (texture.projection == TextureProjection::solid) wave *= square_wave(place.at.z, reach(place, z));
    return std::clamp(0.5 + 0.5 * wave, 0.0, 1.0);
}

double lattice_value(double x, double y, double z) {
    const auto bits = [](double v) { return std::bit_cast<std::uint64_t>(v + 0.0); };  // -0 as 0
    const std::uint64_t hash = mix_bits(bits(x) + mix_bits(bits(y) + mix_bits(bits(z))));
    return static_cast<double>(hash >> 11) * 0x1p-53;
}

// Values at lattice points (Lewis 1989), from 0 to 1, of mean 1/2, joined by Perlin's fade (2002), so that the second derivative is continuous.
double lattice_noise(Vec3 p) {
    const Vec3 at{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    const auto fade = [](double t) { return t * t * t * (t * (t * 6 - 15) + 10); };
    const double fx = fade(p.x - at.x), fy = fade(p.y - at.y), fz = fade(p.z - at.z);
    const auto line = [&](double y, double z) {
        const double a = lattice_value(at.x, y, z), b = lattice_value(at.x + 1, y, z);
        return a + (b - a) * fx;
    };
    const auto sheet = [&](double z) {
        const double a = line(at.y, z), b = line(at.y + 1, z);
        return a + (b - a) * fy;
    };
    const double a = sheet(at.z), b = sheet(at.z + 1);
    return a + (b - a) * fz;
}

// Octaves of half the size and half the height, each faded out where the footprint covers its features (Norton, Rockwood and Skolmoski 1982, "Clamping").
double octaves(Vec3 p, double width, int count) {
    double sum = 0, height = 0.5, whole = 0;
    for (int i = 0; i < count; ++i) {
        const double kept = std::clamp(2 - 2 * width, 0.0, 1.0);
        if (kept > 0) sum += height * kept * (lattice_noise(p) - 0.5);
        whole += height;
        p = p * 2.0 + Vec3{17.3, 5.1, 9.7}, width *= 2, height *= 0.5;
    }
    return 0.5 + sum / whole;
}

// In a block, along the texture's axis; on a surface, along u.
struct Grain {
    Vec3 along, across, aside;
};
Grain grain_of(const Texture& texture) {
    if (texture.projection != TextureProjection::solid) return {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Vec3 axis = normalize(texture.axis), across = perpendicular(axis);
    return {axis, across, cross(axis, across)};
}

// Scratches along the grain: noise drawn out in three widths.
double brushed(const Texture& texture, const TexturePlace& place) {
    const Grain grain = grain_of(texture);
    const double width = std::max(reach(place, grain.across), reach(place, grain.aside)), length = reach(place, grain.along) / texture.stretch;
    double sum = 0, whole = 0;
    Vec3 p{dot(place.at, grain.along) / texture.stretch, dot(place.at, grain.across), dot(place.at, grain.aside)};
    double scale = 1, height = 1;
    for (int i = 0; i < 3; ++i) {
        const double kept = std::clamp(2 - 2 * std::max(width, length) * scale, 0.0, 1.0);
        if (kept > 0) sum += height * kept * (lattice_noise(p * scale + Vec3{31.7 * i, 0, 0}) - 0.5);
        whole += height;
        scale *= 2.7, height *= 0.7;
    }
    return std::clamp(0.5 + 1.6 * sum / whole, 0.0, 1.0);
}

// Rings about the trunk, wavering, with pores along the grain.
double wood(const Texture& texture, const TexturePlace& place) {
    const Grain grain = grain_of(texture);
    const double along = dot(place.at, grain.along), x = dot(place.at, grain.across), y = dot(place.at, grain.aside);
    const bool solid = texture.projection == TextureProjection::solid;
    const double width = std::max(reach(place, grain.across), solid ? reach(place, grain.aside) : 0.0);
    const Vec3 slow{along * 0.08, x * 0.35, y * 0.35};
    // On a surface, a board cut near the heart: its rings are flat arches.
    const double radius = (solid ? std::hypot(x, y) : std::hypot(x, 0.6)) + 1.1 * (octaves(slow, width * 0.35, 2) - 0.5);
    const double kept = std::clamp(2 - 2 * width, 0.0, 1.0);
    const double phase = radius - std::floor(radius);
    // Early wood darkens slowly to late wood, and begins again at once: within the width of the footprint.
    const double edge = std::max(0.06, std::min(width, 0.5));
    const double ring = phase < edge ? 1 - phase / edge : std::pow((phase - edge) / (1 - edge), 2.2);
    constexpr double mean = 0.33;  // of the ring
    const Vec3 pore{along * 0.9, x * 14, y * 14};
    const double pores = std::clamp(2 - 2 * width * 14, 0.0, 1.0) * (lattice_noise(pore) - 0.5);
    return std::clamp(1 - (mean + kept * (ring - mean)) * 0.85 + 0.25 * pores, 0.0, 1.0);
}

// The nearest of points that lie one in each cell, and how far the nearest and the second are.
struct Nearest {
    Vec3 cell;
    double first = 1e9, second = 1e9;
};
Nearest nearest_points(Vec3 p) {
    const Vec3 at{std::floor(p.x), std::floor(p.y), std::floor(p.z)};
    Nearest nearest;
    for (int i = 0; i < 27; ++i) {
        const Vec3 cell = at + Vec3{i % 3 - 1.0, i / 3 % 3 - 1.0, i / 9 - 1.0};
        const Vec3 jitter{lattice_value(cell.x, cell.y, cell.z), lattice_value(cell.y + 0.5, cell.z, cell.x), lattice_value(cell.z + 0.25, cell.x, cell.y)};
        const double distance = length(cell + jitter - p);
        if (distance < nearest.first) nearest.second = nearest.first, nearest.first = distance, nearest.cell = cell;
        else nearest.second = std::min(nearest.second, distance);
    }
    return nearest;
}

// Grains: domes between creases, of uneven outline, with pores.
double leather(const TexturePlace& place) {
    const double width = whole_reach(place), kept = std::clamp(2 - 2 * width, 0.0, 1.0);
    constexpr double mean = 0.62;
    if (kept == 0) return mean;
    const Vec3 bend{lattice_noise(place.at * 1.7), lattice_noise(place.at * 1.7 + Vec3{41.3, 0, 7.7}), lattice_noise(place.at * 1.7 + Vec3{5.9, 83.1, 0})};
    const Nearest n = nearest_points(place.at + bend * 0.8);
    const double crease = std::clamp((n.second - n.first) / 0.28, 0.0, 1.0), dome = 1 - (1 - crease) * (1 - crease) * (1 - crease);
    const double fine = std::clamp(2 - 2 * width * 6, 0.0, 1.0) * (lattice_noise(place.at * 6.0) - 0.5);
    return std::clamp(mean + kept * (dome - 0.12 * n.first - mean) + 0.12 * fine, 0.0, 1.0);
}

// What is left of single flakes.
double flakes_seen(const TexturePlace& place) { return std::clamp(2 - 2 * whole_reach(place), 0.0, 1.0); }

bool is_near(Vec3 v) {
    constexpr double farthest = 1e9;  // beyond, numbers have no fractions to speak of
    return std::abs(v.x) < farthest && std::abs(v.y) < farthest && std::abs(v.z) < farthest;
}
bool is_near(const TexturePlace& place) { return is_near(place.at) && is_near(place.axes[0]) && is_near(place.axes[1]); }

}  // namespace

Vec3 flake_slope(const Texture& texture, const TexturePlace& place) {
    if (!is_near(place)) return {};
    const double seen = flakes_seen(place);
    if (seen == 0) return {};
    const Vec3 cell = nearest_points(place.at).cell;
    // Two numbers make two of a normal distribution (Box and Muller 1958), held to three deviations.
    const auto normal_pair = [&](double offset) {
        const double u = lattice_value(cell.x + offset, cell.y, cell.z), v = lattice_value(cell.x, cell.y + offset, cell.z);
        const double radius = std::min(3.0, std::sqrt(-2 * std::log(1 - u)));
        return std::pair{radius * std::cos(2 * pi * v), radius * std::sin(2 * pi * v)};
    };
    const auto [x, y] = normal_pair(0.125);
    return Vec3{x, y, normal_pair(0.375).first} * (texture.strength * seen);
}

double hidden_slopes(const Texture& texture, const TexturePlace& place) {
    const double seen = is_near(place) ? flakes_seen(place) : 0;
    return 2 * texture.strength * texture.strength * (1 - seen * seen);
}

double procedure_value(const Texture& texture, const TexturePlace& place) {
    if (!is_near(place)) return 0.5;
    switch (texture.kind) {
        case TextureKind::checker: return checker(texture, place);
        case TextureKind::noise: return octaves(place.at, whole_reach(place), 6);
        case TextureKind::brushed: return brushed(texture, place);
        case TextureKind::wood: return wood(texture, place);
        case TextureKind::leather: return leather(place);
        case TextureKind::flakes: {  // of as many brightnesses
            const Vec3 cell = nearest_points(place.at).cell;
            return 0.5 + flakes_seen(place) * (lattice_value(cell.x, cell.y + 0.625, cell.z) - 0.5);
        }
        case TextureKind::image:
        case TextureKind::vertex_color: break;
    }
    return 0.5;
}

}  // namespace crescente::render
