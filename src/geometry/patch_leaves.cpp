#include "geometry/patch_leaves.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/bernstein.h"
#include "geometry/patch_borders.h"
#include "geometry/patch_kernel.h"

namespace crescente::geometry {
namespace {

constexpr double normal_spread = 18 * pi / 180;  // from the mean: smaller makes more leaves, larger more boxes to halve for each ray
constexpr int max_halvings = 14;                 // of a patch, for the normals' sake
constexpr int extra_halvings = 3;                // for that of an even parametrisation

bool usable(const BezierPatch& patch) {
    const int p = patch.degree_u, q = patch.degree_v;
    if (p < 1 || q < 1 || p > max_patch_degree || q > max_patch_degree) return false;
    if (patch.points.size() != static_cast<std::size_t>(p + 1) * (q + 1)) return false;
    for (const ControlPoint& c : patch.points) {
        if (!is_finite(c.weighted) || !(c.weight > 0) || !std::isfinite(c.weight) || !is_finite(c.weighted / c.weight)) return false;
    }
    return std::isfinite(patch.u0) && std::isfinite(patch.u1) && std::isfinite(patch.v0) && std::isfinite(patch.v1);
}

bool positive(const BezierPatch& patch) {
    return std::all_of(patch.points.begin(), patch.points.end(), [](const ControlPoint& c) { return c.weight > 0; });
}

Vec3 place(const ControlPoint& c) { return c.weighted / c.weight; }

// The patch's range grown in space by `band` on the sides that ask for it.
void extend(BezierPatch& patch, const std::array<bool, 4>& sides, double band) {
    constexpr double most = 0.02;
    const BezierPatch whole = patch;
    for (int side = 0; side < 4; ++side) {
        if (!sides[side]) continue;
        const Way way = side < 2 ? Way::u : Way::v;
        const bool upper = side % 2 == 1;
        const int along = way == Way::u ? patch.degree_v : patch.degree_u, across = way == Way::u ? patch.degree_u : patch.degree_v;
        double least = HUGE_VAL;  // speed across the border
        for (int k = 0; k <= along; ++k) {
            const int from = upper ? across : 0, to = upper ? across - 1 : 1;
            const Vec3 a = place(way == Way::u ? whole.at(from, k) : whole.at(k, from)), b = place(way == Way::u ? whole.at(to, k) : whole.at(k, to));
            least = std::min(least, across * length(b - a));
        }
        double grow = std::min(2 * band / least, most);
        if (!(grow > 0)) continue;
        for (int attempt = 0; attempt < 8; ++attempt, grow *= 0.5) {
            BezierPatch longer = patch;
            if (upper) cut_off(longer, way, 1 + grow);
            else longer = cut_off(longer, way, -grow);
            if (!positive(longer)) continue;  // a weight that falls towards the border
            patch = std::move(longer);
            break;
        }
    }
}

// How a piece of a patch bends.
struct Bend {
    Vec3 normal;           // mean; zero where there is none
    double cosine = 1;     // of the largest angle of a cell of the net to it
    Way way = Way::u;      // the one that bends more
    Way uneven = Way::u;   // the one along which the partial derivatives change more, each compared to its length
};

Bend bend_of(const BezierPatch& piece, const std::vector<Vec3>& at) {
    const int p = piece.degree_u, q = piece.degree_v, columns = q + 1;
    const auto point = [&](int i, int j) { return at[static_cast<std::size_t>(i * columns + j)]; };
    Bend bend;
    for (int i = 0; i < p; ++i) {
        for (int j = 0; j < q; ++j) bend.normal += cross(point(i + 1, j + 1) - point(i, j), point(i, j + 1) - point(i + 1, j));
    }
    const double size = length(bend.normal);
    if (!(size > 0)) return bend;
    bend.normal = bend.normal / size;
    // How much the normal changes along u and along v: a long strip of degree 1 along u may bend by its twist alone. Compared with the last point along
    // the way that has a normal: in a net that shrinks to a point at several rows no two neighbours may have one.
    std::vector<Vec3> normals(at.size());
    double bend_u = 0, bend_v = 0;
    const auto normal_at = [&](int i, int j) -> Vec3& { return normals[static_cast<std::size_t>(i * columns + j)]; };
    const auto exists = [](Vec3 n) { return dot(n, n) > 0; };
    for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) {
            const Vec3 n = cross(point(std::min(i + 1, p), j) - point(std::max(i - 1, 0), j), point(i, std::min(j + 1, q)) - point(i, std::max(j - 1, 0)));
            const double l = length(n);
            if (!(l > 1e-9 * size)) continue;
            bend.cosine = std::min(bend.cosine, dot(n, bend.normal) / l);
            normal_at(i, j) = n / l;
            int above = i - 1, left = j - 1;
            while (above >= 0 && !exists(normal_at(above, j))) --above;
            while (left >= 0 && !exists(normal_at(i, left))) --left;
            if (above >= 0) bend_u = std::max(bend_u, p * length(normal_at(i, j) - normal_at(above, j)) / (i - above));
            if (left >= 0) bend_v = std::max(bend_v, q * length(normal_at(i, j) - normal_at(i, left)) / (j - left));
        }
    }
    double along_u = 0, along_v = 0, twist = 0;
    for (int i = 0; i <= p; ++i) {
        for (int j = 0; j <= q; ++j) {
            if (i >= 1 && j >= 1) twist = std::max(twist, length(point(i, j) - point(i - 1, j) - point(i, j - 1) + point(i - 1, j - 1)) * (p * q));
            if (i >= 2) along_u = std::max(along_u, length(point(i, j) - point(i - 1, j) * 2 + point(i - 2, j)) * (p * (p - 1)));
            if (j >= 2) along_v = std::max(along_v, length(point(i, j) - point(i, j - 1) * 2 + point(i, j - 2)) * (q * (q - 1)));
        }
    }
    double long_u = 0, long_v = 0;
    for (int i = 0; i <= p; ++i) long_v += length(point(i, q) - point(i, 0)) / (p + 1);
    for (int j = 0; j <= q; ++j) long_u += length(point(p, j) - point(0, j)) / (q + 1);
    bend.uneven = along_u / long_u + twist / long_v >= along_v / long_v + twist / long_u ? Way::u : Way::v;
    bend.way = bend_u != bend_v ? (bend_u > bend_v ? Way::u : Way::v) : (long_u >= long_v ? Way::u : Way::v);
    return bend;
}

}  // namespace

