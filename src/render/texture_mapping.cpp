#include "render/texture_mapping.h"

#include <algorithm>
#include <cmath>

#include "geometry/triangle.h"

namespace crescente::render {
namespace {

using accel::Instance;
using geometry::Mesh;
using scene::Texture;
using scene::TextureProjection;

struct Uv {
    double u = 0, v = 0;
};
constexpr Uv operator+(Uv a, Uv b) { return {a.u + b.u, a.v + b.v}; }
constexpr Uv operator-(Uv a, Uv b) { return {a.u - b.u, a.v - b.v}; }
constexpr Uv operator*(Uv a, double s) { return {a.u * s, a.v * s}; }

// Coordinates and how they change over the axes of the footprint.
struct Coordinates {
    Uv at, axes[2];
};

Vec3 unit_or_zero(Vec3 v) {
    const double l = length(v);
    return l > 0 && std::isfinite(l) ? v / l : Vec3{};
}

// Where the point lies in its triangle, and how that changes along vectors of the shape's space.
class Barycentric {
public:
    Barycentric(const Mesh& mesh, std::uint32_t triangle, Vec3 position) : corners_(mesh.triangles[triangle]) {
        const Vec3 p = mesh.positions[corners_[0]];
        e_ = mesh.positions[corners_[1]] - p, f_ = mesh.positions[corners_[2]] - p;
        const auto at = geometry::triangle_surface(geometry::point3(p), geometry::point3(p + e_), geometry::point3(p + f_), geometry::point3(position));
        u_ = at.u, v_ = at.v;
    }

    // Of an attribute that every vertex has.
    template <std::size_t n>
    std::array<double, n> mean(const std::vector<std::array<float, n>>& of) const {
        std::array<double, n> sum;
        for (std::size_t i = 0; i < n; ++i) sum[i] = (1 - u_ - v_) * of[corners_[0]][i] + u_ * of[corners_[1]][i] + v_ * of[corners_[2]][i];
        return sum;
    }
    Uv along(const std::vector<std::array<float, 2>>& of, Vec3 way) const {
        const double ee = dot(e_, e_), ef = dot(e_, f_), ff = dot(f_, f_), area2 = ee * ff - ef * ef;
        const double a = (dot(e_, way) * ff - dot(f_, way) * ef) / area2, b = (dot(f_, way) * ee - dot(e_, way) * ef) / area2;
        const auto &p = of[corners_[0]], &q = of[corners_[1]], &r = of[corners_[2]];
        return {a * (double{q[0]} - p[0]) + b * (double{r[0]} - p[0]), a * (double{q[1]} - p[1]) + b * (double{r[1]} - p[1])};
    }

private:
    const std::array<std::uint32_t, 3>& corners_;
    Vec3 e_, f_;
    double u_, v_;
};

// Parameters of a shape that is no mesh, of which v runs up, while textures count it down the picture. They change from place to place as the shape's own routine finds them.
Coordinates parameters(const Instance& instance, const TexturePoint& point, const Footprint& print) {
    const auto at = [&](Vec3 world) {
        const geometry::SurfacePoint surface = geometry::surface(*instance.shape, point.primitive, instance.to_local.point(world));
        return Uv{surface.u, 1 - surface.v};
    };
    Coordinates result;
    result.at = at(point.position);
    constexpr double step = 1.0 / 64;  // of the footprint: little enough for curved surfaces, more than rounding
    for (int i = 0; i < 2; ++i) {
        const Vec3 way = (i == 0 ? print.major : print.minor) * step;
        const Uv ahead = at(point.position + way) - result.at, behind = result.at - at(point.position - way);
        // Across a seam one of the two jumps.
        result.axes[i] = Uv{std::abs(ahead.u) < std::abs(behind.u) ? ahead.u : behind.u, std::abs(ahead.v) < std::abs(behind.v) ? ahead.v : behind.v} * (1 / step);
    }
    return result;
}

// The shape's space in metres, its box about the origin.
struct MetricSpace {
    Vec3 at, normal, axes[2];
    Vec3 half;   // of the box; 0 where it has no end

