#include "geometry/patch_borders.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace crescente::geometry {
namespace {

constexpr double same = 1e-6;  // of the patch's size

struct Border {
    Vec3 from, middle, to;  // points on it
    double tolerance;
    std::uint32_t patch;
    int side;
};

Vec3 point_on(std::vector<ControlPoint> control, double s) {
    for (std::size_t rest = control.size(); rest > 1; --rest) {
        for (std::size_t i = 0; i + 1 < rest; ++i) {
            control[i].weighted = control[i].weighted * (1 - s) + control[i + 1].weighted * s;
            control[i].weight = control[i].weight * (1 - s) + control[i + 1].weight * s;
        }
    }
    return control[0].weighted / control[0].weight;
}

double largest(Vec3 a) { return max_component(abs(a)); }

bool alike(const Border& a, const Border& b) {
    const double tolerance = std::max(a.tolerance, b.tolerance);
    const auto near = [=](Vec3 p, Vec3 q) { return largest(p - q) <= tolerance; };
    return near(a.middle, b.middle) && ((near(a.from, b.from) && near(a.to, b.to)) || (near(a.from, b.to) && near(a.to, b.from)));
}

}  // namespace

std::vector<std::array<bool, 4>> free_borders(std::span<const BezierPatch> patches) {
    std::vector<std::array<bool, 4>> free(patches.size(), {false, false, false, false});
    std::vector<Border> borders;
    double widest = 0;
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        const BezierPatch& patch = patches[i];
        const int p = patch.degree_u, q = patch.degree_v;
        if (p < 1 || q < 1 || patch.points.size() != static_cast<std::size_t>(p + 1) * (q + 1)) continue;
        double size = 0;
        const Vec3 corner = patch.points[0].weighted / patch.points[0].weight;
        for (const ControlPoint& c : patch.points) size = std::max(size, largest(c.weighted / c.weight - corner));
        for (int side = 0; side < 4; ++side) {
            std::vector<ControlPoint> control;
            const bool upper = side % 2 == 1;
            for (int k = 0; k <= (side < 2 ? q : p); ++k) control.push_back(side < 2 ? patch.at(upper ? p : 0, k) : patch.at(k, upper ? q : 0));
            const Border border{point_on(control, 0), point_on(control, 0.5), point_on(control, 1), same * size, i, side};
            if (std::max(largest(border.to - border.from), largest(border.middle - border.from)) <= border.tolerance) continue;  // a pole
            free[i][static_cast<std::size_t>(side)] = true;
            widest = std::max(widest, border.tolerance);
            borders.push_back(border);
        }
    }
    std::sort(borders.begin(), borders.end(), [](const Border& a, const Border& b) {
        if (a.middle.x != b.middle.x) return a.middle.x < b.middle.x;
        return a.patch != b.patch ? a.patch < b.patch : a.side < b.side;
    });
    for (std::size_t i = 0; i < borders.size(); ++i) {
        for (std::size_t j = i + 1; j < borders.size() && borders[j].middle.x - borders[i].middle.x <= widest; ++j) {
            if (!alike(borders[i], borders[j])) continue;
            free[borders[i].patch][static_cast<std::size_t>(borders[i].side)] = false;
            free[borders[j].patch][static_cast<std::size_t>(borders[j].side)] = false;
        }
    }
    return free;
}

}  // namespace crescente::geometry
