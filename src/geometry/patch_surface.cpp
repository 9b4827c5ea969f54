// The surface of a leaf at given parameters, and the parameters of a point on it.
#include <algorithm>
#include <array>
#include <cmath>

#include "geometry/patch_kernel.h"
#include "geometry/patch_leaves.h"

namespace crescente::geometry {
namespace {

// Values of a function of (u, v) and its derivatives.
template <class V>
struct Jet {
    V at{}, u{}, v{}, uu{}, uv{}, vv{};
};

// Position and first derivatives, by the leaf's own parameters from 0 to 1.
struct Tangents {
    Vec3 at, u, v;
};

template <class D>
Tangents tangents_at(D degrees, const LeafPoints& points, double s, double t) {
    double bu[D::room_u], su[D::room_u], bv[D::room_v], sv[D::room_v];
    bernstein(degrees.u, s, bu, su);
    bernstein(degrees.v, t, bv, sv);
    const auto of = [&](const double* values) { return evaluate(degrees, values, bu, su, bv, sv); };
    const auto x = of(points.x), y = of(points.y), z = of(points.z);
    Tangents result{{x.value, y.value, z.value}, {x.u, y.u, z.u}, {x.v, y.v, z.v}};
    if (!points.w) return result;
    const auto w = of(points.w);
    const double inverse = 1 / w.value;
    result.at *= inverse;
    result.u = (result.u - result.at * w.u) * inverse, result.v = (result.v - result.at * w.v) * inverse;
    return result;
}

// B_i(s) and their first two derivatives.
struct Basis {
    std::array<double, max_patch_degree + 1> value, slope, bend;

