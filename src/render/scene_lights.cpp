#include "render/scene_lights.h"

#include <cmath>

#include "scene/sky.h"

namespace crescente::render {
namespace {

constexpr double golden_angle = 2.399963229728653;

// Where the i-th of n points of a light with extent is: spread evenly, by golden angles (Vogel 1979, "A Better Way to Construct the Sunflower Head") and golden ratios.
Vec3 point_on(const scene::Light& light, int i, int n) {
    const double share = (i + 0.5) / n;
    if (light.kind == scene::LightKind::sphere) {
        const double y = 1 - 2 * share, level = std::sqrt(1 - y * y);
        return light.position + Vec3{level * std::cos(i * golden_angle), y, level * std::sin(i * golden_angle)} * light.radius;
    }
    const Vec3 up = scene::upward_of(light), side = cross(up, normalize(light.direction));
    if (light.kind == scene::LightKind::disk) {
        const double r = light.radius * std::sqrt(share);
        return light.position + side * (r * std::cos(i * golden_angle)) + up * (r * std::sin(i * golden_angle));
    }
    const double along = i * 0.6180339887498949;
    return light.position + side * ((share - 0.5) * light.width) + up * ((along - std::floor(along) - 0.5) * light.height);
}

void add(World& world, const scene::Light& light, const Receivers& receivers) {
    const bool has_extent = scene::has_extent(light);
    const auto add_to = [&](std::vector<Light>& lights, const scene::Light& one) {
        lights.emplace_back(one);
        lights.back().link(receivers);
    };
    if (has_extent) add_to(world.luminous, light);
    if (!has_extent || light.points == 1) return add_to(world.lights, light);
    scene::Light point = light;
    point.intensity = light.intensity / light.points;
    for (int i = 0; i < light.points; ++i) {
        point.position = point_on(light, i, light.points);
        add_to(world.lights, point);
    }
}

// The size of what is lit, a power of two, so that an object that moves hardly ever moves the sun.
double extent_of(const World& world) {
    double largest = 0;
    for (const Bounds& box : world.boxes) {
        if (box.bounded() && !box.empty()) largest = std::max(largest, box.largest_coordinate());
    }
    return largest > 0 ? std::exp2(std::ceil(std::log2(largest))) : 1;
}

void add_sun(World& world) {
    const scene::Environment& source = world.environment.source();
    const auto daylight = scene::daylight_of(source.sky);
    if (!daylight) return;  // no valid scene
    scene::Light sun = scene::sun_of(*daylight, {}, extent_of(world), source.rotation);
    sun.intensity *= source.intensity;
    add(world, sun, nullptr);
}

// Directions of equal solid angle over the upper half (Fibonacci), each with the light of its part.
void add_directions(World& world) {
    const int count = world.environment.source().directions;
    if (count == 0 || !world.environment.source().lights()) return;
    constexpr double blur = 0.5;  // of a picture: its part of the sky is wide
    const double strength = world.environment.strength() * (1 - world.environment.even_share()) * 2 * pi / count;
    for (int i = 0; i < count; ++i) {
        const double y = (i + 0.5) / count, level = std::sqrt(1 - y * y);
        const Vec3 direction{level * std::cos(i * golden_angle), y, level * std::sin(i * golden_angle)};
        scene::Light light;
        light.name = "environment " + std::to_string(i + 1);
        light.kind = scene::LightKind::directional;
        light.direction = -direction;
        light.color = world.environment.source().panorama ? world.environment.blurred(direction, blur) : world.environment.radiance(direction);
        light.intensity = strength;
        light.highlights = false;
        world.lights.emplace_back(light, true);
    }
}

}  // namespace

void make_lights(World& world) {
    const std::vector<Receivers> receivers = receivers_of_lights(world.scene);
    for (std::size_t i = 0; i < world.scene.lights.size(); ++i) add(world, world.scene.lights[i], receivers[i]);
    if (!world.environment.source().sky.empty()) add_sun(world);
    add_directions(world);
}

}  // namespace crescente::render
