// Light from where a ray leaves the scene.
#pragma once

#include <array>

#include "math/color.h"
#include "math/vec.h"
#include "render/lobes.h"
#include "scene/environment.h"

namespace crescente::render {

using namespace math;

// What surrounds a scene, made ready for being looked up and sampled.
class Environment {
public:
    Environment() = default;  // black
    explicit Environment(const scene::Environment& source);

    const scene::Environment& source() const { return source_; }
    bool operator==(const Environment& other) const { return source_ == other.source_; }

    bool backdrop() const { return source_.backdrop; }
    double strength() const { return source_.strength; }  // factor of its radiance where it lights surfaces
    bool same_radiance(const Environment& other) const;    // whatever the strength and the backdrop
    bool shines() const { return total_ > 0; }             // some direction is not black

    // Directions by their brightness; the density is per solid angle, and that of a direction is the same however it was found. Must shine.
    struct Sample {
        Vec3 direction;
        double pdf = 0;
    };
    Sample sample(double u0, double u1) const;  // u in [0, 1)^2
    double pdf(Vec3 direction) const;

private:
    double height_density(double height) const;

    scene::Environment source_;
    std::array<double, 3> brightness_{};  // at nadir, horizon, zenith
    double total_ = 0;                    // integral of the brightness over the height, -1 to 1
};

// Radiance from a direction (unit): linear in the height of the direction between nadir, horizon and zenith.
Rgb environment_radiance(const Environment& environment, Vec3 direction);

// Irradiance over pi on a surface with this normal (unit): the gradient convolved with the clamped cosine, in closed form.
Rgb environment_irradiance(const Environment& environment, Vec3 normal);

// Radiance that a surface sends to the viewer (unit) by the light of the environment alone, without shadows: diffuse, and the
// reflection that is too blurred for a mirrored ray. inside: the viewer is in the body.
Rgb reflect_environment(const Environment& environment, const Lobes& lobes, Vec3 normal, Vec3 to_viewer, bool inside);

// The backdrop at a height in the picture, 0 bottom to 1 top.
Rgb backdrop_radiance(const Environment& environment, double height);

}  // namespace crescente::render
