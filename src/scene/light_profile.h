// How strongly a lamp shines in each direction, as measured: the content of an IES file.
#pragma once

#include <cstdint>
#include <vector>

namespace crescente::scene {

// Type C of IES LM-63-2002: angles from the lamp's axis (vertical) and about it (horizontal). Between the measured angles the intensity is bilinear, beyond the first and last vertical one
// 0. Immutable: shared by scenes and worlds.
class LightProfile {
public:
    // Angles in radians, rising; the horizontal ones begin at 0 and end at 0 (the same all around), pi / 2 (every quadrant the same), pi (both halves) or 2 pi. Candela row by row, a row for each
    // horizontal angle; finite, not negative.
    LightProfile(std::vector<double> vertical, std::vector<double> horizontal, std::vector<double> candela);

    bool operator==(const LightProfile&) const = default;

    // Candela at an angle from the axis (0 to pi) and one about it (any).
    double intensity(double from_axis, double about_axis) const;
    double strongest() const;
    std::uint64_t content() const;  // checksum

private:
    std::vector<double> vertical_, horizontal_, candela_;
};

}  // namespace crescente::scene
