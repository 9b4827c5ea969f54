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
    std::array<std::vector<double>, 4> attributes;  // others, each empty or so many components for each position
    std::array<int, 4> components{};
};

// What to decode, by the attributes' unique ids; negative: none.
struct DracoIds {
    int positions = -1, normals = -1;
    std::array<int, 4> attributes{-1, -1, -1, -1};
};

bool can_decode_draco();

// Nothing if the data are damaged, hold no triangles, lack what is wanted, or promise more than they can.
std::optional<DracoMesh> decode_draco(std::string_view bytes, const DracoIds& ids);

}  // namespace crescente::io
