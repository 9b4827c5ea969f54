// What a page is sent of a growing picture: the parts that changed since it was last sent something (docs/protocol.md#frames).
#pragma once

#include <algorithm>
#include <optional>
#include <string>

#include "app/server/areas.h"
#include "app/server/message.h"
#include "parallel/pool.h"
#include "render/session.h"

namespace crescente::app {

class FrameMaker {
public:
    explicit FrameMaker(int threads) : pool_(threads) {}

    // The page has nothing, or nothing that is still of use: all is sent again.
    void begin_anew() { anew_ = true; }
    // The picture is another one, such as that of another camera.
    void begin_picture() {
        begins_ = true;
        std::fill(changed_.begin(), changed_.end(), true);
    }
    void show(ShownLayer layer);
    // Materials, settings: how pictures are developed may have changed.
    void scene_changed() { tonemap_.reset(); }

    // Takes in what changed. `done`: the picture is converged, so that what was sent lossily is sent again without loss. Whether there is anything to send.
    bool look(render::Session& session, bool done);

    // The frame of what look() found, to be sent with this number; `looks`: the number of the camera that it is seen by. `quick`: it should be there soon; where this machine takes long for all pixels, a picture
    // with a quarter of them is sent, and all of them with the next frame. Errors: resource.
    Expected<std::string> make(std::uint32_t number, std::uint32_t looks, bool quick);

private:
    enum class Sent : unsigned char { nothing, lossy, exact };
    void look_at_color(render::Session& session);
    void look_at_layer(render::Session& session);
    void mark(const render::Area& area);
    enum class How { coarse, lossy, lossless };
    Expected<std::string> encode(const render::Area& area, How how) const;

    parallel::Pool pool_;
    bool anew_ = true, lossless_ = false, begins_ = true;
    ShownLayer layer_ = ShownLayer::color;
    TileGrid grid_;
    std::vector<bool> changed_;  // tiles, since they were last sent
    std::vector<Sent> sent_;
    render::Frame frame_;        // color
    scene::Image picture_;       // another layer, through the colour map
    std::optional<scene::Tonemap> tonemap_;  // nothing: to be found out
    scene::Tonemap shown_tonemap_ = scene::Tonemap::srgb;
    double exposure_ = 0;
    double seconds_a_pixel_ = 0;  // that the last lossy frame took
};

}  // namespace crescente::app
