// Colours of a document: of labels, and of the faces of a part.
#pragma once

#include <optional>
#include <vector>

#include <TDF_Label.hxx>
#include <TopTools_DataMapOfShapeInteger.hxx>
#include <TopTools_IndexedMapOfShape.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "io/cad_model.h"

namespace crescente::io::occt {

class Colors {
public:
    Colors(const TDF_Label& main, std::vector<CadColor>& table);

    static constexpr std::uint32_t none = CadPart::no_color;

    // Of the part, assembly or instance at a label: that of surfaces, else the general one. An index into the table, or none.
    std::uint32_t of(const TDF_Label& label);

    // Of each face of the part (in the order of the map): its own, else that of the shell, solid or compound in the part that it belongs to; none where
    // the part's label has the say.
    std::vector<std::uint32_t> of_faces(const TDF_Label& part, const TopoDS_Shape& shape, const TopTools_IndexedMapOfShape& faces);

    bool visible(const TDF_Label& label) const { return tool_->IsVisible(label); }

private:
    std::uint32_t index_of(const CadColor& color);

    Handle(XCAFDoc_ColorTool) tool_;
    Handle(XCAFDoc_ShapeTool) shapes_;
    std::vector<CadColor>& table_;
};

}  // namespace crescente::io::occt
