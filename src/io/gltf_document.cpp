#include "io/gltf_document.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "io/base64.h"
#include "io/text_file.h"

namespace crescente::io {
namespace {

static_assert(std::endian::native == std::endian::little, "glTF buffers are little-endian and read in place");

template <class T>
T load(const unsigned char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return value;
}

std::size_t component_size(std::int64_t type) {
    switch (type) {
        case 5120: case 5121: return 1;
        case 5122: case 5123: return 2;
        case 5125: case 5126: return 4;
        default: return 0;
    }
}

int components_of(std::string_view type) {
    constexpr std::pair<std::string_view, int> types[] = {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4},
                                                          {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
    for (const auto& [name, components] : types) {
        if (type == name) return components;
    }
    return 0;
}

std::string outside_folder(const std::string& name) { return "'" + name.substr(0, 100) + "' is refused: only files in the folder of this file are read"; }

// RFC 3986, section 2.1.
std::string decode_percent(std::string_view text) {
    const auto digit = [](char c) { return c >= '0' && c <= '9' ? c - '0' : (c | 32) >= 'a' && (c | 32) <= 'f' ? (c | 32) - 'a' + 10 : -1; };
    std::string result;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%' && i + 2 < text.size() && digit(text[i + 1]) >= 0 && digit(text[i + 2]) >= 0) {
            result.push_back(static_cast<char>(digit(text[i + 1]) * 16 + digit(text[i + 2])));
            i += 2;
        } else {
            result.push_back(text[i]);
        }
    }
    return result;
}

}  // namespace

const unsigned char* GltfAccessor::element_at(std::size_t element) const {
    if (!replaced.empty()) {
        const auto found = std::lower_bound(replaced.begin(), replaced.end(), element);
        if (found != replaced.end() && *found == element) {
            return replacements + static_cast<std::size_t>(found - replaced.begin()) * component_size(component_type) *
                                      static_cast<std::size_t>(components);
        }
    }
    return data ? data + element * stride : nullptr;
}

double GltfAccessor::number(std::size_t element, int component) const {
    const unsigned char* at = element_at(element);
    if (!at) return 0;
    at += component_size(component_type) * static_cast<std::size_t>(component);
    switch (component_type) {  // 3.6.2.2: how normalised integers are decoded
        case 5120: return normalized ? std::max(load<std::int8_t>(at) / 127.0, -1.0) : load<std::int8_t>(at);
        case 5121: return normalized ? *at / 255.0 : *at;
        case 5122: return normalized ? std::max(load<std::int16_t>(at) / 32767.0, -1.0) : load<std::int16_t>(at);
        case 5123: return normalized ? load<std::uint16_t>(at) / 65535.0 : load<std::uint16_t>(at);
        case 5125: return load<std::uint32_t>(at);
        default: return load<float>(at);
    }
}

std::uint32_t GltfAccessor::integer(std::size_t element) const {
    const unsigned char* at = element_at(element);
    if (!at) return 0;
    return component_type == 5121 ? *at : component_type == 5123 ? load<std::uint16_t>(at) : load<std::uint32_t>(at);
}

GltfDocument::GltfDocument(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder)
    : problems(file_name), folder_(folder), total_bytes_(bytes.size()) {
    if (!open_container(bytes)) return;
    const Json* asset = root_.find("asset");
    const std::string version = asset ? text(*asset, Place{} / "asset", "version") : std::string{};
    if (!asset) problems.add("/asset", "is missing: this is not glTF 2.0");
    else if (!version.starts_with("2.")) problems.add("/asset/version", "is '" + version.substr(0, 20) + "', but only glTF 2.x is read");
    if (problems.empty()) load_buffers();
}

