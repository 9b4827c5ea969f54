#include "io/openimageio.h"

#include <dlfcn.h>

#include "io/module_file.h"

namespace crescente::io {
namespace {

struct Module {
    decltype(&crescente_oiio_encode) encode = nullptr;
    decltype(&crescente_oiio_decode) decode = nullptr;
    std::string error;
};

Module load() {
    const auto file = module_file("crescente_openimageio.so");
    if (!file) return {nullptr, nullptr, "this build has no OpenImageIO (crescente_openimageio.so)"};
    void* library = dlopen(file->c_str(), RTLD_NOW | RTLD_LOCAL);  // stays loaded: OpenImageIO keeps threads
    if (!library) return {nullptr, nullptr, dlerror()};
    const auto encode = reinterpret_cast<decltype(&crescente_oiio_encode)>(dlsym(library, "crescente_oiio_encode"));
    const auto decode = reinterpret_cast<decltype(&crescente_oiio_decode)>(dlsym(library, "crescente_oiio_decode"));
    if (!encode || !decode) return {nullptr, nullptr, dlerror()};
    return {encode, decode, {}};
}

const Module& the_module() {
    static const Module module = load();
    return module;
}

struct Answer {
    std::string bytes;
    std::string error;
};

}  // namespace

bool has_openimageio() { return module_file("crescente_openimageio.so").has_value(); }

Expected<std::string> encode_with_openimageio(CrescenteEncodeRequest request) {
    const Module& module = the_module();
    if (!module.encode) return failure(ErrorKind::unsupported, {{}, {}, module.error, "PNG needs no OpenImageIO"});
    Answer answer;
    request.version = crescente_oiio_version;
    request.user = &answer;
    request.take = [](void* user, const char* bytes, std::size_t size) { static_cast<Answer*>(user)->bytes.assign(bytes, size); };
    request.fail = [](void* user, const char* reason) { static_cast<Answer*>(user)->error = reason; };
    if (module.encode(&request)) return std::move(answer.bytes);
    return failure(ErrorKind::resource, {{}, {}, answer.error.empty() ? "OpenImageIO failed" : answer.error, {}});
}

Expected<scene::Pixels> decode_with_openimageio(std::string_view bytes, std::uint64_t most_pixels) {
    const Module& module = the_module();
    if (!module.decode) return failure(ErrorKind::unsupported, {{}, {}, module.error, {}});
    struct Decoded {
        scene::Pixels pixels;
        std::string error;
    } answer;
    CrescenteDecodeRequest request{crescente_oiio_version, bytes.data(), bytes.size(), most_pixels, &answer, nullptr, nullptr};
    request.take = [](void* user, int width, int height, int channels, int sample_bits, const void* pixels) {
        const auto type = sample_bits == 8 ? scene::SampleType::bits8 : sample_bits == 16 ? scene::SampleType::bits16 : scene::SampleType::float32;
        const auto* first = static_cast<const std::uint8_t*>(pixels);
        const auto size = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels) * static_cast<std::size_t>(sample_bits / 8);
        static_cast<Decoded*>(user)->pixels = {width, height, channels, type, {first, first + size}};
    };
    request.fail = [](void* user, const char* reason) { static_cast<Decoded*>(user)->error = reason; };
    if (module.decode(&request)) return std::move(answer.pixels);
    return failure(ErrorKind::input, {{}, {}, answer.error.empty() ? "OpenImageIO failed" : answer.error, {}});
}

}  // namespace crescente::io
