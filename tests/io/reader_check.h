// What the tests of readers share: the shared assets, counts, and every prefix of a file.
#pragma once

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "io/formats.h"

namespace crescente::io {

inline std::filesystem::path asset(const std::string& name) { return std::filesystem::path(CRESCENTE_SHARED) / "assets" / name; }

#define REQUIRE_ASSET(name) \
    if (!std::filesystem::exists(asset(name))) GTEST_SKIP() << "the shared asset " << name << " is not here"

inline std::string bytes_of(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
}

inline std::size_t triangles_in(const scene::Scene& scene) {
    std::size_t count = 0;
    for (const auto& shape : scene.shapes) {
        if (const auto* mesh = std::get_if<geometry::Mesh>(&shape.shape)) count += mesh->triangles.size();
    }
    return count;
}

inline std::size_t appearances_in(const scene::Scene& scene) {
    std::size_t count = 0;
    scene::for_each_appearance(scene, [&](auto, const auto&, const auto&) { ++count; });
    return count;
}

inline bool warns_of(const Loaded& loaded, const std::string& words) {
    for (const Problem& warning : loaded.warnings) {
        if (warning.text().find(words) != std::string::npos) return true;
    }
    return false;
}

inline bool tells(const Error& error, const std::string& words) { return error.text().find(words) != std::string::npos; }

// Reads the first bytes of `whole` at up to `cuts` lengths, all short ones among them; calls check(length, result).
template <class Read, class Check>
void for_each_cut(const std::string& whole, std::size_t cuts, Read&& read, Check&& check) {
    const std::size_t step = std::max<std::size_t>(1, whole.size() / cuts);
    for (std::size_t length = 0; length < whole.size(); length += length < 64 ? 1 : step) check(length, read(whole.substr(0, length)));
}

}  // namespace crescente::io
