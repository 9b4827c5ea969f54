#include "geometry/analytic_surface.h"

#include <algorithm>
#include <cmath>

#include "geometry/convex.h"
#include "geometry/sphere.h"
#include "geometry/torus.h"
#include "math/arctangent.h"

namespace crescente::geometry {
namespace {

constexpr double eps = std::numeric_limits<double>::epsilon();

struct Interval {
    double low, high;
};

// The range of a cos x + b sin x for x in [from, to].
Interval wave(double a, double b, double from, double to) {
    const double f = a * std::cos(from) + b * std::sin(from), g = a * std::cos(to) + b * std::sin(to), amplitude = std::hypot(a, b);
    Interval range{std::min(f, g), std::max(f, g)};
    const double crest = std::atan2(b, a);
    const auto passes = [&](double x) { return x + 2 * pi * std::ceil((from - x) / (2 * pi)) <= to; };
    if (passes(crest)) range.high = amplitude;
    if (passes(crest + pi)) range.low = -amplitude;
    return range;
}

// The least of |c + cos| or the like over an interval: 0 if it changes sign there.
double least_size(Interval range) { return range.low <= 0 && range.high >= 0 ? 0 : std::min(std::abs(range.low), std::abs(range.high)); }

double rho_of(Vec3 local) { return std::sqrt(local.x * local.x + local.y * local.y); }

}  // namespace

Expected<AnalyticSurface> AnalyticSurface::make(const FaceSurface& surface) {
    AnalyticSurface s;
    std::string wrong;
    std::visit([&](const auto& plain) {
        using Surface = std::remove_cvref_t<decltype(plain)>;
        if constexpr (std::is_same_v<Surface, PatchSurface>) {
            wrong = "patches where an analytic surface was expected";
        } else {
            s.frame_ = plain.frame;
            if constexpr (std::is_same_v<Surface, PlaneSurface>) {
                s.kind_ = Kind::plane;
            } else if constexpr (std::is_same_v<Surface, ConeSurface>) {
                s.kind_ = Kind::cone;
                s.radius_ = plain.radius, s.half_angle_ = plain.half_angle, s.sine_ = std::sin(plain.half_angle), s.cosine_ = std::cos(plain.half_angle);
                if (!(std::abs(plain.half_angle) < pi / 2 && s.cosine_ > 1e-9)) wrong = "a cone's half angle that is not less than a right one";
                if (!std::isfinite(s.radius_)) wrong = "a cone's radius that is not finite";
            } else if constexpr (std::is_same_v<Surface, TorusSurface>) {
                s.kind_ = Kind::torus;
                s.radius_ = plain.major, s.minor_ = plain.minor;
                if (!(s.radius_ >= 0 && s.radius_ < 1e30 && s.minor_ > 0 && s.minor_ < 1e30)) wrong = "a torus with radii that are not positive";
            } else {
                s.kind_ = std::is_same_v<Surface, CylinderSurface> ? Kind::cylinder : Kind::sphere;
                s.radius_ = plain.radius;
                if (!(s.radius_ > 0 && s.radius_ < 1e30)) wrong = "a radius that is not positive";
            }
        }
    }, surface);
    const Frame& f = s.frame_;
    const auto unit = [](Vec3 a) { return std::abs(dot(a, a) - 1) < 1e-7; };
    const auto square = [](Vec3 a, Vec3 b) { return std::abs(dot(a, b)) < 1e-7; };
    if (!is_finite(f.origin) || !unit(f.x) || !unit(f.y) || !unit(f.z) || !square(f.x, f.y) || !square(f.y, f.z) || !square(f.z, f.x)) {
        wrong = "a frame that is not orthonormal";
    }
    if (!wrong.empty()) return failure(ErrorKind::input, {"", "", wrong, ""});
    s.hand_ = dot(cross(f.x, f.y), f.z) > 0 ? 1 : -1;
    s.center_ = f.origin;
    return s;
}

FaceSurface AnalyticSurface::plain() const {
    switch (kind_) {
        case Kind::plane: return PlaneSurface{frame_};
        case Kind::cylinder: return CylinderSurface{frame_, radius_};
        case Kind::cone: return ConeSurface{frame_, radius_, half_angle_};
        case Kind::sphere: return SphereSurface{frame_, radius_};
        default: return TorusSurface{frame_, radius_, minor_};
    }
}

Point2 AnalyticSurface::period() const {
    return {kind_ == Kind::plane ? 0 : 2 * pi, kind_ == Kind::torus ? 2 * pi : 0};
}

int AnalyticSurface::meet(const Ray& ray, Meeting* found) const {
    const LocalLine<double> line = into_frame<double>({ray.origin.x, ray.origin.y, ray.origin.z}, {ray.direction.x, ray.direction.y, ray.direction.z});
    const double shift = line.shift;
    const Point3<double> &o = line.origin, &d = line.direction;
    double s[most_meetings];
    int roots = 0;
    switch (kind_) {
        case Kind::plane:
            s[0] = meet_plane(line);
            roots = 1;
            break;
        case Kind::cylinder:
        case Kind::cone: {
            const auto [first, second] = cone_roots(line, radius_, slope());
            s[0] = first, s[1] = second, roots = 2;
            break;
        }
        case Kind::sphere: {
            const auto [enter, leave] = inside_sphere<double>(radius_, o, d);
            if (enter < leave) s[0] = enter, s[1] = leave, roots = 2;
            break;
        }
        case Kind::torus: {  // about y there
            const Ray own{{o.y, o.z, o.x}, {d.y, d.z, d.x}, ray.t_min - shift, ray.t_max - shift};
            roots = torus_crossings(own, radius_, minor_, s, 4);
            if (minor_ > radius_) {
                roots += torus_crossings(own, -radius_, minor_, s + roots, 4);
                for (int i = 1; i < roots; ++i) {
                    for (int k = i; k > 0 && s[k] < s[k - 1]; --k) std::swap(s[k], s[k - 1]);
                }
            }
            break;
        }
    }
    int count = 0;
    for (int i = 0; i < roots; ++i) {
        const double t = shift + s[i];
        if (!in_reach(t, ray)) continue;
        found[count++] = {t, {std::fma(d.x, s[i], o.x), std::fma(d.y, s[i], o.y), std::fma(d.z, s[i], o.z)}};
    }
    return count;
}

Point2 AnalyticSurface::parameters(Vec3 p) const {
    switch (kind_) {
        case Kind::plane: return {p.x, p.y};
        case Kind::cylinder:
        case Kind::cone: {
            const auto [u, v] = unrolled(Point3<double>{p.x, p.y, p.z});
            return {u, v};
        }
        case Kind::sphere: return {arctangent2(p.y, p.x), arctangent2(p.z, rho_of(p))};
        default: {
            // Of a spindle's two sheets the one that is nearer.
            const double rho = rho_of(p), outer = std::hypot(rho - radius_, p.z), inner = std::hypot(rho + radius_, p.z);
            if (minor_ > radius_ && std::abs(inner - minor_) < std::abs(outer - minor_)) return {arctangent2(-p.y, -p.x), arctangent2(p.z, -rho - radius_)};
            return {arctangent2(p.y, p.x), arctangent2(p.z, rho - radius_)};
        }
    }
}

Metric AnalyticSurface::metric(Point2 p) const {
    const auto square = [](double x) { return x * x; };
    switch (kind_) {
        case Kind::plane: return {};
        case Kind::cylinder: return {square(radius_), 0, 1};
        case Kind::cone: return {square(radius_ + p.v * sine_), 0, 1};
        case Kind::sphere: return {square(radius_ * std::cos(p.v)), 0, square(radius_)};
        default: return {square(radius_ + minor_ * std::cos(p.v)), 0, square(minor_)};
    }
}

Vec3 AnalyticSurface::position(Point2 p) const {
    const Vec3 away = radial(p.u);
    switch (kind_) {
        case Kind::plane: return to_world({p.u, p.v, 0});
        case Kind::cylinder: return to_world({radius_ * away.x, radius_ * away.y, p.v});
        case Kind::cone: {
            const double rho = radius_ + p.v * sine_;
            return to_world({rho * away.x, rho * away.y, p.v * cosine_});
        }
        case Kind::sphere: {
            const double rho = radius_ * std::cos(p.v);
            return to_world({rho * away.x, rho * away.y, radius_ * std::sin(p.v)});
        }
        default: {
            const double rho = radius_ + minor_ * std::cos(p.v);
            return to_world({rho * away.x, rho * away.y, minor_ * std::sin(p.v)});
        }
    }
}

Vec3 AnalyticSurface::along_u(Point2 p) const {
    if (kind_ == Kind::plane) return frame_.x;
    const Vec3 turn = frame_.y * std::cos(p.u) - frame_.x * std::sin(p.u);
    switch (kind_) {
        case Kind::cylinder: return turn * radius_;
        case Kind::cone: return turn * (radius_ + p.v * sine_);
        case Kind::sphere: return turn * (radius_ * std::cos(p.v));
        default: return turn * (radius_ + minor_ * std::cos(p.v));
    }
}

Vec3 AnalyticSurface::along_v(Point2 p) const {
    const Vec3 away = frame_.x * std::cos(p.u) + frame_.y * std::sin(p.u);
    switch (kind_) {
        case Kind::plane: return frame_.y;
        case Kind::cylinder: return frame_.z;
        case Kind::cone: return away * sine_ + frame_.z * cosine_;
        case Kind::sphere: return (frame_.z * std::cos(p.v) - away * std::sin(p.v)) * radius_;
        default: return (frame_.z * std::cos(p.v) - away * std::sin(p.v)) * minor_;
    }
}

Vec3 AnalyticSurface::normal(Point2 p) const {
    const Vec3 away = frame_.x * std::cos(p.u) + frame_.y * std::sin(p.u);
    Vec3 n;
    switch (kind_) {
        case Kind::plane: n = frame_.z; break;
        case Kind::cylinder: n = away; break;
        case Kind::cone: n = (away * cosine_ - frame_.z * sine_) * (radius_ + p.v * sine_ < 0 ? -1.0 : 1.0); break;
        case Kind::sphere: n = away * std::cos(p.v) + frame_.z * std::sin(p.v); break;
        case Kind::torus: n = (away * std::cos(p.v) + frame_.z * std::sin(p.v)) * (radius_ + minor_ * std::cos(p.v) < 0 ? -1.0 : 1.0); break;
    }
    return normalize(n) * hand_;
}

SurfacePoint AnalyticSurface::nearest(Vec3 p) const {
    const Point2 uv = parameters(to_local(p));
    SurfacePoint point;
    // Without angles where that is as easy: their rounding would move the point by some units more.
    const Vec3 local = to_local(p);
    const double rho = rho_of(local);
    const Vec3 away = rho > 0 ? Vec3{local.x / rho, local.y / rho, 0} : Vec3{1, 0, 0};
    Vec3 near, n;
    switch (kind_) {
        case Kind::plane: near = {local.x, local.y, 0}, n = {0, 0, 1}; break;
        case Kind::cylinder: near = {away.x * radius_, away.y * radius_, local.z}, n = away; break;
        case Kind::cone: {
            const double signed_rho = radius_ + uv.v * sine_, sign = signed_rho < 0 ? -1 : 1;
            near = {away.x * std::abs(signed_rho), away.y * std::abs(signed_rho), uv.v * cosine_};
            n = Vec3{away.x * cosine_, away.y * cosine_, -sine_ * sign};
            break;
        }
        case Kind::sphere: {
            const double distance = length(local);
            n = distance > 0 ? local / distance : Vec3{0, 0, 1};
            near = n * radius_;
            break;
        }
        case Kind::torus: {
            const bool inner = radius_ + minor_ * std::cos(uv.v) < 0;
            const double across = inner ? -rho - radius_ : rho - radius_, distance = std::hypot(across, local.z);
            const double c = distance > 0 ? across / distance : 1, s = distance > 0 ? local.z / distance : 0, ring = std::abs(radius_ + minor_ * c);
            near = {away.x * ring, away.y * ring, minor_ * s};
            n = inner ? Vec3{away.x * c, away.y * c, -s} : Vec3{away.x * c, away.y * c, s};
            break;
        }
    }
    point.position = to_world(near);
    point.normal = normalize(frame_.x * n.x + frame_.y * n.y + frame_.z * n.z) * hand_;
    point.shading_normal = point.normal;
    point.u = uv.u, point.v = uv.v;
    return point;
}

double AnalyticSurface::side(Vec3 position) const {
    const SurfacePoint foot = nearest(position);
    return dot(position - foot.position, foot.normal);
}

Point2 AnalyticSurface::least_steps(const ParameterBox& box) const {
    switch (kind_) {
        case Kind::plane: return {1, 1};
        case Kind::cylinder: return {radius_, 1};
        case Kind::cone: {
            const double a = radius_ + box.v0 * sine_, b = radius_ + box.v1 * sine_;
            return {least_size({std::min(a, b), std::max(a, b)}), 1};
        }
        case Kind::sphere: return {radius_ * least_size(wave(1, 0, box.v0, box.v1)), radius_};
        default: {
            const Interval range = wave(minor_, 0, box.v0, box.v1);
            return {least_size({radius_ + range.low, radius_ + range.high}), minor_};
        }
    }
}

Bounds AnalyticSurface::bounds(const ParameterBox& box) const {
    Bounds result;
    for (int axis = 0; axis < 3; ++axis) {
        const double x = frame_.x[axis], y = frame_.y[axis], z = frame_.z[axis];
        Interval range{infinity, -infinity};
        const auto include = [&](double low, double high) { range = {std::min(range.low, low), std::max(range.high, high)}; };
        const Interval turn = wave(x, y, box.u0, box.u1);  // of the unit vector from the axis
        switch (kind_) {
            case Kind::plane:
                for (const double u : {box.u0, box.u1}) {
                    for (const double v : {box.v0, box.v1}) include(u * x + v * y, u * x + v * y);
                }
                break;
            case Kind::cylinder:
            case Kind::cone:
                for (const double v : {box.v0, box.v1}) {
                    const double rho = radius_ + v * sine_, a = rho * turn.low, b = rho * turn.high, height = v * cosine_ * z;
                    include(height + std::min(a, b), height + std::max(a, b));
                }
                break;
            case Kind::sphere:
            case Kind::torus: {
                const double major = kind_ == Kind::sphere ? 0 : radius_, minor = kind_ == Kind::sphere ? radius_ : minor_;
                for (const double a : {turn.low, turn.high}) {
                    const Interval tube = wave(minor * a, minor * z, box.v0, box.v1);
                    include(major * a + tube.low, major * a + tube.high);
                }
                break;
            }
        }
        result.lower[axis] = frame_.origin[axis] + range.low;
        result.upper[axis] = frame_.origin[axis] + range.high;
    }
    return result;
}

double AnalyticSurface::error(const Bounds& box) const {
    return 16 * eps * (box.largest_coordinate() + max_component(abs(frame_.origin)) + std::abs(radius_) + minor_);
}

}  // namespace crescente::geometry
