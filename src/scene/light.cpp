#include "scene/light.h"

namespace crescente::scene {

using math::Vec3;

double visible_area(const Light& light) {
    switch (light.kind) {
        case LightKind::rectangle: return light.width * light.height;
        case LightKind::disk:
        case LightKind::sphere: return math::pi * light.radius * light.radius;
        case LightKind::point:
        case LightKind::directional: break;
    }
    return 0;
}

Vec3 upward_of(const Light& light) {
    const Vec3 axis = normalize(light.direction);
    for (const Vec3 wish : {normalize(light.up), Vec3{0, 0, -1}}) {
        constexpr double least_sine = 1e-9;
        const Vec3 up = wish - axis * dot(wish, axis);
        if (length(up) > least_sine) return normalize(up);
    }
    return {0, 1, 0};
}

}  // namespace crescente::scene
