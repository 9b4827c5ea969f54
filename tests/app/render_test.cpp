// Pictures of real scenes: files, counters, time limits and interruption.
#include <png.h>

#include <numeric>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;
using Render = ProgramTest;

const std::string balls = (scenes / "balls4.nff").string();

struct Picture {
    int width = 0, height = 0;
    std::vector<std::uint8_t> rgb;  // empty: the file is no whole PNG
};

Picture read_png(const std::string& file) {
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    if (!png_image_begin_read_from_file(&image, file.c_str())) return {};
    image.format = PNG_FORMAT_RGB;
    Picture picture{static_cast<int>(image.width), static_cast<int>(image.height), std::vector<std::uint8_t>(PNG_IMAGE_SIZE(image))};
    if (!png_image_finish_read(&image, nullptr, picture.rgb.data(), 0, nullptr)) picture.rgb.clear();
    return picture;
}

// How many colours there are: a picture of something has many.
std::size_t colors(const Picture& picture) {
    std::vector<std::uint32_t> all;
    for (std::size_t i = 0; i + 2 < picture.rgb.size(); i += 3) {
        all.push_back(static_cast<std::uint32_t>(picture.rgb[i] << 16 | picture.rgb[i + 1] << 8 | picture.rgb[i + 2]));
    }
    std::sort(all.begin(), all.end());
    return static_cast<std::size_t>(std::unique(all.begin(), all.end()) - all.begin());
}

// The least that changed pixels show: black rows at the bottom would mean that the picture is not whole.
bool bottom_rows_are_drawn(const Picture& picture) {
    const std::size_t row = static_cast<std::size_t>(picture.width) * 3;
    return std::any_of(picture.rgb.end() - static_cast<std::ptrdiff_t>(row * 8), picture.rgb.end(), [](std::uint8_t v) { return v != 0; });
}

