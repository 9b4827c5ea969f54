#include "render/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <utility>

#include "render/level_lens.h"
#include "render/level_visible.h"
#include "render/stand_ins.h"
#include "render/surface_lobes.h"

namespace crescente::render {
namespace {

// Nothing while a corner is missing.
template <class T>
std::optional<T> mean_of(const std::vector<T>& of_nodes, const std::array<std::uint32_t, 4>& corners) {
    T sum{};
    for (const std::uint32_t root : corners) {
        if (root == no_node) return {};
        sum += of_nodes[root];
    }
    return sum * 0.25f;
}

// Of the parts, or while these are not whole, of the quad's own corners.
template <class T>
std::optional<T> mean_of(const std::vector<Quad>& quads, const std::vector<T>& of_nodes, const Quad& quad) {
    T sum{};
    for (std::uint32_t k = 0; quad.parts != no_node && k < 4; ++k) {
        const auto part = mean_of(quads, of_nodes, quads[quad.parts + k]);
        if (!part) return mean_of(of_nodes, quad.corners);
        sum += *part;
    }
    return quad.parts != no_node ? std::optional<T>(sum * 0.25f) : mean_of(of_nodes, quad.corners);
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
            if (!on_grid(y, tile.height, step)) continue;
            for (int x = 0; whole && x <= tile.width; ++x) {
                if (on_grid(x, tile.width, step)) whole = tile.corner(x, y) != no_node;
            }
        }
        if (whole) return step;
    }
    return 0;
}

