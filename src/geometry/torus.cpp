#include "geometry/torus.h"

#include "geometry/revolved.h"
#include "math/bracketed_root.h"
#include "math/exact.h"

namespace crescente::geometry {
namespace {

// How far inside (negative) or outside the tube the point origin + s direction is:
//
//     g(s) = (rho - R)^2 + y^2 - r^2,     rho = distance from the axis
//
// Unlike the usual quartic, which is g times its mirror image, g keeps its precision for thin tubes, and where it bends is known in
// closed form: with c = x dz - z dx, rho'' = c^2 / rho^3, so that g'' = 2 |d|^2 - 2 R c^2 / rho^3 is negative exactly where
// rho^3 < R c^2 / |d|^2: in one interval about the point of the line nearest to the axis. In the three intervals so made g is
// convex, concave and convex, and the signs at the ends and at one extremum enclose every root.
struct Tube {
    Vec3 origin, direction;
    double major, minor;

    double value(double s) const {
        const Vec3 p = at(s);
        const double across = axis_distance(p) - major;
        return difference_of_squares(std::sqrt(across * across + p.y * p.y));
    }
    ValueAndSlope value_and_slope(double s) const {
        const Vec3 p = at(s);
        const double rho = axis_distance(p), across = rho - major;
        const double rho_slope = rho > 0 ? (p.x * direction.x + p.z * direction.z) / rho : 0;
        return {difference_of_squares(std::sqrt(across * across + p.y * p.y)), 2 * (across * rho_slope + p.y * direction.y)};
    }
    double slope(double s, double rho_slope) const {
        return 2 * (dot(origin, direction) + s * dot(direction, direction) - major * rho_slope);
    }
    ValueAndSlope slope_and_bend(double s, double area2) const {
        const Vec3 p = at(s);
        const double rho = axis_distance(p);
        const double rho_slope = rho > 0 ? (p.x * direction.x + p.z * direction.z) / rho : 0;
        return {slope(s, rho_slope), 2 * dot(direction, direction) - 2 * major * area2 / (rho * rho * rho)};
    }

private:
    Vec3 at(double s) const {
        return {std::fma(direction.x, s, origin.x), std::fma(direction.y, s, origin.y), std::fma(direction.z, s, origin.z)};
    }
    double difference_of_squares(double distance) const { return (distance - minor) * (distance + minor); }
};

// The roots in ascending order. Two that rounding made equal are a touch, or two solids that meet: neither is a crossing.
struct Roots {
    double t[6];
    int count = 0;

