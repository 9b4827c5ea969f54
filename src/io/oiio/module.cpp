// Encodes pictures with OpenImageIO, into memory: writing the file safely is the program's matter.
#include "io/oiio/module.h"

#include <string>
#include <vector>

#include <OpenImageIO/filesystem.h>
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

std::string encode(const CrescenteEncodeRequest& request, std::vector<unsigned char>& bytes) {
    const auto output = OIIO::ImageOutput::create(request.format);
    if (!output) return "OpenImageIO cannot write " + std::string(request.format) + ": " + OIIO::geterror();
    OIIO::Filesystem::IOVecOutput memory{bytes};
    if (!output->set_ioproxy(&memory)) return "OpenImageIO cannot write " + std::string(request.format) + " into memory";
    const OIIO::ImageSpec spec = spec_of(request);
    if (!output->open(request.format, spec) || !output->write_image(spec.format, request.pixels) || !output->close()) {
        return output->geterror();
    }
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
        std::vector<unsigned char> bytes;
        error = encode(*request, bytes);
        if (error.empty()) {
            request->take(request->user, reinterpret_cast<const char*>(bytes.data()), bytes.size());
            return 1;
        }
    } catch (const std::exception& e) {
        error = e.what();
    }
    request->fail(request->user, error.c_str());
    return 0;
}
