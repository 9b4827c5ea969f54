// Encodes and decodes pictures with OpenImageIO, in memory: reading and writing files safely is the program's matter.
#include "io/oiio/module.h"

#include <cerrno>
#include <cstring>
#include <string>
#include <vector>

#include <sys/mman.h>
#include <unistd.h>

#include <OpenImageIO/imageio.h>

namespace {

OIIO::ImageSpec spec_of(const CrescenteEncodeRequest& request) {
    const OIIO::TypeDesc type = request.sample_bits == 8    ? OIIO::TypeDesc::UINT8
                                : request.sample_bits == 16 ? OIIO::TypeDesc::UINT16
                                                            : OIIO::TypeDesc::FLOAT;
    OIIO::ImageSpec spec{request.width, request.height, request.channels, type};
    spec.channelnames.assign(request.channel_names, request.channel_names + request.channels);
    spec.attribute("oiio:ColorSpace", request.color_space);
    if (request.compression) spec.attribute("compression", request.compression);
    if (request.sample_bits == 32) {  // Rec. 709 primaries and D65, as OpenEXR and Radiance files say it
        const float chromaticities[8] = {0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f};
        spec.attribute("chromaticities", OIIO::TypeDesc(OIIO::TypeDesc::FLOAT, 8), chromaticities);
    }
    for (int i = 0; i < request.attribute_count; ++i) spec.attribute(request.attribute_names[i], request.attribute_values[i]);
    return spec;
}

// A file in memory with a path: every format can write to it. (With OpenImageIO's own memory streams TIFF files come out broken.)
class MemoryFile {
public:
    MemoryFile() : descriptor_(memfd_create("picture", MFD_CLOEXEC)) {}
    ~MemoryFile() {
        if (descriptor_ >= 0) close(descriptor_);
    }
    MemoryFile(const MemoryFile&) = delete;
    MemoryFile& operator=(const MemoryFile&) = delete;

    bool open() const { return descriptor_ >= 0; }
    std::string path() const { return "/proc/self/fd/" + std::to_string(descriptor_); }
    bool write(const char* bytes, std::size_t size) const {
        for (std::size_t at = 0; at < size;) {
            const ssize_t n = pwrite(descriptor_, bytes + at, size - at, static_cast<off_t>(at));
            if (n <= 0) return false;
            at += static_cast<std::size_t>(n);
        }
        return true;
    }
    bool read(std::string& bytes) const {
        const off_t size = lseek(descriptor_, 0, SEEK_END);
        if (size < 0) return false;
        bytes.resize(static_cast<std::size_t>(size));
        for (std::size_t at = 0; at < bytes.size();) {
            const ssize_t n = pread(descriptor_, bytes.data() + at, bytes.size() - at, static_cast<off_t>(at));
            if (n <= 0) return false;
            at += static_cast<std::size_t>(n);
        }
        return true;
    }

private:
    int descriptor_;
};

// Pictures are decoded in copies of the process, in which threads that the libraries had begun before are not there, and would be waited for without end.
void begin_no_threads() {
    static const bool told = OIIO::attribute("threads", 1) && OIIO::attribute("exr_threads", -1);
    static_cast<void>(told);
}

std::string encode(const CrescenteEncodeRequest& request, std::string& bytes) {
    begin_no_threads();
    const auto output = OIIO::ImageOutput::create(request.format);
    if (!output) return "OpenImageIO cannot write " + std::string(request.format) + ": " + OIIO::geterror();
    const MemoryFile memory;
    if (!memory.open()) return std::string("no file in memory: ") + std::strerror(errno);
    const OIIO::ImageSpec spec = spec_of(request);
    if (!output->open(memory.path(), spec) || !output->write_image(spec.format, request.pixels) || !output->close()) {
        return "OpenImageIO: " + output->geterror();
    }
    return memory.read(bytes) ? std::string{} : std::string("the file in memory cannot be read: ") + std::strerror(errno);
}

std::string decode(const CrescenteDecodeRequest& request) {
    begin_no_threads();
    const MemoryFile memory;
    if (!memory.open() || !memory.write(request.bytes, request.size)) return std::string("no file in memory: ") + std::strerror(errno);
    OIIO::ImageSpec raw;  // alpha as the file has it, not multiplied in
    raw.attribute("oiio:UnassociatedAlpha", 1);
    const auto input = OIIO::ImageInput::open(memory.path(), &raw);
    if (!input) {
        OIIO::geterror();  // which is about the path
        return "is no picture that OpenImageIO knows, or damaged";
    }
    const OIIO::ImageSpec& spec = input->spec();
    if (spec.width <= 0 || spec.height <= 0 || spec.nchannels <= 0 || spec.depth > 1) return "is no flat picture";
    const std::string size = std::to_string(spec.width) + " x " + std::to_string(spec.height);
    if (static_cast<std::uint64_t>(spec.width) * static_cast<std::uint64_t>(spec.height) > request.most_pixels) {
        return "has " + size + " pixels, a texture may have " + std::to_string(request.most_pixels);
    }
    if (spec.nchannels > 4) return "has " + std::to_string(spec.nchannels) + " channels, a texture may have 1 to 4";
    const int bits = spec.format == OIIO::TypeDesc::UINT8 ? 8 : spec.format == OIIO::TypeDesc::UINT16 ? 16 : 32;
    const OIIO::TypeDesc type = bits == 8 ? OIIO::TypeDesc::UINT8 : bits == 16 ? OIIO::TypeDesc::UINT16 : OIIO::TypeDesc::FLOAT;
    const int width = spec.width, height = spec.height, channels = spec.nchannels;
    std::vector<char> pixels(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * static_cast<std::size_t>(channels) * static_cast<std::size_t>(bits / 8));
    if (!input->read_image(0, 0, 0, channels, type, pixels.data())) return "is damaged: " + input->geterror();
    request.take(request.user, width, height, channels, bits, pixels.data());
    return {};
}

}  // namespace

extern "C" __attribute__((visibility("default"))) int crescente_oiio_encode(const CrescenteEncodeRequest* request) {
    std::string error;
    try {
        if (request->version != crescente_oiio_version) {
            request->fail(request->user, "the module crescente_openimageio is of another version");
            return 0;
        }
        std::string bytes;
        error = encode(*request, bytes);
        if (error.empty()) {
            request->take(request->user, bytes.data(), bytes.size());
            return 1;
        }
    } catch (const std::exception& e) {
        error = e.what();
    }
    request->fail(request->user, error.c_str());
    return 0;
}

extern "C" __attribute__((visibility("default"))) int crescente_oiio_decode(const CrescenteDecodeRequest* request) {
    std::string error;
    try {
        error = request->version == crescente_oiio_version ? decode(*request) : "the module crescente_openimageio is of another version";
        if (error.empty()) return 1;
    } catch (const std::exception& e) {
        error = e.what();
    }
    request->fail(request->user, error.c_str());
    return 0;
}
