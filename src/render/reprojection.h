// The old picture from a camera that moved: kept hits are shown where the new camera sees them, until there are new ones. After Walter, Drettakis and Parker
// 1999, "Interactive Rendering using the Render Cache".
#pragma once

#include <span>
#include <vector>

#include "parallel/pool.h"
#include "render/camera_rays.h"
#include "render/forest.h"

namespace crescente::render {

// What was seen through a pixel.
struct SeenPoint {
    enum class Kind : std::uint8_t { unknown, surface, far, backdrop };
    Kind kind = Kind::unknown;
    std::array<float, 3> position{};  // of the hit at the pixel's top left corner; far: direction
    Rgb color;                        // of the pixel
};

// The points of a tile, at their places in those of a picture of this width, row by row. backdrop: what is seen behind everything stays where it is.
void take_points(const Tile& tile, std::span<const Rgb> displayed, bool backdrop, int width, std::span<SeenPoint> points);

struct Reprojected {
    std::vector<Rgb> pixels;         // row by row, holes filled
    std::vector<std::uint8_t> seen;  // whether a point was seen there
};

// The points of a picture, width x height of them, as `camera`, of the same size, sees them: the nearest in each pixel, without those that show through gaps between nearer ones. Holes
// get the mean of the farthest of what is around them, which lies behind what moved away (pull-push: Gortler, Grzeszczuk, Szeliski and Cohen 1996, "The Lumigraph", section 3.4). The same on any number of threads.
Reprojected reproject(std::span<const SeenPoint> points, const CameraRays& camera, int width, int height, parallel::Pool& pool);

}  // namespace crescente::render
