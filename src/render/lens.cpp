#include "render/lens.h"

#include <algorithm>
#include <cmath>

#include "render/world.h"

namespace crescente::render {
namespace {

// Concentric map from the square to the unit disk (Shirley and Chiu 1997, "A Low Distortion Map Between Disk and Square").
std::array<double, 2> point_of_disk(double u, double v) {
    const double a = 2 * u - 1, b = 2 * v - 1;
    if (a == 0 && b == 0) return {0, 0};
    const bool wide = std::abs(a) > std::abs(b);
    const double radius = wide ? a : b, angle = wide ? pi / 4 * (b / a) : pi / 2 - pi / 4 * (a / b);
    return {radius * std::cos(angle), radius * std::sin(angle)};
}

// Of the regular polygon in the unit circle with a corner at the top: one of its triangles about the middle, and a point in that.
std::array<double, 2> point_of_polygon(int corners, double u, double v) {
    const double place = u * corners, sector = std::min(std::floor(place), corners - 1.0);
    const double outward = std::sqrt(v), along = place - sector;  // the triangle's lines parallel to its outer side grow with the distance
    const double a = 2 * pi * sector / corners, b = 2 * pi * (sector + 1) / corners;
    const double x = -std::sin(a) * (1 - along) - std::sin(b) * along, y = std::cos(a) * (1 - along) + std::cos(b) * along;
    return {outward * x, outward * y};
}

}  // namespace

std::optional<Lens> lens_of(const World& world, std::uint64_t motion) {
    const scene::Camera& camera = *world.scene.camera;
    if (world.scene.settings.level <= scene::Level::edges) return {};
    const bool takes_time = camera.shutter_close > camera.shutter_open;
    const bool catches = std::any_of(world.lobes.begin(), world.lobes.end(), [](const Lobes& lobes) { return lobes.catcher; });
    const Lens lens{camera, takes_time ? motion : 0, catches, world.environment.source().transparent};
    const bool sees_motion = lens.objects != 0 || (takes_time && camera.moves());
    return camera.aperture > 0 || sees_motion ? std::optional(lens) : std::nullopt;
}

std::array<double, 2> point_of_opening(const scene::Camera& camera, double u, double v) {
    const auto [x, y] = camera.blades == 0 ? point_of_disk(u, v) : point_of_polygon(camera.blades, u, v);
    const double radius = camera.aperture / 2, c = std::cos(camera.blade_rotation) * radius, s = std::sin(camera.blade_rotation) * radius;
    return {x * c - y * s, x * s + y * c};
}

}  // namespace crescente::render
