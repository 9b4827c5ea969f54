#include "io/assimp_material.h"

#ifdef CRESCENTE_WITH_ASSIMP

#include <algorithm>
#include <cmath>
#include <string_view>

#include <assimp/ObjMaterial.h>

#include "io/text_file.h"

namespace crescente::io {
namespace {

using math::Rgb;

std::optional<double> number(const aiMaterial& material, const char* key, unsigned type, unsigned index) {
    ai_real value = 0;
    if (material.Get(key, type, index, value) != aiReturn_SUCCESS || !std::isfinite(value)) return std::nullopt;
    return value;
}

std::optional<Rgb> color(const aiMaterial& material, const char* key, unsigned type, unsigned index) {
    aiColor3D value;
    if (material.Get(key, type, index, value) != aiReturn_SUCCESS) return std::nullopt;
    const Rgb rgb{value.r, value.g, value.b};
    if (!is_finite(rgb)) return std::nullopt;
    return Rgb{std::max(rgb.r, 0.0f), std::max(rgb.g, 0.0f), std::max(rgb.b, 0.0f)};
}

Rgb at_most_one(Rgb c) { return {std::min(c.r, 1.0f), std::min(c.g, 1.0f), std::min(c.b, 1.0f)}; }

// The roughness whose highlight is as wide as that of a Phong exponent: alpha^2 = 2 / (n + 2) (Walter et al. 2007, "Microfacet Models for
// Refraction through Rough Surfaces", section 5.2, by way of Blinn's), and alpha = roughness^2.
double roughness_of_exponent(double n) { return std::clamp(std::pow(2 / (std::max(n, 0.0) + 2), 0.25), 0.0, 1.0); }

// Wavefront MTL: which illumination models refract (4, 6, 7, 9: glass).
bool refracts(const aiMaterial& material) {
    int model = 0;
    return material.Get(AI_MATKEY_OBJ_ILLUM, model) == aiReturn_SUCCESS && (model == 4 || model == 6 || model == 7 || model == 9);
}

scene::Wrap wrap(const aiMaterial& material, aiTextureType type, bool vertical) {
    int mode = aiTextureMapMode_Wrap;
    if (vertical) material.Get(AI_MATKEY_MAPPINGMODE_V(type, 0), mode);
    else material.Get(AI_MATKEY_MAPPINGMODE_U(type, 0), mode);
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? scene::Wrap::clamp : mode == aiTextureMapMode_Mirror ? scene::Wrap::mirror : scene::Wrap::repeat;
}

// Those that have a file in the folder, and are laid on by the first set of coordinates.
void read_textures(const aiMaterial& material, const std::filesystem::path& folder, scene::Material& result) {
    struct Kind {
        aiTextureType type;
        const char* target;
        scene::Channel channel;
    };
    constexpr Kind kinds[] = {{aiTextureType_BASE_COLOR, "base_color", scene::Channel::automatic}, {aiTextureType_DIFFUSE, "base_color", scene::Channel::automatic},
                              {aiTextureType_EMISSIVE, "emissive", scene::Channel::automatic},     {aiTextureType_OPACITY, "opacity", scene::Channel::red},
                              {aiTextureType_METALNESS, "metallic", scene::Channel::red},          {aiTextureType_DIFFUSE_ROUGHNESS, "roughness", scene::Channel::red},
                              {aiTextureType_NORMALS, "normal", scene::Channel::automatic}};
    for (const Kind& kind : kinds) {
        aiString path;
        unsigned set = 0;
        if (material.GetTexture(kind.type, 0, &path, nullptr, &set) != aiReturn_SUCCESS || set != 0) continue;
        std::string name = path.C_Str();
        std::replace(name.begin(), name.end(), '\\', '/');
        const bool again = std::any_of(result.textures.begin(), result.textures.end(), [&](const scene::TextureBinding& b) { return b.target == kind.target; });
        if (again || name.empty() || name.front() == '*' || !stays_in_folder(name)) continue;
        scene::Texture texture;
        texture.channel = kind.channel;
        texture.wrap_u = wrap(material, kind.type, false), texture.wrap_v = wrap(material, kind.type, true);
        texture.image = std::make_shared<const scene::TextureImage>(scene::ImageSource{(folder / name).string(), {}, "material '" + result.name + "'"});
        result.textures.push_back({kind.target, std::move(texture)});
    }
}

}  // namespace

std::optional<scene::Material> physical_material(const aiMaterial& material, const std::filesystem::path& folder) {
    scene::Material result;
    aiString name;
    if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) result.name = name.C_Str();
    auto& m = std::get<scene::PhysicalMaterial>(result.model);

    const Rgb diffuse = color(material, AI_MATKEY_COLOR_DIFFUSE).value_or(Rgb{0.6f, 0.6f, 0.6f});
    const bool is_grey = diffuse.r == diffuse.g && diffuse.g == diffuse.b;
    if ((result.name.empty() || result.name == AI_DEFAULT_MATERIAL_NAME) && is_grey && texture_count(material) == 0) return std::nullopt;
    m.base_color = at_most_one(color(material, AI_MATKEY_BASE_COLOR).value_or(diffuse));

    const auto metallic = number(material, AI_MATKEY_METALLIC_FACTOR), roughness = number(material, AI_MATKEY_ROUGHNESS_FACTOR);
    if (metallic || roughness) {
        m.metallic = std::clamp(metallic.value_or(0), 0.0, 1.0);
        m.roughness = std::clamp(roughness.value_or(0.5), 0.0, 1.0);
    } else {
        const double strength = number(material, AI_MATKEY_SHININESS_STRENGTH).value_or(1);
        const Rgb specular = color(material, AI_MATKEY_COLOR_SPECULAR).value_or(Rgb{}) * static_cast<float>(std::clamp(strength, 0.0, 1.0));
        const double exponent = number(material, AI_MATKEY_SHININESS).value_or(0);
        m.roughness = is_black(specular) ? 1 : roughness_of_exponent(exponent);
        constexpr float dark = 0.04f, bright = 0.3f;  // no body colour but a strong highlight: a metal
        if (max_component(m.base_color) <= dark && max_component(specular) >= bright) {
            m.base_color = at_most_one(specular);
            m.metallic = 1;
        }
    }
    if (const auto emissive = color(material, AI_MATKEY_COLOR_EMISSIVE)) m.emissive = *emissive;
    const auto ior = number(material, AI_MATKEY_REFRACTI);
    if (ior && *ior > 1) m.ior = std::min(*ior, 10.0);
    const double opacity = std::clamp(number(material, AI_MATKEY_OPACITY).value_or(1), 0.0, 1.0);
    if (refracts(material) && opacity < 1) m.transmission = 1 - opacity;
    else m.opacity = opacity;
    if (const auto transmission = number(material, AI_MATKEY_TRANSMISSION_FACTOR)) m.transmission = std::clamp(*transmission, 0.0, 1.0);
    read_textures(material, folder, result);
    return result;
}

std::size_t texture_count(const aiMaterial& material) {
    std::size_t count = 0;
    for (int type = aiTextureType_NONE; type <= AI_TEXTURE_TYPE_MAX; ++type) {
        count += material.GetTextureCount(static_cast<aiTextureType>(type));
    }
    return count;
}

}  // namespace crescente::io

#endif
