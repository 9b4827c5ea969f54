// The face of the engine, used alike by the command line, the viewer, Python and the cluster.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/counts.h"
#include "render/deadline.h"
#include "render/ray_tree.h"
#include "scene/edit.h"
#include "scene/image.h"
#include "scene/scene.h"

namespace crescente::render {

struct LevelStats {
    std::string name;
    double seconds = 0;  // time in which any thread worked on the level
    RayCounts rays;
};
struct Stats {
    RayCounts rays;
    TestCounts tests;
    std::vector<LevelStats> levels;
    std::uint64_t nodes = 0;           // grown; all of them are kept unless settings.keep is false
    std::uint64_t forest_bytes = 0;    // kept now
    std::uint64_t peak_forest_bytes = 0;
    std::uint64_t accelerator_bytes = 0;
    std::uint64_t dropped_tiles = 0;   // states given up under the memory ceiling
    double bytes_per_pixel = 0;        // what the grown forest takes, or would if it were kept
    double render_seconds = 0;         // inside advance()
    double build_seconds = 0;          // acceleration structure
    int threads = 0;
    std::uint64_t revised_tiles = 0;   // times that an edit touched the trees of a tile
};

struct Progress {
    bool done = false;
    std::string level;      // what is being worked on
    double fraction = 0;    // of the whole picture, 0..1, falls only by an edit
    bool first_picture = false;  // the coarsest grid covers the whole frame: picture() is whole
};

// A rectangle of the picture in pixels, from its top left corner.
struct Area {
    int x = 0, y = 0, width = 0, height = 0;
};

// A picture of a session that can be brought up to date: the color layer, and when it was taken.
struct Frame {
    scene::Image image;
    std::uint64_t time = 0;  // of the session's clock
};

// What the camera sees through a pixel.
struct Pick {
    std::vector<scene::NodeId> path;  // from a root of the scene down to the node with the shape
    std::uint32_t face = 0;           // of the shape, from 0: of a CAD part its face, of a mesh the triangle
    scene::MaterialId material;       // not valid: the default one
    math::Vec3 position, normal;      // in the world; the normal is that of shading, unit, on the side of the viewer
};

// What an edit did to the trees, before any work is done anew.
struct EditReport {
    std::vector<scene::Edit> undo;   // edits that bring the scene back
    bool began_anew = false;         // no tree was kept
    bool accelerator_kept = true;
    double seconds = 0;
};

class Session {
public:
    // Builds the acceleration structure. The scene must be valid and have a camera. Errors: a setting that this build
    // cannot serve, not enough memory.
    static Expected<Session> open(scene::Scene scene);
    // The same, gone on from a checkpoint: open() and restore(), with the errors of both.
    static Expected<Session> resume(scene::Scene scene, const std::filesystem::path& file);
    Session(Session&&) noexcept;
    Session& operator=(Session&&) noexcept;
    ~Session();

    // Does the most influential pending work until the deadline.
    Progress advance(const Deadline& deadline);

    // Changes the scene; what it does not touch is kept, and advance() does the rest. The converged picture is that of a fresh session of the edited
    // scene, to the bit. Several edits are one. Errors (input, resource): every problem, with `file` and its place; nothing has changed then.
    Expected<EditReport> edit(std::vector<scene::Edit> edits, const std::string& file = {});

    // Writes the whole forest to a file, from which it can be brought back: a checkpoint (render/checkpoint.h). Between calls of advance(), after any edits;
    // what was edited is brought up to date first. `note`: up to 64 KiB for whoever reads its head. Returns the size in bytes. Errors: output, resource; an
    // older checkpoint of that name is then as it was, and so is the session.
    Expected<std::uint64_t> save(const std::filesystem::path& file, const std::string& note = {});

    // Takes the forest of a checkpoint in place of its own: what was traced is there, and what is still to be done ends in the same picture, to the bit.
    // The session's scene, with its edits, must be that of the checkpoint, its picture of the same size in the same tiles; settings of growth (level,
    // threshold, ...) may be others, which is an edit. Errors: input (missing, damaged, of another version or scene), resource; the session is then as it was.
    Expected<void> restore(const std::filesystem::path& file);

    // The picture so far, whole at any moment: layer "color" only, or with all layers (see scene/image.h).
    scene::Image picture(bool all_layers = false) const;

    // Brings the frame's color to what the session shows now, and returns where it was written: the tiles that changed since it was taken. What is filtered
    // (settings.denoise) stays in it between an edit and the next advance(). An empty frame,
    // or one of another size, becomes the whole picture. A frame belongs to one session.
    std::vector<Area> refresh(Frame& frame) const;

    // Where the user looks: once the whole frame has a first picture, tiles in the area grow before the others, and these in the order of their distance
    // from it. Empty, or outside of the picture: nowhere in particular. The converged picture is the same.
    void look_at(const Area& area);

    // The surface that the camera sees through a pixel, from the trees that are kept; nothing if that is the background, not known yet, or outside the
    // picture. Traces nothing; under a memory ceiling the tile is recomputed first.
    std::optional<Pick> pick(int x, int y);

    Stats stats() const;
    const scene::Scene& scene() const;

    // The ray trees of a pixel's corners: rays, hits, influences, light by light. x and y count from the top left.
    // Empty if the pixel is outside the picture. Traces nothing; under a memory ceiling the tile is recomputed first.
    PixelTrees trees(int x, int y);
    std::string describe(int x, int y) { return text_of(trees(x, y)); }

private:
    struct State;
    explicit Session(std::unique_ptr<State> state);
    std::unique_ptr<State> state_;
};

}  // namespace crescente::render