    // False if it cancelled the root before.
    bool add(double root) {
        if (count > 0 && t[count - 1] >= root) {
            --count;
            return false;
        }
        t[count++] = root;
        return true;
    }
};

}  // namespace

Bounds Torus::bounds() const {
    const double outer = major_radius + minor_radius;
    return {{-outer, -minor_radius, -outer}, {outer, minor_radius, outer}};
}

int torus_crossings(const Ray& ray, double major_radius, double minor_radius, double* found, int most) {
    // The flat cylinder about the torus, a little larger, so that g is positive at both ends whatever the rounding.
    constexpr double margin = 1 + 1e-9;
    const double outer = (major_radius + minor_radius) * margin, half_height = minor_radius * margin;
    const Stretch within = slab(ray.origin.y, ray.direction.y, -half_height, half_height);
    if (!(within.enter < within.leave)) return 0;
    const double shift = nearest_to_axis(ray, within);
    const Tube tube{exact_at(ray, shift), ray.direction, major_radius, minor_radius};
    Stretch reach = inside_cone(tube.origin, tube.direction, outer, 0);
    reach.clip(slab(tube.origin.y, tube.direction.y, -half_height, half_height));
    if (!(reach.enter < reach.leave && reach.enter > -infinity && reach.leave < infinity)) return 0;
    if (shift + reach.leave <= ray.t_min || shift + reach.enter > ray.t_max) return 0;

    // Where g turns from convex to concave and back.
    const Vec3 d = ray.direction;
    const double d2 = dot(d, d), across2 = d.x * d.x + d.z * d.z;
    const double area = difference_of_products(tube.origin.x, d.z, tube.origin.z, d.x), area2 = area * area;
    const double rho_bend = std::cbrt(major_radius * area2 / d2), rho_least2 = area2 / across2;
    const double nearest = -(tube.origin.x * d.x + tube.origin.z * d.z) / across2;
    const double half_width = std::sqrt(std::max(rho_bend * rho_bend - rho_least2, 0.0) / across2);
    const bool bends = major_radius > 0 && across2 > 0 && (half_width > 0 || area == 0);
    // The slope of rho where g bends. It is taken from the closed form, since near the axis (area -> 0: a kink) rounding hides it.
    const double rho_slope = area == 0 ? std::sqrt(across2) : across2 * half_width / rho_bend;

    // These return whether the wanted roots in reach are known, so that those behind them need not be refined.
    Roots roots;
    int wanted = most;
    const auto root_between = [&](double low, double high, bool negative_at_low, double start) {
        if (shift + high <= ray.t_min) return false;
        const double t = shift + bracketed_root([&](double s) { return tube.value_and_slope(s); }, low, high, negative_at_low, start);
        return roots.add(t) && in_reach(t, ray) && t < shift + high && --wanted == 0;
    };
    // The roots of one interval, where g bends one way. The slopes of g at its ends come from the caller. Newton's method starts from
    // the ends, where it comes near the root from one side.
    const auto search = [&](double low, double high, double value_low, double value_high, double slope_low, double slope_high,
                            bool convex) {
        const bool negative_low = value_low < 0, negative_high = value_high < 0;
        const double after_low = low - value_low / slope_low, before_high = high - value_high / slope_high;
        if (negative_low != negative_high) {
            return root_between(low, high, negative_low, negative_low == convex ? before_high : after_low);
        }
        // Both ends on the side away from which g bends: none, or two about the extremum.
        if (negative_low == convex || (slope_low < 0) == (slope_high < 0) || (slope_low < 0) != convex) return false;
        if (!(after_low <= before_high)) return false;  // g stays beyond its tangents at the ends, which meet on this side
        double middle = 0;
        bool crossed = false;
        const auto slope = [&](double s) -> ValueAndSlope {
            middle = s;
            crossed = (tube.value(s) < 0) != negative_low;
            if (crossed) return {0, 0};  // far enough: any point beyond the roots separates them
            return tube.slope_and_bend(s, area2);
        };
        bracketed_root(slope, low, high, slope_low < 0, low + (high - low) * (slope_low / (slope_low - slope_high)));
        if (!crossed) return false;
        return root_between(low, middle, negative_low, after_low) || root_between(middle, high, !negative_low, before_high);
    };

    const double low = reach.enter, high = reach.leave;
    const ValueAndSlope at_low = tube.value_and_slope(low), at_high = tube.value_and_slope(high);
    const double bend_low = nearest - half_width, bend_high = nearest + half_width;
    const auto search_all = [&] {
        if (!bends || bend_low >= high || bend_high <= low) {
            return search(low, high, at_low.value, at_high.value, at_low.slope, at_high.slope, true);
        }
        double from = low, value = at_low.value, slope = at_low.slope;
        if (bend_low > low) {
            const double v = tube.value(bend_low), falling = tube.slope(bend_low, -rho_slope);
            if (search(from, bend_low, value, v, slope, falling, true)) return true;
            from = bend_low, value = v, slope = falling;
        }
        if (bend_high >= high) return search(from, high, value, at_high.value, slope, at_high.slope, false);
        const double v = tube.value(bend_high), rising = tube.slope(bend_high, rho_slope);
        if (bend_high > from && search(from, bend_high, value, v, slope, rising, false)) return true;
        return search(bend_high, high, v, at_high.value, rising, at_high.slope, true);
    };
    search_all();

    int count = 0;
    for (int i = 0; i < roots.count && count < most; ++i) {
        if (in_reach(roots.t[i], ray)) found[count++] = roots.t[i];
    }
    return count;
}

std::optional<ShapeHit> Torus::intersect(std::uint32_t, const Ray& ray) const {
    double t;
    if (torus_crossings(ray, major_radius, minor_radius, &t, 1) == 0) return std::nullopt;
    return ShapeHit{t, 0};
}

// u: turn about the y axis; v: turn about the tube, from the outermost circle upwards.
SurfacePoint Torus::surface(std::uint32_t, Vec3 position) const {
    SurfacePoint point;
    const Vec3 away = away_from_axis(position);
    const double across = axis_distance(position) - major_radius;
    const double distance = std::sqrt(across * across + position.y * position.y);
    const double c = distance > 0 ? across / distance : 1, s = distance > 0 ? position.y / distance : 0;
    point.normal = point.shading_normal = {away.x * c, s, away.z * c};
    const double radius = std::max(major_radius + minor_radius * c, 0.0);
    point.position = {away.x * radius, minor_radius * s, away.z * radius};
    point.error = 8 * std::numeric_limits<double>::epsilon() * (major_radius + minor_radius);
    point.u = azimuth(position);
    const double turn = std::atan2(s, c) / (2 * pi);
    point.v = turn < 0 ? turn + 1 : turn + 0.0;
    return point;
}

const FieldTable<Torus>& Torus::fields() {
    static const FieldTable<Torus> table{
        field(&Torus::major_radius, {"major_radius", FieldType::number, "m", 0, unbounded, "From the y axis to the middle of the tube"}),
        field(&Torus::minor_radius, {"minor_radius", FieldType::number, "m", 0, unbounded,
              "Radius of the tube; the outer surface alone is seen where it exceeds the major radius"}),
    };
    return table;
}

}  // namespace crescente::geometry
