// Faces as bytes, and back: for the archives of base/byte_archive.h.
#pragma once

#include <utility>

#include "base/byte_archive.h"
#include "geometry/face.h"

namespace crescente::geometry {

// An alternative of a variant by its index; reading makes it first.
template <class Archive, class... Kinds, class Each>
void alternative(Archive& a, std::variant<Kinds...>& v, Each&& each) {
    std::uint8_t index = static_cast<std::uint8_t>(v.index());
    a.raw(&index, 1);
    if (index >= sizeof...(Kinds)) a.fail();
    if (!a.good()) return;
    if (index != v.index()) {
        const auto make = [&]<std::size_t... I>(std::index_sequence<I...>) { (void)((index == I && (v.template emplace<I>(), true)) || ...); };
        make(std::index_sequence_for<Kinds...>{});
    }
    std::visit(each, v);
}

template <class Archive>
void patch(Archive& a, BezierPatch& p) {
    value(a, p.degree_u), value(a, p.degree_v), value(a, p.rational);
    for (double* bound : {&p.u0, &p.u1, &p.v0, &p.v1}) value(a, *bound);
    array(a, p.points);
}

template <class Archive>
void surface(Archive& a, FaceSurface& v) {
    alternative(a, v, [&](auto& s) {
        if constexpr (requires { s.patches; }) {
            list(a, s.patches, 2 * sizeof(int), [&](BezierPatch& p) { patch(a, p); });
            bool revolved = s.revolved.has_value();
            value(a, revolved);
            if (revolved && !s.revolved) s.revolved.emplace();
            if (revolved) value(a, *s.revolved);
        } else {
            value(a, s);  // frame and radii: plain numbers
        }
    });
}

template <class Archive>
void face(Archive& a, Face& f) {
    surface(a, f.surface);
    for (double* bound : {&f.u0, &f.u1, &f.v0, &f.v1}) value(a, *bound);
    list(a, f.loops, sizeof(std::uint64_t), [&](Loop& loop) {
        list(a, loop, 1 + sizeof(double), [&](LoopEdge& edge) {
            alternative(a, edge.piece, [&](auto& piece) {
                if constexpr (requires { piece.points; }) array(a, piece.points);
                else value(a, piece);
            });
            value(a, edge.band);
        });
    });
    value(a, f.reversed), value(a, f.slot), value(a, f.shell);
}

}  // namespace crescente::geometry
