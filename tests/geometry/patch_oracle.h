// The roots of a ray with a patch by subdivision alone, in long double: boxes of parameters are halved until they are tiny, none is given up but
// for lying beside the ray, and the winding number about what remains tells how many crossings are there. No Newton, no leaves.
#pragma once

#include <cmath>
#include <vector>

#include "geometry/bezier_patch.h"
#include "geometry/ray.h"

namespace crescente::geometry::test {

using Real = long double;

struct OracleRoot {
    Real u0, u1, v0, v1;  // a box that it is in, of the patch's [0, 1]^2
    Real t0, t1;          // parameters of the ray about there
    int winding;          // of (f, g) about it: +-1 a crossing; 0 none, or two that are not told apart
    bool blurred;         // the box was grown since doubles cannot tell where in it the root is
};

class PatchOracle {
public:
    explicit PatchOracle(const BezierPatch& patch) : p_(patch.degree_u), q_(patch.degree_v), corner_(patch.points[0].weighted / patch.points[0].weight) {
        for (const ControlPoint& c : patch.points) {
            const Real w = c.weight;
            points_.push_back({c.weighted.x - w * corner_.x, c.weighted.y - w * corner_.y, c.weighted.z - w * corner_.z, w});
            if (c.weight != 1) rounded_ = std::max(std::abs(corner_.x), std::max(std::abs(corner_.y), std::abs(corner_.z)));
        }
    }

    // margin: how far beyond [0, 1] roots are looked for.
    std::vector<OracleRoot> roots(const Ray& ray, Real margin = 0) const {
        Net net = project(ray);
        if (margin > 0) {
            for (const bool along_u : {true, false}) {
                Net behind = net;
                cut(net, behind, along_u, 1 + margin);
                cut(net, behind, along_u, -margin / (1 + margin));  // of a range that is now [0, 1 + margin]
                net = behind;
            }
        }
        net.u0 = net.v0 = -margin, net.size_u = net.size_v = 1 + 2 * margin;
        std::vector<Net> pending{net};
        std::vector<OracleRoot> found;
        while (!pending.empty()) {
            Net box = std::move(pending.back());
            pending.pop_back();
            if (one_sided(box.f) || one_sided(box.g) || beside(box)) continue;
            if (pending.size() > 2000 || found.size() > 200) {
                hopeless_ = true;
                return {};
            }
            if (box.size_u < finest && box.size_v < finest) {
                join(found, box);
                continue;
            }
            const bool along_u = box.size_u >= box.size_v;
            Net behind = box;
            cut(box, behind, along_u, 0.5L);
            Real& size = along_u ? box.size_u : box.size_v;
            size *= 0.5L;
            (along_u ? behind.size_u : behind.size_v) = size;
            (along_u ? behind.u0 : behind.v0) += size;
            pending.push_back(std::move(box));
            pending.push_back(std::move(behind));
        }
        merge(found);
        for (OracleRoot& root : found) judge(root, ray);
        return found;
    }
    bool hopeless() const { return hopeless_; }  // the last ray runs along the surface: too many boxes

    struct Point {
        Real x, y, z;
    };
    // What follows is as seen from the patch's first corner.
    Vec3 corner() const { return corner_; }
    Point on_ray(const Ray& ray, Real t) const {
        const Point p = from(ray);
        return {p.x + t * ray.direction.x, p.y + t * ray.direction.y, p.z + t * ray.direction.z};
    }
    Point at(Real u, Real v) const {
        Real sum[4] = {};
        for (int i = 0; i <= p_; ++i) {
            for (int j = 0; j <= q_; ++j) {
                const Control& c = points_[static_cast<std::size_t>(i * (q_ + 1) + j)];
                const Real b = basis(p_, i, u) * basis(q_, j, v);
                sum[0] += b * c.x, sum[1] += b * c.y, sum[2] += b * c.z, sum[3] += b * c.w;
            }
        }
        return {sum[0] / sum[3], sum[1] / sum[3], sum[2] / sum[3]};
    }

private:
    static constexpr Real finest = 0x1p-24L;

    struct Net {
        std::vector<Real> f, g;
        Real u0 = 0, v0 = 0, size_u = 1, size_v = 1;
    };

