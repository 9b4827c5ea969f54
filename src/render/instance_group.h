// Instances that an edit brought or took, apart from all others: what the rays that are kept are tried against.
//
// Brière and Poulin 1996 find the rays that an object concerns by its volume, through hierarchies over the rays. Here neighbouring rays are bundles,
// which the boxes of the objects turn away together; the rays that are left are tried against the objects themselves.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "accel/accelerator.h"
#include "math/vec_lanes.h"

namespace crescente::render {

using namespace math;

// Stretches of rays. At the parameter t, from 0 to `end`, each is between start.lower + t lower and start.upper + t upper.
struct Bundle {
    Bounds start;
    Vec3 lower, upper;
    double end;
};

// From points of one box to points of another.
Bundle between(const Bounds& start, const Bounds& end);
// From points of a box in directions of another, without an end. Directions may have any length.
Bundle toward(const Bounds& start, const Bounds& directions);

// Eight single stretches, each from `start` by `way`, or in that direction without an end where the bit of `endless` is set. They may begin and end beside
// these points, by `slack` at most in each coordinate.
struct StretchLanes {
    Vec3Lanes start, way;
    Lanes slack;
    unsigned endless = 0;
};

// False only if no stretch of the bundle passes the box, nor would with rounding errors of 1e-9 of the coordinates.
bool may_pass(const Bounds& box, const Bundle& bundle);
// The same for each of the eight, as bits. The box must be bounded. Separating axes of a segment and a box: no division, no branch (Gottschalk, Lin and
// Manocha 1996, "OBBTree").
unsigned may_pass(const Bounds& box, const StretchLanes& stretches);

// What a ray meets of a group.
enum class Meeting : std::uint8_t {
    nothing,
    something,  // or it is not known
    occluder,   // on the way of light: nothing gets through
};

class InstanceGroup {
public:
    // `boxes`: of the instances, in world space; there may be many. The instances are `alone` in that accelerator, which refers to them; null: it is not known
    // what they look like, and whatever comes near their boxes may meet them.
    InstanceGroup(std::span<const Bounds> boxes, std::vector<accel::Instance> instances, std::unique_ptr<accel::Accelerator> alone);

    bool may_meet(const Bundle& bundle) const;
    unsigned may_meet(const StretchLanes& stretches) const;  // bits of those that may

    // Tries rays against the instances alone. By ray: what the eye meets within its range, or what light does.
    void meet(std::span<const geometry::Ray> rays, std::vector<Meeting>& meetings, accel::TestCounts& counts) const;
    void meet_light(std::span<const geometry::Ray> rays, std::vector<Meeting>& meetings, accel::TestCounts& counts) const;

private:
    Bounds box_;                 // of all
    std::vector<Bounds> boxes_;  // few, that hold those of all instances
    std::vector<accel::Instance> instances_;
    std::unique_ptr<accel::Accelerator> alone_;
};

}  // namespace crescente::render