// 4.4: header of 12 bytes, then chunks of length, type and content.
bool GltfDocument::open_container(std::string_view bytes) {
    std::string_view json = bytes;
    if (bytes.starts_with("glTF")) {
        const auto word = [&](std::size_t at) { return load<std::uint32_t>(reinterpret_cast<const unsigned char*>(bytes.data()) + at); };
        constexpr std::size_t header = 12, chunk_header = 8;
        constexpr std::uint32_t json_chunk = 0x4E4F534A, bin_chunk = 0x004E4942;
        if (bytes.size() < header + chunk_header) return problems.add("", "the file ends inside its header"), false;
        if (word(4) != 2) return problems.add("byte 4", "version " + std::to_string(word(4)) + " of the container is not known"), false;
        if (word(8) > bytes.size()) {
            problems.add("", "the file is cut: " + std::to_string(bytes.size()) + " of " + std::to_string(word(8)) + " bytes are there");
            return false;
        }
        bytes = bytes.substr(0, word(8));
        json = {};
        for (std::size_t at = header; at + chunk_header <= bytes.size();) {
            const std::size_t length = word(at);
            const std::uint32_t type = word(at + 4);
            const std::string place = "byte " + std::to_string(at);
            at += chunk_header;
            if (length > bytes.size() - at) return problems.add(place, "a chunk is longer than the file"), false;
            if (json.empty() && type != json_chunk) return problems.add(place, "the first chunk must be JSON"), false;
            if (json.empty()) json = bytes.substr(at, length);
            else if (type == bin_chunk && binary_chunk_.empty()) binary_chunk_ = bytes.substr(at, length);
            at += length;
        }
    }
    if (json.starts_with("\xEF\xBB\xBF")) json.remove_prefix(3);
    std::optional<Json> root = parse_json(json, problems);
    if (!root) return false;
    if (!root->object()) return problems.add("", "this is not glTF: an object is expected"), false;
    root_ = std::move(*root);
    return true;
}

void GltfDocument::load_buffers() {
    const Json::Array& buffers = array("buffers");
    loaded_.reserve(buffers.size());  // views into them must stay valid
    for (std::size_t i = 0; i < buffers.size(); ++i) {
        const Place root, list = root / "buffers", place = list / i;
        const auto length = size(buffers[i], place, "byteLength", 0);
        std::string_view content;
        if (buffers[i].find("uri")) {
            std::string reason;
            auto bytes = load_uri(text(buffers[i], place, "uri"), reason);
            if (!bytes) {
                problems.add(buffers[i], place / "uri", reason);
            } else {
                content = loaded_.emplace_back(std::move(*bytes));
                total_bytes_ += content.size();
            }
        } else if (i == 0) {
            content = binary_chunk_;
        }
        if (length && *length > content.size() && problems.empty()) {
            problems.add(buffers[i], place, "has " + std::to_string(content.size()) + " bytes, but declares " + std::to_string(*length));
        }
        buffers_.push_back(content.substr(0, length.value_or(0)));
    }
}

std::optional<std::string> GltfDocument::load_uri(const std::string& uri, std::string& reason) const {
    if (uri.starts_with("data:")) {
        const std::size_t comma = uri.find(',');
        if (comma == std::string::npos || !uri.substr(0, comma).ends_with(";base64")) {
            reason = "a data URI must be base64";
            return std::nullopt;
        }
        auto bytes = decode_base64(std::string_view(uri).substr(comma + 1));
        if (!bytes) reason = "the data URI is not base64";
        return bytes;
    }
    const std::string name = decode_percent(uri);
    if (!stays_in_folder(name)) {
        reason = outside_folder(name);
        return std::nullopt;
    }
    auto bytes = read_whole_file(folder_ / name);
    if (bytes) return std::move(*bytes);
    reason = "'" + name.substr(0, 100) + "': " + bytes.error().problems.front().reason;
    return std::nullopt;
}

const Json::Array& GltfDocument::array(std::string_view name) const {
    static const Json::Array none;
    const Json* member = root_.find(name);
    return member && member->array() ? *member->array() : none;
}

const Json* GltfDocument::extension(const Json& object, std::string_view name) {
    const Json* extensions = object.find("extensions");
    return extensions ? extensions->find(name) : nullptr;
}

std::optional<std::size_t> GltfDocument::size(const Json& object, const Place& place, std::string_view key, std::size_t otherwise) {
    const Json* member = object.find(key);
    if (!member) return otherwise;
    const std::int64_t* value = member->integer();
    const auto number = member->number();  // exporters write 12.0 too
    if (value && *value >= 0) return static_cast<std::size_t>(*value);
    if (!value && number && *number >= 0 && *number < 9e15 && *number == std::floor(*number)) return static_cast<std::size_t>(*number);
    problems.add(*member, place / key, "must be a whole number, not negative");
    return std::nullopt;
}

