#include "app/server/frame_maker.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "app/cli/picture_options.h"
#include "app/server/color_map.h"
#include "app/server/jpeg.h"
#include "io/display_samples.h"
#include "io/png_file.h"

namespace crescente::app {
namespace {

constexpr int jpeg_quality = 88;
constexpr int tallest_part = 4;  // tiles: enough parts for the processors, few enough headers

void put(std::string& out, std::uint32_t value, int bytes) {
    for (int i = 0; i < bytes; ++i) out += static_cast<char>(value >> (8 * i) & 0xff);
}

// Every four pixels as one; the last row and column may stand for fewer.
std::vector<float> halved(const scene::Image& image, const render::Area& area) {
    const scene::Layer& layer = image.layers.front();
    const std::size_t channels = layer.channels.size(), row = static_cast<std::size_t>(image.width) * channels;
    std::vector<float> values;
    values.reserve(static_cast<std::size_t>((area.width + 1) / 2) * static_cast<std::size_t>((area.height + 1) / 2) * channels);
    for (int y = 0; y < area.height; y += 2) {
        const float* upper = &layer.values[static_cast<std::size_t>(area.y + y) * row + static_cast<std::size_t>(area.x) * channels];
        const float* lower = y + 1 < area.height ? upper + row : upper;
        for (int x = 0; x < area.width; x += 2) {
            const std::size_t left = static_cast<std::size_t>(x) * channels, right = x + 1 < area.width ? left + channels : left;
            for (std::size_t c = 0; c < channels; ++c) values.push_back((upper[left + c] + upper[right + c] + lower[left + c] + lower[right + c]) / 4);
        }
    }
    return values;
}

std::vector<float> cut_out(const scene::Image& image, const render::Area& area) {
    const scene::Layer& layer = image.layers.front();
    const std::size_t channels = layer.channels.size(), row = static_cast<std::size_t>(area.width) * channels;
    std::vector<float> values(row * static_cast<std::size_t>(area.height));
    for (int y = 0; y < area.height; ++y) {
        const std::size_t from = (static_cast<std::size_t>(area.y + y) * static_cast<std::size_t>(image.width) + static_cast<std::size_t>(area.x)) * channels;
        std::copy_n(&layer.values[from], row, &values[row * static_cast<std::size_t>(y)]);
    }
    return values;
}

}  // namespace

void FrameMaker::show(ShownLayer layer) {
    if (layer == layer_) return;
    layer_ = layer;
    anew_ = true;
}

bool FrameMaker::look(render::Session& session, bool done) {
    const scene::Settings& settings = session.scene().settings;
    const TileGrid grid{settings.width, settings.height, settings.tile};
    if (anew_ || !(grid == grid_)) {
        anew_ = false;
        begins_ = true;
        grid_ = grid;
        changed_.assign(grid.size(), true);
        sent_.assign(grid.size(), Sent::nothing);
        frame_ = {};
        picture_ = {};
        tonemap_.reset();
    }
    if (layer_ == ShownLayer::color) look_at_color(session);
    else look_at_layer(session);
    lossless_ = done;
    return std::find(changed_.begin(), changed_.end(), true) != changed_.end() ||
           (done && std::any_of(sent_.begin(), sent_.end(), [](Sent s) { return s != Sent::exact; }));
}

void FrameMaker::look_at_color(render::Session& session) {
    for (const render::Area& area : session.refresh(frame_)) mark(area);
    const scene::Settings& settings = session.scene().settings;
    if (tonemap_ && !settings.auto_exposure) return;
    const io::ImageOptions how = image_options({}, session.scene(), frame_.image);
    if (how.tonemap != shown_tonemap_ || how.exposure != exposure_) std::fill(changed_.begin(), changed_.end(), true);
    tonemap_ = shown_tonemap_ = how.tonemap;
    exposure_ = how.exposure;
}

void FrameMaker::look_at_layer(render::Session& session) {
    scene::Image picture = through_color_map(session.picture(true), layer_, session.scene().settings);
    const auto differs = [&](const render::Area& area) {
        if (picture_.width != picture.width || picture_.height != picture.height) return true;
        return cut_out(picture_, area) != cut_out(picture, area);
    };
    for (int y = 0; y < grid_.down(); ++y) {
        for (int x = 0; x < grid_.across(); ++x) {
            const render::Area tile{x * grid_.tile, y * grid_.tile, std::min(grid_.tile, grid_.width - x * grid_.tile), std::min(grid_.tile, grid_.height - y * grid_.tile)};
            if (differs(tile)) mark(tile);
        }
    }
    picture_ = std::move(picture);
}

void FrameMaker::mark(const render::Area& area) {
    changed_[static_cast<std::size_t>(area.y / grid_.tile) * static_cast<std::size_t>(grid_.across()) + static_cast<std::size_t>(area.x / grid_.tile)] = true;
}

Expected<std::string> FrameMaker::encode(const render::Area& area, How how) const {
    const scene::Image& image = layer_ == ShownLayer::color ? frame_.image : picture_;
    const std::size_t channels = image.layers.front().channels.size();
    // Maps are display colours already.
    const std::vector<float> values = how == How::coarse ? halved(image, area) : cut_out(image, area);
    std::vector<std::uint8_t> samples;
    if (layer_ == ShownLayer::color) {
        samples = io::display_samples<std::uint8_t>(values, channels, io::AlphaIs::straight, *tonemap_, exposure_);
    } else {
        samples.resize(values.size());
        std::transform(values.begin(), values.end(), samples.begin(), [](float v) { return static_cast<std::uint8_t>(v * 255 + 0.5f); });
    }
    if (how == How::coarse) return encode_jpeg((area.width + 1) / 2, (area.height + 1) / 2, samples, jpeg_quality);
    if (how == How::lossy) return encode_jpeg(area.width, area.height, samples, jpeg_quality);
    return io::encode_png(area.width, area.height, channels == 4 ? 4 : 3, std::span<const std::uint8_t>(samples), {});
}

Expected<std::string> FrameMaker::make(std::uint32_t number, std::uint32_t looks, bool quick) {
    const scene::Image& image = layer_ == ShownLayer::color ? frame_.image : picture_;
    const bool lossless = lossless_ || image.layers.front().channels.size() == 4;  // JPEG has no alpha
    constexpr double too_long = 0.008;  // seconds, of the fiftieth of one in which a picture should follow the hand
    const bool coarse = quick && !lossless && seconds_a_pixel_ * image.width * image.height > too_long;
    const How how = lossless ? How::lossless : coarse ? How::coarse : How::lossy;
    const auto start = std::chrono::steady_clock::now();
    std::vector<bool> send = changed_;
    for (std::size_t i = 0; i < send.size(); ++i) send[i] = send[i] || (lossless_ && sent_[i] != Sent::exact);
    const std::vector<render::Area> areas = rectangles_of(grid_, send, tallest_part);
    std::vector<Expected<std::string>> parts(areas.size());
    pool_.for_each(areas.size(), [&](std::size_t i) { parts[i] = encode(areas[i], how); });
    std::size_t pixels = 0;
    for (const render::Area& area : areas) pixels += static_cast<std::size_t>(area.width) * static_cast<std::size_t>(area.height);
    if (how == How::lossy && pixels > 0) seconds_a_pixel_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / static_cast<double>(pixels);

    std::string bytes = "CRF1";
    put(bytes, number, 4);
    put(bytes, looks, 4);
    put(bytes, static_cast<std::uint32_t>(grid_.width), 2);
    put(bytes, static_cast<std::uint32_t>(grid_.height), 2);
    put(bytes, lossless_ ? 1 : 0, 1);
    put(bytes, begins_ ? 1 : 0, 1);
    put(bytes, static_cast<std::uint32_t>(areas.size()), 2);
    for (std::size_t i = 0; i < areas.size(); ++i) {
        if (!parts[i]) return tl::unexpected(parts[i].error());
        for (const int value : {areas[i].x, areas[i].y, areas[i].width, areas[i].height}) put(bytes, static_cast<std::uint32_t>(value), 2);
        put(bytes, lossless ? 1 : 0, 4);
        put(bytes, static_cast<std::uint32_t>(parts[i]->size()), 4);
        bytes += *parts[i];
    }
    for (std::size_t i = 0; i < send.size(); ++i) {
        if (send[i]) sent_[i] = lossless ? Sent::exact : Sent::lossy;
    }
    if (!coarse) std::fill(changed_.begin(), changed_.end(), false);
    begins_ = false;
    return bytes;
}

}  // namespace crescente::app