    MetricSpace(const TexturePoint& point, const Footprint& print) {
        const Instance& instance = *point.instance;
        const Affine& out = instance.to_world;
        const Vec3 scale{length(out.x), length(out.y), length(out.z)};
        const auto scaled = [&](Vec3 v) { return Vec3{v.x * scale.x, v.y * scale.y, v.z * scale.z}; };
        const Bounds& box = *point.box;
        const Vec3 center = box.bounded() ? (box.lower + box.upper) * 0.5 : Vec3{};
        half = box.bounded() ? scaled(box.upper - box.lower) * 0.5 : Vec3{};
        at = scaled(instance.to_local.point(point.position) - center);
        axes[0] = scaled(instance.to_local.vector(print.major)), axes[1] = scaled(instance.to_local.vector(print.minor));
        const Vec3 n = out.transposed(point.inside ? -point.geometric : point.geometric);
        normal = normalize(Vec3{n.x / scale.x, n.y / scale.y, n.z / scale.z});
    }
};

// Seen from the tip of the axis: to the right, and up in the picture. The y axis is up where it can be.
struct View {
    Vec3 right, up;
};
View view_along(Vec3 axis) {
    const Vec3 across = cross(Vec3{0, 1, 0}, axis);
    const Vec3 right = length(across) > 1e-6 ? normalize(across) : Vec3{1, 0, 0};
    return {right, cross(axis, right)};
}

Coordinates flat(const MetricSpace& space, const View& view, double size) {
    const auto project = [&](Vec3 v) { return Uv{dot(v, view.right) / size, -dot(v, view.up) / size}; };
    return {project(space.at), {project(space.axes[0]), project(space.axes[1])}};
}

// Around an axis. u makes whole repeats of about `size` around the shape, so that it closes; v is the height along the axis, or on a sphere the arc from the pole.
Coordinates around(const MetricSpace& space, Vec3 axis, double size, bool spherical) {
    const View view = view_along(axis);
    const auto reach = [&](Vec3 way) { return std::abs(way.x) * space.half.x + std::abs(way.y) * space.half.y + std::abs(way.z) * space.half.z; };
    const double radius = std::max(reach(view.right), reach(view.up));
    const double repeats = std::max(1.0, std::round(2 * pi * radius / size));
    const auto project = [&](Vec3 p) {
        const double x = dot(p, view.right), y = dot(p, view.up), h = dot(p, axis);
        const double turn = std::atan2(y, x) / (2 * pi);
        return Uv{turn * repeats, spherical ? std::atan2(std::sqrt(x * x + y * y), h) * radius / size : -h / size};
    };
    Coordinates result{project(space.at), {}};
    constexpr double step = 1.0 / 64;
    for (int i = 0; i < 2; ++i) {
        const Uv change = project(space.at + space.axes[i] * step) - project(space.at - space.axes[i] * step);
        result.axes[i] = Uv{std::remainder(change.u, repeats), change.v} * (0.5 / step);
    }
    return result;
}

// KHR_texture_transform.
Uv transformed(const Texture& t, Uv way) {
    const double u = way.u * t.scale_u, v = way.v * t.scale_v;
    if (t.rotation == 0) return {u, v};
    const double c = std::cos(t.rotation), s = std::sin(t.rotation);
    return {c * u + s * v, c * v - s * u};
}

// Where u grows and v falls on the surface, from how the two change along the footprint's axes.
void find_directions(TexturePlace& place, const Footprint& print) {
    const double a = length(print.major), b = length(print.minor);
    const Vec3 major = print.major / a, minor = print.minor / b;
    const double ua = place.axes[0].x / a, va = place.axes[0].y / a, ub = place.axes[1].x / b, vb = place.axes[1].y / b;
    const double sign = ua * vb - ub * va < 0 ? -1 : 1;
    place.right = unit_or_zero((major * vb - minor * va) * sign);
    place.up = unit_or_zero((major * ub - minor * ua) * sign);
}

TexturePlace place_at(const Texture& texture, const Coordinates& c, const Footprint& print) {
    TexturePlace place;
    const Uv at = transformed(texture, c.at) + Uv{texture.offset_u, texture.offset_v};
    place.at = {at.u, at.v, 0.5};
    for (int i = 0; i < 2; ++i) {
        const Uv axis = transformed(texture, c.axes[i]);
        place.axes[i] = {axis.u, axis.v, 0};
    }
    find_directions(place, print);
    return place;
}

// The tangents that the vertices have, where u and v are not turned.
void take_tangent(const Mesh& mesh, const Barycentric& in, const TexturePoint& point, TexturePlace& place) {
    const std::array<double, 4> t = in.mean(mesh.tangents);
    const Instance& instance = *point.instance;
    const Vec3 normal = geometry::surface(*instance.shape, point.primitive, instance.to_local.point(point.position)).shading_normal;
    const Vec3 right{t[0], t[1], t[2]};
    place.right = unit_or_zero(instance.to_world.vector(right));
    place.up = unit_or_zero(instance.to_world.vector(cross(normal, right) * (t[3] < 0 ? -1.0 : 1.0)));
}

TexturePlaces places_on_surface(const Texture& texture, const TexturePoint& point, const Footprint& print) {
    TexturePlaces places;
    const Instance& instance = *point.instance;
    const auto* mesh = std::get_if<Mesh>(instance.shape);
    if (!mesh) {
        places.place[0] = place_at(texture, parameters(instance, point, print), print);
        return places;
    }
    const auto& coordinates = mesh->coordinates[static_cast<std::size_t>(texture.set)];
    if (coordinates.empty()) {  // all of it is one place of the texture
        places.place[0] = place_at(texture, {}, print);
        return places;
    }
    const Barycentric in(*mesh, point.primitive, instance.to_local.point(point.position));
    const std::array<double, 2> at = in.mean(coordinates);
    const auto along = [&](Vec3 way) { return in.along(coordinates, instance.to_local.vector(way)); };
    places.place[0] = place_at(texture, {{at[0], at[1]}, {along(print.major), along(print.minor)}}, print);
    if (!mesh->tangents.empty() && texture.set == 0 && texture.rotation == 0 && texture.scale_u > 0 && texture.scale_v > 0) take_tangent(*mesh, in, point, places.place[0]);
    return places;
}

TexturePlaces places_on_box(const Texture& texture, const MetricSpace& space, const Footprint& print) {
    TexturePlaces places;
    places.count = 0;
    double sum = 0;
    const double least = (1 - texture.blend) * max_component(abs(space.normal));
    for (int i = 0; i < 3; ++i) {
        const double weight = std::abs(space.normal[i]) - least;
        if (!(weight > 0) && !(texture.blend == 0 && weight == 0 && places.count == 0)) continue;
        Vec3 axis;
        axis[i] = space.normal[i] < 0 ? -1 : 1;
        TexturePlace& place = places.place[static_cast<std::size_t>(places.count++)];
        place = place_at(texture, flat(space, view_along(axis), texture.size), print);
        place.weight = texture.blend == 0 ? 1 : weight;
        sum += place.weight;
    }
    for (int i = 0; i < places.count; ++i) places.place[static_cast<std::size_t>(i)].weight /= sum;
    return places;
}

}  // namespace

Footprint footprint(const TexturePoint& point) {
    constexpr double flattest = 1.0 / 64;
    const double cosine = dot(point.geometric, point.to_viewer);
    const Vec3 along = point.to_viewer - point.geometric * cosine;
    const Vec3 way = length(along) > 1e-9 ? normalize(along) : perpendicular(point.geometric);
    const double width = std::max(point.width, 1e-12);
    return {way * (width / std::max(cosine, flattest)), cross(point.geometric, way) * width};
}

TexturePlaces places_of(const Texture& texture, const TexturePoint& point) {
    const Footprint print = footprint(point);
    if (texture.projection == TextureProjection::uv) return places_on_surface(texture, point, print);
    const MetricSpace space(point, print);
    const Vec3 axis = normalize(texture.axis);
    TexturePlaces places;
    TexturePlace& place = places.place[0];
    switch (texture.projection) {
        case TextureProjection::uv: break;
        case TextureProjection::box: return places_on_box(texture, space, print);
        case TextureProjection::planar: place = place_at(texture, flat(space, view_along(axis), texture.size), print); break;
        case TextureProjection::cylindrical: place = place_at(texture, around(space, axis, texture.size, false), print); break;
        case TextureProjection::spherical: place = place_at(texture, around(space, axis, texture.size, true), print); break;
        case TextureProjection::solid:
            place.at = space.at / texture.size;
            place.axes[0] = space.axes[0] / texture.size, place.axes[1] = space.axes[1] / texture.size;
            break;
    }
    return places;
}

Vec3 shading_normal(const TexturePoint& point) {
    const Instance& instance = *point.instance;
    const Vec3 own = geometry::surface(*instance.shape, point.primitive, instance.to_local.point(point.position)).shading_normal;
    const Vec3 outward = normalize(instance.to_local.transposed(own));
    const Vec3 normal = dot(outward, point.geometric) * (point.inside ? -1 : 1) < 0 ? -outward : outward;
    const Vec3 towards = point.inside ? -normal : normal;
    const double facing = dot(towards, point.to_viewer);
    return facing < 1e-4 ? normalize(towards + point.to_viewer * (1e-4 - facing)) : towards;
}

bool same_places(const Texture& a, const Texture& b) {
    return a.projection == b.projection && a.set == b.set && a.size == b.size && a.axis == b.axis && a.blend == b.blend && a.offset_u == b.offset_u &&
           a.offset_v == b.offset_v && a.rotation == b.rotation && a.scale_u == b.scale_u && a.scale_v == b.scale_v;
}

}  // namespace crescente::render
