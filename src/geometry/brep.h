// A CAD part, solid or shell, as exact trimmed faces that rays meet directly.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "base/fields.h"
#include "geometry/analytic_surface.h"
#include "geometry/patch_leaves.h"

namespace crescente::geometry {

// A face that cannot be traced, and why.
struct FaceProblem {
    std::uint32_t face = 0;
    std::string reason;
};

// Parts and primitives are leaves: a face with an analytic surface is one, of a spline surface there are several.
class Brep {
public:
    Brep() = default;  // without faces: never hit

    // Makes faces ready for rays. Those that cannot be prepared are left out, and listed in `problems` by their index in `faces`.
    Brep(std::span<const Face> faces, std::vector<FaceProblem>& problems);
    // The same, where a face that is left out is an error (input): every such face is told.
    static Expected<Brep> make(std::span<const Face> faces);

    Bounds bounds() const { return bounds_; }
    std::uint32_t parts() const { return static_cast<std::uint32_t>(leaves_.size()); }
    Bounds part_bounds(std::uint32_t part) const { return leaves_[part].box; }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const;
    // intersect() for each of the lanes of `active`, to the same bits: the lanes that meet the part, and their parameters.
    unsigned intersect(std::uint32_t part, const RayLanes& rays, unsigned active, Lanes& t) const;
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const;
    std::uint32_t slot(std::uint32_t primitive) const { return faces_[leaves_[primitive].face].slot; }
    static const FieldTable<Brep>& fields();  // none: it comes from a CAD file

    std::size_t face_count() const { return faces_.size(); }
    std::uint32_t face_of(std::uint32_t primitive) const { return leaves_[primitive].face; }
    // The plain face again: the same surface and curves; loops welded, bands rounded up to float.
    Face face(std::uint32_t index) const;
    std::size_t bytes() const;

private:
    static constexpr std::uint32_t none = 0xffffffff;

    struct TrimmedFace {
        AnalyticSurface surface;        // where there are no patches
        std::uint32_t patches = none;   // index into patches_
        bool reversed = false;
        std::uint16_t slot = 0;
        std::uint32_t shell = 0;
        Trimming trimming;
    };
    struct Patches {
        PatchSurface plain;
        PatchLeaves leaves;
    };
    struct Leaf {
        Bounds box;
        std::uint32_t face;
        std::uint32_t patch_leaf;  // of a spline surface
    };

    Expected<void> add(const Face& face);
    Expected<void> add_analytic(const Face& face);
    Expected<void> add_patches(const Face& face, const PatchSurface& surface);
    std::optional<ShapeHit> meet_patch(std::uint32_t part, const TrimmedFace& face, const Ray& ray) const;
    Trimming::Located locate_patch(const Leaf& leaf, const TrimmedFace& face, const PatchRoot& root, Vec3 position, Vec3 direction) const;
    SurfacePoint patch_surface(const Leaf& leaf, const TrimmedFace& face, Vec3 position) const;

    bool belongs(std::uint32_t part, const TrimmedFace& face, const Ray& ray, const Meeting& meeting) const;

    // --- brep_edges.cpp
    struct Tangents {
        Vec3 along_u, along_v, normal;  // normal: of unit length, outward
    };
    Tangents tangents(const Leaf& leaf, const TrimmedFace& face, Point2 root, Vec3 position) const;
    // Whether the crossing of the ray's line with the part near an edge is one of those that the solid has there. `root`: the parameters of the surface
    // itself, of the patches where it is made of such.
    bool counts(std::uint32_t part, const Ray& ray, double t, Point2 root, const Trimming::Located& located) const;
    friend class EdgeJudge;

    static constexpr std::uint32_t clump_size = 16;
    std::vector<Bounds> clumps_;  // of so many leaves in a row
    std::vector<TrimmedFace> faces_;
    std::vector<Patches> patches_;
    std::vector<Leaf> leaves_;
    Bounds bounds_;
};

}  // namespace crescente::geometry
