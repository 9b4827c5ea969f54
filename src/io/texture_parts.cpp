#include "io/texture_parts.h"

#include "base/spelling.h"
#include "io/base64.h"

namespace crescente::io {
namespace {

using nlohmann::ordered_json;
constexpr std::string_view embedded = "data:;base64,";

std::shared_ptr<const scene::TextureImage> read_image(const Json& json, const Place& place, ProblemList& problems) {
    const auto wrong = [&](std::string reason) {
        problems.add(json, place, std::move(reason));
        return nullptr;
    };
    if (!json.text() || json.text()->empty() || json.text()->find('\0') != std::string::npos) return wrong("is " + std::string(json.kind()) + ", must be the path of a picture");
    const std::string& text = *json.text();
    if (!text.starts_with("data:")) return std::make_shared<const scene::TextureImage>(scene::ImageSource{text, {}, place.pointer()});
    const std::size_t comma = text.find(',');
    if (comma == std::string::npos || !std::string_view(text).substr(0, comma).ends_with(";base64")) return wrong("a data URI must be base64");
    auto bytes = decode_base64(std::string_view(text).substr(comma + 1));
    if (!bytes) return wrong("the data URI is not base64");
    return std::make_shared<const scene::TextureImage>(scene::ImageSource{{}, std::move(*bytes), place.pointer()});
}

scene::Texture read_texture(const Json& json, const Measure& measure, const Place& place, ProblemList& problems) {
    scene::Texture texture;
    const auto own = names_of(texture_words());
    read_fields(json, texture, scene::Texture::fields(), measure, place, problems, own);
    const Json* image = json.find("image");
    if (image) texture.image = read_image(*image, place / "image", problems);
    else if (json.object() && texture.kind == scene::TextureKind::image) problems.add(json, place, "'image' is missing", "or another kind: checker, noise, brushed, wood, leather, flakes");
    if (image && texture.kind != scene::TextureKind::image) problems.add(json, place, "has a picture, which its kind does not show");
    return texture;
}

}  // namespace

std::span<const Word> texture_words() {
    static const std::vector<Word> words{
        {"image", "path, or data:;base64,...", "The picture, of any format that OpenImageIO reads; relative to this file. Its upper left corner is at u = v = 0"},
    };
    return words;
}

namespace {

void find_images_in(scene::Material& material, const std::filesystem::path& folder) {
    for (scene::TextureBinding& binding : material.textures) {
        const scene::TextureImage* image = binding.texture.image.get();
        if (!image || image->source().file.empty()) continue;
        scene::ImageSource source = image->source();
        source.file = (folder / source.file).string();
        binding.texture.image = std::make_shared<const scene::TextureImage>(std::move(source));
    }
}

}  // namespace

void read_textures(const Json& json, scene::Material& material, const Measure& measure, const Place& place, ProblemList& problems) {
    if (!json.object()) return problems.add(json, place, "is " + std::string(json.kind()) + ", must be an object");
    const auto targets = scene::texture_targets(material);
    for (const auto& member : *json.object()) {
        const Place here = place / member.key;
        if (std::find(targets.begin(), targets.end(), member.key) == targets.end()) {
            unknown_member(member, place, targets, problems);
            continue;
        }
        if (!member.value.array()) {
            material.textures.push_back({member.key, read_texture(member.value, measure, here, problems)});
            continue;
        }
        std::size_t index = 0;
        for (const Json& one : *member.value.array()) material.textures.push_back({member.key, read_texture(one, measure, here / index++, problems)});
    }
    find_images_in(material, std::filesystem::path(problems.file()).parent_path());
}

ordered_json write_textures(const scene::Material& material, const Measure& measure) {
    ordered_json all = ordered_json::object();
    for (const scene::TextureBinding& binding : material.textures) {
        ordered_json one = ordered_json::object();
        if (const scene::TextureImage* image = binding.texture.image.get()) {
            const scene::ImageSource& source = image->source();
            one["image"] = source.file.empty() ? std::string(embedded) + encode_base64(source.bytes) : std::filesystem::absolute(source.file).string();
        }
        write_fields(binding.texture, scene::Texture::fields(), measure, one);
        ordered_json& list = all[binding.target];
        if (list.is_null()) list = ordered_json::array();
        list.push_back(std::move(one));
    }
    for (auto& [target, list] : all.items()) {
        if (list.size() == 1) list = ordered_json(list[0]);
    }
    return all;
}

ordered_json textures_schema(const scene::Material& model) {
    const ordered_json one{{"$ref", "#/$defs/texture"}};
    ordered_json properties = ordered_json::object();
    for (const std::string& target : scene::texture_targets(model)) properties[target] = {{"anyOf", {one, {{"type", "array"}, {"items", one}}}}};
    return {{"type", "object"}, {"properties", properties}, {"additionalProperties", false}};
}

}  // namespace crescente::io
