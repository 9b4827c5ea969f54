#include "io/occt/assembly.h"

#include <algorithm>
#include <map>
#include <optional>
#include <tuple>
#include <utility>

#include <TCollection_AsciiString.hxx>
#include <TDF_LabelSequence.hxx>
#include <TDataStd_Name.hxx>
#include <TopExp.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_ShapeTool.hxx>
#include <gp_Trsf.hxx>

#include "io/occt/colors.h"
#include "io/occt/labels.h"
#include "io/occt/usages.h"
#include "io/occt/vectors.h"

namespace crescente::io::occt {
namespace {

math::Affine affine(const gp_Trsf& t) {
    const auto column = [&](int c) { return math::Vec3{t.Value(1, c), t.Value(2, c), t.Value(3, c)}; };
    return {column(1), column(2), column(3), column(4)};
}

std::string name_of(const TDF_Label& label) {
    Handle(TDataStd_Name) name;
    if (!label.FindAttribute(TDataStd_Name::GetID(), name)) return {};
    return TCollection_AsciiString(name->Get()).ToCString();  // as UTF-8
}

// Names that OpenCASCADE or an exporter made up say nothing.
bool made_up(const std::string& name) {
    return name.empty() || name.starts_with("=>[") || name.starts_with("NAUO") || name == "SOLID" || name == "COMPOUND" || name == "SHELL" || name == "ASSEMBLY" || name == "FACE" || name == "Open CASCADE STEP translator";
}

class TreeMaker {
public:
    TreeMaker(const CadDocument& document, const PartOptions& options, const Progress& progress)
        : main_(document.document->Main()), options_(options), progress_(progress), colors_(main_, model_.colors), usages_(main_) {
        model_.unit = document.unit, model_.unit_metres = document.unit_metres;
        model_.referenced = document.referenced, model_.warnings = document.warnings;
    }

    Expected<CadModel> make() {
        TDF_LabelSequence roots;
        XCAFDoc_DocumentTool::ShapeTool(main_)->GetFreeShapes(roots);
        faces_ = count_faces();
        for (TDF_LabelSequence::Iterator each(roots); each.More(); each.Next()) {
            if (const auto node = place(each.Value(), Colors::none, {}, Usages::none)) model_.roots.push_back(*node);
        }
        std::uint64_t all = 0;
        for (const std::uint64_t n : model_.counts.faces) all += n;
        model_.counts.shown = faces_shown();
        if (all + model_.counts.tessellated == 0) return failure(ErrorKind::input, {options_.shown_name, {}, "there is no face in it", curves_hint()});
        if (hidden_ > 0) model_.warnings.push_back({options_.shown_name, {}, std::to_string(hidden_) + " parts or instances that it hides are not shown", {}});
        return std::move(model_);
    }

private:
    // What a label shows, wherever it stands (as far as no usage begun above goes on in it). Colours from above count only for what has none, so the same label under another colour is another.
    struct Content {
        std::uint32_t part = CadNode{}.part;
        std::vector<std::uint32_t> colors, children;
        std::uint64_t faces = 0;
    };
    struct PartFaces {
        std::uint32_t part;
        std::vector<std::uint32_t> colors;  // by slot; none: whatever comes from above
        std::uint64_t faces;
    };

    static std::string curves_hint() { return "curves, points and drawings are not shown"; }

    std::uint64_t count_faces() const {
        TDF_LabelSequence all;
        XCAFDoc_DocumentTool::ShapeTool(main_)->GetShapes(all);
        std::uint64_t count = 0;
        for (TDF_LabelSequence::Iterator each(all); each.More(); each.Next()) {
            if (!XCAFDoc_ShapeTool::IsSimpleShape(each.Value())) continue;
            TopTools_IndexedMapOfShape faces;
            TopExp::MapShapes(XCAFDoc_ShapeTool::GetShape(each.Value()), TopAbs_FACE, faces);
            count += static_cast<std::uint64_t>(faces.Extent());
        }
        return count;
    }

    // Children come before their parents among the nodes.
    std::uint64_t faces_shown() const {
        std::vector<std::uint64_t> below;
        for (const CadNode& node : model_.nodes) {
            const bool has_part = node.part < model_.parts.size();
            std::uint64_t sum = has_part ? model_.parts[node.part].faces.size() + part_triangulated_[node.part] : 0;
            for (const std::uint32_t child : node.children) sum += below[child];
            below.push_back(sum);
        }
        std::uint64_t all = 0;
        for (const std::uint32_t root : model_.roots) all += below[root];
        return all;
    }

