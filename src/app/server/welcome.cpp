#include "app/server/welcome.h"

#include "app/server/message.h"
#include "app/server/replies.h"
#include "render/level.h"
#include "scene/material_library.h"
#include "scene/studio.h"

namespace crescente::app {
namespace {

// What a small picture of the material would show: what a metal reflects straight on, what anything else scatters. Linear.
math::Rgb swatch(const scene::PhysicalMaterial& material) {
    if (material.eta.r <= 0 && material.k.r <= 0) return material.base_color;
    const auto reflectance = [](float n, float k) { return ((n - 1) * (n - 1) + k * k) / ((n + 1) * (n + 1) + k * k); };
    return {reflectance(material.eta.r, material.k.r), reflectance(material.eta.g, material.k.g), reflectance(material.eta.b, material.k.b)};
}

}  // namespace

std::string welcome(const std::string& key, bool taken_up, const SessionLimits& limits) {
    ReplyJson levels = ReplyJson::array(), formats = ReplyJson::array(), layers = ReplyJson::array(), studios = ReplyJson::array(), library = ReplyJson::array();
    for (const render::LevelKind& level : render::levels()) levels.push_back(level.name);
    for (const auto& name : export_formats()) formats.push_back(name);
    for (const auto& name : layer_names()) layers.push_back(name);
    for (const auto& name : scene::studio_names) studios.push_back(name);
    for (const scene::LibraryMaterial& one : scene::material_library()) {
        const math::Rgb color = swatch(one.material);
        library.push_back({{"name", one.name}, {"group", one.group}, {"note", one.note}, {"color", {color.r, color.g, color.b}}});
    }
    return reply("welcome", {{"version", CRESCENTE_VERSION},
                             {"protocol", protocol_version},
                             {"session", key},
                             {"taken_up", taken_up},
                             {"limits", {{"upload", limits.upload}, {"message", longest_message}, {"width", widest_view}, {"height", widest_view}}},
                             {"levels", std::move(levels)},
                             {"layers", std::move(layers)},
                             {"formats", std::move(formats)},
                             {"studios", std::move(studios)},
                             {"library", std::move(library)}});
}

}  // namespace crescente::app
