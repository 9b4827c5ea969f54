// Roots of rays with leaves: the kernel for each pair of degrees, and the search of boxes that one step does not decide.
#include <algorithm>
#include <memory>

#include "geometry/patch_kernel.h"
#include "geometry/patch_leaves.h"

namespace crescente::geometry {
namespace {

constexpr int max_roots = 64;     // found of one ray in one leaf
constexpr int max_depth = 96;     // halvings, of both parameters
constexpr int max_boxes = 4096;   // tried for one ray; more only for rays that run along the surface, where the answer is lost in rounding

struct Point2d {
    double u, v;
};

// A part of the leaf's [0, 1]^2, and the coefficients there.
template <class D>
struct Box {
    double u, v, size_u, size_v;
    double f[D::room], g[D::room];
};

// Coefficients of the first half stay in `values`, those of the second go to `behind`.
void halve(double* values, double* behind, int count, int stride) {
    for (int level = 0; level < count; ++level) {
        behind[(count - 1 - level) * stride] = values[(count - 1) * stride];
        for (int i = count - 1; i > level; --i) values[i * stride] = 0.5 * (values[(i - 1) * stride] + values[i * stride]);
    }
}

template <class D>
void halve(D degrees, double* values, double* behind, Way way) {
    const int columns = degrees.v + 1;
    if (way == Way::u) {
        for (int j = 0; j < columns; ++j) halve(values + j, behind + j, degrees.u + 1, columns);
    } else {
        for (int i = 0; i <= degrees.u; ++i) halve(values + i * columns, behind + i * columns, columns, 1);
    }
}

// The longer way of the net.
template <class D>
Way longer_way(D degrees, const Box<D>& box) {
    const int columns = degrees.v + 1;
    double along_u = 0, along_v = 0;
    for (int i = 0; i < degrees.u; ++i) {
        for (int k = i * columns; k < (i + 1) * columns; ++k) {
            along_u = std::max({along_u, std::abs(box.f[k + columns] - box.f[k]), std::abs(box.g[k + columns] - box.g[k])});
        }
    }
    for (int i = 0; i <= degrees.u; ++i) {
        for (int k = i * columns; k < i * columns + degrees.v; ++k) {
            along_v = std::max({along_v, std::abs(box.f[k + 1] - box.f[k]), std::abs(box.g[k + 1] - box.g[k])});
        }
    }
    return along_u * degrees.u > along_v * degrees.v ? Way::u : Way::v;
}

enum class Seen { extended, edge_on, point };

// Whether the net is more than rounding: a point, or a surface that is seen edge-on, as a line.
template <class D>
Seen seen_as(D degrees, const Box<D>& box, double delta) {
    double size = 0, f = 0, g = 0;
    bool point = true;
    for (int k = 0; k < degrees.count; ++k) {
        point = point && std::abs(box.f[k]) <= 4 * delta && std::abs(box.g[k]) <= 4 * delta;
        const double df = box.f[k] - box.f[0], dg = box.g[k] - box.g[0], square = df * df + dg * dg;
        if (square > size) size = square, f = df, g = dg;
    }
    if (point) return Seen::point;
    const double bound = 4 * delta * std::sqrt(size);
    for (int k = 0; k < degrees.count; ++k) {
        if (!(std::abs((box.f[k] - box.f[0]) * g - (box.g[k] - box.g[0]) * f) <= bound)) return Seen::extended;
    }
    return Seen::edge_on;
}

// Where in the box a net that is a point or a line is nearest to the ray; nothing if that is off by more than rounding.
template <class D>
std::optional<Point2d> nearest_point(D degrees, const Box<D>& box, double delta) {
    Point2d at{0.5, 0.5};
    for (int step = 0; step < 8; ++step) {
        double bu[D::room_u], su[D::room_u], bv[D::room_v], sv[D::room_v];
        bernstein(degrees.u, at.u, bu, su);
        bernstein(degrees.v, at.v, bv, sv);
        const auto f = evaluate(degrees, box.f, bu, su, bv, sv), g = evaluate(degrees, box.g, bu, su, bv, sv);
        if (std::abs(f.value) <= 8 * delta && std::abs(g.value) <= 8 * delta) return at;
        // Down the gradient of f^2 + g^2, by the step that is right if both are linear along it.
        const double down_u = f.value * f.u + g.value * g.u, down_v = f.value * f.v + g.value * g.v;
        const double df = f.u * down_u + f.v * down_v, dg = g.u * down_u + g.v * down_v, square = df * df + dg * dg;
        if (!(square > 0)) return std::nullopt;
        const double stride = (f.value * df + g.value * dg) / square;
        at = {std::clamp(at.u - stride * down_u, 0.0, 1.0), std::clamp(at.v - stride * down_v, 0.0, 1.0)};
    }
    return std::nullopt;
}

struct Found {
    double t, u, v;    // of the leaf's [0, 1]^2
    int turn;          // sign of the Jacobian; 0: tangential
    double blur = 0;   // of t, for tangential ones
};

class FoundList {
public:
    explicit FoundList(double same) : same_(same) {}

