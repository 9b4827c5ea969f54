#include "geometry/cone.h"

#include "geometry/revolved.h"

namespace crescente::geometry {

Bounds Cone::bounds() const {
    const double radius = std::max(base_radius, top_radius);
    return {{-radius, 0, -radius}, {radius, height, radius}};
}

std::optional<ShapeHit> Cone::intersect(std::uint32_t, const Ray& ray) const {
    return frustum_hit(ray, base_radius, top_radius, height, capped);
}

// u: turn about the axis; v: way from base to top on the wall, distance from the axis on the caps, as shares of the whole.
SurfacePoint Cone::surface(std::uint32_t primitive, Vec3 position) const {
    return frustum_surface(primitive, position, base_radius, top_radius, height);
}

const FieldTable<Cone>& Cone::fields() {
    static const FieldTable<Cone> table{
        field(&Cone::base_radius, {"base_radius", FieldType::number, "m", 0, unbounded, "Radius at y = 0; 0: an apex"}),
        field(&Cone::top_radius, {"top_radius", FieldType::number, "m", 0, unbounded, "Radius at the top; 0: an apex"}),
        field(&Cone::height, {"height", FieldType::number, "m", 0, unbounded, "From the base at y = 0 to the top"}),
        field(&Cone::capped, {"capped", FieldType::boolean, "", 0, 1, "Closed by disks where a radius is not zero"}),
    };
    return table;
}

}  // namespace crescente::geometry
