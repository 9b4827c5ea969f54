// Measured lamps from memory: what is read has a finite intensity in every direction.
#include <cmath>
#include <cstdlib>

#include "io/ies_file.h"

extern "C" int LLVMFuzzerTestOneInput(const unsigned char* data, std::size_t size) {
    const auto lamp = crescente::io::read_ies({reinterpret_cast<const char*>(data), size}, "fuzz.ies");
    if (!lamp) return 0;
    for (int i = 0; i <= 12; ++i) {
        for (int k = -13; k <= 13; ++k) {
            const double candela = (*lamp)->intensity(i * crescente::math::pi / 12, k * 0.5);
            if (!(candela >= 0 && std::isfinite(candela))) std::abort();
        }
    }
    return 0;
}
