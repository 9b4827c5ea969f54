#include "io/gltf_material.h"

#include <algorithm>
#include <cmath>
#include <memory>

#include "io/openimageio.h"

namespace crescente::io {
namespace {

using math::Rgb;
using Vector = std::array<double, 3>;

Rgb rgb(const Vector& v) { return {static_cast<float>(v[0]), static_cast<float>(v[1]), static_cast<float>(v[2])}; }

Vector times(const Vector& a, const Vector& b) { return {a[0] * b[0], a[1] * b[1], a[2] * b[2]}; }

scene::Texture of_channel(scene::Texture texture, scene::Channel channel) {
    texture.channel = channel;
    return texture;
}

}  // namespace

GltfMaterials::GltfMaterials(GltfDocument& document) : document_(document) {
    for (const Json& mesh : document_.array("meshes")) {
        const Json* primitives = mesh.find("primitives");
        if (!primitives || !primitives->array()) continue;
        for (const Json& primitive : *primitives->array()) {
            const Json *attributes = primitive.find("attributes"), *material = primitive.find("material");
            if (!attributes || !attributes->find("COLOR_0")) continue;
            const std::int64_t* index = material ? material->integer() : nullptr;
            colored_.insert(index && *index >= 0 ? std::optional(static_cast<std::size_t>(*index)) : std::nullopt);
        }
    }
}

scene::Material GltfMaterials::read(std::optional<std::size_t> which) {
    scene::PhysicalMaterial m;  // the default material, 3.9.6
    m.base_color = {1, 1, 1};
    m.metallic = 1;
    m.roughness = 1;
    m.double_sided = false;
    std::vector<scene::TextureBinding> textures;
    const auto bind = [&](std::string target, scene::Texture texture) { textures.push_back({std::move(target), std::move(texture)}); };
    scene::Texture vertex_colors;
    vertex_colors.kind = scene::TextureKind::vertex_color;
    const bool colored = colored_.contains(which);
    if (!which && colored) bind("base_color", vertex_colors);
    if (!which) return {"", m, std::move(textures)};

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
    const bool unlit = GltfDocument::extension(object, "KHR_materials_unlit") != nullptr;
    std::array<double, 4> base{1, 1, 1, 1};
    std::optional<scene::Texture> base_texture;
    if (const Json* glossy = GltfDocument::extension(object, "KHR_materials_pbrSpecularGlossiness")) {
        base = document_.numbers<4>(*glossy, place, "diffuseFactor", base);
        base_texture = texture(*glossy, place, "diffuseTexture");
        m.metallic = 0;
        m.roughness = 1 - document_.number(*glossy, place, "glossinessFactor", 1);
        if (glossy->find("specularGlossinessTexture")) ++glossy_textures_;
    } else {
        const Json& pbr = member(object, "pbrMetallicRoughness");
        base = document_.numbers<4>(pbr, place, "baseColorFactor", base);
        base_texture = texture(pbr, place, "baseColorTexture");
        m.metallic = document_.number(pbr, place, "metallicFactor", 1);
        m.roughness = document_.number(pbr, place, "roughnessFactor", 1);
        if (const auto both = texture(pbr, place, "metallicRoughnessTexture"); both && !unlit) {
            bind("metallic", of_channel(*both, scene::Channel::blue));
            bind("roughness", of_channel(*both, scene::Channel::green));
        }
    }
    if (auto occlusion = texture(object, place, "occlusionTexture"); occlusion && !unlit) {
        occlusion->strength = document_.number(*object.find("occlusionTexture"), place / "occlusionTexture", "strength", 1);
        bind("occlusion", std::move(*occlusion));
    }
    m.base_color = rgb({base[0], base[1], base[2]});
    const std::string color_target = unlit ? "emissive" : "base_color";
    if (base_texture) bind(color_target, *base_texture);
    if (alpha_mode == "BLEND" || alpha_mode == "MASK") {
        const double cutoff = alpha_mode == "MASK" ? std::clamp(document_.number(object, place, "alphaCutoff", 0.5), 0.0, 1.0) : 0;
        m.opacity = base[3];
        if (base_texture) bind("opacity", of_channel(*base_texture, scene::Channel::alpha));
        if (colored) bind("opacity", of_channel(vertex_colors, scene::Channel::alpha));
        if (base_texture || colored) textures.back().texture.cutoff = cutoff;
        else if (cutoff > 0) m.opacity = base[3] >= cutoff ? 1 : 0;
    }
    if (colored) bind(color_target, vertex_colors);
    if (auto normal = texture(object, place, "normalTexture"); normal && !unlit) {
        normal->strength = document_.number(*object.find("normalTexture"), place / "normalTexture", "scale", 1);
        bind("normal", std::move(*normal));
    }

    const Vector emissive = document_.numbers<3>(object, place, "emissiveFactor", {0, 0, 0});
    const double strength = document_.number(extension("KHR_materials_emissive_strength"), place, "emissiveStrength", 1);
    m.emissive = rgb(times(emissive, {strength, strength, strength}));
    if (auto glow = texture(object, place, "emissiveTexture"); glow && !unlit && !math::is_black(m.emissive)) bind("emissive", std::move(*glow));

    m.ior = document_.number(extension("KHR_materials_ior"), place, "ior", 1.5);  // 0: infinite
    const Json& transmission = extension("KHR_materials_transmission");
    m.transmission = document_.number(transmission, place, "transmissionFactor", 0);
    if (auto share = texture(transmission, place, "transmissionTexture"); share && m.transmission > 0) bind("transmission", std::move(*share));

    const Json& clearcoat = extension("KHR_materials_clearcoat");
    m.clearcoat = document_.number(clearcoat, place, "clearcoatFactor", 0);
    m.clearcoat_roughness = document_.number(clearcoat, place, "clearcoatRoughnessFactor", 0);
    if (auto coat = texture(clearcoat, place, "clearcoatTexture"); coat && m.clearcoat > 0) bind("clearcoat", of_channel(*coat, scene::Channel::red));
    if (auto rough = texture(clearcoat, place, "clearcoatRoughnessTexture"); rough && m.clearcoat > 0) {
        bind("clearcoat_roughness", of_channel(*rough, scene::Channel::green));
    }

    if (auto bumps = texture(clearcoat, place, "clearcoatNormalTexture"); bumps && m.clearcoat > 0) {
        bumps->strength = document_.number(*clearcoat.find("clearcoatNormalTexture"), place / "clearcoatNormalTexture", "scale", 1);
        bind("clearcoat_normal", std::move(*bumps));
    }

    const Json& specular = extension("KHR_materials_specular");
    m.specular = document_.number(specular, place, "specularFactor", 1);
    m.specular_color = rgb(document_.numbers<3>(specular, place, "specularColorFactor", {1, 1, 1}));
    if (auto share = texture(specular, place, "specularTexture"); share && !unlit) bind("specular", of_channel(*share, scene::Channel::alpha));
    if (auto tint = texture(specular, place, "specularColorTexture"); tint && !unlit) bind("specular_color", std::move(*tint));

    const Json& sheen = extension("KHR_materials_sheen");
    m.sheen_color = rgb(document_.numbers<3>(sheen, place, "sheenColorFactor", {0, 0, 0}));
    m.sheen_roughness = document_.number(sheen, place, "sheenRoughnessFactor", 0);
    if (!math::is_black(m.sheen_color)) {
        if (auto tint = texture(sheen, place, "sheenColorTexture")) bind("sheen_color", std::move(*tint));
        if (auto rough = texture(sheen, place, "sheenRoughnessTexture")) bind("sheen_roughness", of_channel(*rough, scene::Channel::alpha));
    }

    const Json& anisotropy = extension("KHR_materials_anisotropy");
    m.anisotropy = document_.number(anisotropy, place, "anisotropyStrength", 0);
    m.anisotropy_rotation = document_.number(anisotropy, place, "anisotropyRotation", 0);
    if (auto grain = texture(anisotropy, place, "anisotropyTexture"); grain && m.anisotropy > 0) {
        bind("anisotropy", of_channel(*grain, scene::Channel::blue));
        bind("grain", std::move(*grain));
    }
    if (m.anisotropy > 0) m.grain = scene::Grain::surface;

    const Json& iridescence = extension("KHR_materials_iridescence");
    m.iridescence = document_.number(iridescence, place, "iridescenceFactor", 0);
    if (m.iridescence > 0) {
        m.iridescence_ior = document_.number(iridescence, place, "iridescenceIor", 1.3);
        m.iridescence_thickness = document_.number(iridescence, place, "iridescenceThicknessMaximum", 400);
        if (auto share = texture(iridescence, place, "iridescenceTexture")) bind("iridescence", of_channel(*share, scene::Channel::red));
        if (auto thick = texture(iridescence, place, "iridescenceThicknessTexture")) {
            // From least to most, as the most times what the texture's strength makes of it.
            const double least = document_.number(iridescence, place, "iridescenceThicknessMinimum", 100);
            if (m.iridescence_thickness > 0) thick->strength = std::clamp(1 - least / m.iridescence_thickness, -1000.0, 1000.0);
            bind("iridescence_thickness", of_channel(*thick, scene::Channel::green));
        }
    }
    m.dispersion = document_.number(extension("KHR_materials_dispersion"), place, "dispersion", 0);

    const Json& volume = extension("KHR_materials_volume");
    if (const double thickness = document_.number(volume, place, "thicknessFactor", 0); thickness == 0 && m.transmission > 0) m.dispersion = 0;  // a thin wall bends nothing
    const double distance = document_.number(volume, place, "attenuationDistance", 0);  // absent: infinite
    if (distance > 0) {
        const Vector color = document_.numbers<3>(volume, place, "attenuationColor", {1, 1, 1});
        Vector absorbed;
        for (std::size_t c = 0; c < 3; ++c) absorbed[c] = std::log(1 / std::clamp(color[c], 1e-6, 1.0)) / distance;
        m.attenuation = rgb(absorbed);
    }
    m.double_sided = document_.boolean(object, place, "doubleSided", false);
    if (unlit) {
        m.emissive = m.base_color;
        m.base_color = {0, 0, 0};
        m.metallic = 0;
        m.roughness = 1;
        m.specular = 0, m.specular_color = {1, 1, 1}, m.clearcoat = 0, m.sheen_color = {0, 0, 0}, m.iridescence = 0, m.transmission = 0, m.anisotropy = 0, m.dispersion = 0;
        const auto is_light = [](const scene::TextureBinding& b) { return b.target == "emissive" || b.target == "opacity"; };
        std::erase_if(textures, [&](const scene::TextureBinding& b) { return !is_light(b); });
    }
    return {document_.text(object, place, "name"), m, std::move(textures)};
}

std::shared_ptr<const scene::TextureImage> GltfMaterials::image(std::size_t which) {
    const auto [known, is_new] = images_.try_emplace(which);
    if (!is_new) return known->second;
    // Many images may name one piece of a buffer: it is kept once.
    const Json& object = document_.array("images")[which];
    const Json* view = object.find("uri") ? nullptr : object.find("bufferView");
    const std::int64_t* piece = view ? view->integer() : nullptr;
    if (piece && pieces_.contains(*piece)) return known->second = pieces_.at(*piece);
    if (auto source = document_.image_source(which)) known->second = std::make_shared<const scene::TextureImage>(std::move(*source));
    if (piece) pieces_.emplace(*piece, known->second);
    return known->second;
}

std::optional<scene::Texture> GltfMaterials::texture(const Json& owner, const Place& owner_place, std::string_view key) {
    const Json* info = owner.find(key);
    if (!info) return std::nullopt;
    const Place place = owner_place / key, root, list = root / "textures", samplers = root / "samplers";
    const Json::Array& textures = document_.array("textures");
    const auto index = document_.index(*info, place, "index", textures.size());
    if (!index) return std::nullopt;
    const Json& object = textures[*index];
    const Json* webp = has_openimageio() && !object.find("source") ? GltfDocument::extension(object, "EXT_texture_webp") : nullptr;
    const Json& shows = webp && webp->find("source") ? *webp : object;
    if (!shows.find("source")) {
        const Json* extensions = object.find("extensions");
        if (extensions && extensions->object()) {
            for (const auto& member : *extensions->object()) other_sources_.insert(member.key.substr(0, 100));
        }
        ++without_source_;
        return std::nullopt;
    }
    const auto source = document_.index(shows, list / *index, "source", document_.array("images").size());
    scene::Texture texture;
    texture.image = source ? image(*source) : nullptr;
    if (!texture.image) return std::nullopt;

    const Json* transform = GltfDocument::extension(*info, "KHR_texture_transform");
    double set = document_.number(*info, place, "texCoord", 0);
    if (transform) {
        const Place here = place / "KHR_texture_transform";
        const auto offset = document_.numbers<2>(*transform, here, "offset", {0, 0}), scale = document_.numbers<2>(*transform, here, "scale", {1, 1});
        texture.offset_u = offset[0], texture.offset_v = offset[1], texture.scale_u = scale[0], texture.scale_v = scale[1];
        texture.rotation = document_.number(*transform, here, "rotation", 0);
        set = document_.number(*transform, here, "texCoord", set);
    }
    if (!(set == 0 || set == 1)) {
        document_.problems.add(*info, place / "texCoord", "must be 0 or 1: two sets of texture coordinates are read");
        return std::nullopt;
    }
    texture.set = static_cast<int>(set);

    if (const auto sampler = document_.index(object, list / *index, "sampler", document_.array("samplers").size())) {
        const Json& how = document_.array("samplers")[*sampler];
        const auto wrap = [&](std::string_view member) {
            const double code = document_.number(how, samplers / *sampler, member, 10497);
            if (code == 33071) return scene::Wrap::clamp;
            if (code == 33648) return scene::Wrap::mirror;
            if (code != 10497) document_.problems.add(how, samplers / *sampler, "has a wrap mode that glTF does not know");
            return scene::Wrap::repeat;
        };
        texture.wrap_u = wrap("wrapS"), texture.wrap_v = wrap("wrapT");
        if (document_.number(how, samplers / *sampler, "magFilter", 9729) == 9728) texture.filter = scene::TextureFilter::nearest;
    }
    return texture;
}

void GltfMaterials::warn_of_textures() {
    if (glossy_textures_ > 0) document_.warn(std::to_string(glossy_textures_) + " textures of specular colour and glossiness are left out: their factors are taken");
    if (without_source_ == 0) return;
    std::string names;
    for (const std::string& name : other_sources_) {
        const std::string_view format = name == "KHR_texture_basisu" ? " (KTX2, Basis Universal)" : name == "EXT_texture_webp" || name == "GOOGLE_texture_webp" ? " (WebP)" : name == "MSFT_texture_dds" ? " (DDS)" : "";
        names += (names.empty() ? "" : ", ") + name + std::string(format);
    }
    document_.warn(std::to_string(without_source_) + " textures are left out: " + (names.empty() ? "they name no picture" : "they have their picture only in an extension that is not read: " + names));
}

}  // namespace crescente::io
