// Meshes from memory: PLY, STL, and the bytes that the process of Assimp answers with. Assimp itself is not ours to fuzz: it works
// in a process of its own because it fails on damaged files.
#include "engine.h"
#include "io/packed_scene.h"
#include "io/ply.h"
#include "io/stl.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    using namespace crescente;
    constexpr std::string_view packed_mark = "packed:";  // of inputs for unpack(), which begins after it
    const std::string_view bytes{reinterpret_cast<const char*>(data), size};
    if (bytes.starts_with("ply")) {
        fuzz::exercise(io::read_ply(bytes, "fuzz.ply"));
    } else if (bytes.starts_with(packed_mark)) {
        if (auto answer = io::unpack(bytes.substr(packed_mark.size()))) fuzz::exercise(std::move(*answer));
    } else {
        fuzz::exercise(io::read_stl(bytes, "fuzz.stl"));
    }
    return 0;
}
