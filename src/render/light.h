// Lights compiled for shading: as points or directions. Lights with extent act at their centre until there are samples of them (render/emitters.h).
#pragma once

#include "math/color.h"
#include "math/vec_lanes.h"
#include "render/light_links.h"
#include "scene/light.h"

namespace crescente::render {

using namespace math;

// How a light reaches a point (T = double), or eight points (T = Lanes), before anything stands in its way.
template <class T>
struct Reach {
    VecOf<T> to_light;  // unit
    T distance;         // infinite for directional lights
    T factor;           // of the light's color; 0: the point is outside its cone or range
};

// The same for one point, with the light's color.
struct Incident {
    Vec3 to_light;        // unit
    double distance = 0;  // infinite for directional lights
    Rgb strength;         // irradiance on a surface that faces the light; black: the point is outside its cone or range
};

class Light {
public:
    // stands_in: for light that levels that sample take from samples, as they do that of lights with extent.
    explicit Light(const scene::Light& light, bool stands_in = false);

    Incident at(Vec3 point) const;
    template <class T>
    Reach<T> reach(const VecOf<T>& point) const;
    // Which instances it acts on; no_instance (a camera's ray): always.
    void link(Receivers receivers) { receivers_ = std::move(receivers); }
    const Receivers& receivers() const { return receivers_; }
    bool acts_on(std::uint32_t instance) const { return render::acts_on(receivers_, instance); }
    bool is_sampled() const { return sampled_; }
    const scene::Light& source() const { return light_; }
    Rgb color() const { return color_; }
    bool casts_shadows() const { return light_.shadows; }
    bool makes_highlights() const { return light_.highlights; }

private:
    template <class T>
    T flat(const T& cosine) const;
    template <class T>
    T profile(const VecOf<T>& to_light) const;
    template <class T>
    T cone(const T& cosine) const;
    template <class T>
    T falloff(const T& distance) const;

    scene::Light light_;
    Receivers receivers_;
    bool sampled_;
    Vec3 axis_;
    Vec3 upward_;  // of a profile
    Rgb color_;
    bool oriented_;
    double cos_outer_, cos_scale_;
};

}  // namespace crescente::render
