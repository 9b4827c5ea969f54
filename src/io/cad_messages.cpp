#include "io/cad_messages.h"

#include <cmath>

#include "base/byte_archive.h"
#include "geometry/face_archive.h"
#include "io/cad_check.h"

namespace crescente::io {
namespace {

using namespace geometry;

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
