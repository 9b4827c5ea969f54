// A material at one place, seen from one side: prepared once for any number of directions to lights, and directions drawn from it (render/bsdf.h says what the values are).
#pragma once

#include "render/bsdf.h"
#include "render/microfacets.h"

namespace crescente::render {

// What becomes of perfectly smooth lobes: nothing (but what disperses draws its refracted ray all the same), rays, or highlights of the smallest size.
enum class SmoothAs : std::uint8_t { nothing, rays, highlights };

class Scattering {
public:
    // to_viewer: unit. The lobes must outlive this.
    Scattering(const Lobes& lobes, const Facing& facing, Vec3 to_viewer, SmoothAs smooth_as);

    // What the lobes that are not perfectly smooth send to the viewer of light from `to_light` (unit, away from the surface; the light may be behind it), and the density of sample() there.
    // Zero where the viewer does not see the front of both normals, or the normals disagree about the light's side. Classic materials: as reflect_light, over pi
    // (classic lights without extent are given in units of which pi make a lux).
    Scattered toward(Vec3 to_light) const;

    // A direction drawn about as the material reflects and transmits, from three numbers in [0, 1): the first chooses the lobe, the others the direction. Nothing
    // if there is nothing to draw, or the drawn direction gives nothing.
    std::optional<ScatterSample> sample(std::array<double, 3> u) const;

private:
    // The lobes that a direction is drawn from, in the order in which the first number chooses.
    enum Lobe : std::uint8_t { diffuse, rough, fibres, coated, multiple, glass_multiple, through, highlight, mirror, refraction, straight, lobe_count };

    bool seen() const { return v_.z > 0 && dot(facing_.geometric, viewer_) > 0; }
    struct FacetColors {  // what a facet reflects and transmits, cosine: between its normal and the viewer
        Rgb reflected, transmitted;
        double chance_reflected;
    };
    FacetColors facet(double cosine) const;
    struct Frame {
        Vec3 x, y, z;
        Vec3 local(Vec3 w) const { return {dot(x, w), dot(y, w), dot(z, w)}; }
        Vec3 world(Vec3 w) const { return x * w.x + y * w.y + z * w.z; }
    };
    Vec3 local(Vec3 w) const { return frame_.local(w); }
    double above_layer(Vec3 w, double coat_cosine) const;
    double missing(Vec3 w) const;  // between facets, if these reflect all
    double along_grain(Vec3 w) const;
    bool allows(Vec3 to_light, bool crosses) const { return (dot(facing_.shading, to_light) < 0) == crosses && (dot(facing_.geometric, to_light) < 0) == crosses; }
    double layer_over_diffuse(Vec3 w) const;
    double missing_in_glass(double cosine, std::size_t side) const;
    std::optional<Vec3> draw(Lobe lobe, std::array<double, 3> u) const;
    std::optional<ScatterSample> ray(Lobe lobe) const;
    void add_diffuse(Vec3 l, Vec3 to_light, Scattered& sum) const;
    void add_facets(Vec3 l, Scattered& sum) const;
    void add_multiple(Vec3 l, Scattered& sum) const;
    void under_sheen(Vec3 l, Scattered& sum) const;
    void under_coat(Vec3 l, Vec3 to_light, Scattered& sum) const;
    void add_highlight(Vec3 l, Scattered& sum) const;
    double highlight_scale() const;
    const MissingCells& cells_of_multiple() const { return gives_back_below() ? lobes_.lost_cells : lobes_.multiple_cells; }
    // Coats that do not follow the surface, and the side without them, are not what Lobes::lost_below was found for.
    bool gives_back_below() const { return lobes_.gives_back_below && !facing_.inside && lobes_.coat_normal == Vec3{}; }

    const Lobes& lobes_;
    Facing facing_;
    Frame frame_, coat_frame_;
    Vec3 viewer_, v_, coat_v_;
    double eta_;        // index behind over index in front
    std::size_t side_;  // of a glass: that of the viewer, outer or inner
    Smooth smooth_;
    ChildWeights rays_;
    Microfacets facets_, coat_facets_;
    bool mirror_base_ = false, mirror_coat_ = false;  // perfectly smooth, and not shown as highlights
    double chances_[lobe_count] = {};
};

}  // namespace crescente::render
