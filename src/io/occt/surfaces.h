// Surfaces of OpenCASCADE as ours.
#pragma once

#include <Geom_Surface.hxx>

#include "geometry/face.h"
#include "io/cad_model.h"
#include "io/occt/loop_pieces.h"

namespace crescente::io::occt {

struct SurfaceConversion {
    geometry::FaceSurface surface;
    ParameterMap map;  // from the file's parameters to those of `surface`
    CadSurface kind = CadSurface::other;
    bool approximated = false;
};

// The surface where the box of the loops lies (in the file's parameters; on periodic surfaces no wider than a period). Analytic surfaces stay
// analytic, extrusions and revolutions become analytic where they are, all else patches. Surfaces that are neither (offsets) are approximated
// to `tolerance`, mm. Throws Standard_Failure where that cannot be done.
SurfaceConversion convert(Handle(Geom_Surface) surface, const Box2& box, double tolerance);

// A point of such a surface; of patches the nearest covers parameters that none does.
math::Vec3 point_on(const geometry::FaceSurface& surface, Point2 p);

}  // namespace crescente::io::occt
