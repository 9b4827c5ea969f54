// Meshes compressed by Draco (glTF extension KHR_draco_mesh_compression).
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

#include "math/vec.h"

namespace crescente::io {

struct DracoMesh {
    std::vector<math::Vec3> positions;
    std::vector<std::array<double, 3>> normals;  // empty, or one for each position
    std::vector<std::uint32_t> indices;          // three for each triangle, all within the positions
};

bool can_decode_draco();

// `normal_id` is negative if there are none. Nothing if the data are damaged, hold no triangles, or promise more than they can.
std::optional<DracoMesh> decode_draco(std::string_view bytes, int position_id, int normal_id);

}  // namespace crescente::io
