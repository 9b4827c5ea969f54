#include "io/module_file.h"

#include <vector>

#include <dlfcn.h>

namespace crescente::io {
namespace {

namespace fs = std::filesystem;

// Marks this code, to ask the system which file it was loaded from: the program, or the Python module.
void here() {}

}  // namespace

std::optional<fs::path> module_file(const std::string& name) {
    std::vector<fs::path> folders;
    std::error_code error;
    if (const auto program = fs::read_symlink("/proc/self/exe", error); !error) folders.push_back(program.parent_path());
    if (Dl_info info{}; dladdr(reinterpret_cast<void*>(&here), &info) && info.dli_fname) {
        if (const auto library = fs::canonical(info.dli_fname, error); !error) folders.push_back(library.parent_path());
    }
    for (const fs::path& folder : folders) {
        for (const char* place : {".", "../lib", "../lib/crescente"}) {
            fs::path file = (folder / place / name).lexically_normal();
            if (fs::exists(file, error)) return file;
        }
    }
    return std::nullopt;
}

}  // namespace crescente::io
