#include "app/cli/picture_options.h"

#include <algorithm>
#include <filesystem>

#include "scene/hierarchy.h"
#include "scene/tonemap.h"

namespace crescente::app {
namespace {

// sRGB for classic materials, whose colours are meant for the screen; the neutral curve as soon as a physical one is seen.
scene::Tonemap automatic_tonemap(const scene::Scene& scene) {
    bool physical = false;
    scene::for_each_appearance(scene, [&](std::uint32_t, const math::Affine&, const std::vector<scene::MaterialId>& materials) {
        if (materials.empty()) physical |= std::holds_alternative<scene::PhysicalMaterial>(scene::Material{}.model);
        for (const scene::MaterialId id : materials) {
            physical |= id.valid() && std::holds_alternative<scene::PhysicalMaterial>(scene.materials[id.value].model);
        }
    });
    return physical ? scene::Tonemap::neutral : scene::Tonemap::srgb;
}

}  // namespace

void add_picture_options(CLI::App& command, PictureOptions& options, bool required) {
    command.add_option("-o,--output", options.outputs, "Where the picture goes: .png .jpg .tif .hdr .exr (repeatable)")
        ->option_text("FILE")->required(required)->expected(1)->take_all()->allow_extra_args(false);
    command.add_option("--tonemap", options.tonemap, "Display colours: auto, srgb or neutral (Khronos PBR Neutral)")
        ->option_text("NAME")->check(CLI::IsMember({"auto", "srgb", "neutral"}));
    command.add_option("--exposure", options.exposure, "Brightness of the picture in stops; auto: its log-average becomes middle grey, little burns out")->option_text("STOPS|auto")
        ->check(CLI::Range(-32.0, 32.0) | CLI::IsMember({"auto"}));
    command.add_option("--bits", options.bits, "Bits of a channel in PNG and TIFF")->option_text("8|16")->check(CLI::IsMember({8, 16}));
}

void OutputCheck::add(const Expected<void>& writable) {
    if (writable) return;
    if (unwritable_.problems.empty()) unwritable_.kind = writable.error().kind;
    unwritable_.problems.insert(unwritable_.problems.end(), writable.error().problems.begin(), writable.error().problems.end());
}

Expected<void> OutputCheck::result() const {
    if (!unwritable_.problems.empty()) return tl::unexpected<Error>(unwritable_);
    return {};
}

bool needs_all_layers(const std::vector<std::string>& outputs) {
    return std::any_of(outputs.begin(), outputs.end(), [](const std::string& output) {
        const std::string extension = std::filesystem::path(output).extension();
        return extension == ".exr" || extension == ".EXR";
    });
}

io::ImageOptions image_options(const PictureOptions& options, const scene::Scene& scene, const scene::Image& picture) {
    io::ImageOptions image;
    image.tonemap = scene.settings.tonemap;
    if (options.tonemap == "srgb") image.tonemap = scene::Tonemap::srgb;
    if (options.tonemap == "neutral") image.tonemap = scene::Tonemap::neutral;
    if (options.tonemap == "auto") image.tonemap = scene::Tonemap::automatic;
    if (image.tonemap == scene::Tonemap::automatic) image.tonemap = automatic_tonemap(scene);
    const bool by_number = options.exposure && *options.exposure != "auto";
    image.exposure = by_number ? std::stod(*options.exposure) : scene.settings.exposure;
    if (!by_number && (options.exposure || scene.settings.auto_exposure)) {
        const scene::Layer& color = picture.layers.front();
        image.exposure += scene::automatic_exposure(color.values, color.channels.size());
    }
    image.bits = options.bits;
    return image;
}

void prefer_finish(scene::Settings& settings, bool trees_needed) {
    settings.order = scene::Order::tiles;
    const bool denoises = settings.level > scene::Level::edges && settings.denoise != scene::Denoise::off;
    settings.keep = settings.keep && (denoises || trees_needed);
}

Expected<void> check_alpha(const std::vector<std::string>& outputs, const scene::Scene& scene) {
    OutputCheck all;
    if (scene.environment && scene.environment->transparent) {
        for (const std::string& output : outputs) all.add(io::can_write(output, true));
    }
    return all.result();
}

}  // namespace crescente::app