std::optional<std::size_t> GltfDocument::index(const Json& object, const Place& place, std::string_view key, std::size_t limit) {
    if (!object.find(key)) return std::nullopt;
    const auto value = size(object, place, key, 0);
    if (value && *value >= limit) {
        problems.add(*object.find(key), place / key, "points at " + std::to_string(*value) + ", but there are only " + std::to_string(limit));
        return std::nullopt;
    }
    return value;
}

double GltfDocument::number(const Json& object, const Place& place, std::string_view key, double otherwise) {
    double value = otherwise;
    if (const Json* member = object.find(key)) {
        const auto given = member->number();
        if (given && std::isfinite(*given)) value = *given;
        else problems.add(*member, place / key, "must be a number");
    }
    return value;
}

void GltfDocument::numbers_into(const Json& object, const Place& place, std::string_view key, double* values, std::size_t n) {
    const Json* member = object.find(key);
    if (!member) return;
    if (!member->array() || member->array()->size() != n) {
        problems.add(*member, place / key, "must be an array of " + std::to_string(n) + " numbers");
        return;
    }
    for (std::size_t i = 0; i < n; ++i) {
        const auto value = (*member->array())[i].number();
        if (value && std::isfinite(*value)) values[i] = *value;
        else problems.add((*member->array())[i], place / key, "must be numbers");
    }
}

std::string GltfDocument::text(const Json& object, const Place& place, std::string_view key) {
    const Json* member = object.find(key);
    if (!member) return {};
    if (member->text()) return *member->text();
    problems.add(*member, place / key, "must be a text");
    return {};
}

bool GltfDocument::boolean(const Json& object, const Place& place, std::string_view key, bool otherwise) {
    const Json* member = object.find(key);
    if (!member) return otherwise;
    if (member->boolean()) return *member->boolean();
    problems.add(*member, place / key, "must be true or false");
    return otherwise;
}

std::optional<std::string_view> GltfDocument::view_bytes(std::size_t view) {
    const Place root, list = root / "bufferViews", place = list / view;
    const Json& object = array("bufferViews")[view];
    const auto buffer = index(object, place, "buffer", buffers_.size());
    const auto offset = size(object, place, "byteOffset", 0), length = size(object, place, "byteLength", 0);
    if (!buffer || !offset || !length) {
        if (problems.empty()) problems.add(object, place, "names no buffer");
        return std::nullopt;
    }
    const std::string_view bytes = buffers_[*buffer];
    if (*offset > bytes.size() || *length > bytes.size() - *offset) {
        problems.add(object, place, "reaches beyond the end of its buffer");
        return std::nullopt;
    }
    return bytes.substr(*offset, *length);
}

// `needed` bytes of the view that `object` names, from its offset on.
std::optional<std::string_view> GltfDocument::range(const Json& object, const Place& place, std::string_view offset_key,
                                                    std::size_t needed) {
    const auto view = index(object, place, "bufferView", array("bufferViews").size());
    const auto offset = size(object, place, offset_key, 0);
    if (!view || !offset) {
        if (problems.empty()) problems.add(object, place, "names no buffer view");
        return std::nullopt;
    }
    const auto bytes = view_bytes(*view);
    if (!bytes) return std::nullopt;
    if (*offset > bytes->size() || needed > bytes->size() - *offset) {
        problems.add(object, place, "reaches beyond the end of its buffer view");
        return std::nullopt;
    }
    return bytes->substr(*offset);
}

