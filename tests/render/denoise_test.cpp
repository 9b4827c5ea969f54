// What is shown of light that has too few samples.
#include <cmath>

#include "render/guided_filter.h"
#include "render/scenes.h"

namespace crescente::render::testing {
namespace {

using scene::Denoise;
using scene::Scene;

// A room corner with balls, lit by a panel and by what the walls send on.
Scene room(int samples) {
    Build b(64, 48);
    b.settings().level = scene::Level::indirect, b.settings().samples = samples, b.settings().noise = 0.0001, b.settings().threads = 2;
    b.settings().supersampling = 1, b.settings().tile = 32;
    b.camera().position = {0, 1.2, 5}, b.camera().target = {0, 0.9, 0};
    PhysicalMaterial wall, red, metal, clear;
    wall.base_color = {0.7f, 0.7f, 0.7f}, wall.roughness = 1;
    red = wall, red.base_color = {0.7f, 0.1f, 0.1f};
    metal.base_color = {0.9f, 0.8f, 0.6f}, metal.metallic = 1, metal.roughness = 0.25;
    clear.transmission = 1, clear.roughness = 0, clear.base_color = {1, 1, 1};
    const MaterialId white = b.material(wall);
    b.place(geometry::Plane{}, white);
    b.place(box({-3, 0, -2}, {3, 3, -1.9}), white);
    b.place(box({-2, 0, -2}, {-1.9, 3, 2}), b.material(red));
    b.place(sphere(0.6), b.material(metal), at({-0.7, 0.6, 0}));
    b.place(sphere(0.5), b.material(clear), at({0.7, 0.5, 0.8}));
    scene::Light& panel = b.light();
    panel.kind = scene::LightKind::rectangle, panel.position = {0.5, 2.8, 1}, panel.direction = {0, -1, -0.2}, panel.intensity = 6;
    return b.scene;
}

scene::Image picture_with(Scene scene, Denoise how) {
    scene.settings.denoise = how;
    return picture_of(std::move(scene));
}

double error(const scene::Image& image, const scene::Image& reference) {
    double sum = 0;
    const std::vector<float>&a = image.layers[0].values, &b = reference.layers[0].values;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double scale = b[i] + 0.05, d = (a[i] - b[i]) / scale;
        sum += std::min(1.0, d * d);
    }
    return std::sqrt(sum / static_cast<double>(a.size()));
}

// The filter's picture is nearer to the truth than the noise, by much where there are few samples, and what it adds to the error goes to zero.
TEST(Denoise, NearerToTheTruth) {
    const scene::Image reference = picture_with(room(1024), Denoise::off);
    double before = 1;
    for (const auto& [samples, gain] : {std::pair{1, 0.65}, {4, 0.65}, {16, 0.8}, {64, 1.1}}) {
        const double raw = error(picture_with(room(samples), Denoise::off), reference), filtered = error(picture_with(room(samples), Denoise::filter), reference);
        EXPECT_LT(filtered, gain * raw) << samples;
        EXPECT_LT(filtered, before) << samples;
        before = filtered;
    }
}

// A ball and a slab, whose soft shadows and blurred images are all that is seen of the ground, under a panel, a lamp and an even sky.
Scene on_catcher(int samples, bool transparent) {
    Build b(64, 48);
    b.settings().level = scene::Level::indirect, b.settings().samples = samples, b.settings().noise = 0.0001, b.settings().threads = 2;
    b.settings().supersampling = 1, b.settings().tile = 32;
    b.camera().position = {0, 2, 5}, b.camera().target = {0, 0.4, 0};
    PhysicalMaterial ground, matt;
    ground.catcher = true, ground.base_color = gray(0.6f), ground.roughness = 0.25;
    matt.base_color = {0.7f, 0.5f, 0.3f}, matt.roughness = 1;
    b.place(geometry::Plane{}, b.material(ground));
    b.place(sphere(0.6), b.material(matt), at({-0.7, 0.6, 0}));
    b.place(box({0.4, 0, -0.3}, {1.3, 0.9, 0.1}), b.material(matt));
    scene::Light& panel = b.light();
    panel.kind = scene::LightKind::rectangle, panel.position = {2.5, 2.8, 1}, panel.direction = {-1, -1.2, -0.4}, panel.intensity = 12, panel.visible = false;
    b.light().position = {-3, 3, 3}, b.scene.lights.back().intensity = 6;
    b.uniform_environment({0.4f, 0.5f, 0.6f}, 1);
    b.scene.environment->transparent = transparent, b.scene.environment->backdrop = !transparent;
    b.scene.environment->backdrop_top = {0.3f, 0.5f, 0.9f}, b.scene.environment->backdrop_bottom = {0.9f, 0.8f, 0.7f};
    return b.scene;
}

// Root mean square of what alpha is off, or where there is none, the color.
double error_of_shadows(const scene::Image& image, const scene::Image& reference) {
    const std::size_t channels = image.layers[0].channels.size();
    double sum = 0;
    for (std::size_t i = channels - 1; i < image.layers[0].values.size(); i += channels) {
        const double d = image.layers[0].values[i] - reference.layers[0].values[i];
        sum += d * d;
    }
    return std::sqrt(sum * static_cast<double>(channels) / static_cast<double>(image.layers[0].values.size()));
}

// Shadows on catchers are filtered as light is, in the picture's alpha too.
TEST(Denoise, ShadowsOnCatchers) {
    for (const bool transparent : {true, false}) {
        const scene::Image reference = picture_with(on_catcher(1024, transparent), Denoise::off);
        double before = 1;
        for (const auto& [samples, gain] : {std::pair{1, 0.75}, {4, 0.8}, {16, 0.9}, {64, 1.3}}) {
            const scene::Image noisy = picture_with(on_catcher(samples, transparent), Denoise::off), clean = picture_with(on_catcher(samples, transparent), Denoise::filter);
            const double raw = error_of_shadows(noisy, reference), filtered = error_of_shadows(clean, reference);
            EXPECT_LT(filtered, gain * raw) << samples << (transparent ? ", alpha " : ", color ") << raw;
            EXPECT_LT(filtered, before) << samples;
            before = filtered;
        }
    }
}

TEST(Denoise, NothingIsLeftOfItOnCatchersWithoutNoise) {
    for (const bool transparent : {true, false}) {
        Scene scene = on_catcher(1024, transparent);
        scene.settings.noise = 0.2;
        EXPECT_TRUE(same_picture(picture_with(scene, Denoise::off), picture_with(scene, Denoise::filter)));
    }
}

// What has the samples that it wants is shown as it is.
TEST(Denoise, NothingIsLeftOfItWithoutNoise) {
    Scene scene = room(1024);
    scene.settings.noise = 0.2;
    EXPECT_TRUE(same_picture(picture_with(scene, Denoise::off), picture_with(scene, Denoise::filter)));
}

// Edits of the setting ask for no ray, and are seen at once.
TEST(Denoise, IsSwitched) {
    Session session = finished(room(2));
    Frame frame;
    session.refresh(frame);
    const RayCounts rays = session.stats().rays;
    for (const Denoise how : {Denoise::off, Denoise::filter}) {
        scene::Settings settings = session.scene().settings;
        settings.denoise = how;
        ASSERT_TRUE(session.edit({scene::SetSettings{settings}}));
        session.refresh(frame);
        EXPECT_TRUE(same_picture(picture_with(room(2), how), frame.image));
    }
    EXPECT_EQ(session.stats().rays.total(), rays.total());
}

// A frame that is brought up to date now and then ends as the picture, whatever was dropped on the way.
TEST(Denoise, Frames) {
    for (const std::int64_t memory : {0, 1}) {
        Scene scene = room(3);
        scene.settings.memory = memory;
        Session session = opened(scene);
        Frame frame;
        while (!session.advance(Deadline::in(std::chrono::milliseconds(3))).done) session.refresh(frame);
        session.refresh(frame);
        EXPECT_TRUE(same_picture(picture_of(room(3)), frame.image)) << memory;
    }
}

// Light that an edit makes to be sampled anew is shown as it was shown before, without its noise, until there is some of the new.
TEST(Denoise, EditsGoOnFromWhatWasShown) {
    const scene::Image reference = picture_with(room(128), Denoise::off);
    Session session = finished(room(4));
    Frame frame;
    session.refresh(frame);
    const double raw = error(picture_with(room(4), Denoise::off), reference), filtered = error(frame.image, reference);
    scene::Light light = session.scene().lights[0];
    light.position.x += 1e-6;
    ASSERT_TRUE(session.edit({scene::SetLight{{0}, light}}));
    for (bool done = false; !done;) {
        done = session.advance(Deadline::in(std::chrono::milliseconds(1))).done;
        session.refresh(frame);
        EXPECT_LT(error(frame.image, reference), (raw + filtered) / 2);
    }
}

// After an edit of one object's material all others are shown as they were until it is done: the picture is nearly the final one long before all is sampled again.
TEST(Outdated, PictureIsNearlyThereEarly) {
    Scene scene = room(64);
    scene.settings.denoise = Denoise::off, scene.settings.order = scene::Order::even;
    Session session = finished(scene);
    const std::uint64_t whole = session.stats().rays.path;
    std::get<PhysicalMaterial>(scene.materials[2].model).base_color = {0.3f, 0.6f, 0.9f};
    ASSERT_TRUE(session.edit({scene::SetMaterial{{2}, scene.materials[2]}}));
    const scene::Image fresh = picture_of(scene);
    while (true) {
        const bool done = session.advance(Deadline::in(std::chrono::milliseconds(2))).done;
        const double asked = double(session.stats().rays.path - whole) / double(whole);
        if (error(session.picture(), fresh) < 0.02 || done) {
            EXPECT_LT(asked, 0.25);
            break;
        }
    }
    session.advance(Deadline::never());
    EXPECT_TRUE(same_picture(fresh, session.picture()));
    EXPECT_GT(session.stats().rays.path - whole, whole / 2) << "in the end all is sampled anew";
}

// Light on the grid: noise of the given deviation about what `truth` says, all of one surface but where `surface` says otherwise.
GuidedGrid noisy_grid(int size, float deviation, const std::function<float(int, int)>& truth, const std::function<std::uint32_t(int, int)>& surface) {
    GuidedGrid grid;
    grid.width = grid.height = size;
    Random random(3);
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) {
            const float value = truth(x, y) + deviation * static_cast<float>(random.uniform(-std::sqrt(3.0), std::sqrt(3.0)));
            grid.guides.push_back({{float(x), float(y), 0}, {0, 0, 1}, surface(x, y), 0});
            grid.light.push_back({gray(value), {}, value, deviation * deviation});
        }
    }
    return grid;
}

