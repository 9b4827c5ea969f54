#include "scene/motion.h"

#include <bit>

#include "math/gradual.h"
#include "math/mix_bits.h"
#include "scene/scene.h"

namespace crescente::scene {

using math::Affine;
using math::Vec3;

Affine place_at(const Node& node, double time) {
    return node.motion && time != 0 ? node.transform * math::gradual(*node.motion, time) : node.transform;
}

std::uint64_t motion_below(std::uint64_t above, const Node& node) {
    std::uint64_t hash = above + 1;
    const auto add = [&](const Affine& a) {
        for (const Vec3& column : {a.x, a.y, a.z, a.origin}) {
            for (const double v : {column.x, column.y, column.z}) hash = math::mix_bits(hash ^ std::bit_cast<std::uint64_t>(v));
        }
    };
    if (above != 0) add(node.transform);  // below what moves it matters where things are to each other
    add(node.motion.value_or(Affine{}));
    return hash | 1;
}

double focus_of(const Camera& camera) { return camera.focus_distance > 0 ? camera.focus_distance : length(camera.target - camera.position); }

Camera camera_at(const Camera& camera, double time) {
    Camera at = camera;
    at.travel = at.target_travel = {}, at.roll = 0;
    if (time == 0 || !camera.moves()) return at;
    at.position += camera.travel * time, at.target += camera.target_travel * time;
    at.focus_distance = focus_of(camera);
    if (camera.roll != 0) at.up = Affine::rotation(at.position - at.target, camera.roll * time).vector(camera.up);
    return at;
}

}  // namespace crescente::scene
