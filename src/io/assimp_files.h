// The files that Assimp may see: the one being read, from memory, and what lies in its folder.
#pragma once

#ifdef CRESCENTE_WITH_ASSIMP

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

namespace crescente::io {

class AssimpFiles : public Assimp::IOSystem {
public:
    // `bytes` and `missing` must outlive this. Names asked for in vain are added to `missing`, once each, at most 20.
    AssimpFiles(std::string main_file, std::string_view bytes, std::filesystem::path folder, std::vector<std::string>& missing)
        : main_file_(std::move(main_file)), bytes_(bytes), folder_(std::move(folder)), missing_(missing) {}

    bool Exists(const char* name) const override;
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* name, const char* mode) override;  // null: not there, or not to be read
    void Close(Assimp::IOStream* stream) override { delete stream; }

private:
    void note_missing(const std::string& name);

    std::string main_file_;
    std::string_view bytes_;
    std::filesystem::path folder_;
    std::vector<std::string>& missing_;
};

}  // namespace crescente::io

#endif