TEST(Denoise, KeepsLightAndBorders) {
    constexpr int size = 64;
    parallel::Pool pool(2);
    const auto truth = [](int x, int) { return x < size / 2 ? 1.0f : 1.5f; };
    GuidedGrid grid = noisy_grid(size, 0.3f, truth, [](int x, int) { return x < size / 2 ? 1u : 2u; });
    filter(grid, pool);
    double squares = 0;
    for (int y = 0; y < size; ++y) {
        for (int x = 0; x < size; ++x) squares += std::pow(grid.light[static_cast<std::size_t>(y * size + x)].luminance - truth(x, y), 2);
    }
    EXPECT_LT(std::sqrt(squares) / size, 0.3 / 8) << "noise of 0.3 is left in part";

    // Far from the step of a surface of one kind nothing is known of it; at the step it stays as steep as the noise lets it be told.
    GuidedGrid shadow = noisy_grid(size, 0.02f, truth, [](int, int) { return 1u; });
    filter(shadow, pool);
    for (int y = 0; y < size; ++y) {
        for (const int x : {size / 2 - 1, size / 2}) EXPECT_NEAR(shadow.light[static_cast<std::size_t>(y * size + x)].luminance, truth(x, y), 0.06);
    }

    // What is as good as it should be is left to the bit.
    GuidedGrid good = noisy_grid(size, 0.3f, truth, [](int, int) { return 1u; });
    for (Guide& guide : good.guides) guide.aim = 1;
    GuidedGrid after = good;
    filter(after, pool);
    for (std::size_t i = 0; i < good.light.size(); ++i) EXPECT_EQ(good.light[i].luminance, after.light[i].luminance);
}

// One dot far brighter than all around it, of which one sample says nothing.
TEST(Denoise, DotsAreHeld) {
    constexpr int size = 32;
    parallel::Pool pool(1);
    GuidedGrid grid = noisy_grid(size, 0.1f, [](int, int) { return 1.0f; }, [](int, int) { return 1u; });
    for (FilteredLight& light : grid.light) light.variance = -1;
    FilteredLight& dot = grid.light[static_cast<std::size_t>(16 * size + 16)];
    dot.diffuse = gray(100), dot.luminance = 100;
    filter(grid, pool);
    for (const FilteredLight& light : grid.light) EXPECT_NEAR(light.luminance, 1, 0.15);
}

}  // namespace
}  // namespace crescente::render::testing