TEST_F(Render, PictureOfASceneHasItsSizeAndContent) {
    const Outcome outcome = crescente({"render", balls, "-o", path("a.png"), "--size", "97x61", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    const Picture picture = read_png(path("a.png"));
    EXPECT_EQ(picture.width, 97);
    EXPECT_EQ(picture.height, 61);
    EXPECT_GT(colors(picture), 100u);
    EXPECT_EQ(files(), std::vector<std::string>{"a.png"});
}

TEST_F(Render, BareModelGetsTheStudio) {
    const Outcome outcome = crescente({"render", (scenes / "2CylinderEngine.glb").string(), "-o", path("a.png"), "--size", "120x80"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(colors(read_png(path("a.png"))), 200u);
    EXPECT_TRUE(contains(outcome.out, "120x80"));
}

TEST_F(Render, EveryStudioIsAnother) {
    std::vector<std::string> pictures;
    for (const char* studio : {"default", "softbox", "three-point", "overhead", "tent", "turntable"}) {
        const Outcome outcome = crescente({"render", (scenes / "2CylinderEngine.glb").string(), "-o", path("a.png"), "--size", "60x40", "--studio", studio, "-q"});
        ASSERT_EQ(outcome.code, 0) << studio << outcome.err;
        const Picture picture = read_png(path("a.png"));
        EXPECT_GT(colors(picture), 200u) << studio;
        const double mean = std::accumulate(picture.rgb.begin(), picture.rgb.end(), 0.0) / static_cast<double>(picture.rgb.size());
        EXPECT_GT(mean, 60) << studio;
        EXPECT_LT(mean, 220) << studio;
        pictures.emplace_back(picture.rgb.begin(), picture.rgb.end());
    }
    std::sort(pictures.begin(), pictures.end());
    EXPECT_EQ(std::unique(pictures.begin(), pictures.end()), pictures.end());
    const Outcome unknown = crescente({"render", balls, "-o", path("a.png"), "--studio", "tents"});
    EXPECT_EQ(unknown.code, 2);
    EXPECT_TRUE(contains(unknown.err, "there is no studio 'tents'")) << unknown.err;
    EXPECT_TRUE(contains(unknown.err, "'tent'")) << unknown.err;
}

TEST_F(Render, EnvironmentLightsABareModel) {
    const std::string model = (scenes / "2CylinderEngine.glb").string();
    // What another picture is, another can be seen in.
    const Outcome made = crescente({"render", balls, "-o", path("around.hdr"), "--size", "64x32", "-q"});
    if (made.code != 0 && contains(made.err, "OpenImageIO")) GTEST_SKIP() << "built without OpenImageIO";
    ASSERT_EQ(made.code, 0) << made.err;
    const Outcome lit = crescente({"render", model, "-o", path("lit.png"), "--size", "60x40", "--environment", path("around.hdr"), "-q"});
    ASSERT_EQ(lit.code, 0) << lit.err;
    EXPECT_GT(colors(read_png(path("lit.png"))), 200u);
    const Outcome turned = crescente({"render", model, "-o", path("turned.png"), "--size", "60x40", "--environment", path("around.hdr"), "--set", "environment.rotation=90", "-q"});
    ASSERT_EQ(turned.code, 0) << turned.err;
    EXPECT_NE(read_png(path("turned.png")).rgb, read_png(path("lit.png")).rgb);
    const Outcome absent = crescente({"render", model, "-o", path("a.png"), "--environment", path("absent.hdr")});
    EXPECT_EQ(absent.code, 3) << absent.err;
    EXPECT_TRUE(contains(absent.err, "absent.hdr")) << absent.err;
    const Outcome neither = crescente({"render", path("absent.glb"), "-o", path("a.png"), "--environment", path("absent.hdr")});
    EXPECT_EQ(neither.code, 3) << neither.err;
    EXPECT_TRUE(contains(neither.err, "absent.glb") && contains(neither.err, "absent.hdr")) << neither.err;
}

TEST_F(Render, DaylightByAnglesOrByTimeAndPlace) {
    const std::string model = (scenes / "2CylinderEngine.glb").string();
    const auto render = [&](const char* name, const char* sky) {
        const Outcome outcome = crescente({"render", model, "-o", path(name), "--size", "60x40", "--sky", sky, "-q"});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return read_png(path(name)).rgb;
    };
    const auto noon = render("noon.png", "180,50"), evening = render("evening.png", "290,6"), there = render("there.png", "2024-06-21T12:36,38.72,-9.14,4");
    EXPECT_FALSE(noon.empty());
    EXPECT_NE(noon, evening);
    EXPECT_NE(noon, there);
    for (const auto& [sky, said] : {std::pair{"10", "no place of the sun"}, {"0,-5", "-5.0 degrees, below the horizon"}, {"2024-02-30T12:00,0,0", "no date"}, {"0,45,99", "turbidity"},
                                    {"2024-06-21T12:00,95,0", "latitude"}, {"2024-12-21T12:00,80,0", "below the horizon"}}) {
        const Outcome outcome = crescente({"render", model, "-o", path("a.png"), "--sky", sky});
        EXPECT_EQ(outcome.code, 2) << sky;
        EXPECT_TRUE(contains(outcome.err, said)) << outcome.err;
    }
}

TEST_F(Render, TransparentBackgroundAndGroundThatCatches) {
    const std::string model = (scenes / "2CylinderEngine.glb").string();
    const Outcome done = crescente({"render", model, "-o", path("a.png"), "--size", "60x40", "--ground", "catch", "--background", "transparent", "-q"});
    ASSERT_EQ(done.code, 0) << done.err;
    std::ifstream stream(path("a.png"), std::ios::binary);
    const std::string png{std::istreambuf_iterator<char>(stream), {}};
    ASSERT_GT(png.size(), 26u);
    EXPECT_EQ(png[25], 6) << "the colour type with alpha";
    const Outcome refused = crescente({"render", model, "-o", path("a.jpg"), "--size", "60x40", "--background", "transparent"});
    EXPECT_NE(refused.code, 0);
    EXPECT_TRUE(contains(refused.err, "no alpha channel")) << refused.err;
    const Outcome blue = crescente({"render", model, "-o", path("blue.png"), "--size", "60x40", "--background", "#0000ff", "--ground", "none", "-q"});
    ASSERT_EQ(blue.code, 0) << blue.err;
    EXPECT_GT(read_png(path("blue.png")).rgb[2], 200);
    EXPECT_LT(read_png(path("blue.png")).rgb[0], 60);
    const Outcome wrong = crescente({"render", model, "-o", path("a.png"), "--background", "blue"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_TRUE(contains(wrong.err, "'blue' is no background")) << wrong.err;
}

// However bright the scene is, it is developed alike.
TEST_F(Render, AutomaticExposure) {
    const std::string model = (scenes / "2CylinderEngine.glb").string();
    const auto render = [&](const char* name, const std::vector<std::string>& more) {
        std::vector<std::string> arguments{"render", model, "-o", path(name), "--size", "60x40", "--sky", "200,40", "--tonemap", "srgb", "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = crescente(arguments);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return read_png(path(name)).rgb;
    };
    EXPECT_EQ(render("a.png", {"--exposure", "auto"}), render("b.png", {"--set", "environment.intensity=1", "--set", "settings.auto_exposure=true"}));
    const auto normal = render("c.png", {"--exposure", "auto"}), brighter = render("d.png", {"--exposure", "auto", "--set", "settings.exposure=1"});
    EXPECT_GT(std::accumulate(brighter.begin(), brighter.end(), 0.0), 1.15 * std::accumulate(normal.begin(), normal.end(), 0.0));
}

TEST_F(Render, NamedViewsDiffer) {
    std::vector<std::string> pictures;
    for (const char* view : {"front", "back", "left", "right", "top", "bottom", "iso"}) {
        const std::string file = path(std::string(view) + ".png");
        const Outcome outcome = crescente({"render", balls, "-o", file, "--size", "48x48", "--level", "0", "--camera", view, "-q"});
        ASSERT_EQ(outcome.code, 0) << view << outcome.err;
        const Picture picture = read_png(file);
        pictures.emplace_back(picture.rgb.begin(), picture.rgb.end());
    }
    std::sort(pictures.begin(), pictures.end());
    EXPECT_EQ(std::unique(pictures.begin(), pictures.end()), pictures.end());
}

TEST_F(Render, OrthographicDiffersFromPerspective) {
    ASSERT_EQ(crescente({"render", balls, "-o", path("p.png"), "--size", "48x48", "--level", "0", "-q"}).code, 0);
    ASSERT_EQ(crescente({"render", balls, "-o", path("o.png"), "--size", "48x48", "--level", "0", "-q", "--orthographic"}).code, 0);
    const Picture orthographic = read_png(path("o.png"));
    EXPECT_NE(read_png(path("p.png")).rgb, orthographic.rgb);
    EXPECT_GT(colors(orthographic), 20u);
}

// Through a lens that is focused on the middle all is blurred but what is as far away; the options are those of the fields.
TEST_F(Render, Lens) {
    const auto render = [&](const char* name, std::vector<std::string> options) {
        std::vector<std::string> words{"render", balls, "-o", path(name), "--size", "48x48", "--level", "soft", "--samples", "4", "-q"};
        words.insert(words.end(), options.begin(), options.end());
        const Outcome outcome = crescente(words);
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return read_png(path(name)).rgb;
    };
    const auto sharp = render("sharp.png", {}), focused = render("focused.png", {"--aperture", "0.3", "--focus", "auto"});
    EXPECT_NE(focused, sharp);
    EXPECT_NE(render("near.png", {"--aperture", "0.3", "--focus", "0.5"}), focused);
    EXPECT_EQ(render("fields.png", {"--set", "camera.aperture=0.3", "--set", "camera.blades=5"}), render("options.png", {"--aperture", "0.3", "--blades", "5", "--shutter", "0,1"}));
    const Outcome nothing = crescente({"render", balls, "-o", path("no.png"), "--focus", "auto", "--camera", "0,0,50,0,0,100"});
    EXPECT_EQ(nothing.code, 2) << nothing.err;
    EXPECT_TRUE(contains(nothing.err, "nothing in the middle")) << nothing.err;
}

TEST_F(Render, SeveralOutputsAtOnce) {
    const Outcome outcome = crescente({"render", balls, "-o", path("a.png"), "-o", path("b.exr"), "--size", "32x32", "--bits", "16"});
    if (outcome.code == 5) GTEST_SKIP() << "this build has no OpenImageIO";
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(files(), (std::vector<std::string>{"a.png", "b.exr"}));
    const std::string exr = read(path("b.exr"));
    EXPECT_EQ(exr.substr(0, 4), std::string("\x76\x2f\x31\x01"));
    for (const char* channel : {"depth", "normal", "albedo", "samples"}) EXPECT_TRUE(exr.find(channel) != std::string::npos) << channel;
    EXPECT_EQ(static_cast<int>(read(path("a.png"))[24]), 16);  // bit depth in the PNG's header
}

TEST_F(Render, StatsHaveTheDocumentedFields) {
    const Outcome outcome = crescente({"render", balls, "-o", path("a.png"), "--size", "64x64", "--threads", "1", "--stats", path("s.json")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json stats = Json::parse(read(path("s.json")));
    for (const char* kind : {"camera", "reflected", "refracted", "shadow"}) EXPECT_TRUE(stats.at("rays").at(kind).is_number_unsigned()) << kind;
    EXPECT_GE(stats["rays"]["camera"], 65u * 65u);
    EXPECT_GT(stats["rays"]["reflected"], 0u);
    EXPECT_EQ(stats["rays"]["refracted"], 0u);
    EXPECT_GT(stats["rays"]["shadow"], 0u);
    EXPECT_GT(stats.at("nodes"), 0u);
    EXPECT_GT(stats.at("bytes_per_pixel"), 0.0);
    EXPECT_EQ(stats.at("threads"), 1);
    EXPECT_EQ(stats.at("ended_by"), "complete");
    for (const char* part : {"load", "render", "total"}) EXPECT_TRUE(stats.at("time").at(part).is_number()) << part;
    EXPECT_GE(stats["time"]["total"].get<double>(), stats["time"]["render"].get<double>());
    ASSERT_EQ(stats.at("levels").size(), 4u);
    std::uint64_t rays = 0;
    for (const Json& level : stats["levels"]) {
        EXPECT_TRUE(level.at("name").is_string() && level.at("time").is_number());
        rays += level.at("rays").at("total").get<std::uint64_t>();
    }
    EXPECT_EQ(rays, stats["rays"]["total"].get<std::uint64_t>());
    EXPECT_EQ(stats.at("scene").at("hash").get<std::string>().size(), 16u);
    for (const char* field : {"version", "command", "tests", "memory"}) EXPECT_TRUE(stats.contains(field)) << field;
}

TEST_F(Render, PictureTellsWhereItComesFrom) {
    ASSERT_EQ(crescente({"render", balls, "-o", path("a.png"), "--size", "16x16", "-q"}).code, 0);
    const std::string png = read(path("a.png"));
    for (const char* part : {"Software", "Crescente", "--size 16x16", "xxh64:", "\"rays\""}) EXPECT_NE(png.find(part), std::string::npos) << part;
}

TEST_F(Render, LowerLevelsTraceLess) {
    std::uint64_t last = 0;
    for (const char* level : {"visible", "shadows", "reflections", "edges"}) {
        ASSERT_EQ(crescente({"render", balls, "-o", path("a.png"), "--size", "64x64", "--level", level, "-q", "--stats", path("s.json")}).code, 0);
        const std::uint64_t rays = Json::parse(read(path("s.json")))["rays"]["total"];
        EXPECT_GT(rays, last) << level;
        last = rays;
    }
}

TEST_F(Render, ThreadsAndAcceleratorsGiveThePictureToTheBit) {
    const auto render = [&](const std::string& name, std::vector<std::string> more) {
        std::vector<std::string> arguments{"render", balls, "-o", path(name), "--size", "80x60", "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(crescente(arguments).code, 0);
        return read_png(path(name)).rgb;
    };
    const auto reference = render("a.png", {"--threads", "1"});
    EXPECT_EQ(render("b.png", {"--threads", "3"}), reference);
    EXPECT_EQ(render("c.png", {"--accel", "kay-kajiya"}), reference);
    EXPECT_EQ(render("d.png", {"--memory", "8M"}), reference);
}

TEST_F(Render, TimeLimitGivesAWholePicture) {
    const Outcome outcome =
        crescente({"render", balls, "-o", path("a.png"), "--size", "1600x1200", "--threads", "1", "--time", "0s", "--stats", path("s.json")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "the time was over"));
    EXPECT_EQ(Json::parse(read(path("s.json")))["ended_by"], "time");
    const Picture picture = read_png(path("a.png"));
    ASSERT_EQ(picture.width, 1600);
    EXPECT_GT(colors(picture), 50u);
    EXPECT_TRUE(bottom_rows_are_drawn(picture));
}

TEST_F(Render, FirstInterruptFinishesWithAWholePicture) {
    for (const int signal : {SIGINT, SIGTERM}) {
        Running running(command({"render", balls, "-o", path("a.png"), "--size", "4000x3000", "--threads", "1", "--stats", path("s.json")}), {});
        ASSERT_TRUE(running.wait_for_error_text("rendering"));
        running.send(signal);
        const Outcome outcome = running.finish();
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_TRUE(contains(outcome.err, "stopped before the picture was complete"));
        EXPECT_EQ(Json::parse(read(path("s.json")))["ended_by"], "signal");
        const Picture picture = read_png(path("a.png"));
        ASSERT_EQ(picture.width, 4000);
        EXPECT_TRUE(bottom_rows_are_drawn(picture));
        fs::remove(path("a.png"));
    }
}

TEST_F(Render, SecondInterruptStopsAndLeavesTheOldFile) {
    write("a.png", "what was here before");
    // Brute force on a large picture: there is time between the two signals, whatever the machine.
    Running running(command({"render", balls, "-o", path("a.png"), "--size", "8000x6000", "--threads", "1", "--accel", "linear"}), {});
    ASSERT_TRUE(running.wait_for_error_text("rendering"));
    running.send(SIGINT);
    usleep(50'000);  // signals of one kind that meet are one signal
    running.send(SIGINT);
    const Outcome outcome = running.finish();
    EXPECT_EQ(outcome.code, 130) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "nothing was written"));
    EXPECT_EQ(read(path("a.png")), "what was here before");
    EXPECT_EQ(files(), std::vector<std::string>{"a.png"});
}

TEST_F(Render, ReplayTellsAPixelsTree) {
    const Outcome outcome = crescente({"render", balls, "-o", path("a.png"), "--size", "64x64", "--replay", "32,32", "-q"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_GT(count(outcome.out, "\n"), 4u) << outcome.out;
    EXPECT_TRUE(contains(outcome.out, "camera ray from (2.1 1.3 1.7), ")) << outcome.out;
    const Outcome outside = crescente({"render", balls, "-o", path("b.png"), "--size", "64x64", "--replay", "64,0", "-q"});
    EXPECT_EQ(outside.code, 2);
    EXPECT_TRUE(contains(outside.err, "outside the picture"));
}

TEST_F(Render, PickTellsWhatIsUnderAPixel) {
    const Outcome outcome = crescente({"render", balls, "-o", path("a.png"), "--size", "64x64", "--pick", "32,32", "--replay", "32,32", "-q"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* said : {"object    ", "shape     sphere", "material  ", "position  ", "normal    "}) EXPECT_TRUE(contains(outcome.out, said)) << outcome.out;
    EXPECT_EQ(crescente({"render", balls, "-o", path("b.png"), "--size", "64x64", "--pick", "0,64", "-q"}).code, 2);
}

TEST_F(Render, TonemapAndExposureChangeThePicture) {
    const auto render = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"render", balls, "-o", path("a.png"), "--size", "40x30", "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        EXPECT_EQ(crescente(arguments).code, 0);
        return read_png(path("a.png")).rgb;
    };
    const auto automatic = render({});
    EXPECT_EQ(render({"--tonemap", "srgb"}), automatic);  // classic materials
    EXPECT_NE(render({"--tonemap", "neutral"}), automatic);
    EXPECT_NE(render({"--exposure", "-1"}), automatic);
}

}  // namespace
}  // namespace crescente::test
