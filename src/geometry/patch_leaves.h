// Spline surfaces ready for rays: Bézier patches cut into leaves whose normals spread little, and the intersection of a ray with a leaf.
//
// The intersection is certified: that there is no root in a part of a leaf is only ever concluded from a proof of it, never from an iteration
// that did not converge, so that no root is lost. geometry/patch_kernel.h says how; docs/decisions/ why.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "geometry/bezier_patch.h"
#include "geometry/ray.h"
#include "geometry/ray_view.h"
#include "geometry/shape.h"
#include "math/bounds.h"
#include "math/lanes.h"

namespace crescente::geometry {

// Where a ray meets a surface, in the parameters of the surface.
struct PatchRoot {
    double t = 0, u = 0, v = 0;
};

// The surface at (u, v), with its partial derivatives.
struct PatchPoint {
    Vec3 position, along_u, along_v;
    Vec3 normal;  // along S_u x S_v, unit length; at a pole or a degenerate edge its limit
};

// Eight rays, as Ray has them. Lanes that are not asked for may hold anything.
struct RayLanes {
    Point3<Lanes> origin, direction;
    Lanes t_min, t_max;
};
struct PatchRootLanes {
    Lanes t, u, v;
};

class PatchLeaves {
public:
    PatchLeaves() = default;

    // Degrees from 1 to max_patch_degree, weights positive, all finite; a patch that is not so has no leaves. Borders that have no neighbour in the
    // set (nor are degenerate) are extended by the length `band`, at most by a fiftieth of the patch: parameters then exceed the patch's range.
    // Of what `unwanted` says true for no leaves are made: a surface is often larger than the face on it, and may be folded there.
    explicit PatchLeaves(std::span<const BezierPatch> patches, double band = 0, const std::function<bool(const ParameterBox&)>& unwanted = {});

    std::uint32_t count() const { return static_cast<std::uint32_t>(leaves_.size()); }
    std::uint32_t patch(std::uint32_t leaf) const { return leaves_[leaf].patch; }
    // The hull of the control points: holds the leaf, extension included, and what rounding adds.
    Bounds bounds(std::uint32_t leaf) const;
    // The parameters that the leaf covers, extension included.
    ParameterBox range(std::uint32_t leaf) const { return {leaves_[leaf].u0, leaves_[leaf].u1, leaves_[leaf].v0, leaves_[leaf].v1}; }
    std::size_t bytes() const;

    // All roots with t_min < t <= t_max in increasing t; of more than out.size() the nearest. Returns how many. Neighbours overlap a little, so
    // that no ray passes between them: a root on a common border is found in both, at parameters t that differ by rounding.
    int roots(std::uint32_t leaf, const Ray& ray, std::span<PatchRoot> out) const;
    // The first of them.
    std::optional<PatchRoot> nearest(std::uint32_t leaf, const Ray& ray) const;
    // nearest() for each of the lanes of `active`, to the same bits. Returns the lanes that have a root.
    unsigned nearest(std::uint32_t leaf, const RayLanes& rays, unsigned active, PatchRootLanes& roots) const;

    // The surface at parameters of the surface in the leaf, or close by.
    PatchPoint at(std::uint32_t leaf, double u, double v) const;
    // The parameters of a point that is on the leaf but for rounding; u and v of the result, t: its distance along the leaf's mean normal.
    PatchRoot locate(std::uint32_t leaf, Vec3 position) const;
    // Whether a point is sure to be farther from the leaf than `distance`: by slabs that hold the control points.
    bool surely_farther(std::uint32_t leaf, Vec3 position, double distance) const;
    // What Shape::surface has to answer for a hit on the leaf at `position` (slot left at 0).
    SurfacePoint surface(std::uint32_t leaf, Vec3 position) const;
    // Bound on the distance of at().position from the true surface.
    double error(std::uint32_t leaf) const { return 16 * std::numeric_limits<double>::epsilon() * leaves_[leaf].reach; }

private:
    // Control points about `center`, by component: x y z, and for rational leaves the weight, with weights of 1 at most.
    struct Leaf {
        Vec3 center;
        double u0, u1, v0, v1;       // in the parameters of the surface
        double reach;                // largest coordinate of any point, in size
        double blur_reach;           // what the rounding of the control points is relative to: their distance from the center, or, with weights, reach
        Vec3 normal;                 // mean
        std::uint64_t first;         // in numbers_
        std::uint32_t patch;
        std::uint8_t degree_u, degree_v, kernel;
        bool rational;
    };
    friend struct PatchKernels;
    friend class LeafCutter;

    const double* points(const Leaf& leaf) const { return numbers_.data() + leaf.first; }

    std::vector<Leaf> leaves_;
    std::vector<double> numbers_;
};

}  // namespace crescente::geometry
