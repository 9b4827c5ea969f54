// What the shapes have in common that are described in one way or another and traced as Bézier patches.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "base/error.h"
#include "base/fields.h"
#include "geometry/patch_leaves.h"

namespace crescente::geometry {

// Kind: a struct with `Expected<std::vector<BezierPatch>> patches() const`, whose problems name the member that is wrong as their place. What rays
// need is derived from the description by prepare(), once it is complete; until then the shape has no parts. Copies share it.
template <class Kind>
class PatchShape {
public:
    // To be called again when the description has changed. A wrong description has no parts.
    void prepare() {
        leaves_.reset();
        if (const auto patches = static_cast<const Kind&>(*this).patches()) leaves_ = std::make_shared<const PatchLeaves>(*patches);
    }
    const PatchLeaves* leaves() const { return leaves_.get(); }

    Bounds bounds() const {
        Bounds box;
        if (leaves_) {
            for (std::uint32_t leaf = 0; leaf < leaves_->count(); ++leaf) box.include(leaves_->bounds(leaf));
        } else if (const auto patches = static_cast<const Kind&>(*this).patches()) {
            for (const BezierPatch& patch : *patches) {
                for (const ControlPoint& c : patch.points) box.include(c.weighted / c.weight);
            }
        }
        return box;
    }
    std::uint32_t parts() const { return leaves_ ? leaves_->count() : 0; }
    Bounds part_bounds(std::uint32_t part) const { return leaves_->bounds(part); }
    std::optional<ShapeHit> intersect(std::uint32_t part, const Ray& ray) const {
        const auto root = leaves_->nearest(part, ray);
        return root ? std::optional(ShapeHit{root->t, part}) : std::nullopt;
    }
    SurfacePoint surface(std::uint32_t primitive, Vec3 position) const { return leaves_->surface(primitive, position); }

private:
    std::shared_ptr<const PatchLeaves> leaves_;
};

}  // namespace crescente::geometry
