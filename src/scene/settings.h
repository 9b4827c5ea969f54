// How a picture is made. What can change a pixel is above the line, what only changes time and memory below.
#pragma once

#include <cstdint>

#include "base/fields.h"

namespace crescente::scene {

enum class Level { visible, shadows, reflections, edges, soft, indirect };
enum class Denoise { off, filter };
enum class Tonemap { automatic, srgb, neutral };
enum class AcceleratorKind { embree, kay_kajiya, linear };
enum class SubpixelShortcut { off, exact, trust };
enum class Order {
    automatic,  // even, but tiles where nobody watches: the command line without a time limit
    even,   // the whole picture grows evenly: for whoever watches
    tiles,  // after the first coarse picture one tile after the other to the end: faster, for whoever waits
};

struct Settings {
    int width = 1280, height = 720;
    Level level = Level::edges;
    double threshold = 1.0 / 256;  // a ray is grown while any component of its influence exceeds this
    int depth = 12;                // most bounces of a ray; the safety net
    int supersampling = 2;         // a pixel is split at most this often: 4^n sub-pixels; 0: off
    double noise = 0.01;           // soft, indirect: nodes are sampled until their error in the pixel is below this share of its brightness
    int samples = 256;             // soft, indirect: most of a node
    bool caustics = false;         // light that mirrors and glass throw on other surfaces; without it glass lets light through straight
    Denoise denoise = Denoise::filter;  // soft, indirect: what is shown of light that has fewer samples than it wants
    double contrast = 0.08;        // corners that differ by more, on a perceptual 0..1 scale, split the pixel
    Tonemap tonemap = Tonemap::automatic;
    double exposure = 0;           // stops
    bool auto_exposure = false;    // the finished picture says how bright it is developed, `exposure` is added (scene/tonemap.h)
    SubpixelShortcut subpixel_shortcut = SubpixelShortcut::off;  // `trust` may change pixels
    // ------------------------------------------------------------------------------------------------------------------
    AcceleratorKind accelerator = AcceleratorKind::embree;
    bool octant_rejection = true;  // kay-kajiya
    bool priority_queue = true;    // kay-kajiya
    bool shadow_cache = false;
    Order order = Order::automatic;
    bool keep = true;              // keep the trees of finished tiles; false: their pixels only
    int tile = 64;                 // edge of a tile, pixels
    int threads = 0;               // 0: all
    std::int64_t memory = 0;       // ceiling for the forest, bytes; 0: none
    static const FieldTable<Settings>& fields();
    bool operator==(const Settings&) const = default;
};

}  // namespace crescente::scene