    Basis(int degree, double s) {
        bernstein(degree, s, value.data(), slope.data());
        bend.fill(0);
        if (degree < 2) return;
        std::array<double, max_patch_degree + 1> lower, lower_slope;
        bernstein(degree - 1, s, lower.data(), lower_slope.data());
        for (int i = 0; i <= degree; ++i) bend[i] = degree * ((i > 0 ? lower_slope[i - 1] : 0) - (i < degree ? lower_slope[i] : 0));
    }
};

template <class V, class At>
Jet<V> jet_of(int p, int q, const Basis& u, const Basis& v, const At& at) {
    Jet<V> sum;
    for (int i = 0; i <= p; ++i) {
        V row{}, slope{}, bend{};
        for (int j = 0; j <= q; ++j) {
            const V c = at(i * (q + 1) + j);
            row += c * v.value[j], slope += c * v.slope[j], bend += c * v.bend[j];
        }
        sum.at += row * u.value[i], sum.u += row * u.slope[i], sum.uu += row * u.bend[i];
        sum.v += slope * u.value[i], sum.uv += slope * u.slope[i];
        sum.vv += bend * u.value[i];
    }
    return sum;
}

// By the quotient rule: S = W / w.
Jet<Vec3> divided(const Jet<Vec3>& top, const Jet<double>& w) {
    Jet<Vec3> s;
    const double inverse = 1 / w.at;
    s.at = top.at * inverse;
    s.u = (top.u - s.at * w.u) * inverse, s.v = (top.v - s.at * w.v) * inverse;
    s.uu = (top.uu - s.u * (2 * w.u) - s.at * w.uu) * inverse, s.vv = (top.vv - s.v * (2 * w.v) - s.at * w.vv) * inverse;
    s.uv = (top.uv - s.u * w.v - s.v * w.u - s.at * w.uv) * inverse;
    return s;
}

Jet<Vec3> jet_at(const LeafPoints& points, int p, int q, double u, double v) {
    const Basis bu(p, u), bv(q, v);
    const auto top = jet_of<Vec3>(p, q, bu, bv, [&](int k) { return Vec3{points.x[k], points.y[k], points.z[k]}; });
    if (!points.w) return top;
    return divided(top, jet_of<double>(p, q, bu, bv, [&](int k) { return points.w[k]; }));
}

}  // namespace

PatchPoint PatchLeaves::at(std::uint32_t index, double u, double v) const {
    const Leaf& leaf = leaves_[index];
    const std::size_t count = static_cast<std::size_t>(leaf.degree_u + 1) * (leaf.degree_v + 1);
    const double* x = points(leaf);
    const LeafPoints control{x, x + count, x + 2 * count, leaf.rational ? x + 3 * count : nullptr};
    const double size_u = leaf.u1 - leaf.u0, size_v = leaf.v1 - leaf.v0;
    const double s = (u - leaf.u0) / size_u, t = (v - leaf.v0) / size_v;
    const Tangents tangents =
        visit_degrees(leaf.kernel, leaf.degree_u, leaf.degree_v, [&](auto degrees) { return tangents_at(degrees, control, s, t); });
    PatchPoint point;
    point.position = leaf.center + tangents.at;
    point.along_u = tangents.u / size_u, point.along_v = tangents.v / size_v;

    // Unit normals: S_u x S_v divided by what it would be were the two perpendicular. Where one of the two vanishes the limit, from inside
    // the leaf, has its derivative instead.
    constexpr double degenerate = 1e-7;
    const double turn = size_u * size_v < 0 ? -1 : 1;
    {
        constexpr double regular = 1e-3;
        const Vec3 across = cross(tangents.u, tangents.v);
        const double uu = dot(tangents.u, tangents.u), vv = dot(tangents.v, tangents.v), size = dot(across, across);
        if (size > regular * regular * uu * vv && uu > regular * regular * vv && vv > regular * regular * uu && size > 1e-280) {
            point.normal = across * (turn / std::sqrt(size));
            return point;
        }
    }
    const Jet<Vec3> jet = jet_at(control, leaf.degree_u, leaf.degree_v, s, t);
    const double long_u = length(jet.u), long_v = length(jet.v);
    const double bend_u = length(jet.uu) + length(jet.uv), bend_v = length(jet.vv) + length(jet.uv);
    Vec3 normal = cross(jet.u, jet.v);
    double whole = long_u * long_v;
    if (long_u <= degenerate * (long_v + bend_u) && long_v > degenerate * (long_u + bend_v)) {
        // S_u(u, v + h) = S_u + h S_uv, towards the leaf's middle.
        const Vec3 limit = jet.uv * (t > 0.5 ? -1.0 : 1.0);
        normal = cross(limit, jet.v), whole = length(limit) * long_v;
    } else if (long_v <= degenerate * (long_u + bend_v) && long_u > degenerate * (long_v + bend_u)) {
        const Vec3 limit = jet.uv * (s > 0.5 ? -1.0 : 1.0);
        normal = cross(jet.u, limit), whole = length(limit) * long_u;
    }
    // Still none, as where both vanish or are parallel: from nearer to the middle.
    for (double step = 1e-6; !(length(normal) > degenerate * whole); step *= 10) {
        if (step > 0.5) {
            normal = leaf.normal * turn, whole = 0;
            if (!(dot(normal, normal) > 0)) normal = {0, 0, 1};
            break;
        }
        const Jet<Vec3> near = jet_at(control, leaf.degree_u, leaf.degree_v, s + (0.5 - s) * step, t + (0.5 - t) * step);
        normal = cross(near.u, near.v), whole = length(near.u) * length(near.v);
    }
    point.normal = normalize(normal / max_component(abs(normal))) * turn;
    return point;
}

bool PatchLeaves::surely_farther(std::uint32_t index, Vec3 position, double distance) const {
    const Leaf& leaf = leaves_[index];
    const int p = leaf.degree_u, q = leaf.degree_v, columns = q + 1, last = p * columns;
    const std::size_t count = static_cast<std::size_t>(p + 1) * columns;
    const double* x = points(leaf);
    const auto point = [&](std::size_t k) { return Vec3{x[k], x[count + k], x[2 * count + k]} / (leaf.rational ? x[3 * count + k] : 1); };
    const Vec3 off = position - leaf.center;
    const Vec3 a = point(0), b = point(static_cast<std::size_t>(q)), c = point(static_cast<std::size_t>(last)), d = point(static_cast<std::size_t>(last + q));
    // Along the normal, and across the four sides.
    for (const Vec3 axis : {leaf.normal, cross(leaf.normal, b - a), cross(leaf.normal, d - c), cross(leaf.normal, c - a), cross(leaf.normal, d - b)}) {
        const double size = length(axis), at = dot(axis, off);
        if (!(size > 0)) continue;
        double low = HUGE_VAL, high = -HUGE_VAL;
        for (std::size_t k = 0; k < count; ++k) {
            const double reach = dot(axis, point(k));
            low = std::min(low, reach), high = std::max(high, reach);
        }
        if (std::max(low - at, at - high) > size * (distance + 2 * error(index)) + 1e-6 * (high - low)) return true;
    }
    return false;
}

PatchRoot PatchLeaves::locate(std::uint32_t index, Vec3 position) const {
    const Leaf& leaf = leaves_[index];
    // Newton's method on the leaf seen along its mean normal, where it is nearly a plane; sure to be right if it comes to rest on the point.
    const std::size_t count = static_cast<std::size_t>(leaf.degree_u + 1) * (leaf.degree_v + 1);
    const double* x = points(leaf);
    const LeafPoints control{x, x + count, x + 2 * count, leaf.rational ? x + 3 * count : nullptr};
    const double size_u = leaf.u1 - leaf.u0, size_v = leaf.v1 - leaf.v0;
    const Vec3 target = position - leaf.center;
    const double close = 16 * error(index);
    double s = 0.5, t = 0.5;
    bool beside = false;
    const auto nearest_from_here = [&] {
        for (int step = 0; step < 20; ++step) {
            const Tangents jet = visit_degrees(leaf.kernel, leaf.degree_u, leaf.degree_v, [&](auto degrees) { return tangents_at(degrees, control, s, t); });
            const Vec3 off = target - jet.at;
            const double damp = 1e-9, uu = dot(jet.u, jet.u) * (1 + damp) + 1e-300, uv = dot(jet.u, jet.v), vv = dot(jet.v, jet.v) * (1 + damp) + 1e-300;
            const double ou = dot(off, jet.u), ov = dot(off, jet.v), det = uu * vv - uv * uv;
            const double ds = (vv * ou - uv * ov) / det, dt = (uu * ov - uv * ou) / det;
            if (!std::isfinite(ds) || !std::isfinite(dt)) break;
            const double last_s = s, last_t = t;
            s = std::clamp(s + ds, 0.0, 1.0), t = std::clamp(t + dt, 0.0, 1.0);
            if (s != last_s + ds || t != last_t + dt) {  // at the border: the nearest in the tangent plane by one parameter after the other
                for (int sweep = 0; sweep < 4; ++sweep) {
                    t = std::clamp(last_t + (ov - uv * (s - last_s)) / vv, 0.0, 1.0);
                    s = std::clamp(last_s + (ou - uv * (t - last_t)) / uu, 0.0, 1.0);
                }
            }
            if (s == last_s && t == last_t) break;
        }
        const Tangents at = visit_degrees(leaf.kernel, leaf.degree_u, leaf.degree_v, [&](auto degrees) { return tangents_at(degrees, control, s, t); });
        return PatchRoot{dot(target - at.at, leaf.normal), leaf.u0 + s * size_u, leaf.v0 + t * size_v};
    };
    for (int step = 0; step < 12; ++step) {
        const Tangents jet =
            visit_degrees(leaf.kernel, leaf.degree_u, leaf.degree_v, [&](auto degrees) { return tangents_at(degrees, control, s, t); });
        const Vec3 off = target - jet.at;
        // Least squares in the tangent plane.
        const double uu = dot(jet.u, jet.u), uv = dot(jet.u, jet.v), vv = dot(jet.v, jet.v), ou = dot(off, jet.u), ov = dot(off, jet.v);
        const double det = uu * vv - uv * uv;
        if (!(det > 1e-12 * uu * vv)) break;
        const double ds = (vv * ou - uv * ov) / det, dt = (uu * ov - uv * ou) / det;
        const double last_s = s, last_t = t;
        s = std::min(std::max(s + ds, -1e-3), 1 + 1e-3), t = std::min(std::max(t + dt, -1e-3), 1 + 1e-3);
        if (std::abs(ds) + std::abs(dt) > 1e-9) {
            // At rest at the border, no farther than a few times the leaf's length, which bands may be: beside it.
            beside = std::abs(s - last_s) + std::abs(t - last_t) <= 1e-9 && length(off) <= 16 * (std::sqrt(uu) + std::sqrt(vv));
            if (beside) break;
            continue;
        }
        if (length(off) > close + 1e-6 * (std::abs(ds) * std::sqrt(uu) + std::abs(dt) * std::sqrt(vv))) break;
        return {dot(off, leaf.normal), leaf.u0 + s * size_u, leaf.v0 + t * size_v};
    }
    if (beside) return nearest_from_here();
    // The certified way.
    std::array<PatchRoot, 8> found;
    const Vec3 along = dot(leaf.normal, leaf.normal) > 0 ? leaf.normal : Vec3{0, 0, 1};
    const int roots_found = roots(index, {position, along, -HUGE_VAL, HUGE_VAL}, found);
    PatchRoot best{HUGE_VAL, 0, 0};
    for (int i = 0; i < roots_found; ++i) {
        if (std::abs(found[i].t) < std::abs(best.t)) best = found[i];
    }
    if (roots_found > 0) return best;
    // Off the leaf by a little: the nearest of a grid, refined as above.
    double least = HUGE_VAL;
    for (int i = 0; i <= 8; ++i) {
        for (int j = 0; j <= 8; ++j) {
            const Vec3 off = target - jet_at(control, leaf.degree_u, leaf.degree_v, i / 8.0, j / 8.0).at;
            if (dot(off, off) < least) least = dot(off, off), s = i / 8.0, t = j / 8.0;
        }
    }
    return nearest_from_here();
}

SurfacePoint PatchLeaves::surface(std::uint32_t leaf, Vec3 position) const {
    const PatchRoot place = locate(leaf, position);
    const PatchPoint on = at(leaf, place.u, place.v);
    SurfacePoint point;
    point.position = on.position;
    point.normal = point.shading_normal = on.normal;
    point.error = error(leaf);
    point.u = place.u, point.v = place.v;
    return point;
}

}  // namespace crescente::geometry
