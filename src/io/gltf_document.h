// A glTF file opened: its JSON, its buffers, and checked access to what they hold (glTF 2.0 specification, 3.6 and 4).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/error.h"
#include "io/json_text.h"
#include "scene/texture_image.h"

namespace crescente::io {

// The elements of an accessor. Valid as long as the document.
struct GltfAccessor {
    std::size_t count = 0;
    int components = 1;      // 1 for SCALAR to 4 for VEC4, 16 for MAT4
    int component_type = 0;  // 5120 byte, 5121 unsigned byte, 5122 short, 5123 unsigned short, 5125 unsigned int, 5126 float
    bool normalized = false;

    double number(std::size_t element, int component) const;        // integers as numbers, normalised ones in [-1, 1]
    std::uint32_t integer(std::size_t element) const;               // of an unsigned scalar

    const unsigned char* data = nullptr;  // null: zeros
    std::size_t stride = 0;
    std::vector<std::uint32_t> replaced;            // sparse: elements that come from `replacements`, ascending
    const unsigned char* replacements = nullptr;    // packed tightly

private:
    const unsigned char* element_at(std::size_t element) const;
};

class GltfDocument {
public:
    // `bytes` must outlive the document. After it, `problems` tells whether anything was wrong.
    GltfDocument(std::string_view bytes, const std::string& file_name, const std::filesystem::path& folder);

    ProblemList problems;
    Problems warnings;

    void warn(std::string reason) { warnings.push_back({problems.file(), {}, std::move(reason), {}}); }

    // A member of the root that is an array; empty if there is none.
    const Json::Array& array(std::string_view name) const;
    const Json& root() const { return root_; }
    const Json* root_extension(std::string_view name) const { return extension(root_, name); }
    static const Json* extension(const Json& object, std::string_view name);

    // Members of an object, or nothing / the default when absent. What has the wrong kind is a problem.
    std::optional<std::size_t> index(const Json& object, const Place& place, std::string_view key, std::size_t limit);
    double number(const Json& object, const Place& place, std::string_view key, double otherwise);
    template <std::size_t N>
    std::array<double, N> numbers(const Json& object, const Place& place, std::string_view key, const std::array<double, N>& otherwise) {
        std::array<double, N> values = otherwise;
        numbers_into(object, place, key, values.data(), N);
        return values;
    }
    std::string text(const Json& object, const Place& place, std::string_view key);
    bool boolean(const Json& object, const Place& place, std::string_view key, bool otherwise);

    // Nothing where there is a problem, which is told then.
    std::optional<std::string_view> view_bytes(std::size_t view);
    std::optional<GltfAccessor> accessor(std::size_t index);

    // Where an image is: a file, which is not opened, or bytes.
    std::optional<scene::ImageSource> image_source(std::size_t image);

    std::size_t total_bytes() const { return total_bytes_; }  // of the file and its buffers: what counts in it are held against

private:
    bool open_container(std::string_view bytes);
    void load_buffers();
    std::optional<std::string> load_uri(const std::string& uri, std::string& reason) const;
    void numbers_into(const Json& object, const Place& place, std::string_view key, double* values, std::size_t n);
    std::optional<std::size_t> size(const Json& object, const Place& place, std::string_view key, std::size_t otherwise);
    std::optional<std::string_view> range(const Json& object, const Place& place, std::string_view offset_key, std::size_t needed);

    std::filesystem::path folder_;
    Json root_ = Json::make_object();
    std::string_view binary_chunk_;
    std::vector<std::string> loaded_;           // buffers from elsewhere
    std::vector<std::string_view> buffers_;     // all buffers
    std::size_t total_bytes_ = 0;
};

}  // namespace crescente::io
