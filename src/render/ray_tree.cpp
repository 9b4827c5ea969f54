#include "render/ray_tree.h"

#include <cstdarg>
#include <cstdio>

namespace crescente::render {
namespace {

using math::Rgb;
using math::Vec3;

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

void print(const RayTree& tree, int indent, std::string& out) {
    const std::string pad(static_cast<std::size_t>(indent) * 2, ' ');
    out += pad + tree.kind + " ray" + (tree.from ? " from " + text(*tree.from) : "") + ", influence " + text(tree.influence) + ", radiance " + text(tree.radiance) + "\n";
    if (tree.left_scene) {
        out += pad + "  leaves the scene towards " + text(tree.position) + ": " + text(tree.local) + "\n";
        return;
    }
    out += pad + "  hits " + tree.object_name + " (" + tree.shape + format(", face %u", tree.face) + ", " + tree.material_name + ")" + (tree.inside ? " from inside" : "") + "\n";
    out += pad + "  at " + text(tree.position) + ", normal " + text(tree.normal) + "\n";
    out += pad + "  local light " + text(tree.local) + "\n";
    for (const SeenLight& light : tree.lights) {
        out += pad + "    " + light.name + ": " + light.share;
        if (light.share == "filtered") out += " " + text(light.through);
        out += ", strength " + text(light.strength) + "\n";
    }
    for (const RayTree& child : tree.children) print(child, indent + 1, out);
    for (const RayTree::Ungrown& ungrown : tree.ungrown) out += pad + "  " + ungrown.kind + " ray not grown: influence " + format("%.4g", ungrown.influence) + "\n";
}

}  // namespace

std::string text_of(const PixelTrees& trees) {
    if (trees.corners.empty()) return {};
    static constexpr const char* corner_names[] = {"top left", "top right", "bottom left", "bottom right"};
    std::string out = format("pixel %d,%d\n", trees.x, trees.y);
    for (std::size_t i = 0; i < trees.corners.size(); ++i) {
        const PixelTrees::Corner& corner = trees.corners[i];
        if (i == std::size(corner_names) && trees.splits) out += format("split %zu times\n", *trees.splits);
        out += i < std::size(corner_names) ? format("%s corner\n", corner_names[i]) : format("at %g,%g\n", corner.x, corner.y);
        if (corner.tree) print(*corner.tree, 1, out);
        else out += "  not traced yet\n";
    }
    if (trees.corners.size() == std::size(corner_names) && trees.splits) out += format("split %zu times\n", *trees.splits);
    return out;
}

}  // namespace crescente::render
