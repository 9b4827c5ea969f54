#include "app/server/jpeg.h"

#include <memory>

#include <turbojpeg.h>

namespace crescente::app {

Expected<std::string> encode_jpeg(int width, int height, std::span<const std::uint8_t> rgb, int quality) {
    const std::unique_ptr<void, int (*)(tjhandle)> compressor(tjInitCompress(), tjDestroy);
    if (!compressor) return failure(ErrorKind::resource, {"", "", "libjpeg-turbo cannot be used", ""});
    std::string bytes(tjBufSize(width, height, TJSAMP_444), '\0');
    auto* place = reinterpret_cast<unsigned char*>(bytes.data());
    unsigned long size = bytes.size();
    if (tjCompress2(compressor.get(), rgb.data(), width, 0, height, TJPF_RGB, &place, &size, TJSAMP_444, quality, TJFLAG_NOREALLOC | TJFLAG_FASTDCT) != 0) {
        return failure(ErrorKind::resource, {"", "", std::string("JPEG: ") + tjGetErrorStr2(compressor.get()), ""});
    }
    bytes.resize(size);
    return bytes;
}

}  // namespace crescente::app
