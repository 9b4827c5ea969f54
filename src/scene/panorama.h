// A picture of all that surrounds a scene: radiance by direction, and what lighting by it needs.
//
// The projection is equirectangular, as Blender and three.js have it: the middle of the picture is seen towards +x, its right half towards +z, its upper
// half above the horizon (+y up). Between pixels the radiance is bilinear.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "math/color.h"
#include "math/vec.h"

namespace crescente::scene {

using math::Rgb;
using math::Vec3;

// Immutable once made: shared by scenes, worlds and threads.
class Panorama {
public:
    // Linear RGB, row by row from the top; width x height values, finite and not negative.
    Panorama(int width, int height, std::vector<Rgb> pixels);

    int width() const { return width_; }
    int height() const { return height_; }
    const std::vector<Rgb>& pixels() const { return pixels_; }
    std::uint64_t content() const { return content_; }  // checksum of size and pixels
    bool shines() const { return total_ > 0; }  // some direction is not black

    // Directions are unit vectors.
    Rgb radiance(Vec3 direction) const;

    // Irradiance over pi on a surface with this normal, by nine coefficients of spherical harmonics (Ramamoorthi and Hanrahan 2001, "An Efficient
    // Representation for Irradiance Environment Maps"); never negative.
    Rgb irradiance(Vec3 normal) const;

    // What a surface of this roughness (0: a mirror, to 1) reflects of it about the mirrored direction: the radiance under a GGX lobe seen head on (Karis
    // 2013, "Real Shading in Unreal Engine 4").
    Rgb blurred(Vec3 direction, double roughness) const;

    // A direction by its luminance; u in [0, 1)^2. The density is per solid angle and constant within cells of the picture (Pharr, Jakob and Humphreys 2023,
    // "Physically Based Rendering", 12.5.2; cells here are even in the height of the direction, so that none is denser at the poles). Must shine.
    struct Sample {
        Vec3 direction;
        double pdf = 0;
    };
    Sample sample(double u0, double u1) const;
    double pdf(Vec3 direction) const;

private:
    struct Lookup {  // by share of the picture's width and height
        int width, height;
        const std::vector<Rgb>& pixels;
        Rgb at(double u, double v) const;
    };
    void make_cells();
    void make_harmonics();
    void make_blurred();
    std::vector<Rgb> reduced(int width, int height) const;

    int width_, height_;
    std::vector<Rgb> pixels_;
    std::uint64_t content_;

    int cell_size_ = 1;               // pixels along an edge
    int columns_ = 0, rows_ = 0;      // of cells
    double total_ = 0;                // brightness of all cells, times their solid angle
    std::vector<double> row_ends_;    // sums of rows up to each
    std::vector<double> cell_ends_;   // of each row: sums of cells up to each
    std::array<std::array<double, 3>, 9> harmonics_{};

    static constexpr int blurred_width = 64, blurred_height = 32, blurred_count = 4;
    std::array<std::vector<Rgb>, blurred_count> blurred_;  // at roughness 1/4, 2/4, 3/4, 1
};

}  // namespace crescente::scene
