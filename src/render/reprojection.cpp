#include "render/reprojection.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <limits>

#include "render/film.h"

namespace crescente::render {
namespace {

// Nearer points have smaller keys; of equally near ones the first wins, whatever order they come in. Depths are positive, so their bits order as they do.
using Key = std::int64_t;
constexpr Key nothing = std::numeric_limits<Key>::max();
Key key_of(float depth, std::uint32_t point) { return Key{std::bit_cast<std::int32_t>(depth)} << 32 | Key{point}; }
float depth_of(Key key) { return std::bit_cast<float>(static_cast<std::uint32_t>(key >> 32)); }
std::uint32_t point_of_key(Key key) { return static_cast<std::uint32_t>(key); }
constexpr float farthest = std::numeric_limits<float>::max();

void keep_least(Key& place, Key key) {
    std::atomic_ref<Key> least(place);
    Key was = least.load(std::memory_order_relaxed);
    while (key < was && !least.compare_exchange_weak(was, key, std::memory_order_relaxed)) {}
}

// CameraRays::project() for many points: what is the same for all of them is worked out once.
class Projection {
public:
    Projection(const CameraRays& camera, int width, int height)
        : position_(camera.position()), forward_(camera.forward()), parallel_(!camera.project_direction(forward_)), near_(camera.through(width / 2.0, height / 2.0).t_min), half_width_(width / 2.0), half_height_(height / 2.0) {
        // From the middle of the picture to its right and upper edges.
        const auto edge = [&](double x, double y) {
            const geometry::Ray ray = camera.through(x, y);
            const Vec3 way = parallel_ ? ray.origin - position_ : ray.direction / dot(ray.direction, forward_) - forward_;
            return way / dot(way, way);
        };
        right_ = edge(width, half_height_) * half_width_;
        up_ = edge(half_width_, 0) * half_height_;
    }

    // The pixel whose corner, half a pixel off its middle, is nearest to where it is seen. depth: not positive where it is not seen.
    struct Place {
        double x, y, depth;
    };
    Place of_point(Vec3 point) const {
        const Vec3 way = point - position_;
        const double depth = dot(way, forward_);
        return at(way, parallel_ ? 1.0 : depth, depth > near_ ? depth : 0.0);
    }
    Place of_direction(Vec3 direction) const {
        const double depth = dot(direction, forward_);
        return at(direction, depth, parallel_ ? 0.0 : depth);
    }

private:
    Place at(Vec3 way, double scale, double depth) const {
        const double inverse = 1 / scale;
        return {std::floor(dot(way, right_) * inverse + half_width_ + 0.5), std::floor(half_height_ - dot(way, up_) * inverse + 0.5), depth};
    }

    Vec3 position_, forward_, right_, up_;
    bool parallel_;
    double near_, half_width_, half_height_;
};

// The nearest point of each pixel, with a border around them in which there is nothing, so that each has eight neighbours.
struct Nearest {
    int width, height;
    std::size_t stride;
    std::vector<Key> keys;

    Nearest(int w, int h) : width(w), height(h), stride(static_cast<std::size_t>(w) + 2), keys(stride * (static_cast<std::size_t>(h) + 2), nothing) {}
    Key* row(std::size_t y) { return &keys[(y + 1) * stride + 1]; }
    const Key* row(std::size_t y) const { return &keys[(y + 1) * stride + 1]; }
};

Nearest nearest_points(std::span<const SeenPoint> points, const CameraRays& camera, int width, int height, parallel::Pool& pool) {
    Nearest nearest(width, height);
    const Projection projection(camera, width, height);
    pool.for_each(static_cast<std::size_t>(height), [&](std::size_t row) {
        const std::size_t first = row * static_cast<std::size_t>(width);
        for (std::size_t x = 0; x < static_cast<std::size_t>(width); ++x) {
            const SeenPoint& point = points[first + x];
            if (point.kind == SeenPoint::Kind::unknown) continue;
            const auto index = static_cast<std::uint32_t>(first + x);
            if (point.kind == SeenPoint::Kind::backdrop) {
                keep_least(nearest.row(row)[x], key_of(farthest, index));
                continue;
            }
            const Vec3 at{point.position[0], point.position[1], point.position[2]};
            const bool far = point.kind == SeenPoint::Kind::far;
            const Projection::Place seen = far ? projection.of_direction(at) : projection.of_point(at);
            if (!(seen.depth > 0 && seen.x >= 0 && seen.y >= 0 && seen.x < width && seen.y < height)) continue;
            keep_least(nearest.row(static_cast<std::size_t>(seen.y))[static_cast<std::size_t>(seen.x)], key_of(far ? farthest : static_cast<float>(seen.depth), index));
        }
    });
    return nearest;
}

constexpr float nowhere = std::numeric_limits<float>::quiet_NaN();  // depth of a hole

struct Grid {
    int width, height;
    std::vector<Rgb> colors;
    std::vector<float> depths;

