// From trees to pixels.
#pragma once

#include <span>

#include "render/forest.h"
#include "render/world.h"
#include "scene/image.h"

namespace crescente::render {

// The colours of a tile's pixels, row by row, as its trees stand: the mean of a pixel's corners, or of its parts where it was split.
// Before all corners are there, coarser ones are interpolated. Black for a tile without any.
std::vector<Rgb> develop(const Tile& tile, const Corrections& corrections = {});

// The share of what is behind the scene that is seen in each pixel, in the same way; empty: none in any, or the picture does not keep it apart.
std::vector<float> develop_clear(const Tile& tile, const Corrections& corrections = {});

// Makes what the tile shows its `pixels`, and gives these up. `displayed`: if not empty, the colours that were shown, which need not be told anew, and may be filtered.
void keep_picture(Tile& tile, std::span<const Rgb> displayed = {});
void forget_picture(Tile& tile);

// The root that says best what a pixel of the tile shows: at its middle where it was split, else at a corner, or as near to it as there is one by now.
// no_node: nothing is known yet.
std::uint32_t root_near(const Tile& tile, int x, int y);

// The tile with its picture and counts alone, or with another picture.
Tile without_trees(const Tile& tile);
Tile without_trees(const Tile& tile, std::vector<Rgb> pixels);

// Names, channels and room for the layers of a picture; see scene/image.h. alpha: the colours have a fourth channel.
scene::Image blank_image(int width, int height, bool all_layers, bool alpha);

// Writes what the tile knows into every layer of the image. `level` is the level that each finished stage belongs to.
void expose(const Tile& tile, const World& world, std::span<const scene::Level> level_of_stage, scene::Image& image, const Corrections& corrections = {});

}  // namespace crescente::render
