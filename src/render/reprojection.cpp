#include "render/reprojection.h"

#include <atomic>
#include <bit>

#include "render/film.h"

namespace crescente::render {
namespace {

// Nearer points have smaller keys; of equally near ones the first wins, whatever order they come in. Depths are positive, so their bits order as they do.
constexpr std::uint64_t nothing = ~std::uint64_t{0};
std::uint64_t key_of(float depth, std::uint32_t point) { return std::uint64_t{std::bit_cast<std::uint32_t>(depth)} << 32 | point; }
float depth_of(std::uint64_t key) { return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32)); }
std::uint32_t point_of_key(std::uint64_t key) { return static_cast<std::uint32_t>(key); }
constexpr float farthest = std::numeric_limits<float>::max();

void keep_least(std::uint64_t& place, std::uint64_t key) {
    std::atomic_ref<std::uint64_t> least(place);
    std::uint64_t was = least.load(std::memory_order_relaxed);
    while (key < was && !least.compare_exchange_weak(was, key, std::memory_order_relaxed)) {}
}

std::vector<std::uint64_t> nearest_points(std::span<const SeenPoint> points, const CameraRays& camera, int width, int height, parallel::Pool& pool) {
    std::vector<std::uint64_t> nearest(points.size(), nothing);
    pool.for_each(static_cast<std::size_t>(height), [&](std::size_t row) {
        const std::size_t first = row * static_cast<std::size_t>(width);
        for (std::size_t i = first; i < first + static_cast<std::size_t>(width); ++i) {
            const SeenPoint& point = points[i];
            if (point.kind == SeenPoint::Kind::unknown) continue;
            const auto index = static_cast<std::uint32_t>(i);
            if (point.kind == SeenPoint::Kind::backdrop) {
                keep_least(nearest[i], key_of(farthest, index));
                continue;
            }
            const Vec3 at{point.position[0], point.position[1], point.position[2]};
            const bool far = point.kind == SeenPoint::Kind::far;
            const auto seen = far ? camera.project_direction(at) : camera.project(at);
            if (!seen) continue;
            const double x = std::floor(seen->x + 0.5), y = std::floor(seen->y + 0.5);  // corners are half a pixel off the middle
            if (!(x >= 0 && y >= 0 && x < width && y < height)) continue;
            const auto pixel = static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x);
            keep_least(nearest[pixel], key_of(far ? farthest : static_cast<float>(seen->depth), index));
        }
    });
    return nearest;
}

// Whether most of what is around the pixel is clearly nearer: then it is seen through a gap.
bool shows_through(const std::vector<std::uint64_t>& nearest, int x, int y, int width, int height) {
    constexpr float clearly = 0.97f;
    constexpr int most = 5;
    const auto at = [&](int i, int j) { return nearest[static_cast<std::size_t>(j) * static_cast<std::size_t>(width) + static_cast<std::size_t>(i)]; };
    const float depth = depth_of(at(x, y));
    int nearer = 0;
    for (int j = std::max(0, y - 1); j <= std::min(height - 1, y + 1); ++j) {
        for (int i = std::max(0, x - 1); i <= std::min(width - 1, x + 1); ++i) nearer += at(i, j) != nothing && depth_of(at(i, j)) < clearly * depth;
    }
    return nearer >= most;
}

struct Grid {
    int width, height;
    std::vector<Rgb> colors;
    std::vector<std::uint8_t> known;

    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x); }
};

// Means of what is known in each square of four.
Grid coarser(const Grid& fine, parallel::Pool& pool) {
    Grid coarse{(fine.width + 1) / 2, (fine.height + 1) / 2, {}, {}};
    coarse.colors.resize(static_cast<std::size_t>(coarse.width) * static_cast<std::size_t>(coarse.height));
    coarse.known.resize(coarse.colors.size());
    pool.for_each(static_cast<std::size_t>(coarse.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < coarse.width; ++x) {
            Rgb sum;
            int count = 0;
            for (int k = 0; k < 4; ++k) {
                const int i = 2 * x + (k & 1), j = 2 * y + (k >> 1);
                if (i >= fine.width || j >= fine.height || !fine.known[fine.index(i, j)]) continue;
                sum += fine.colors[fine.index(i, j)];
                ++count;
            }
            if (count == 0) continue;
            coarse.colors[coarse.index(x, y)] = sum * (1 / static_cast<float>(count));
            coarse.known[coarse.index(x, y)] = 1;
        }
    });
    return coarse;
}

void fill_holes(Grid& grid, parallel::Pool& pool) {
    std::vector<Grid> coarse;
    for (const Grid* fine = &grid; fine->width > 1 || fine->height > 1; fine = &coarse.back()) coarse.push_back(coarser(*fine, pool));
    for (std::size_t i = coarse.size(); i-- > 0;) {
        Grid& fine = i > 0 ? coarse[i - 1] : grid;
        pool.for_each(static_cast<std::size_t>(fine.height), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < fine.width; ++x) {
                if (!fine.known[fine.index(x, y)]) fine.colors[fine.index(x, y)] = coarse[i].colors[coarse[i].index(x / 2, y / 2)];
            }
        });
    }
}

}  // namespace

void take_points(const Tile& tile, std::span<const Rgb> displayed, bool backdrop, int width, std::span<SeenPoint> points) {
    if (tile.corners.empty()) return;
    const std::vector<Rgb> made = displayed.empty() ? develop(tile) : std::vector<Rgb>{};
    const std::span<const Rgb> pixels = displayed.empty() ? made : displayed;
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const std::uint32_t root = tile.corner(x, y);
            if (root == no_node) continue;
            const Node& node = tile.nodes[root];
            SeenPoint& point = points[static_cast<std::size_t>(tile.y0 + y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(tile.x0 + x)];
            point.kind = !node.left_scene() ? SeenPoint::Kind::surface : backdrop ? SeenPoint::Kind::backdrop : SeenPoint::Kind::far;
            point.position = {static_cast<float>(node.position.x), static_cast<float>(node.position.y), static_cast<float>(node.position.z)};
            point.color = pixels[static_cast<std::size_t>(y) * static_cast<std::size_t>(tile.width) + static_cast<std::size_t>(x)];
        }
    }
}

Reprojected reproject(std::span<const SeenPoint> points, const CameraRays& camera, int width, int height, parallel::Pool& pool) {
    const std::vector<std::uint64_t> nearest = nearest_points(points, camera, width, height, pool);
    Grid grid{width, height, std::vector<Rgb>(nearest.size()), std::vector<std::uint8_t>(nearest.size())};
    pool.for_each(static_cast<std::size_t>(height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < width; ++x) {
            const std::size_t i = grid.index(x, y);
            if (nearest[i] == nothing || shows_through(nearest, x, y, width, height)) continue;
            grid.colors[i] = points[point_of_key(nearest[i])].color;
            grid.known[i] = 1;
        }
    });
    fill_holes(grid, pool);
    return {std::move(grid.colors), std::move(grid.known)};
}

}  // namespace crescente::render