    Grid(int w, int h) : width(w), height(h), colors(static_cast<std::size_t>(w) * static_cast<std::size_t>(h)), depths(colors.size(), nowhere) {}
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(width) + static_cast<std::size_t>(x); }
    bool is_known(std::size_t i) const { return depths[i] == depths[i]; }
};

// The nearest points as a picture. Left out are those around which most is clearly nearer: they are seen through a gap.
Grid seen_of(std::span<const SeenPoint> points, const Nearest& nearest, parallel::Pool& pool) {
    constexpr float clearly = 0.97f;
    constexpr Key most = 5;
    Grid grid(nearest.width, nearest.height);
    pool.for_each(static_cast<std::size_t>(nearest.height), [&](std::size_t y) {
        const Key *here = nearest.row(y), *above = here - nearest.stride, *below = here + nearest.stride;
        const std::size_t first = y * static_cast<std::size_t>(nearest.width);
        std::vector<Key> nearer(static_cast<std::size_t>(nearest.width));
        for (int x = 0; x < nearest.width; ++x) {
            const Key limit = key_of(clearly * depth_of(here[x]), 0);
            const auto is = [limit](Key key) { return static_cast<Key>(key < limit); };
            nearer[static_cast<std::size_t>(x)] = is(above[x - 1]) + is(above[x]) + is(above[x + 1]) + is(here[x - 1]) + is(here[x + 1]) + is(below[x - 1]) + is(below[x]) + is(below[x + 1]);
        }
        for (int x = 0; x < nearest.width; ++x) {
            if (here[x] == nothing || nearer[static_cast<std::size_t>(x)] >= most) continue;
            const std::size_t i = first + static_cast<std::size_t>(x);
            grid.colors[i] = points[point_of_key(here[x])].color;
            grid.depths[i] = depth_of(here[x]);
        }
    });
    return grid;
}

constexpr float about = 0.97f;  // as far as

// In each square of four the mean of what is about as far as the farthest: what a moving camera lays bare lies behind what hid it.
Grid coarser(const Grid& fine, parallel::Pool& pool) {
    Grid coarse((fine.width + 1) / 2, (fine.height + 1) / 2);
    pool.for_each(static_cast<std::size_t>(coarse.height), [&](std::size_t row) {
        const int y = static_cast<int>(row);
        for (int x = 0; x < coarse.width; ++x) {
            std::array<std::size_t, 4> known{};
            std::size_t count = 0;
            float far = 0;
            for (int k = 0; k < 4; ++k) {
                const int i = 2 * x + (k & 1), j = 2 * y + (k >> 1);
                if (i >= fine.width || j >= fine.height || !fine.is_known(fine.index(i, j))) continue;
                known[count++] = fine.index(i, j);
                far = std::max(far, fine.depths[known[count - 1]]);
            }
            if (count == 0) continue;
            Rgb sum;
            int summed = 0;
            for (std::size_t k = 0; k < count; ++k) {
                if (fine.depths[known[k]] < about * far) continue;
                sum += fine.colors[known[k]];
                ++summed;
            }
            coarse.colors[coarse.index(x, y)] = sum * (1 / static_cast<float>(summed));
            coarse.depths[coarse.index(x, y)] = far;
        }
    });
    return coarse;
}

// A hole gets what is farthest of the four squares about its place, its own and those on the sides to which it lies: in its own there may be nothing but what stands before the hole.
void fill_hole(Grid& fine, int x, int y, const Grid& coarse) {
    const int own_x = x / 2, own_y = y / 2;
    const int aside_x = std::clamp(own_x + (x & 1 ? 1 : -1), 0, coarse.width - 1), aside_y = std::clamp(own_y + (y & 1 ? 1 : -1), 0, coarse.height - 1);
    std::size_t from = coarse.index(own_x, own_y);
    for (const std::size_t other : {coarse.index(aside_x, own_y), coarse.index(own_x, aside_y), coarse.index(aside_x, aside_y)}) {
        if (about * coarse.depths[other] > coarse.depths[from]) from = other;
    }
    const std::size_t hole = fine.index(x, y);
    fine.colors[hole] = coarse.colors[from];
    fine.depths[hole] = coarse.depths[from];
}

void fill_holes(Grid& grid, parallel::Pool& pool) {
    std::vector<Grid> coarse;
    for (const Grid* fine = &grid; fine->width > 1 || fine->height > 1; fine = &coarse.back()) coarse.push_back(coarser(*fine, pool));
    for (std::size_t i = coarse.size(); i-- > 0;) {
        Grid& fine = i > 0 ? coarse[i - 1] : grid;
        pool.for_each(static_cast<std::size_t>(fine.height), [&](std::size_t row) {
            const int y = static_cast<int>(row);
            for (int x = 0; x < fine.width; ++x) {
                if (!fine.is_known(fine.index(x, y))) fill_hole(fine, x, y, coarse[i]);
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
    Grid grid = seen_of(points, nearest_points(points, camera, width, height, pool), pool);
    std::vector<std::uint8_t> seen(grid.depths.size());
    for (std::size_t i = 0; i < seen.size(); ++i) seen[i] = grid.is_known(i);
    fill_holes(grid, pool);
    return {std::move(grid.colors), std::move(seen)};
}

}  // namespace crescente::render
