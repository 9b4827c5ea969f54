#include "render/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "render/level_visible.h"

#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

// Nothing while a corner is missing.
std::optional<Rgb> mean_of(const std::vector<Rgb>& radiance, const std::array<std::uint32_t, 4>& corners) {
    Rgb sum;
    for (const std::uint32_t root : corners) {
        if (root == no_node) return {};
        sum += radiance[root];
    }
    return sum * 0.25f;
}

// Of the parts, or while these are not whole, of the quad's own corners.
std::optional<Rgb> mean_of(const std::vector<Quad>& quads, const std::vector<Rgb>& radiance, const Quad& quad) {
    Rgb sum;
    for (std::uint32_t k = 0; quad.parts != no_node && k < 4; ++k) {
        const auto part = mean_of(quads, radiance, quads[quad.parts + k]);
        if (!part) return mean_of(radiance, quad.corners);
        sum += *part;
    }
    return quad.parts != no_node ? sum * 0.25f : mean_of(radiance, quad.corners);
}

std::uint32_t samples_in(const Tile& tile, const Quad& quad) {
    if (quad.parts == no_node) return 1;
    std::uint32_t sum = 0;
    for (std::uint32_t k = 0; k < 4; ++k) sum += samples_in(tile, tile.quads[quad.parts + k]);
    return sum;
}

// The step of the finest grid that is whole: every corner of it has a root. 0: none.
int whole_grid(const Tile& tile) {
    if (tile.corners.empty()) return 0;
    for (int step = 1; step <= coarsest_grid; step *= 2) {
        bool whole = true;
        for (int y = 0; whole && y <= tile.height; ++y) {
            if (y % step && y != tile.height) continue;
            for (int x = 0; whole && x <= tile.width; ++x) {
                if (x % step == 0 || x == tile.width) whole = tile.corner(x, y) != no_node;
            }
        }
        if (whole) return step;
    }
    return 0;
}

// Bilinear between the corners of a coarse grid, at the middle of each pixel.
std::vector<Rgb> interpolate(const Tile& tile, const std::vector<Rgb>& radiance, int step) {
    std::vector<Rgb> pixels;
    pixels.reserve(static_cast<std::size_t>(tile.width) * tile.height);
    for (int y = 0; y < tile.height; ++y) {
        const int y0 = y / step * step, y1 = std::min(y0 + step, tile.height);
        const float fy = (static_cast<float>(y - y0) + 0.5f) / static_cast<float>(y1 - y0);
        for (int x = 0; x < tile.width; ++x) {
            const int x0 = x / step * step, x1 = std::min(x0 + step, tile.width);
            const float fx = (static_cast<float>(x - x0) + 0.5f) / static_cast<float>(x1 - x0);
            const auto at = [&](int i, int j) { return radiance[tile.corner(i, j)]; };
            pixels.push_back(mix(mix(at(x0, y0), at(x1, y0), fx), mix(at(x0, y1), at(x1, y1), fx), fy));
        }
    }
    return pixels;
}

// Whether a pixel is shown as it was made up after an edit, until its trees are further.
bool is_previewed(const Tile& tile, const std::array<std::uint32_t, 4>& corners) {
    const auto is_old = [&](std::uint32_t root) { return root < tile.kept || root == no_node; };
    return tile.stage < tile.previewed_until && !tile.pixels.empty() && std::any_of(corners.begin(), corners.end(), is_old);
}

std::array<std::uint32_t, 4> corners_of(const Tile& tile, int x, int y) {
    return {tile.corner(x, y), tile.corner(x + 1, y), tile.corner(x, y + 1), tile.corner(x + 1, y + 1)};
}

}  // namespace

std::vector<Rgb> develop(const Tile& tile, std::span<const Rgb> corrections) {
    if (tile.shows_pixels()) return tile.pixels;
    const std::size_t count = static_cast<std::size_t>(tile.width) * tile.height;
    const bool edited = !tile.pixels.empty();  // what is not known anew is still shown as it was
    const std::vector<Quad>& quads = tile.quads_before.empty() ? tile.quads : tile.quads_before;
    const int step = !quads.empty() || (edited && !tile.corners.empty()) ? 1 : whole_grid(tile);
    if (step == 0) return edited ? tile.pixels : std::vector<Rgb>(count);
    const std::vector<Rgb> radiance = radiances(tile, corrections);
    if (step > 1) return interpolate(tile, radiance, step);
    std::vector<Rgb> pixels;
    pixels.reserve(count);
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const auto corners = corners_of(tile, x, y);
            const auto pixel = is_previewed(tile, corners) ? std::nullopt : quads.empty() ? mean_of(radiance, corners) : mean_of(quads, radiance, quads[pixels.size()]);
            pixels.push_back(pixel ? *pixel : edited ? tile.pixels[pixels.size()] : Rgb{});
        }
    }
    return pixels;
}