    struct Control {
        Real x, y, z, w;
    };

    Point from(const Ray& ray) const { return {Real{ray.origin.x} - corner_.x, Real{ray.origin.y} - corner_.y, Real{ray.origin.z} - corner_.z}; }
    static Real basis(int n, int i, Real s) {
        Real b = 1;
        for (int k = 0; k < i; ++k) b *= s * (n - k) / (k + 1);
        for (int k = i; k < n; ++k) b *= 1 - s;
        return b;
    }
    static bool one_sided(const std::vector<Real>& values) {
        bool positive = true, negative = true;
        for (const Real x : values) positive = positive && x > 0, negative = negative && x < 0;
        return positive || negative;
    }
    // Whether a combination of f and g is one-sided: those that are nearly the distances in u and v.
    bool beside(const Net& box) const {
        const std::size_t last = box.f.size() - 1, row = static_cast<std::size_t>(q_), column = last - row;
        const auto slope = [](const std::vector<Real>& c, std::size_t a, std::size_t b, std::size_t d, std::size_t e) { return c[a] - c[b] + c[d] - c[e]; };
        const Real fu = slope(box.f, column, 0, last, row), fv = slope(box.f, row, 0, last, column);
        const Real gu = slope(box.g, column, 0, last, row), gv = slope(box.g, row, 0, last, column);
        std::vector<Real> a, b;
        for (std::size_t k = 0; k <= last; ++k) a.push_back(gv * box.f[k] - fv * box.g[k]), b.push_back(fu * box.g[k] - gu * box.f[k]);
        return one_sided(a) || one_sided(b);
    }
    void cut(Net& net, Net& behind, bool along_u, Real s) const {
        for (auto values : {&Net::f, &Net::g}) {
            for (int line = 0; line <= (along_u ? q_ : p_); ++line) {
                const int count = along_u ? p_ + 1 : q_ + 1;
                const auto place = [&](int k) { return static_cast<std::size_t>(along_u ? k * (q_ + 1) + line : line * (q_ + 1) + k); };
                for (int level = 0; level < count; ++level) {
                    (behind.*values)[place(count - 1 - level)] = (net.*values)[place(count - 1)];
                    for (int k = count - 1; k > level; --k) {
                        (net.*values)[place(k)] = (1 - s) * (net.*values)[place(k - 1)] + s * (net.*values)[place(k)];
                    }
                }
            }
        }
    }
    // Two linear functions that vanish on the ray: the components of d x (P - o) in the two axes where they are independent.
    void planes(const Ray& ray, Real n[2][3]) const {
        const Real d[3] = {ray.direction.x, ray.direction.y, ray.direction.z};
        int axis = 0;
        for (int k = 1; k < 3; ++k) {
            if (std::abs(d[k]) > std::abs(d[axis])) axis = k;
        }
        const int i = (axis + 1) % 3, j = (axis + 2) % 3;
        for (int k = 0; k < 3; ++k) n[0][k] = n[1][k] = 0;
        n[0][i] = 1, n[0][axis] = -d[i] / d[axis];
        n[1][j] = 1, n[1][axis] = -d[j] / d[axis];
    }
    Net project(const Ray& ray) const {
        Real n[2][3];
        planes(ray, n);
        Net net;
        const Point o = from(ray);
        for (const Control& c : points_) {
            const Real x = c.x - c.w * o.x, y = c.y - c.w * o.y, z = c.z - c.w * o.z;
            net.f.push_back(n[0][0] * x + n[0][1] * y + n[0][2] * z);
            net.g.push_back(n[1][0] * x + n[1][1] * y + n[1][2] * z);
        }
        return net;
    }
    static void join(std::vector<OracleRoot>& found, const Net& box) {
        const OracleRoot root{box.u0, box.u0 + box.size_u, box.v0, box.v0 + box.size_v, 0, 0, 0, false};
        for (OracleRoot& old : found) {
            if (apart(old, root)) continue;
            unite(old, root);
            return;
        }
        found.push_back(root);
    }
    static bool apart(const OracleRoot& a, const OracleRoot& b) {
        constexpr Real gap = 4 * finest;
        return a.u0 > b.u1 + gap || b.u0 > a.u1 + gap || a.v0 > b.v1 + gap || b.v0 > a.v1 + gap;
    }
    static void unite(OracleRoot& a, const OracleRoot& b) {
        a.u0 = std::min(a.u0, b.u0), a.u1 = std::max(a.u1, b.u1), a.v0 = std::min(a.v0, b.v0), a.v1 = std::max(a.v1, b.v1);
    }
    static void merge(std::vector<OracleRoot>& found) {
        for (bool changed = true; changed;) {
            changed = false;
            for (std::size_t i = 0; i < found.size(); ++i) {
                for (std::size_t j = found.size() - 1; j > i; --j) {
                    if (apart(found[i], found[j])) continue;
                    unite(found[i], found[j]);
                    found.erase(found.begin() + static_cast<std::ptrdiff_t>(j));
                    changed = true;
                }
            }
        }
    }
    // Walks about the root's box, grown until the ray is farther from the walk than doubles can blur; if it cannot be, the winding number is left 0.
    void judge(OracleRoot& root, const Ray& ray) const {
        Real n[2][3];
        planes(ray, n);
        // Coordinates are exact; what is rounded are differences from the ray's origin, and those times weights.
        Real reach = 0;
        const Point o = from(ray);
        for (const Control& c : points_) reach = std::max({reach, std::abs(c.x / c.w - o.x), std::abs(c.y / c.w - o.y), std::abs(c.z / c.w - o.z)});
        reach += rounded_;
        const Real blur = 1024 * std::numeric_limits<double>::epsilon() * reach;
        const Real dd = Real{ray.direction.x} * ray.direction.x + Real{ray.direction.y} * ray.direction.y + Real{ray.direction.z} * ray.direction.z;
        Real grow_u = 4 * finest + (root.u1 - root.u0), grow_v = 4 * finest + (root.v1 - root.v0);
        for (Real least = 0; grow_u < 0.1L && grow_v < 0.1L; grow_u *= 4, grow_v *= 4) {
            const OracleRoot box{root.u0 - grow_u, root.u1 + grow_u, root.v0 - grow_v, root.v1 + grow_v, HUGE_VALL, -HUGE_VALL, 0, root.blurred};
            constexpr int side = 64;
            Real turn = 0, f0 = 0, g0 = 0, t0 = HUGE_VALL, t1 = -HUGE_VALL;
            least = HUGE_VALL;
            for (int k = 0; k <= 4 * side; ++k) {
                const int edge = k / side % 4;
                const Real s = Real(k % side) / side, du = box.u1 - box.u0, dv = box.v1 - box.v0;
                const Real u = edge == 0 ? box.u0 + s * du : edge == 1 ? box.u1 : edge == 2 ? box.u1 - s * du : box.u0;
                const Real v = edge == 0 ? box.v0 : edge == 1 ? box.v0 + s * dv : edge == 2 ? box.v1 : box.v1 - s * dv;
                const Point on = at(u, v);
                const Real x = on.x - o.x, y = on.y - o.y, z = on.z - o.z;
                const Real f = n[0][0] * x + n[0][1] * y + n[0][2] * z, g = n[1][0] * x + n[1][1] * y + n[1][2] * z;
                const Real t = (x * ray.direction.x + y * ray.direction.y + z * ray.direction.z) / dd;
                t0 = std::min(t0, t), t1 = std::max(t1, t);
                least = std::min(least, std::hypot(f, g));
                if (k > 0) {
                    const Real step = std::atan2(f0 * g - g0 * f, f0 * f + g0 * g);
                    turn += step;
                    if (std::abs(step) > 1) least = 0;  // it may come nearer between the two
                }
                f0 = f, g0 = g;
            }
            root.t0 = t0, root.t1 = t1;
            if (least < blur) {
                root.blurred = true;
                continue;
            }
            root = box;
            root.t0 = t0, root.t1 = t1;
            root.winding = static_cast<int>(std::lround(turn / (2 * pi)));
            return;
        }
    }

    int p_, q_;
    Vec3 corner_;
    std::vector<Control> points_;
    Real rounded_ = 0;
    mutable bool hopeless_ = false;
};

}  // namespace crescente::geometry::test
