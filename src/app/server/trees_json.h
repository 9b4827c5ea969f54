// Ray trees for the page.
#pragma once

#include "app/server/replies.h"
#include "render/ray_tree.h"

namespace crescente::app {

// A list of trees, those of the pixel's corners first; lengths in units of `metres`. Rays of corners that are not traced yet are left out.
ReplyJson trees_json(const render::PixelTrees& trees, double metres);

}  // namespace crescente::app
