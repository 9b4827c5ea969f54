// OpenCASCADE's points and axes as ours.
#pragma once

#include <gp_Ax3.hxx>
#include <gp_Pnt.hxx>
#include <gp_Pnt2d.hxx>

#include "geometry/face.h"

namespace crescente::io::occt {

inline math::Vec3 vec(const gp_XYZ& p) { return {p.X(), p.Y(), p.Z()}; }
inline math::Vec3 vec(const gp_Pnt& p) { return vec(p.XYZ()); }
inline math::Vec3 vec(const gp_Dir& p) { return vec(p.XYZ()); }
inline geometry::Point2 point2(const gp_XY& p) { return {p.X(), p.Y()}; }
inline geometry::Point2 point2(const gp_Pnt2d& p) { return point2(p.XY()); }

// Axes may be left-handed: Direction is then opposite to the cross product of the others, as a Frame allows.
inline geometry::Frame frame(const gp_Ax3& a) { return {vec(a.Location()), vec(a.XDirection()), vec(a.YDirection()), vec(a.Direction())}; }

}  // namespace crescente::io::occt
