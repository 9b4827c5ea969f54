// glTF from memory, text and binary.
#include "engine.h"
#include "io/gltf.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    using namespace crescente;
    fuzz::exercise(io::read_gltf({reinterpret_cast<const char*>(data), size}, "fuzz.gltf", "/no folder"));
    return 0;
}