// Cuts patches into leaves.
class LeafCutter {
public:
    LeafCutter(PatchLeaves& leaves, const std::function<bool(const ParameterBox&)>& unwanted) : leaves_(leaves), unwanted_(unwanted) {}

    void cut_patch(const BezierPatch& patch, std::uint32_t index) {
        Bounds box;
        for (const ControlPoint& c : patch.points) box.include(place(c));
        center_ = box.center();
        index_ = index;
        rational_ = patch.rational;
        reach_ = box.largest_coordinate();
        blur_reach_ = 0.5 * max_component(box.diagonal()) + (rational_ ? reach_ : 0);
        BezierPatch local = patch;
        double heaviest = 0;
        for (const ControlPoint& c : local.points) heaviest = std::max(heaviest, c.weight);
        for (ControlPoint& c : local.points) {
            c.weighted = (c.weighted - center_ * c.weight) / heaviest;
            c.weight /= heaviest;
        }
        cut_piece(std::move(local), 0, 0);
    }

private:
    void cut_piece(BezierPatch piece, int halvings, int extra) {
        if (unwanted_ && unwanted_({std::min(piece.u0, piece.u1), std::max(piece.u0, piece.u1), std::min(piece.v0, piece.v1), std::max(piece.v0, piece.v1)})) return;
        std::vector<Vec3> at;
        for (const ControlPoint& c : piece.points) at.push_back(rational_ ? place(c) : c.weighted);
        const Bend bend = bend_of(piece, at);
        const bool bent = bend.cosine < std::cos(normal_spread);
        if (halvings < max_halvings && (bent || (extra < extra_halvings && !even(piece, bend.normal)))) {
            BezierPatch behind = cut_off(piece, bent ? bend.way : bend.uneven, 0.5);
            cut_piece(std::move(piece), halvings + 1, extra + !bent);
            cut_piece(std::move(behind), halvings + 1, extra + !bent);
            return;
        }
        PatchLeaves::Leaf leaf{};
        leaf.center = center_;
        leaf.u0 = piece.u0, leaf.u1 = piece.u1, leaf.v0 = piece.v0, leaf.v1 = piece.v1;
        leaf.reach = reach_, leaf.blur_reach = blur_reach_;
        leaf.normal = bend.normal;
        leaf.first = leaves_.numbers_.size();
        leaf.patch = index_;
        leaf.degree_u = static_cast<std::uint8_t>(piece.degree_u), leaf.degree_v = static_cast<std::uint8_t>(piece.degree_v);
        leaf.kernel = patch_kernel_of(piece.degree_u, piece.degree_v);
        leaf.rational = rational_;
        for (int axis = 0; axis < 3; ++axis) {
            for (const ControlPoint& c : piece.points) leaves_.numbers_.push_back(c.weighted[axis]);
        }
        if (rational_) {
            for (const ControlPoint& c : piece.points) leaves_.numbers_.push_back(c.weight);
        }
        leaves_.leaves_.push_back(leaf);
    }

