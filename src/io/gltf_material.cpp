#include "io/gltf_material.h"

#include <algorithm>
#include <cmath>

namespace crescente::io {
namespace {

using math::Rgb;
using Vector = std::array<double, 3>;

Rgb rgb(const Vector& v) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}; }

Vector times(const Vector& a, const Vector& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

}  // namespace

scene::Material GltfMaterials::read(std::optional<std::size_t> which) {
    scene::PhysicalMaterial m;  // the default material, 3.9.6
    m.base_color = {1, 1, 1};
    m.metallic = 1;
    m.roughness = 1;
    m.double_sided = false;
    if (!which) return {"", m};

    const Place root, list = root / "materials", place = list / *which;
    const Json& object = document_.array("materials")[*which];
    static const Json nothing = Json::make_object();
    const auto member = [&](const Json& of, std::string_view key) -> const Json& {
        const Json* found = of.find(key);
        return found ? *found : nothing;
    };
    const auto extension = [&](std::string_view name) -> const Json& {
        const Json* found = GltfDocument::extension(object, name);
        return found ? *found : nothing;
    };

    const std::string alpha_mode = document_.text(object, place, "alphaMode");
    const double cutoff = document_.number(object, place, "alphaCutoff", 0.5);
    std::array<double, 4> base{1, 1, 1, 1};
    double texture_cutoff = 0.5;
    const auto apply_base = [&](const Json& of, std::string_view factor, std::string_view texture) {
        base = document_.numbers<4>(of, place, factor, base);
        texture_cutoff = base[3] > 0 ? cutoff / base[3] : 2;
        return mean(of, place, texture, texture_cutoff);
    };

    std::optional<ImageMean> color_mean;
    if (const Json* glossy = GltfDocument::extension(object, "KHR_materials_pbrSpecularGlossiness")) {
        color_mean = apply_base(*glossy, "diffuseFactor", "diffuseTexture");
        m.metallic = 0;
        m.roughness = 1 - document_.number(*glossy, place, "glossinessFactor", 1);
    } else {
        const Json& pbr = member(object, "pbrMetallicRoughness");
        color_mean = apply_base(pbr, "baseColorFactor", "baseColorTexture");
        m.metallic = document_.number(pbr, place, "metallicFactor", 1);
        m.roughness = document_.number(pbr, place, "roughnessFactor", 1);
        if (const auto texture = mean(pbr, place, "metallicRoughnessTexture")) {
            m.roughness *= texture->data[1];
            m.metallic *= texture->data[2];
        }
    }
    m.base_color = rgb({base[0], base[1], base[2]});
    if (color_mean) m.base_color = rgb(times({base[0], base[1], base[2]}, color_mean->color));
    if (alpha_mode == "BLEND") m.opacity = base[3] * (color_mean ? color_mean->alpha : 1);
    if (alpha_mode == "MASK") m.opacity = color_mean ? color_mean->covered : base[3] >= cutoff ? 1 : 0;

    Vector emissive = document_.numbers<3>(object, place, "emissiveFactor", {0, 0, 0});
    if (const auto texture = mean(object, place, "emissiveTexture")) emissive = times(emissive, texture->color);
    const double strength = document_.number(extension("KHR_materials_emissive_strength"), place, "emissiveStrength", 1);
    m.emissive = rgb(times(emissive, {strength, strength, strength}));

    m.ior = document_.number(extension("KHR_materials_ior"), place, "ior", 1.5);
    const Json& transmission = extension("KHR_materials_transmission");
    m.transmission = document_.number(transmission, place, "transmissionFactor", 0);
    if (const auto texture = mean(transmission, place, "transmissionTexture")) m.transmission *= texture->data[0];

    const Json& clearcoat = extension("KHR_materials_clearcoat");
    m.clearcoat = document_.number(clearcoat, place, "clearcoatFactor", 0);
    m.clearcoat_roughness = document_.number(clearcoat, place, "clearcoatRoughnessFactor", 0);
    if (const auto texture = mean(clearcoat, place, "clearcoatTexture")) m.clearcoat *= texture->data[0];
    if (const auto texture = mean(clearcoat, place, "clearcoatRoughnessTexture")) m.clearcoat_roughness *= texture->data[1];

    const Json& volume = extension("KHR_materials_volume");
    const double distance = document_.number(volume, place, "attenuationDistance", 0);  // absent: infinite
    if (distance > 0) {
        const Vector color = document_.numbers<3>(volume, place, "attenuationColor", {1, 1, 1});
        Vector absorbed;
        for (std::size_t c = 0; c < 3; ++c) absorbed[c] = std::log(1 / std::clamp(color[c], 1e-6, 1.0)) / distance;
        m.attenuation = rgb(absorbed);
    }
    m.double_sided = document_.boolean(object, place, "doubleSided", false);
    if (GltfDocument::extension(object, "KHR_materials_unlit")) {
        m.emissive = m.base_color;
        m.base_color = {0, 0, 0};
        m.metallic = 0;
        m.roughness = 1;
    }
    for (const std::string_view unused : {"normalTexture", "occlusionTexture"}) {
        if (const Json* info = object.find(unused)) {
            if (const auto texture = document_.index(*info, place, "index", document_.array("textures").size())) textures_.try_emplace(*texture, false);
        }
    }
    return {document_.text(object, place, "name"), m};
}

std::optional<ImageMean> GltfMaterials::mean(const Json& owner, const Place& place, std::string_view key, double alpha_cutoff) {
    const Json* info = owner.find(key);
    if (!info) return std::nullopt;
    const Json::Array& textures = document_.array("textures");
    const auto texture = document_.index(*info, place / key, "index", textures.size());
    if (!texture) return std::nullopt;
    bool& stands_in = textures_.try_emplace(*texture, false).first->second;
    const Place root, list = root / "textures";
    const auto image = document_.index(textures[*texture], list / *texture, "source", document_.array("images").size());
    if (!image) return std::nullopt;
    const auto [known, is_new] = means_.try_emplace({*image, alpha_cutoff});
    if (is_new) known->second = mean_of_image(document_.image_bytes(*image), alpha_cutoff, pixels_left_);
    if (known->second) stands_in = true;
    return known->second;
}

void GltfMaterials::warn_of_textures() {
    if (textures_.empty()) return;
    const auto means = static_cast<std::size_t>(std::count_if(textures_.begin(), textures_.end(), [](const auto& t) { return t.second; }));
    document_.warn(std::to_string(textures_.size()) + " textures are not applied: of " + std::to_string(means) +
                   " the mean stands in, of the others nothing but the factor");
}

}  // namespace crescente::io
