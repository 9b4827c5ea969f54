#include "io/cad_file.h"

#include <utility>

#include "io/cad_reader.h"
#include "io/cad_scene.h"

namespace crescente::io {

namespace fs = std::filesystem;

Expected<Loaded> read_cad_file(const fs::path& file, const ReadOptions& options) {
    auto model = read_cad_model(file, options);
    if (!model) return tl::unexpected<Error>(std::move(model.error()));
    std::vector<UntraceableFace> untraceable;
    Loaded loaded = cad_scene(*model, untraceable);
    if (untraceable.empty()) return loaded;

    // What the tracer cannot prepare is fetched again as triangles.
    CadRequest again;
    for (const UntraceableFace& face : untraceable) again.triangulated.push_back({face.part, model->parts[face.part].numbers[face.face]});
    std::vector<UntraceableFace> missing;
    if (auto triangulated = read_cad_anew(file, again, options)) {
        loaded = cad_scene(*triangulated, missing);
    } else {
        missing = std::move(untraceable);
    }
    for (const UntraceableFace& face : missing) {
        loaded.warnings.push_back({file.string(), "part " + std::to_string(face.part + 1) + ", face " + std::to_string(face.face + 1), face.reason + ": it is missing", {}});
    }
    return loaded;
}

}  // namespace crescente::io