    // Unless it is there already: boxes overlap, so that a root on the border of two is found in both, with the Jacobian's sign the same.
    void add(const Found& root) {
        for (int i = 0; i < count_; ++i) {
            const Found& old = list_[i];
            const bool close = std::abs(old.t - root.t) <= same_ + old.blur + root.blur;
            const bool tangential = old.turn == 0 || root.turn == 0;
            if (close && (tangential || (old.turn == root.turn && std::abs(old.u - root.u) < 1e-6 && std::abs(old.v - root.v) < 1e-6))) return;
        }
        if (count_ < max_roots) list_[count_++] = root;
    }
    std::span<const Found> sorted() {
        std::sort(list_, list_ + count_, [](const Found& a, const Found& b) { return a.t < b.t; });
        return {list_, static_cast<std::size_t>(count_)};
    }

private:
    double same_;
    Found list_[max_roots];
    int count_ = 0;
};

int sign(double x) { return x < 0 ? -1 : 1; }

// Boxes still to be tried: as many as halvings, since of each pair one is tried at once.
template <class D>
class Stack {
public:
    Box<D>& push() {
        if (static_cast<std::size_t>(count_) == boxes_.size()) boxes_.push_back(std::make_unique_for_overwrite<Box<D>>());
        return *boxes_[count_++];
    }
    Box<D>& pop() { return *boxes_[--count_]; }
    bool empty() const { return count_ == 0; }
    int count() const { return count_; }

private:
    std::vector<std::unique_ptr<Box<D>>> boxes_;
    int count_ = 0;
};

template <class D>
void copy(D degrees, const Box<D>& from, Box<D>& to) {
    to.u = from.u, to.v = from.v, to.size_u = from.size_u, to.size_v = from.size_v;
    std::copy(from.f, from.f + degrees.count, to.f);
    std::copy(from.g, from.g + degrees.count, to.g);
    pad(degrees, to.f), pad(degrees, to.g);
}

// Tries what the first attempt left undecided.
template <class D>
void search(D degrees, const LeafPoints& points, const PatchRay<double>& ray, Box<D>& box, FoundList& found) {
    const auto add = [&](double u, double v, int turn) { found.add({parameter_at(degrees, points, ray, u, v), u, v, turn}); };
    Stack<D> stack;
    for (int tried = 0; tried < max_boxes; ++tried) {
        bool split = false;
        const Seen seen = seen_as(degrees, box, ray.delta);
        if (seen == Seen::extended && stack.count() < max_depth) {
            split = true;
        } else if (box.size_u * box.size_v < 1) {
            // As near as can be told the ray touches the surface here. A whole leaf seen edge-on is not hit, as other flat shapes are not.
            if (const auto touch = nearest_point(degrees, box, ray.delta)) {
                const double u = box.u + touch->u * box.size_u, v = box.v + touch->v * box.size_v, t = parameter_at(degrees, points, ray, u, v);
                const double along_u = parameter_at(degrees, points, ray, box.u, v) - parameter_at(degrees, points, ray, box.u + box.size_u, v);
                const double along_v = parameter_at(degrees, points, ray, u, box.v) - parameter_at(degrees, points, ray, u, box.v + box.size_v);
                found.add({t, u, v, 0, std::abs(along_u) + std::abs(along_v)});
            }
        }
        if (split) {
            Box<D>& behind = stack.push();
            behind.u = box.u, behind.v = box.v, behind.size_u = box.size_u, behind.size_v = box.size_v;
            const Way way = longer_way(degrees, box);
            halve(degrees, box.f, behind.f, way);
            halve(degrees, box.g, behind.g, way);
            pad(degrees, box.f), pad(degrees, box.g), pad(degrees, behind.f), pad(degrees, behind.g);
            (way == Way::u ? box.size_u : box.size_v) *= 0.5;
            (way == Way::u ? behind.size_u : behind.size_v) *= 0.5;
            if (way == Way::u) behind.u += box.size_u;
            else behind.v += box.size_v;
        } else {
            if (stack.empty()) return;
            copy(degrees, stack.pop(), box);
        }
        while (true) {
            const auto result = attempt<D, double>(degrees, box.f, box.g, ray.delta, true);
            if (!result.excluded && !result.found) break;
            if (result.found) add(box.u + box.size_u * result.u, box.v + box.size_v * result.v, sign(result.turn));
            if (stack.empty()) return;
            copy(degrees, stack.pop(), box);
        }
    }
}

// Of a leaf whose coefficients are in the box, after the first attempt left it undecided.
template <class D>
int searched_roots(D degrees, const LeafPoints& points, const PatchRay<double>& ray, Box<D>& box, const Ray& within, std::span<PatchRoot> out) {
    box.u = box.v = 0, box.size_u = box.size_v = 1;
    FoundList found(4 * ray.delta / ray.speed);
    search(degrees, points, ray, box, found);
    std::size_t count = 0;
    for (const Found& root : found.sorted()) {
        if (root.t > within.t_min && root.t <= within.t_max && root.t < HUGE_VAL && count < out.size()) out[count++] = {root.t, root.u, root.v};
    }
    return static_cast<int>(count);
}

template <class D>
int roots_in(D degrees, const LeafPoints& points, const PatchRay<double>& ray, const Ray& within, std::span<PatchRoot> out) {
    if (!ray.usable() || out.empty()) return 0;
    Box<D> box;
    project(degrees, points, ray.origin, ray.across, box.f);
    pad(degrees, box.f);
    if (one_sided(degrees, box.f, ray.delta)) return 0;
    project(degrees, points, ray.origin, ray.up, box.g);
    pad(degrees, box.g);
    const auto first = attempt<D, double>(degrees, box.f, box.g, ray.delta, true);
    if (first.excluded) return 0;
    if (first.found) {
        const double t = parameter_at(degrees, points, ray, first.u, first.v);
        if (!(t > within.t_min && t <= within.t_max && t < HUGE_VAL)) return 0;
        out[0] = {t, first.u, first.v};
        return 1;
    }
    return searched_roots(degrees, points, ray, box, within, out);
}

template <class D>
unsigned roots_in(D degrees, const LeafPoints& points, const PatchRay<Lanes>& ray, unsigned active, const RayLanes& within, PatchRootLanes& out) {
    Lanes f[D::room], g[D::room];
    project(degrees, points, ray.origin, ray.across, f);
    project(degrees, points, ray.origin, ray.up, g);
    const LaneMask wanted = mask_of(active) & ray.usable();
    const auto result = attempt<D, Lanes>(degrees, f, g, ray.delta, wanted);
    unsigned found = 0;
    if (any(result.found & wanted)) {
        out.u = result.u, out.v = result.v;
        out.t = parameter_at(degrees, points, ray, result.u, result.v);
        found = bits_of(result.found & wanted & (out.t > within.t_min) & (out.t <= within.t_max) & (out.t < HUGE_VAL));
    }
    // What is undecided goes on from the coefficients, one ray at a time.
    for (unsigned rest = bits_of(wanted & (!(result.excluded | result.found))); rest; rest &= rest - 1) {
        const int i = __builtin_ctz(rest);
        Box<D> box;
        for (int k = 0; k < degrees.count; ++k) box.f[k] = f[k][i], box.g[k] = g[k][i];
        pad(degrees, box.f), pad(degrees, box.g);
        PatchRoot root;
        Ray one;
        one.t_min = within.t_min[i], one.t_max = within.t_max[i];
        if (searched_roots(degrees, points, ray.lane(i), box, one, {&root, 1}) == 0) continue;
        out.t[i] = root.t, out.u[i] = root.u, out.v[i] = root.v;
        found |= 1u << i;
    }
    return found;
}

template <class T>
PatchRay<T> patch_ray(const Point3<T>& origin, const Point3<T>& direction, Vec3 center, double reach) {
    return {origin, direction, center, reach};
}

}  // namespace

// What sees into leaves.
struct PatchKernels {
    static std::uint8_t kernel_of(int degree_u, int degree_v) {
        for (std::uint8_t kernel = 1; kernel <= 14; ++kernel) {
            if (visit_degrees(kernel, 0, 0, [=](auto degrees) { return degrees.u == degree_u && degrees.v == degree_v; })) return kernel;
        }
        return 0;
    }

