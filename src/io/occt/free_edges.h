// Edges that bound one face only, matched with each other by where they run.
#pragma once

#include <cstdint>
#include <vector>

#include "math/vec.h"

namespace crescente::io::occt {

using EdgePoints = std::vector<math::Vec3>;  // at equal steps of the parameter

// How far the two run apart at most: the largest distance of points at the same parameter, or, where they run at different paces, of a point from
// the other's polyline, with what that strays from its curve added. What is no more than `enough` is not looked at more closely.
double distance_between(const EdgePoints& a, const EdgePoints& b, double enough = 0);

struct FreeEdge {
    int id;
    double tolerance;
    EdgePoints points;
};
struct FreeEdgeGap {
    std::size_t edge;  // index of a free edge
    bool matched;      // another runs along all of it
    std::size_t other;  // that one; itself where not matched
    double gap;        // mm, 0 where not matched
};

// For each edge the others that run along it, no further away than 1e-4 of the diagonal or three times the tolerances: they are taken for the same
// edge of another face.
std::vector<FreeEdgeGap> gaps_between(const std::vector<FreeEdge>& edges, double diagonal);

}  // namespace crescente::io::occt
