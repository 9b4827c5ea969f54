#include "render/describe.h"

#include <cstdarg>
#include <cstdio>

namespace crescente::render {
namespace {

std::string format(const char* pattern, ...) {
    char buffer[512];
    va_list arguments;
    va_start(arguments, pattern);
    std::vsnprintf(buffer, sizeof buffer, pattern, arguments);
    va_end(arguments);
    return buffer;
}

std::string text(Rgb c) { return format("(%.4g %.4g %.4g)", double(c.r), double(c.g), double(c.b)); }
std::string text(Vec3 v) { return format("(%.9g %.9g %.9g)", v.x, v.y, v.z); }

std::string name_or(const std::string& name, const char* kind, std::uint32_t index) {
    return name.empty() ? format("%s %u", kind, index) : "'" + name + "'";
}

const char* word(Share share) {
    switch (share) {
        case Share::untried: return "not tried";
        case Share::behind: return "behind the surface or out of reach";
        case Share::blocked: return "in shadow";
        case Share::clear: return "clear";
        case Share::filtered: return "filtered";
    }
    return "";
}

const char* word(Way way) {
    switch (way) {
        case Way::reflected: return "reflected";
        case Way::refracted: return "refracted";
        case Way::straight: return "straight";
    }
    return "";
}

void describe_node(const Tile& tile, const World& world, const std::vector<Rgb>& radiance, std::uint32_t index, const char* kind, int indent,
                   std::string& out) {
    const Node& node = tile.nodes[index];
    const std::string pad(static_cast<std::size_t>(indent) * 2, ' ');
    const bool from_camera = node.parent == no_node && !node.left_scene();
    out += pad + kind + " ray" + (from_camera ? " from " + text(world.camera.viewer_of(node.position)) : "") + ", influence " + text(influence(tile, index)) + ", radiance " + text(radiance[index]) + "\n";
    if (node.left_scene()) {
        out += pad + "  leaves the scene towards " + text(node.position) + ": " + text(node.local) + "\n";
        return;
    }
    const scene::Scene& scene = world.scene;
    const std::uint32_t owner = world.node_of_instance[node.instance];
    const std::string material = node.material < scene.materials.size() ? name_or(scene.materials[node.material].name, "material", node.material)
                                                                        : std::string("the default material");
    const geometry::Shape& shape = scene.shapes[scene.nodes[owner].shape.value].shape;
    out += pad + "  hits " + name_or(scene.nodes[owner].name, "node", owner) + " (" + std::string(geometry::shape_names[shape.index()]) + format(", face %u", geometry::face_number(shape, node.primitive)) +
           ", " + material + ")" + (node.inside ? " from inside" : "") + "\n";
    out += pad + "  at " + text(node.position) + ", normal " + text(Vec3{node.normal[0], node.normal[1], node.normal[2]}) + "\n";
    out += pad + "  local light " + text(node.local) + "\n";
    const std::size_t lights = world.lights.size();
    for (std::size_t l = 0; l < lights; ++l) {
        const std::size_t key = index * lights + l;
        const Share share = key < tile.shares.size() ? tile.shares[key] : Share::untried;
        out += pad + "    " + name_or(world.lights[l].source().name, "light", static_cast<std::uint32_t>(l)) + ": " + word(share);
        if (share == Share::filtered) out += " " + text(tile.filtered.at(key));
        out += ", strength " + text(world.lights[l].at(node.position).strength) + "\n";
    }
    for_each_child(tile, index, [&](std::uint32_t child, Way way) { describe_node(tile, world, radiance, child, word(way), indent + 1, out); });
    for (const Pending& p : tile.pending) {
        if (p.parent == index) {
            out += pad + "  " + word(p.way) + " ray not grown: influence " + format("%.4g", double(p.influence)) + "\n";
        }
    }
}

std::size_t splits(const Tile& tile, const Quad& quad) {
    if (quad.parts == no_node) return 0;
    std::size_t sum = 1;
    for (std::uint32_t k = 0; k < 4; ++k) sum += splits(tile, tile.quads[quad.parts + k]);
    return sum;
}

// The five roots that split a quad, whose top left corner and size are given in pixels, and those that split its parts.
void describe_parts(const Tile& tile, const World& world, const std::vector<Rgb>& radiance, const Quad& quad, double x, double y, double size,
                    std::string& out) {
    if (quad.parts == no_node) return;
    const double half = size / 2;
    const auto describe_root = [&](std::uint32_t part, std::uint32_t corner, double dx, double dy) {
        out += format("at %g,%g\n", x + dx, y + dy);
        describe_node(tile, world, radiance, tile.quads[quad.parts + part].corners[corner], "camera", 1, out);
    };
    describe_root(0, 1, half, 0);
    describe_root(0, 2, 0, half);
    describe_root(0, 3, half, half);
    describe_root(1, 3, size, half);
    describe_root(2, 3, half, size);
    for (std::uint32_t k = 0; k < 4; ++k) {
        describe_parts(tile, world, radiance, tile.quads[quad.parts + k], x + (k & 1 ? half : 0), y + (k & 2 ? half : 0), half, out);
    }
}

}  // namespace

std::string describe_pixel(const Tile& tile, const World& world, int x, int y) {
    std::string out = format("pixel %d,%d\n", tile.x0 + x, tile.y0 + y);
    const std::vector<Rgb> radiance = radiances(tile);
    static constexpr const char* corner_names[] = {"top left", "top right", "bottom left", "bottom right"};
    for (int k = 0; k < 4; ++k) {
        const std::uint32_t root = tile.corners.empty() ? no_node : tile.corner(x + (k & 1), y + (k >> 1));
        out += format("%s corner\n", corner_names[k]);
        if (root == no_node) {
            out += "  not traced yet\n";
        } else {
            describe_node(tile, world, radiance, root, "camera", 1, out);
        }
    }
    if (!tile.quads.empty()) {
        out += format("split %zu times\n", splits(tile, tile.quads[static_cast<std::size_t>(y) * tile.width + x]));
        describe_parts(tile, world, radiance, tile.quads[static_cast<std::size_t>(y) * tile.width + x], tile.x0 + x, tile.y0 + y, 1, out);
    }
    return out;
}

}  // namespace crescente::render
