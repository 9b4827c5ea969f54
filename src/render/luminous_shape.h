// Shapes that shine evenly, as light sampling knows them: a part of a light or of an emissive object, in world space.
#pragma once

#include <cstdint>
#include <optional>

#include "geometry/ray.h"
#include "math/bounds.h"
#include "math/vec.h"

namespace crescente::render {

using namespace math;

// How a point of a shape is seen from elsewhere.
struct ShapeSample {
    Vec3 direction;  // unit
    double distance = 0;
    double pdf = 0;  // of the direction, per solid angle
};

class LuminousShape {
    enum class Form : std::uint8_t { rectangle, parallelogram, triangle, ellipse, sphere };

public:
    // Edges from a corner, at right angles; the front is where cross(a, b) points to. Sampled by solid angle.
    static LuminousShape rectangle(Vec3 corner, Vec3 a, Vec3 b, bool two_sided);
    // The same with edges at any angle. Sampled by area, like those below but the sphere.
    static LuminousShape parallelogram(Vec3 corner, Vec3 a, Vec3 b, bool two_sided);
    static LuminousShape triangle(Vec3 corner, Vec3 a, Vec3 b, bool two_sided);
    // Conjugate half axes; the share `inner` of them is left open in the middle.
    static LuminousShape ellipse(Vec3 center, Vec3 a, Vec3 b, double inner, bool two_sided);
    // Shines outward, two-sided: inward too. Sampled by solid angle.
    static LuminousShape sphere(Vec3 center, double radius, bool two_sided);

    bool operator==(const LuminousShape&) const = default;

    // A point that is seen from `from` by its shining side, for u in [0, 1)^2; none where there is none.
    std::optional<ShapeSample> sample(Vec3 from, double u0, double u1) const;

    // The density with which sample(from) chooses the direction to a point of the shape that `from` sees by its shining side; 0: it never does.
    double pdf(Vec3 from, Vec3 point) const;

    // Where a ray meets the shining side first: its parameter t, within the ray's bounds. The direction must be of unit length.
    std::optional<double> meet(const geometry::Ray& ray) const;

    Bounds bounds() const;
    double area() const { return area_; }
    bool flat() const { return form_ != Form::sphere; }
    bool two_sided() const { return two_sided_; }
    Vec3 normal() const { return normal_; }  // unit, of flat shapes

private:
    LuminousShape(Form form, Vec3 origin, Vec3 a, Vec3 b, double inner, bool two_sided);
    bool faces(Vec3 from) const;
    Vec3 point_of(double u0, double u1) const;
    std::optional<ShapeSample> sample_sphere(Vec3 from, double u0, double u1) const;

    Form form_;
    bool two_sided_;
    Vec3 origin_, a_, b_;  // sphere: a_.x is the radius
    double inner_, area_;
    Vec3 normal_;
};

}  // namespace crescente::render
