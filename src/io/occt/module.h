// The face of the OpenCASCADE module: plain C, so that the program can load it late and in another process
// (docs/decisions/0005-cad-files-read-in-a-child.md).
#pragma once

#include <cstddef>
#include <cstdint>

extern "C" {

struct CrescenteCadFace {
    std::uint32_t part, number;  // a part by its index, a face by its number from 1 in it
};

struct CrescenteCadRequest {
    std::uint32_t version;   // must be crescente_cad_version
    const char* file;        // absolute path
    const char* shown_name;  // as the user gave it, for messages
    double deflection;       // share of each part's diagonal: everything as triangles that stray so far; 0: exact faces
    const CrescenteCadFace* triangulated;  // faces that are to come as triangles whatever they are
    std::size_t triangulated_count;
    void* user;
    void (*progress)(void* user, double fraction, const char* stage);
    void (*take)(void* user, const char* bytes, std::size_t size);  // called once with what pack_cad() made: the model, or what is wrong
};

// The single symbol of the module.
void crescente_cad_read(const CrescenteCadRequest* request);
}

inline constexpr std::uint32_t crescente_cad_version = 1;
