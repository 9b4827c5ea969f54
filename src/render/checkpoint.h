// What a session holds besides its scene, in a file: the forest with its counts, so that a stop or a crash loses nothing. docs/forest.md has the layout,
// docs/decisions/0009-checkpoints.md why it is so.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "base/error.h"
#include "render/fingerprint.h"
#include "render/forest.h"
#include "render/world.h"

namespace crescente::render {

// To be raised whenever the bytes of the file change, or the trees that a scene gives.
inline constexpr std::uint32_t checkpoint_version = 6;

// What a session counts that is not in its tiles; see Stats.
struct SessionCounts {
    std::vector<double> level_seconds;  // by level
    std::vector<RayCounts> level_rays;  // by level
    RayCounts past_rays;
    TestCounts past_tests;
    double render_seconds = 0;
    std::uint64_t peak_bytes = 0, drops = 0, dropped_bytes = 0, dropped_nodes = 0, revised = 0;
};

// What a checkpoint says before the first tile.
struct CheckpointHead {
    std::string program;     // version of the program that wrote it
    std::string note;        // for whoever saved: which edits led to the scene, for instance
    Fingerprint scene;
    scene::Settings settings;  // those by which the trees grew; the others are the defaults
    SessionCounts counts;
};
struct Checkpoint {
    CheckpointHead head;
    std::vector<Tile> tiles;  // row by row
};

// Settings that trees depend on, from one to the other.
void copy_tree_settings(const scene::Settings& from, scene::Settings& to);

// Writes the file beside its place, tile by tile, and puts it there when it is whole; an older one stays until then. The tiles must know all edits. Returns its
// size in bytes. Errors: output (no permission, disk full), resource (memory); an older file is then as it was.
Expected<std::uint64_t> write_checkpoint(const std::filesystem::path& file, const World& world, const std::string& note, const SessionCounts& counts,
                                         std::vector<Tile>& tiles);

// Whether there is such a file and it begins as checkpoints do, of whatever version and however damaged.
bool is_checkpoint(const std::filesystem::path& file);

// The file may be hostile. Errors: input (missing, no checkpoint, damaged, of another version), resource (memory).
Expected<CheckpointHead> read_checkpoint_head(const std::filesystem::path& file);

// The whole of it, for a world of the same scene. Errors: as above, and input where it is of another scene, or of a picture of another size.
Expected<Checkpoint> read_checkpoint(const std::filesystem::path& file, const World& world);

}  // namespace crescente::render