    // Whether a ray along the normal through the middle is sure of at most one root at the first attempt, with room to spare for others.
    bool even(const BezierPatch& piece, Vec3 normal) const {
        constexpr double sure = 0.7;
        if (!(dot(normal, normal) > 0)) return true;
        const int p = piece.degree_u, q = piece.degree_v, columns = q + 1, last = p * columns;
        const Vec3 side = perpendicular(normal), up = cross(normal, side);
        const ControlPoint& middle = piece.at(p / 2, q / 2);
        const Vec3 through = place(middle);
        std::vector<double> f, g;
        for (const ControlPoint& c : piece.points) {
            const Vec3 away = c.weighted - through * c.weight;
            f.push_back(dot(side, away)), g.push_back(dot(up, away));
        }
        double fu = 0, fv = 0, gu = 0, gv = 0;
        for (int j = 0; j <= q; ++j) fu += (f[last + j] - f[j]) / columns, gu += (g[last + j] - g[j]) / columns;
        for (int i = 0; i <= p; ++i) fv += (f[i * columns + q] - f[i * columns]) / (p + 1), gv += (g[i * columns + q] - g[i * columns]) / (p + 1);
        const double det = fu * gv - fv * gu;
        double k11 = 0, k12 = 0, k21 = 0, k22 = 0;
        for (int i = 0; i <= p; ++i) {
            for (int j = 0; j <= q; ++j) {
                const int k = i * columns + j;
                if (i < p) {
                    const double df = p * (f[k + columns] - f[k]), dg = p * (g[k + columns] - g[k]);
                    k11 = std::max(k11, std::abs((gv * df - fv * dg) / det - 1));
                    k21 = std::max(k21, std::abs((fu * dg - gu * df) / det));
                }
                if (j < q) {
                    const double df = q * (f[k + 1] - f[k]), dg = q * (g[k + 1] - g[k]);
                    k12 = std::max(k12, std::abs((gv * df - fv * dg) / det));
                    k22 = std::max(k22, std::abs((fu * dg - gu * df) / det - 1));
                }
            }
        }
        return k11 + k12 < sure && k21 + k22 < sure;
    }

    PatchLeaves& leaves_;
    const std::function<bool(const ParameterBox&)>& unwanted_;
    Vec3 center_;
    std::uint32_t index_ = 0;
    double reach_ = 0, blur_reach_ = 0;
    bool rational_ = false;
};

PatchLeaves::PatchLeaves(std::span<const BezierPatch> patches, double band, const std::function<bool(const ParameterBox&)>& unwanted) {
    LeafCutter cutter(*this, unwanted);
    std::vector<std::array<bool, 4>> sides(patches.size(), {false, false, false, false});
    if (band > 0) sides = free_borders(patches);
    for (std::uint32_t i = 0; i < patches.size(); ++i) {
        if (!usable(patches[i])) continue;
        BezierPatch patch = patches[i];
        if (band > 0) extend(patch, sides[i], band);
        cutter.cut_patch(patch, i);
    }
    numbers_.insert(numbers_.end(), lane_count, 0.0);  // the last leaf is read in whole blocks too
    leaves_.shrink_to_fit();
    numbers_.shrink_to_fit();
}

Bounds PatchLeaves::bounds(std::uint32_t index) const {
    const Leaf& leaf = leaves_[index];
    const std::size_t count = static_cast<std::size_t>(leaf.degree_u + 1) * (leaf.degree_v + 1);
    const double* x = points(leaf);
    Bounds box;
    for (std::size_t k = 0; k < count; ++k) {
        const double weight = leaf.rational ? x[3 * count + k] : 1;
        box.include(leaf.center + Vec3{x[k], x[count + k], x[2 * count + k]} / weight);
    }
    const Vec3 margin = Vec3{1, 1, 1} * (2 * error(index));
    // The overlap of neighbours lies in the extension of the leaf, outside the hull by no more than a share of its size.
    const Vec3 overlap = box.diagonal() * 1e-9;
    return {box.lower - margin - overlap, box.upper + margin + overlap};
}

std::size_t PatchLeaves::bytes() const { return leaves_.capacity() * sizeof(Leaf) + numbers_.capacity() * sizeof(double); }

}  // namespace crescente::geometry
