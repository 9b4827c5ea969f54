// NFF from memory.
#include "engine.h"
#include "io/nff.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    using namespace crescente;
    fuzz::exercise(io::read_nff({reinterpret_cast<const char*>(data), size}, "fuzz.nff"));
    return 0;
}