    // The node of a free shape or of a component; nothing if there is nothing to see.
    std::optional<std::uint32_t> place(const TDF_Label& label, std::uint32_t color_above, const std::string& name_above, Usages::Begun begun_above) {
        TDF_Label shown = label;
        const bool is_instance = XCAFDoc_ShapeTool::GetReferredShape(label, shown);
        const auto [usage, begun] = is_instance ? usages_.enter(begun_above, label) : Usages::Place{{}, begun_above};
        if (!colors_.visible(label) || (!usage.IsNull() && !colors_.visible(usage))) {
            ++hidden_;
            return std::nullopt;
        }
        std::uint32_t own = usage.IsNull() ? Colors::none : colors_.of(usage);
        if (own == Colors::none && is_instance) own = colors_.of(label);
        // An instance's colour is meant for it more than the part's own.
        CadNode node;
        const std::string name = name_of(label), product = name_of(shown);
        node.name = !made_up(name) ? name : !made_up(product) ? product : name_above;
        const Content& content = content_of(shown, own != Colors::none ? own : color_above, own != Colors::none, made_up(product) ? node.name : product, begun);
        if (content.faces == 0) return std::nullopt;
        if (is_instance) node.transform = affine(XCAFDoc_ShapeTool::GetLocation(label).Transformation());
        node.part = content.part, node.colors = content.colors, node.children = content.children;
        model_.nodes.push_back(std::move(node));
        return static_cast<std::uint32_t>(model_.nodes.size() - 1);
    }

    const Content& content_of(const TDF_Label& label, std::uint32_t above, bool overriding, const std::string& name, Usages::Begun begun) {
        const auto [found, is_new] = contents_.try_emplace({entry_of(label), begun, above, overriding});
        Content& content = found->second;
        if (!is_new) return content;
        const std::uint32_t own = colors_.of(label);
        const std::uint32_t color = overriding || own == Colors::none ? above : own;
        if (XCAFDoc_ShapeTool::IsAssembly(label)) {
            TDF_LabelSequence components;
            XCAFDoc_ShapeTool::GetComponents(label, components);
            std::vector<std::uint32_t> children;
            std::uint64_t faces = 0;
            for (TDF_LabelSequence::Iterator each(components); each.More(); each.Next()) {
                if (const auto child = place(each.Value(), color, name, begun)) children.push_back(*child), ++faces;
            }
            content.children = std::move(children), content.faces = faces;
            take_only_child(content, name);
        } else if (XCAFDoc_ShapeTool::IsSimpleShape(label)) {
            const PartFaces& part = part_of(label, name);
            content.part = part.part, content.colors = part.colors, content.faces = part.faces;
            for (std::uint32_t& slot : content.colors) slot = slot == Colors::none ? color : slot;
        }
        return content;
    }

    // Exporters wrap a part in an assembly of its own: one place without a name or movement of its own says nothing.
    void take_only_child(Content& content, const std::string& name) {
        if (content.children.size() != 1 || content.children[0] + 1 != model_.nodes.size()) return;
        const CadNode& child = model_.nodes.back();
        if (!(child.transform == math::Affine{}) || (!child.name.empty() && child.name != name)) return;
        content.part = child.part, content.colors = child.colors;
        content.children = std::vector<std::uint32_t>(child.children);
        model_.nodes.pop_back();
    }

    const PartFaces& part_of(const TDF_Label& label, const std::string& known_name) {
        const auto [found, is_new] = parts_.try_emplace(entry_of(label));
        if (!is_new) return found->second;
        const TopoDS_Shape shape = XCAFDoc_ShapeTool::GetShape(label);
        TopTools_IndexedMapOfShape faces;
        TopExp::MapShapes(shape, TopAbs_FACE, faces);
        PartFaces result{CadNode{}.part, {}, static_cast<std::uint64_t>(faces.Extent())};
        if (result.faces > 0) {
            std::vector<std::uint16_t> slots;
            constexpr std::size_t most_slots = 65535;
            for (const std::uint32_t color : colors_.of_faces(label, shape, faces)) {
                const auto known = std::find(result.colors.begin(), result.colors.end(), color);
                const auto slot = static_cast<std::size_t>(known - result.colors.begin());
                slots.push_back(static_cast<std::uint16_t>(std::min(slot, most_slots - 1)));
                if (slot == result.colors.size() && slot < most_slots) result.colors.push_back(color);
            }
            progress_(static_cast<double>(done_) / static_cast<double>(std::max<std::uint64_t>(1, faces_)), "faces");
            std::string name = known_name;
            if (name.empty()) name = "part " + std::to_string(model_.parts.size() + 1);
            const std::uint64_t before = model_.counts.tessellated;
            model_.parts.push_back(make_part(shape, name, faces, slots, options_, model_));
            part_triangulated_.push_back(model_.counts.tessellated - before);
            done_ += result.faces;
            result.part = static_cast<std::uint32_t>(model_.parts.size() - 1);
        }
        return found->second = std::move(result);
    }

    TDF_Label main_;
    const PartOptions& options_;
    const Progress& progress_;
    CadModel model_;
    Colors colors_;
    Usages usages_;
    std::map<std::tuple<std::string, Usages::Begun, std::uint32_t, bool>, Content> contents_;
    std::map<std::string, PartFaces> parts_;
    std::vector<std::uint64_t> part_triangulated_;  // faces of each part that are shown as triangles
    std::uint64_t faces_ = 0, done_ = 0, hidden_ = 0;
};

}  // namespace

Expected<CadModel> model_of(const CadDocument& document, const PartOptions& options, const Progress& progress) {
    return TreeMaker(document, options, progress).make();
}

}  // namespace crescente::io::occt
