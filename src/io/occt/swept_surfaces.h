// Extrusions and surfaces of revolution: analytic where they are, else exact patches.
#pragma once

#include <Geom_SurfaceOfLinearExtrusion.hxx>
#include <Geom_SurfaceOfRevolution.hxx>

#include "io/occt/surfaces.h"

namespace crescente::io::occt {

SurfaceConversion convert_extrusion(const Geom_SurfaceOfLinearExtrusion& surface, const Box2& box, double tolerance);
SurfaceConversion convert_revolution(const Geom_SurfaceOfRevolution& surface, const Box2& box, double tolerance);

// (radius + v sin a) (cos u x + sin u y) + v cos a z with a of 90 degrees: a plane in polar parameters.
SurfaceConversion flat_cone(const geometry::Frame& frame, double radius, double outward);  // outward: sin a, 1 or -1

}  // namespace crescente::io::occt
