#include "io/cad_messages.h"

#include <cmath>

#include "io/byte_archive.h"
#include "io/cad_check.h"

namespace crescente::io {
namespace {

using namespace geometry;

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

template <class Archive>
void model(Archive& a, CadModel& m) {
    constexpr std::size_t text = sizeof(std::uint64_t);  // bytes that an empty one takes
    value(a, m.unit), value(a, m.unit_metres);
    list(a, m.parts, text, [&](CadPart& part) {
        value(a, part.name);
        list(a, part.faces, 5 * sizeof(double), [&](Face& f) { face(a, f); });
        array(a, part.numbers), array(a, part.mesh.positions), array(a, part.mesh.triangles), array(a, part.mesh.normals), array(a, part.mesh.slots);
        value(a, part.unmatched_edges);
    });
    list(a, m.nodes, text, [&](CadNode& node) {
        value(a, node.name), value(a, node.transform), value(a, node.part), array(a, node.colors), array(a, node.children);
    });
    array(a, m.roots), array(a, m.colors), value(a, m.counts);
    list(a, m.referenced, text, [&](std::string& name) { value(a, name); });
    problems(a, m.warnings);
}

}  // namespace

std::string pack_cad(const Expected<CadModel>& result) {
    ByteWriter writer;
    bool good = result.has_value();
    value(writer, good);
    if (good) {
        model(writer, const_cast<CadModel&>(*result));  // a writer changes nothing
    } else {
        Error copy = result.error();
        value(writer, copy.kind);
        problems(writer, copy.problems);
    }
    return std::move(writer.bytes);
}

std::optional<Expected<CadModel>> unpack_cad(std::string_view bytes) {
    ByteReader reader{bytes};
    bool good = false;
    value(reader, good);
    if (good) {
        CadModel result;
        model(reader, result);
        if (!reader.good() || !reader.bytes.empty() || !holds_together(result)) return std::nullopt;
        return Expected<CadModel>(std::move(result));
    }
    Error error;
    value(reader, error.kind);
    problems(reader, error.problems);
    const bool known = error.kind >= ErrorKind::usage && error.kind <= ErrorKind::internal;
    if (!reader.good() || !reader.bytes.empty() || error.problems.empty() || !known) return std::nullopt;
    return Expected<CadModel>(tl::unexpected(std::move(error)));
}

}  // namespace crescente::io