std::uint32_t root_near(const Tile& tile, int x, int y) {
    if (tile.corners.empty()) return no_node;
    if (!tile.quads.empty()) {
        const Quad& pixel = tile.quads[static_cast<std::size_t>(y) * tile.width + x];
        constexpr std::size_t bottom_right = 3;  // of the first part
        if (pixel.parts != no_node && tile.quads[pixel.parts].corners[bottom_right] != no_node) return tile.quads[pixel.parts].corners[bottom_right];
    }
    std::uint32_t nearest = no_node;
    double least = std::numeric_limits<double>::infinity();
    for (int j = 0; j <= tile.height; ++j) {
        for (int i = 0; i <= tile.width; ++i) {
            const double distance = std::hypot(i - (x + 0.5), j - (y + 0.5));
            if (tile.corner(i, j) != no_node && distance < least) nearest = tile.corner(i, j), least = distance;
        }
    }
    return nearest;
}

Tile without_trees(const Tile& tile) { return without_trees(tile, develop(tile)); }

Tile without_trees(const Tile& tile, std::vector<Rgb> pixels) {
    Tile rest = blank_tile(tile);
    rest.pixels = std::move(pixels);
    rest.rays = tile.rays;
    rest.tests = tile.tests;
    return rest;
}

scene::Image blank_image(int width, int height, bool all_layers) {
    scene::Image image{width, height, {}};
    const auto add = [&](const char* name, std::vector<std::string> channels) {
        const std::size_t values = static_cast<std::size_t>(width) * height * channels.size();
        image.layers.push_back({name, std::move(channels), std::vector<float>(values)});
    };
    add("color", {"R", "G", "B"});
    if (!all_layers) return image;
    add("depth", {"Z"});
    add("position", {"X", "Y", "Z"});
    add("normal", {"X", "Y", "Z"});
    add("albedo", {"R", "G", "B"});
    add("object", {"id"});
    add("material", {"id"});
    add("influence", {"R", "G", "B"});
    add("level", {"L"});
    add("samples", {"N"});
    return image;
}

void expose(const Tile& tile, const World& world, std::span<const scene::Level> level_of_stage, scene::Image& image, std::span<const Rgb> corrections) {
    std::vector<Rgb> developed;
    if (!tile.shows_pixels()) developed = develop(tile, corrections);
    const std::vector<Rgb>& pixels = tile.shows_pixels() ? tile.pixels : developed;
    for (int y = 0; y < tile.height; ++y) {
        float* row = &image.layers[0].values[3 * (static_cast<std::size_t>(tile.y0 + y) * image.width + tile.x0)];
        for (int x = 0; x < tile.width; ++x) {
            const Rgb& pixel = pixels[static_cast<std::size_t>(y) * tile.width + x];
            row[3 * x] = pixel.r, row[3 * x + 1] = pixel.g, row[3 * x + 2] = pixel.b;
        }
    }
    if (image.layers.size() == 1 || tile.corners.empty()) return;

    const float level = tile.stage == 0 ? 0.0f : static_cast<float>(level_of_stage[static_cast<std::size_t>(tile.stage - 1)]);
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const std::uint32_t root = tile.corner(x, y);
            const std::size_t pixel = static_cast<std::size_t>(tile.y0 + y) * image.width + tile.x0 + x;
            const bool previewed = is_previewed(tile, corners_of(tile, x, y));
            if (previewed) image.layers[8].values[pixel] = -1;
            if (root == no_node) continue;
            const auto set = [&](std::size_t layer, std::initializer_list<double> values) {
                std::size_t k = pixel * values.size();
                for (const double v : values) image.layers[layer].values[k++] = static_cast<float>(v);
            };
            const Node& node = tile.nodes[root];
            if (!previewed) set(8, {level});
            set(9, {double(tile.quads.empty() ? 1u : samples_in(tile, tile.quads[static_cast<std::size_t>(y) * tile.width + x]))});
            // What the rays that go on from there together weigh in the pixel.
            Rgb left;
            for_each_child(tile, root, [&](std::uint32_t child, Way) { left += tile.nodes[child].weight; });
            set(7, {left.r, left.g, left.b});
            if (node.left_scene()) {
                set(1, {std::numeric_limits<double>::infinity()});
                set(5, {-1});
                set(6, {-1});
                continue;
            }
            const Vec3 view = node.position - world.camera.position();
            set(1, {dot(view, world.camera.forward())});
            set(2, {node.position.x, node.position.y, node.position.z});
            set(3, {node.normal[0], node.normal[1], node.normal[2]});
            Lobes scratch;
            const Rgb& albedo = lobes_of(world, tile, root, scratch).albedo;
            set(4, {albedo.r, albedo.g, albedo.b});
            set(5, {double(world.node_of_instance[node.instance])});
            set(6, {double(node.material)});
        }
    }
}

}  // namespace crescente::render