std::optional<GltfAccessor> GltfDocument::accessor(std::size_t which) {
    const Place root, list = root / "accessors", place = list / which;
    const Json& object = array("accessors")[which];
    GltfAccessor accessor;
    const auto count = size(object, place, "count", 0), type = size(object, place, "componentType", 0);
    accessor.components = components_of(text(object, place, "type"));
    accessor.normalized = boolean(object, place, "normalized", false);
    if (!count || !type) return std::nullopt;
    const std::size_t component = component_size(static_cast<std::int64_t>(*type));
    if (component == 0) problems.add(object, place, "has a componentType that glTF does not know");
    if (accessor.components == 0) problems.add(object, place, "has a type that glTF does not know");
    // Also without a view, where all elements are zero: no file may ask for more elements than it has bytes.
    if (*count > total_bytes_) problems.add(object, place, "has more elements than the file has bytes");
    if (component == 0 || accessor.components == 0 || *count > total_bytes_) return std::nullopt;
    accessor.count = *count;
    accessor.component_type = static_cast<int>(*type);
    const std::size_t element = component * static_cast<std::size_t>(accessor.components);
    accessor.stride = element;
    if (object.find("bufferView")) {
        const auto view = index(object, place, "bufferView", array("bufferViews").size());
        if (!view) return std::nullopt;
        const Place views = root / "bufferViews", view_place = views / *view;
        const auto stride = size(array("bufferViews")[*view], view_place, "byteStride", element);
        if (!stride || *stride < element || *stride > 252) {
            problems.add(object, place, "has a byteStride that does not fit its type");
            return std::nullopt;
        }
        accessor.stride = *stride;
        const std::size_t needed = accessor.count == 0 ? 0 : (accessor.count - 1) * accessor.stride + element;
        const auto bytes = range(object, place, "byteOffset", needed);
        if (!bytes) return std::nullopt;
        accessor.data = reinterpret_cast<const unsigned char*>(bytes->data());
    }
    if (const Json* sparse = object.find("sparse")) {
        const Place at = place / "sparse";
        const auto replaced = size(*sparse, at, "count", 0);
        const Json *indices = sparse->find("indices"), *values = sparse->find("values");
        if (!replaced || !indices || !values || *replaced > accessor.count) {
            problems.add(*sparse, at, "needs a count up to the accessor's, indices and values");
            return std::nullopt;
        }
        const auto index_type = size(*indices, at / "indices", "componentType", 0);
        if (!index_type || (*index_type != 5121 && *index_type != 5123 && *index_type != 5125)) {
            problems.add(*indices, at, "has indices of a type that glTF does not allow");
            return std::nullopt;
        }
        GltfAccessor list_of_indices;
        list_of_indices.component_type = static_cast<int>(*index_type);
        list_of_indices.stride = component_size(list_of_indices.component_type);
        const auto index_bytes = range(*indices, at / "indices", "byteOffset", *replaced * list_of_indices.stride);
        const auto value_bytes = range(*values, at / "values", "byteOffset", *replaced * element);
        if (!index_bytes || !value_bytes) return std::nullopt;
        list_of_indices.data = reinterpret_cast<const unsigned char*>(index_bytes->data());
        accessor.replacements = reinterpret_cast<const unsigned char*>(value_bytes->data());
        for (std::size_t i = 0; i < *replaced; ++i) {
            const std::uint32_t position = list_of_indices.integer(i);
            if (position >= accessor.count || (i > 0 && position <= accessor.replaced.back())) {
                problems.add(*indices, at, "has indices that do not ascend or lie outside");
                return std::nullopt;
            }
            accessor.replaced.push_back(position);
        }
    }
    return accessor;
}

std::optional<scene::ImageSource> GltfDocument::image_source(std::size_t image) {
    const Json& object = array("images")[image];
    const Place root, list = root / "images", place = list / image;
    if (const Json* uri = object.find("uri"); uri && uri->text()) {
        if (uri->text()->starts_with("data:")) {
            std::string reason;
            auto bytes = load_uri(*uri->text(), reason);
            if (bytes) return scene::ImageSource{{}, std::move(*bytes), place.pointer()};
            problems.add(*uri, place / "uri", reason);
            return std::nullopt;
        }
        const std::string name = decode_percent(*uri->text());
        if (stays_in_folder(name)) return scene::ImageSource{(folder_ / name).string(), {}, place.pointer()};
        problems.add(*uri, place / "uri", outside_folder(name));
        return std::nullopt;
    }
    const auto view = index(object, place, "bufferView", array("bufferViews").size());
    const auto bytes = view ? view_bytes(*view) : std::nullopt;
    if (bytes) return scene::ImageSource{{}, std::string(*bytes), place.pointer()};
    if (!view) problems.add(object, place, "has neither uri nor bufferView");
    return std::nullopt;
}

}  // namespace crescente::io