    static LeafPoints points(const PatchLeaves& leaves, const PatchLeaves::Leaf& leaf) {
        const std::size_t count = static_cast<std::size_t>(leaf.degree_u + 1) * (leaf.degree_v + 1);
        const double* x = leaves.points(leaf);
        return {x, x + count, x + 2 * count, leaf.rational ? x + 3 * count : nullptr};
    }

    static int roots(const PatchLeaves& leaves, const PatchLeaves::Leaf& leaf, const Ray& ray, std::span<PatchRoot> out) {
        const LeafPoints control = points(leaves, leaf);
        const auto from = patch_ray<double>({ray.origin.x, ray.origin.y, ray.origin.z}, {ray.direction.x, ray.direction.y, ray.direction.z}, leaf.center,
                                            leaf.blur_reach);
        const int count = visit_degrees(leaf.kernel, leaf.degree_u, leaf.degree_v, [&](auto degrees) { return roots_in(degrees, control, from, ray, out); });
        for (int i = 0; i < count; ++i) {
            out[i].u = leaf.u0 + out[i].u * (leaf.u1 - leaf.u0);
            out[i].v = leaf.v0 + out[i].v * (leaf.v1 - leaf.v0);
        }
        return count;
    }

    static unsigned nearest(const PatchLeaves& leaves, std::uint32_t index, const RayLanes& rays, unsigned active, PatchRootLanes& out) {
        const PatchLeaves::Leaf& leaf = leaves.leaves_[index];
        const LeafPoints control = points(leaves, leaf);
        return visit_degrees(leaf.kernel, leaf.degree_u, leaf.degree_v, [&](auto degrees) {
            unsigned found = 0;
            if constexpr (std::is_same_v<decltype(degrees), AnyDegrees>) {
                for (unsigned rest = active; rest; rest &= rest - 1) {
                    const int i = __builtin_ctz(rest);
                    const auto &o = rays.origin, &d = rays.direction;
                    const Ray ray{{o.x[i], o.y[i], o.z[i]}, {d.x[i], d.y[i], d.z[i]}, rays.t_min[i], rays.t_max[i]};
                    if (const auto root = leaves.nearest(index, ray)) out.t[i] = root->t, out.u[i] = root->u, out.v[i] = root->v, found |= 1u << i;
                }
            } else {
                const auto from = patch_ray<Lanes>(rays.origin, rays.direction, leaf.center, leaf.blur_reach);
                found = roots_in(degrees, control, from, active, rays, out);
                if (found) out.u = leaf.u0 + out.u * (leaf.u1 - leaf.u0), out.v = leaf.v0 + out.v * (leaf.v1 - leaf.v0);
            }
            return found;
        });
    }
};

int PatchLeaves::roots(std::uint32_t leaf, const Ray& ray, std::span<PatchRoot> out) const {
    return PatchKernels::roots(*this, leaves_[leaf], ray, out);
}

std::optional<PatchRoot> PatchLeaves::nearest(std::uint32_t leaf, const Ray& ray) const {
    PatchRoot first;
    if (PatchKernels::roots(*this, leaves_[leaf], ray, {&first, 1}) == 0) return std::nullopt;
    return first;
}

unsigned PatchLeaves::nearest(std::uint32_t leaf, const RayLanes& rays, unsigned active, PatchRootLanes& roots) const {
    return PatchKernels::nearest(*this, leaf, rays, active, roots);
}

std::uint8_t patch_kernel_of(int degree_u, int degree_v) { return PatchKernels::kernel_of(degree_u, degree_v); }

}  // namespace crescente::geometry
