// What a session shows of its forest.
#include <algorithm>
#include <span>
#include <utility>

#include "render/denoise.h"
#include "render/film.h"
#include "render/session_state.h"

namespace crescente::render {

scene::Image Session::picture(bool all_layers) const {
    State& s = *state_;
    if (!all_layers) {
        Frame frame;
        refresh(frame);
        return std::move(frame.image);
    }
    s.catch_up(Deadline::never());  // layers speak of the scene as it is
    scene::Image image = blank_image(s.width(), s.height(), true, s.keeps_alpha());
    s.show(image, std::vector<bool>(s.tiles.size(), true), true);
    return image;
}

std::vector<Area> Session::refresh(Frame& frame) const {
    State& s = *state_;
    scene::Image& image = frame.image;
    if (image.width != s.width() || image.height != s.height() || image.layers.size() != 1 || image.layers[0].channels.size() != (s.keeps_alpha() ? 4 : 3)) {
        frame = {blank_image(s.width(), s.height(), false, s.keeps_alpha()), 0};
    }
    std::vector<bool> which(s.tiles.size());
    std::transform(s.tiles.begin(), s.tiles.end(), which.begin(), [&](const Tile& tile) { return tile.changed > frame.time; });
    // Tiles that were dropped are filtered when the picture is finished, and not before.
    if (s.denoises()) {
        const std::vector<bool> changed = which;
        which = s.is_finished && frame.time < s.finished ? std::vector<bool>(s.tiles.size(), true) : s.with_neighbours(changed);
        // Those that have not heard of an edit cannot be filtered, and stay as they are until they have.
        for (std::size_t i = 0; i < s.tiles.size(); ++i) which[i] = which[i] && (changed[i] || s.is_known(s.tiles[i]));
    }
    s.show(image, which, false);
    frame.time = s.clock;
    std::vector<Area> areas;
    for (std::size_t i = 0; i < s.tiles.size(); ++i) {
        const Tile& tile = s.tiles[i];
        if (which[i]) areas.push_back({tile.x0, tile.y0, tile.width, tile.height});
    }
    return areas;
}

bool Session::State::denoises() const {
    const scene::Settings& settings = world->scene.settings;
    if (settings.denoise == scene::Denoise::off || settings.level <= scene::Level::edges || world->lens) return false;
    return std::any_of(tiles.begin(), tiles.end(), [&](const Tile& tile) {
        return !tile.samples.empty() || (tile.shown_stage() > 0 && level_of_stage[static_cast<std::size_t>(tile.shown_stage() - 1)] > scene::Level::edges);
    });
}

std::vector<bool> Session::State::with_neighbours(const std::vector<bool>& which) const {
    const int across = tiles_across(), down = static_cast<int>(tiles.size()) / across, reach = (denoise_reach + tile_size() - 1) / tile_size();
    std::vector<bool> wider(which.size());
    for (int y = 0; y < down; ++y) {
        for (int x = 0; x < across; ++x) {
            if (!which[static_cast<std::size_t>(y) * across + x]) continue;
            for (int v = std::max(0, y - reach); v <= std::min(down - 1, y + reach); ++v) {
                for (int u = std::max(0, x - reach); u <= std::min(across - 1, x + reach); ++u) wider[static_cast<std::size_t>(v) * across + u] = true;
            }
        }
    }
    return wider;
}

// What a tile shows in the image; nothing, if it can be told from its trees and memory is scarce.
void Session::State::remember(std::size_t tile, const scene::Image& image, bool pixels) {
    Displayed& own = displayed[tile];
    own.time = clock;
    if (!pixels) return release(own.pixels);
    const Tile& t = tiles[tile];
    const scene::Layer& color = image.layers[0];
    own.pixels.clear();
    for (int y = t.y0; y < t.y0 + t.height; ++y) {
        for (int x = t.x0; x < t.x0 + t.width; ++x) {
            const float* pixel = &color.values[color.channels.size() * (static_cast<std::size_t>(y) * image.width + x)];
            own.pixels.push_back({pixel[0], pixel[1], pixel[2]});
        }
    }
}

void Session::State::show(scene::Image& image, const std::vector<bool>& which, bool regrow) {
    const bool filtered = denoises();
    const bool roomy = world->scene.settings.keep && world->scene.settings.memory == 0;
    if (filtered || roomy) displayed.resize(tiles.size());
    else release(displayed);
    const auto is_dropped = [](const Tile& tile) { return tile.shows_pixels(); };
    const auto is_done = [&](const Tile& tile) { return is_known(tile) && tile.shown_stage() == static_cast<int>(stages.size()); };
    // The filter wants the trees of all tiles; before the picture is finished, dropped ones show what they had.
    regrow = regrow || (filtered && std::all_of(tiles.begin(), tiles.end(), is_done));
    const bool any_regrown = regrow && std::any_of(tiles.begin(), tiles.end(), is_dropped);
    // Those are held a few rows at a time: they were dropped because memory is scarce.
    const int across = tiles_across(), down = static_cast<int>(tiles.size()) / across, step = any_regrown ? 1 : down;
    std::vector<Tile> regrown(any_regrown ? tiles.size() : 0);
    for (int row = 0; row < down; row += step) {
        std::vector<bool> shown(tiles.size());
        const auto first = static_cast<std::ptrdiff_t>(row) * across, end = first + static_cast<std::ptrdiff_t>(step) * across;
        std::copy(which.begin() + first, which.begin() + end, shown.begin() + first);
        const std::vector<bool> needed = filtered ? with_neighbours(shown) : shown;
        std::vector<const Tile*> trees(tiles.size()), known(tiles.size());
        pool.for_each(tiles.size(), [&](std::size_t i) {
            trees[i] = &tiles[i];
            if (any_regrown && !needed[i]) release(regrown[i]);
            if (!needed[i]) return;
            if (any_regrown && is_dropped(tiles[i])) {
                if (regrown[i].nodes.empty()) regrown[i] = this->regrown(tiles[i]);
                trees[i] = &regrown[i];
            }
            if (is_known(tiles[i]) && !is_dropped(*trees[i])) known[i] = trees[i];
        });
        const std::vector<Corrections> corrections = filtered ? denoise(*world, known, pool) : std::vector<Corrections>(tiles.size());
        pool.for_each(tiles.size(), [&](std::size_t i) {
            if (!shown[i]) return;
            expose(*trees[i], *world, level_of_stage, image, corrections[i]);
            if (!displayed.empty() && is_known(tiles[i])) remember(i, image, roomy || !corrections[i].radiance.empty());
        });
    }
}

}  // namespace crescente::render
