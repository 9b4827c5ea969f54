#include "io/occt/usages.h"

#include <algorithm>
#include <numeric>

#include <TDF_AttributeSequence.hxx>
#include <TDF_LabelSequence.hxx>
#include <XCAFDoc_ColorTool.hxx>
#include <XCAFDoc_DocumentTool.hxx>
#include <XCAFDoc_GraphNode.hxx>
#include <XCAFDoc_ShapeTool.hxx>

#include "io/occt/labels.h"

namespace crescente::io::occt {
namespace {

// A usage's components. OpenCASCADE keeps one node for each, and no node has two below it.
std::vector<TDF_Label> way_of(Handle(XCAFDoc_GraphNode) usage) {
    std::vector<TDF_Label> way{usage->Label().Father()};
    while (usage->NbChildren() > 0) {
        usage = usage->GetChild(1);
        way.push_back(usage->Label().Father());
    }
    return way;
}

}  // namespace

Usages::Usages(const TDF_Label& main) {
    const auto colors = XCAFDoc_DocumentTool::ColorTool(main);
    const auto says_something = [&](const TDF_Label& style) {
        return colors->IsSet(style, XCAFDoc_ColorSurf) || colors->IsSet(style, XCAFDoc_ColorGen) || !colors->IsVisible(style);
    };
    TDF_LabelSequence all;
    XCAFDoc_DocumentTool::ShapeTool(main)->GetShapes(all);
    for (TDF_LabelSequence::Iterator each(all); each.More(); each.Next()) {
        TDF_LabelSequence components;
        XCAFDoc_ShapeTool::GetComponents(each.Value(), components);
        for (TDF_LabelSequence::Iterator component(components); component.More(); component.Next()) {
            TDF_AttributeSequence usages;
            if (!XCAFDoc_ShapeTool::GetAllComponentSHUO(component.Value(), usages)) continue;
            for (TDF_AttributeSequence::Iterator usage(usages); usage.More(); usage.Next()) {
                const TDF_Label style = usage.Value()->Label();
                if (says_something(style)) add(way_of(Handle(XCAFDoc_GraphNode)::DownCast(usage.Value())), style);
            }
        }
    }
    link();
}

Usages::Place Usages::enter(Begun above, const TDF_Label& component) const {
    const State& here = states_[next(above, entry_of(component))];
    return {here.style, here.begun};
}

// The longest end of the way to a state and then to a component that begins a usage.
std::uint32_t Usages::next(std::uint32_t state, const std::string& component) const {
    for (;; state = states_[state].shorter) {
        if (const auto found = after_.find({state, component}); found != after_.end()) return found->second;
        if (state == none) return none;
    }
}

// A way of one component is no usage: that is the component's own label. Of several with the same way the first counts.
void Usages::add(const std::vector<TDF_Label>& way, const TDF_Label& style) {
    if (way.size() < 2) return;
    std::uint32_t state = none;
    for (const TDF_Label& label : way) {
        const std::string component = entry_of(label);
        const auto [found, is_new] = after_.try_emplace({state, component}, static_cast<std::uint32_t>(states_.size()));
        if (is_new) states_.push_back({state, component});
        states_[state].begun = state;
        state = found->second;
    }
    if (states_[state].style.IsNull()) states_[state].style = style;
}

// Once all are added: short ways first, for what is shorter must be known.
void Usages::link() {
    std::vector<std::uint32_t> length(states_.size(), 0), order(states_.size());
    for (std::size_t i = 1; i < states_.size(); ++i) length[i] = length[states_[i].above] + 1;  // what is above a state came before it
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) { return length[a] < length[b]; });
    for (const std::uint32_t i : order) {
        State& state = states_[i];
        if (length[i] > 1) state.shorter = next(states_[state.above].shorter, state.component);
        const State& shorter = states_[state.shorter];
        if (state.begun == none) state.begun = shorter.begun;
        if (state.style.IsNull()) state.style = shorter.style;
    }
}

}  // namespace crescente::io::occt
