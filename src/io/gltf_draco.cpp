#include "io/gltf_draco.h"

#ifdef CRESCENTE_WITH_DRACO
#include <draco/compression/decode.h>
#endif

namespace crescente::io {
#ifdef CRESCENTE_WITH_DRACO
namespace {

// The decoder allocates what the header promises before it has seen the data. Connectivity takes at least a good part of a bit for
// each triangle; a header that promises far more lies. Layout: Draco bitstream specification 2.2, sections 3 and 5.
bool promises_too_much(std::string_view bytes) {
    constexpr std::size_t header = 11, most_faces_per_byte = 64;
    if (bytes.size() < header + 2) return true;
    const bool edgebreaker = bytes[8] == 1, has_metadata = (static_cast<unsigned char>(bytes[10]) & 0x80) != 0;
    if (has_metadata || !edgebreaker) return false;  // the sequential decoder checks against the bytes that are left
    std::size_t at = header + 1;                     // after the traversal type: vertices, then faces
    std::uint64_t value = 0;
    for (int field = 0; field < 2; ++field) {
        value = 0;
        for (int shift = 0; at < bytes.size() && shift < 63; shift += 7) {
            const auto byte = static_cast<unsigned char>(bytes[at++]);
            value |= static_cast<std::uint64_t>(byte & 0x7f) << shift;
            if (!(byte & 0x80)) break;
        }
        if (value > most_faces_per_byte * bytes.size()) return true;
    }
    return false;
}

}  // namespace

bool can_decode_draco() { return true; }

std::optional<DracoMesh> decode_draco(std::string_view bytes, const DracoIds& ids) {
    if (promises_too_much(bytes) || ids.positions < 0) return std::nullopt;
    draco::DecoderBuffer buffer;
    buffer.Init(bytes.data(), bytes.size());
    draco::Decoder decoder;
    auto decoded = decoder.DecodeMeshFromBuffer(&buffer);
    if (!decoded.ok()) return std::nullopt;
    const std::unique_ptr<draco::Mesh> mesh = std::move(decoded).value();
    const auto attribute = [&](int id) {
        const draco::PointAttribute* found = id < 0 ? nullptr : mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(id));
        return found && found->num_components() == 3 ? found : nullptr;
    };
    const draco::PointAttribute *positions = attribute(ids.positions), *normals = attribute(ids.normals);
    if (!positions || (ids.normals >= 0 && !normals)) return std::nullopt;

    DracoMesh result;
    const std::uint32_t points = mesh->num_points();
    const auto read = [](const draco::PointAttribute& from, std::uint32_t point, double* to) {
        const draco::AttributeValueIndex value = from.mapped_index(draco::PointIndex(point));
        return value.value() < from.size() && from.ConvertValue<double>(value, from.num_components(), to);
    };
    std::array<const draco::PointAttribute*, 4> others{};
    for (std::size_t k = 0; k < others.size(); ++k) {
        if (ids.attributes[k] < 0) continue;
        others[k] = mesh->GetAttributeByUniqueId(static_cast<std::uint32_t>(ids.attributes[k]));
        if (!others[k] || others[k]->num_components() < 1 || others[k]->num_components() > 4) return std::nullopt;
        result.components[k] = others[k]->num_components();
    }
    for (std::uint32_t i = 0; i < points; ++i) {
        std::array<double, 3> v;
        if (!read(*positions, i, v.data())) return std::nullopt;
        result.positions.push_back({v[0], v[1], v[2]});
        if (normals && !read(*normals, i, v.data())) return std::nullopt;
        if (normals) result.normals.push_back(v);
        for (std::size_t k = 0; k < others.size(); ++k) {
            std::array<double, 4> value;
            if (others[k] && !read(*others[k], i, value.data())) return std::nullopt;
            if (others[k]) result.attributes[k].insert(result.attributes[k].end(), value.begin(), value.begin() + result.components[k]);
        }
    }
    for (std::uint32_t f = 0; f < mesh->num_faces(); ++f) {
        for (const draco::PointIndex& point : mesh->face(draco::FaceIndex(f))) {
            if (point.value() >= points) return std::nullopt;
            result.indices.push_back(point.value());
        }
    }
    return result;
}
#else
bool can_decode_draco() { return false; }
std::optional<DracoMesh> decode_draco(std::string_view, const DracoIds&) { return std::nullopt; }
#endif

}  // namespace crescente::io
