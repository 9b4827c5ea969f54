// The faces of a part: exact where that can be, else as triangles; what could not be is told.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <TopTools_IndexedMapOfShape.hxx>

#include "io/cad_model.h"

namespace crescente::io::occt {

struct PartOptions {
    double deflection = 0;  // share of the diagonal: all faces as triangles; 0: exact
    std::string shown_name;
    std::map<std::uint32_t, std::set<std::uint32_t>> triangulated;  // by part: faces that are to come as triangles
};

// `slots` are the faces' material slots. Counts and warnings are added to those of the model.
CadPart make_part(const TopoDS_Shape& shape, const std::string& name, const TopTools_IndexedMapOfShape& faces, const std::vector<std::uint16_t>& slots,
                  const PartOptions& options, CadModel& model);

}  // namespace crescente::io::occt
