// The table of formats. Adding one: a file pair beside this one, a line here, a section in docs/formats.md.
#include "io/formats.h"

#include <algorithm>
#include <cctype>

#include "base/spelling.h"
#include "io/cad_file.h"
#include "io/gltf.h"
#include "io/mesh_file.h"
#include "io/nff.h"
#include "io/ply.h"
#include "io/scene_file.h"
#include "io/stl.h"
#include "io/texture_files.h"

namespace crescente::io {
namespace {

template <auto read>
Expected<Loaded> at_once(const std::filesystem::path& file, const ReadOptions&) {
    return read(file);
}

// Exact shapes that do not come from further files come from this one.
void note_sources(Loaded& read, const std::filesystem::path& file) {
    std::error_code error;
    std::filesystem::path whole = std::filesystem::weakly_canonical(file, error);
    if (error) whole = file;
    for (std::uint32_t i = 0; i < read.scene.shapes.size(); ++i) {
        if (std::holds_alternative<geometry::Brep>(read.scene.shapes[i].shape)) read.sources.try_emplace(i, ShapeSource{whole, i});
    }
}

Expected<Loaded> completed(Expected<Loaded> read, const std::filesystem::path& file, const ReadOptions& options) {
    if (!read) return read;
    auto warnings = load_textures(read->scene.materials, file.string(), {options.texture_pattern});
    if (!warnings) return tl::unexpected(std::move(warnings.error()));
    read->warnings.insert(read->warnings.end(), std::make_move_iterator(warnings->begin()), std::make_move_iterator(warnings->end()));
    note_sources(*read, file);
    return read;
}

}  // namespace

std::span<const Format> formats() {
    static const std::vector<Format> table{
        {"Crescente scene", {".json"}, "The native format: everything that a scene can hold. Metres, degrees, y up.", read_scene_file},
        {"NFF", {".nff"},
         "Neutral File Format (Haines 1987), the whole of it: view, background, lights, fills, spheres, cones, cylinders, polygons and patches. "
         "No unit (metres) and no fixed up axis: the view says what is up.",
         at_once<read_nff_file>},
        {"STEP", {".step", ".stp", ".p21"},
         "Exact faces, assembly, names and colours of AP203, AP214 and AP242, with external references. Unit as the file says, z up.", read_cad_file},
        {"IGES", {".iges", ".igs"}, "Exact faces, names and colours. Unit as the file says, z up.", read_cad_file},
        {"OpenCASCADE BREP", {".brep", ".brp", ".rle"}, "Exact faces, as text or binary. No unit (millimetres), z up.", read_cad_file},
        {"glTF 2.0", {".gltf", ".glb"},
         "Meshes, hierarchy, instances, cameras, punctual lights, physical materials with their textures. Metres, y up.", at_once<read_gltf_file>},
        {"Wavefront OBJ", {".obj"}, "Polygons with MTL materials. No unit (metres), y up.", at_once<read_mesh_file>},
        {"PLY", {".ply"}, "Polygons. No unit (metres), z up.", at_once<read_ply_file>},
        {"STL", {".stl"}, "Triangles. No unit (millimetres, by custom), z up. Edges sharper than 40 degrees stay sharp.", at_once<read_stl_file>},
        {"3MF", {".3mf"}, "Triangles of additive manufacturing. Millimetres, z up.", at_once<read_mesh_file>},
        {"AMF", {".amf"}, "Triangles of additive manufacturing. Millimetres, z up.", at_once<read_mesh_file>},
        {"OFF", {".off"}, "Polygons. No unit (metres), y up.", at_once<read_mesh_file>},
        {"Collada", {".dae"}, "Polygons, hierarchy, cameras, lights. Unit and up axis as the file says.", at_once<read_mesh_file>},
        {"FBX", {".fbx"}, "Polygons, hierarchy, cameras, lights. Unit and up axis as the file says.", at_once<read_mesh_file>},
        {"3D Studio", {".3ds"}, "Triangles, hierarchy, cameras, lights. No unit (metres), z up.", at_once<read_mesh_file>},
        {"X3D", {".x3d"}, "Polygons, hierarchy. Metres, y up.", at_once<read_mesh_file>},
        {"AC3D", {".ac"}, "Polygons, hierarchy. No unit (metres), y up.", at_once<read_mesh_file>},
        {"LightWave", {".lwo"}, "Polygons. Metres, y up.", at_once<read_mesh_file>},
        {"DirectX", {".x"}, "Polygons, hierarchy. No unit (metres), y up.", at_once<read_mesh_file>},
        {"DXF", {".dxf"}, "Faces of a drawing. No unit (millimetres), z up.", at_once<read_mesh_file>},
    };
    return table;
}

Expected<Loaded> read_scene(const std::filesystem::path& file, const ReadOptions& options) {
    std::string extension = file.extension().string();
    for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    std::vector<std::string> known;
    for (const Format& format : formats()) {
        if (std::find(format.extensions.begin(), format.extensions.end(), extension) != format.extensions.end()) return completed(format.read(file, options), file, options);
        known.insert(known.end(), format.extensions.begin(), format.extensions.end());
    }
    std::error_code code;
    if (!std::filesystem::exists(file, code)) return failure(ErrorKind::input, {file.string(), "", "there is no such file", ""});
    const std::string near = extension.empty() ? std::string{} : nearest_spelling(extension, known);
    std::string hint = "known are";
    for (const std::string& one : known) hint += ' ' + one;
    if (!near.empty()) hint = "did you mean '" + near + "'?";
    return failure(ErrorKind::input, {file.string(), "", extension.empty() ? "has no extension to tell its format" : "the format " + extension + " is not known", hint});
}

}  // namespace crescente::io
