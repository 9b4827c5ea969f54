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
    double strength() const { return panorama() ? source_.intensity : source_.strength; }  // factor of its radiance where it lights surfaces
    double even_share() const { return source_.directions > 0 ? 0.4 : 1.0; }  // of its light, that levels that do not sample take evenly, without shadows: it stands for light between surfaces too
    bool same_radiance(const Environment& other) const;                                    // whatever strength and backdrop
    bool shines() const { return panorama() ? panorama()->shines() : total_ > 0; }         // some direction is not black

    // By direction (unit), for a strength of 1: radiance; irradiance over pi on a surface with this normal; radiance that a surface of a roughness from 0 to 1
    // reflects about a direction.
    Rgb radiance(Vec3 direction) const;
    Rgb irradiance(Vec3 normal) const;
    Rgb blurred(Vec3 direction, double roughness) const;

    // Directions by their brightness; the density is per solid angle, and that of a direction is the same however it was found. Must shine.
    using Sample = scene::Panorama::Sample;
    Sample sample(double u0, double u1) const;  // u in [0, 1)^2
    double pdf(Vec3 direction) const;

private:
    const scene::Panorama* panorama() const { return source_.panorama.get(); }
    Vec3 in_picture(Vec3 direction) const { return {direction.x * cos_ - direction.z * sin_, direction.y, direction.x * sin_ + direction.z * cos_}; }
    double height_density(double height) const;

    scene::Environment source_;
    double cos_ = 1, sin_ = 0;            // of the picture's rotation
    std::array<double, 3> brightness_{};  // at nadir, horizon, zenith
    bool even_ = true;                    // a gradient of one colour
    double total_ = 0;                    // integral of the brightness over the height, -1 to 1
};

// Radiance that is seen in a direction (unit). A gradient is seen as it is, whatever its strength as light; a picture by its intensity.
Rgb environment_radiance(const Environment& environment, Vec3 direction);

// Radiance that a surface sends to the viewer (unit) by the light of the environment alone, without shadows: diffuse, and the
// reflection that is too blurred for a mirrored ray. inside: the viewer is in the body.
Rgb reflect_environment(const Environment& environment, const Lobes& lobes, Vec3 normal, Vec3 to_viewer, bool inside);

// The backdrop at a height in the picture, 0 bottom to 1 top.
Rgb backdrop_radiance(const Environment& environment, double height);

}  // namespace crescente::render
