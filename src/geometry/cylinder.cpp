#include "geometry/cylinder.h"

#include "geometry/revolved.h"

namespace crescente::geometry {

Bounds Cylinder::bounds() const { return {{-radius, 0, -radius}, {radius, height, radius}}; }

std::optional<ShapeHit> Cylinder::intersect(std::uint32_t, const Ray& ray) const {
    return frustum_hit(ray, radius, radius, height, capped);
}

// u: turn about the axis; v: height on the wall, distance from the axis on the caps, as shares of the whole.
SurfacePoint Cylinder::surface(std::uint32_t primitive, Vec3 position) const {
    return frustum_surface(primitive, position, radius, radius, height);
}

const FieldTable<Cylinder>& Cylinder::fields() {
    static const FieldTable<Cylinder> table{
        field(&Cylinder::radius, {"radius", FieldType::number, "m", 0, unbounded, "Distance of the wall from the y axis"}),
        field(&Cylinder::height, {"height", FieldType::number, "m", 0, unbounded, "From the base at y = 0 to the top"}),
        field(&Cylinder::capped, {"capped", FieldType::boolean, "", 0, 1, "Closed by disks at both ends"}),
    };
    return table;
}

}  // namespace crescente::geometry
