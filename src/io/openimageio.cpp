#include "io/openimageio.h"

#include <dlfcn.h>

#include "io/module_file.h"

namespace crescente::io {
namespace {

struct Module {
    decltype(&crescente_oiio_encode) encode = nullptr;
    std::string error;
};

Module load() {
    const auto file = module_file("crescente_openimageio.so");
    if (!file) return {nullptr, "this build has no OpenImageIO (crescente_openimageio.so)"};
    void* library = dlopen(file->c_str(), RTLD_NOW | RTLD_LOCAL);  // stays loaded: OpenImageIO keeps threads
    if (!library) return {nullptr, dlerror()};
    const auto encode = reinterpret_cast<decltype(&crescente_oiio_encode)>(dlsym(library, "crescente_oiio_encode"));
    return {encode, encode ? std::string{} : std::string{dlerror()}};
}

struct Answer {
    std::string bytes;
    std::string error;
};

}  // namespace

bool has_openimageio() { return module_file("crescente_openimageio.so").has_value(); }

Expected<std::string> encode_with_openimageio(CrescenteEncodeRequest request) {
    static const Module module = load();
    if (!module.encode) return failure(ErrorKind::unsupported, {{}, {}, module.error, "PNG needs no OpenImageIO"});
    Answer answer;
    request.version = crescente_oiio_version;
    request.user = &answer;
    request.take = [](void* user, const char* bytes, std::size_t size) { static_cast<Answer*>(user)->bytes.assign(bytes, size); };
    request.fail = [](void* user, const char* reason) { static_cast<Answer*>(user)->error = reason; };
    if (module.encode(&request)) return std::move(answer.bytes);
    return failure(ErrorKind::resource, {{}, {}, answer.error.empty() ? "OpenImageIO failed" : answer.error, {}});
}

}  // namespace crescente::io
