#include "scene/texture.h"

#include <algorithm>

#include "scene/material.h"

namespace crescente::scene {

const FieldTable<Texture>& Texture::fields() {
    using T = Texture;
    static const FieldTable<T> table{
        field(&T::kind, {"kind", FieldType::choice, "", 0, 7, "Where its values come from: a picture, a procedure, or the colours of a mesh's vertices",
              {"image", "checker", "noise", "brushed", "wood", "vertex_color", "leather", "flakes"}}),
        field(&T::color_space, {"color_space", FieldType::choice, "", 0, 2, "Of a picture of 8 or 16 bits; automatic: sRGB for colours, linear for numbers",
              {"automatic", "srgb", "linear"}}),
        field(&T::channel, {"channel", FieldType::choice, "", 0, 4, "What of it is taken; automatic: all for colours, red for numbers",
              {"automatic", "red", "green", "blue", "alpha"}}),
        field(&T::wrap_u, {"wrap_u", FieldType::choice, "", 0, 2, "How a picture goes on to its sides", {"repeat", "clamp", "mirror"}}),
        field(&T::wrap_v, {"wrap_v", FieldType::choice, "", 0, 2, "How a picture goes on above and below", {"repeat", "clamp", "mirror"}}),
        field(&T::filter, {"filter", FieldType::choice, "", 0, 1, "What is between the pixels of a picture seen from near", {"linear", "nearest"}}),
        field(&T::projection, {"projection", FieldType::choice, "", 0, 5,
              "Coordinates: the surface's own, or from the place in the shape's space; solid: the procedure is carved from a block",
              {"uv", "box", "planar", "cylindrical", "spherical", "solid"}}),
        field(&T::set, {"set", FieldType::integer, "", 0, 1, "uv: which of a mesh's two sets of coordinates"}),
        field(&T::size, {"size", FieldType::number, "m", 1e-9, unbounded, "Of one repeat of a picture, of a cell, a ring of wood, a grain of leather or a flake; with uv, coordinates are taken as they are"}),
        field(&T::axis, {"axis", FieldType::vector, "", -unbounded, unbounded, "Of projections but box; of wood and brushed, where they run along; in the shape's space"}),
        field(&T::blend, {"blend", FieldType::number, "", 0, 1, "box: how softly one side goes over into the next"}),
        field(&T::offset_u, {"offset_u", FieldType::number, "", -1e9, 1e9, "Moves coordinates, after scale and rotation"}),
        field(&T::offset_v, {"offset_v", FieldType::number, "", -1e9, 1e9, "Moves coordinates, after scale and rotation; v runs down the picture"}),
        field(&T::rotation, {"rotation", FieldType::angle, "deg", -1e6, 1e6, "Turns coordinates, after scale, counter-clockwise as in glTF"}),
        field(&T::scale_u, {"scale_u", FieldType::number, "", -1e9, 1e9, "Of coordinates: 2 shows a picture twice"}),
        field(&T::scale_v, {"scale_v", FieldType::number, "", -1e9, 1e9, "Of coordinates: 2 shows a picture twice"}),
        field(&T::strength, {"strength", FieldType::number, "", -1000, 1000, "0: nothing of the texture, 1: all; of bump: the height of white over black, in metres; of flakes as normals: the deviation of their slopes"}),
        field(&T::cutoff, {"cutoff", FieldType::number, "", 0, 1, "opacity: what is less is not there, the rest wholly; 0: as it is"}),
        field(&T::color_a, {"color_a", FieldType::color, "", 0, unbounded, "What procedures mix: light cells, smooth metal, early wood"}),
        field(&T::color_b, {"color_b", FieldType::color, "", 0, unbounded, "What procedures mix: dark cells, scratches, late wood"}),
        field(&T::stretch, {"stretch", FieldType::number, "", 1, 10000, "brushed: how long scratches are for their width"}),
    };
    return table;
}

bool Texture::operator==(const Texture& other) const {
    const bool same_image = image == other.image || (image && other.image && image->decoded() == other.image->decoded() &&
                                                     image->content() == other.image->content() && image->source() == other.image->source());
    return same_image && std::all_of(fields().begin(), fields().end(), [&](const auto& f) { return f.get(*this) == f.get(other); });
}

bool may_be_textured(const FieldInfo& field) {
    if (field.type != FieldType::color && field.type != FieldType::number) return false;
    constexpr std::string_view uniform[] = {"ior", "attenuation", "dispersion", "iridescence_ior"};
    return std::none_of(std::begin(uniform), std::end(uniform), [&](std::string_view name) { return field.name == name; });
}

const FieldInfo* textured_field(const Material& material, std::string_view target) {
    return std::visit([&](const auto& model) -> const FieldInfo* {
        for (const auto& f : model.fields()) {
            if (f.info.name == target) return may_be_textured(f.info) ? &f.info : nullptr;
        }
        return nullptr;
    }, material.model);
}

std::vector<std::string> texture_targets(const Material& material) {
    std::vector<std::string> names;
    std::visit([&](const auto& model) {
        for (const auto& f : model.fields()) {
            if (may_be_textured(f.info)) names.push_back(f.info.name);
        }
    }, material.model);
    names.insert(names.end(), std::begin(relief_targets), std::end(relief_targets));
    return names;
}

bool asks_for_tangents(const Material& material) {
    const auto bends = [](const TextureBinding& b) { return b.target == "normal" || b.target == "clearcoat_normal"; };
    const auto* m = std::get_if<PhysicalMaterial>(&material.model);
    return (m && m->anisotropy > 0) || std::any_of(material.textures.begin(), material.textures.end(), bends);
}

}  // namespace crescente::scene
