#include "io/occt/parts.h"

#include <algorithm>

#include <BRep_Builder.hxx>
#include <Standard_Failure.hxx>
#include <TopoDS.hxx>
#include <TopoDS_Compound.hxx>

#include "io/occt/faces.h"
#include "io/occt/tessellation.h"

namespace crescente::io::occt {
namespace {

constexpr double fallback_deflection = 1e-4;  // of the part's diagonal
constexpr std::size_t most_named = 20;        // faces that a part's warnings name; the others are counted

class PartMaker {
public:
    PartMaker(const PartOptions& options, const std::string& name, CadModel& model) : options_(options), model_(model) { part_.name = name; }

    CadPart make(const TopoDS_Shape& shape, const TopTools_IndexedMapOfShape& faces, const std::vector<std::uint16_t>& slots) {
        const EdgeBands bands(shape);
        CadCounts& counts = model_.counts;
        counts.largest_tolerance = std::max(counts.largest_tolerance, bands.largest_tolerance());
        counts.largest_gap = std::max(counts.largest_gap, bands.largest_gap());
        part_.unmatched_edges = bands.unmatched();
        const auto found = options_.triangulated.find(static_cast<std::uint32_t>(model_.parts.size()));
        const auto* wanted = found == options_.triangulated.end() ? nullptr : &found->second;
        part_.faces.reserve(static_cast<std::size_t>(faces.Extent()));
        for (int i = 1; i <= faces.Extent(); ++i) {
            const std::uint16_t slot = slots[static_cast<std::size_t>(i - 1)];
            const TopoDS_Face& face = TopoDS::Face(faces(i));
            if (wanted && wanted->contains(static_cast<std::uint32_t>(i))) {
                const auto kind = convert_face(face, bands);
                rest_.push_back({i, slot, kind ? kind->kind : kind.error().kind, "cannot be traced as it is"});
                ++counts.faces[static_cast<std::size_t>(rest_.back().kind)];
            } else if (options_.deflection > 0) rest_.push_back({i, slot, CadSurface::other, {}});
            else add(i, slot, bands.shell(face), convert_face(face, bands));
        }
        if (!rest_.empty()) add_triangles(faces, (options_.deflection > 0 ? options_.deflection : fallback_deflection) * bands.diagonal());
        tell_rest();
        return std::move(part_);
    }

private:
    struct Unconverted {
        int face;
        std::uint16_t slot;
        CadSurface kind;
        std::string reason;
    };

    void add(int number, std::uint16_t slot, std::uint32_t shell, tl::expected<ConvertedFace, UnconvertedFace> result) {
        CadCounts& counts = model_.counts;
        ++counts.faces[static_cast<std::size_t>(result ? result->kind : result.error().kind)];
        if (!result && result.error().degenerate) {
            ++counts.degenerate;
            tell(number, result.error().kind, result.error().reason + " and is left out");
            return;
        }
        if (!result) {
            rest_.push_back({number, slot, result.error().kind, result.error().reason});
            return;
        }
        ++(result->approximated ? counts.approximated : counts.exact);
        if (result->healed) {
            ++counts.healed;
            tell(number, result->kind, "was mended by OpenCASCADE");
        }
        if (const auto* patches = std::get_if<geometry::PatchSurface>(&result->face.surface)) counts.patches += patches->patches.size();
        result->face.slot = slot, result->face.shell = shell;
        part_.faces.push_back(std::move(result->face));
        part_.numbers.push_back(static_cast<std::uint32_t>(number));
    }

    void add_triangles(const TopTools_IndexedMapOfShape& faces, double deflection) {
        TopoDS_Compound compound;
        BRep_Builder builder;
        builder.MakeCompound(compound);
        for (const Unconverted& one : rest_) builder.Add(compound, faces(one.face));
        try {
            triangulate(compound, deflection);
        } catch (const Standard_Failure&) {  // whatever has no triangles is told below
        }
        for (const Unconverted& one : rest_) {
            const bool shown = append_triangles(TopoDS::Face(faces(one.face)), one.slot, part_.mesh);
            model_.counts.tessellated += shown;
            if (options_.deflection > 0) continue;
            tell(one.face, one.kind, one.reason + (shown ? ": it is shown as triangles" : "; nor can OpenCASCADE make triangles of it: it is missing"));
        }
    }

    void tell(int face, CadSurface kind, const std::string& what) {
        if (++told_ > most_named) return;
        const std::string name = cad_surface_names[static_cast<std::size_t>(kind)].data();
        model_.warnings.push_back({options_.shown_name, "part '" + part_.name + "', face " + std::to_string(face) + " (" + name + ")", what, {}});
    }
    void tell_rest() {
        if (told_ <= most_named) return;
        model_.warnings.push_back({options_.shown_name, "part '" + part_.name + "'", "and " + std::to_string(told_ - most_named) + " more of its faces likewise", {}});
    }

    const PartOptions& options_;
    CadModel& model_;
    CadPart part_;
    std::vector<Unconverted> rest_;
    std::size_t told_ = 0;
};

}  // namespace

CadPart make_part(const TopoDS_Shape& shape, const std::string& name, const TopTools_IndexedMapOfShape& faces, const std::vector<std::uint16_t>& slots,
                  const PartOptions& options, CadModel& model) {
    return PartMaker(options, name, model).make(shape, faces, slots);
}

}  // namespace crescente::io::occt