// Bilinear between the corners of a coarse grid, at the middle of each pixel.
template <class T>
std::vector<T> interpolate(const Tile& tile, const std::vector<T>& of_nodes, int step) {
    std::vector<T> pixels;
    pixels.reserve(static_cast<std::size_t>(tile.width) * tile.height);
    for (int y = 0; y < tile.height; ++y) {
        const int y0 = y / step * step, y1 = std::min(y0 + step, tile.height);
        const float fy = (static_cast<float>(y - y0) + 0.5f) / static_cast<float>(y1 - y0);
        for (int x = 0; x < tile.width; ++x) {
            const int x0 = x / step * step, x1 = std::min(x0 + step, tile.width);
            const float fx = (static_cast<float>(x - x0) + 0.5f) / static_cast<float>(x1 - x0);
            const auto at = [&](int i, int j) { return of_nodes[tile.corner(i, j)]; };
            const auto between = [](const T& a, const T& b, float share) { return a * (1.0f - share) + b * share; };
            pixels.push_back(between(between(at(x0, y0), at(x1, y0), fx), between(at(x0, y1), at(x1, y1), fx), fy));
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

// The pixels by what of_nodes() says of every node; `before`: what they showed at an earlier time.
template <class T, class OfNodes>
std::vector<T> developed(const Tile& tile, OfNodes&& of_nodes, const std::vector<T>& before) {
    const std::size_t count = static_cast<std::size_t>(tile.width) * tile.height;
    const bool edited = !tile.pixels.empty();  // what is not known anew is still shown as it was
    const std::vector<Quad>& quads = tile.quads_before.empty() ? tile.quads : tile.quads_before;
    const int step = !quads.empty() || (edited && !tile.corners.empty()) ? 1 : whole_grid(tile);
    if (step == 0) return edited ? before : std::vector<T>(count);
    std::vector<T> values = of_nodes(tile);
    if (values.empty() && before.empty()) return {};
    values.resize(tile.nodes.size());
    if (step > 1) return interpolate(tile, values, step);
    if (tile.quads_before.empty() && !tile.samples.empty()) let_stand_in(tile, values);
    std::vector<T> pixels;
    pixels.reserve(count);
    for (int y = 0; y < tile.height; ++y) {
        for (int x = 0; x < tile.width; ++x) {
            const auto corners = corners_of(tile, x, y);
            const std::size_t i = pixels.size();
            std::optional<T> pixel;
            if (!is_previewed(tile, corners)) pixel = quads.empty() ? mean_of(values, corners) : mean_of(quads, values, quads[i]);
            pixels.push_back(pixel ? *pixel : i < before.size() ? before[i] : T{});
        }
    }
    return pixels;
}

}  // namespace

std::vector<Rgb> develop(const Tile& tile, const Corrections& corrections) {
    if (!tile.shows_pixels() && !tile.lens_pixels.empty()) return tile.lens_pixels;
    return tile.shows_pixels() ? tile.pixels : developed<Rgb>(tile, [&](const Tile& t) { return radiances(t, corrections); }, tile.pixels);
}

std::vector<float> develop_clear(const Tile& tile, const Corrections& corrections) {
    if (!tile.shows_pixels() && !tile.lens_pixels.empty()) return tile.lens_clear;
    return tile.shows_pixels() ? tile.clear_pixels : developed<float>(tile, [&](const Tile& t) { return clearness(t, corrections); }, tile.clear_pixels);
}

void keep_picture(Tile& tile, std::span<const Rgb> displayed) {
    std::vector<float> clear = develop_clear(tile);
    tile.pixels = displayed.empty() ? develop(tile) : std::vector<Rgb>(displayed.begin(), displayed.end());
    tile.clear_pixels = std::move(clear);
}

void forget_picture(Tile& tile) {
    release(tile.pixels), release(tile.clear_pixels);
    tile.pixels_stage = -1;
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
    rest.clear_pixels = develop_clear(tile);
    rest.rays = tile.rays;
    rest.tests = tile.tests;
    return rest;
}

scene::Image blank_image(int width, int height, bool all_layers, bool alpha) {
    scene::Image image{width, height, {}};
    const auto add = [&](const char* name, std::vector<std::string> channels) {
        const std::size_t values = static_cast<std::size_t>(width) * height * channels.size();
        image.layers.push_back({name, std::move(channels), std::vector<float>(values)});
    };
    add("color", alpha ? std::vector<std::string>{"R", "G", "B", "A"} : std::vector<std::string>{"R", "G", "B"});
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

void expose(const Tile& tile, const World& world, std::span<const scene::Level> level_of_stage, scene::Image& image, const Corrections& corrections) {
    std::vector<Rgb> made;
    if (!tile.shows_pixels()) made = develop(tile, corrections);
    const std::vector<Rgb>& pixels = tile.shows_pixels() ? tile.pixels : made;
    const std::size_t channels = image.layers[0].channels.size();
    const std::vector<float> clear = channels == 4 ? develop_clear(tile, corrections) : std::vector<float>{};
    for (int y = 0; y < tile.height; ++y) {
        float* to = &image.layers[0].values[channels * (static_cast<std::size_t>(tile.y0 + y) * image.width + tile.x0)];
        for (int x = 0; x < tile.width; ++x, to += channels) {
            const std::size_t i = static_cast<std::size_t>(y) * tile.width + x;
            to[0] = pixels[i].r, to[1] = pixels[i].g, to[2] = pixels[i].b;
            if (channels == 4) to[3] = 1 - std::clamp(i < clear.size() ? clear[i] : 0.0f, 0.0f, 1.0f);
        }
    }
    if (image.layers.size() == 1 || tile.corners.empty()) return;

    const LensPixels lens = lens_pixels_of(tile, world.scene.settings);
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
            const bool by_lens = !tile.lens_samples.empty();
            if (by_lens) set(9, {double(tile.lens_samples[lens.at(tile.x0 + x, tile.y0 + y)])});
            else set(9, {double(tile.quads.empty() ? 1u : samples_in(tile, tile.quads[static_cast<std::size_t>(y) * tile.width + x]))});
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
            TexturedLobes scratch;
            const Rgb& albedo = lobes_of(world, tile, root, scratch).albedo;
            set(4, {albedo.r, albedo.g, albedo.b});
            set(5, {double(world.node_of_instance[node.instance])});
            set(6, {double(node.material)});
        }
    }
}

}  // namespace crescente::render
