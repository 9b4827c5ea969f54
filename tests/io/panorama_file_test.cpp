#include "io/panorama_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <unistd.h>

#include "io/edit_text.h"
#include "io/formats.h"
#include "io/image_file.h"
#include "io/openimageio.h"
#include "io/overrides.h"
#include "io/scene_file.h"

using namespace crescente;
namespace fs = std::filesystem;

namespace {

class PanoramaFile : public testing::Test {
protected:
    void SetUp() override {
        if (!io::has_openimageio()) GTEST_SKIP() << "built without OpenImageIO";
        folder_ = fs::temp_directory_path() / ("crescente-panoramas-" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    // An EXR of these values, pixel by pixel.
    fs::path write(const std::string& name, int width, int height, std::vector<std::string> channels, std::vector<float> values) const {
        const fs::path file = folder_ / name;
        EXPECT_TRUE(io::write_image({width, height, {{"color", std::move(channels), std::move(values)}}}, file, {}));
        return file;
    }
    std::string problem_of(const fs::path& file) const {
        const auto read = io::read_panorama(file);
        return read ? "none" : read.error().text();
    }
    static void expect_says(const std::string& text, const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << text; }

    fs::path folder_;
};

const std::vector<std::string> rgb{"R", "G", "B"};
std::vector<float> ramp(int count) {
    std::vector<float> values;
    for (int i = 0; i < count; ++i) values.push_back(0.25f * static_cast<float>(i));
    return values;
}

TEST_F(PanoramaFile, ReadsWhatIsThere) {
    const auto read = io::read_panorama(write("sky.exr", 4, 2, rgb, ramp(24)));
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_TRUE(read->warnings.empty());
    EXPECT_EQ(read->panorama->width(), 4);
    EXPECT_EQ(read->panorama->height(), 2);
    EXPECT_EQ(read->panorama->pixels()[5], (math::Rgb{3.75f, 4, 4.25f}));

    const auto alpha = io::read_panorama(write("alpha.exr", 2, 1, {"R", "G", "B", "A"}, {1, 2, 3, 0.5f, 4, 5, 6, 1}));
    ASSERT_TRUE(alpha) << alpha.error().text();
    EXPECT_EQ(alpha->panorama->pixels()[0], (math::Rgb{1, 2, 3}));
    const auto grey = io::read_panorama(write("grey.exr", 2, 1, {"Y"}, {1, 2}));
    ASSERT_TRUE(grey) << grey.error().text();
    EXPECT_EQ(grey->panorama->pixels()[1], math::gray(2));
    const auto display = io::read_panorama(write("display.png", 2, 1, rgb, {1, 0.214f, 0, 0, 0, 0}));
    ASSERT_TRUE(display) << display.error().text();
    EXPECT_NEAR(display->panorama->pixels()[0].g, 0.214f, 0.004f);
}

// The process that decodes has no threads of the one that wrote.
TEST_F(PanoramaFile, IsReadAfterLargePicturesWereWritten) {
    const fs::path file = write("large.exr", 1024, 512, rgb, ramp(1024 * 512 * 3));
    write("large.jpg", 1024, 512, rgb, ramp(1024 * 512 * 3));
    const auto read = io::read_panorama(file);
    ASSERT_TRUE(read) << read.error().text();
    EXPECT_EQ(read->panorama->pixels()[1024 * 512 - 1].b, 0.25f * (1024 * 512 * 3 - 1));
    const fs::path half = fs::path(CRESCENTE_SHARED) / "assets/hdri/studio_512_dwab.exr";
    if (!fs::exists(half)) GTEST_SKIP() << "the shared assets are not here";
    const auto shared = io::read_panorama(half);
    ASSERT_TRUE(shared) << shared.error().text();
    EXPECT_EQ(shared->panorama->width(), 512);
    EXPECT_TRUE(shared->panorama->shines());
}

TEST_F(PanoramaFile, TellsWhatIsWrong) {
    expect_says(problem_of(folder_ / "absent.hdr"), "absent.hdr");
    expect_says(problem_of(folder_), folder_.filename().string());
    std::ofstream(folder_ / "text.hdr") << "no picture at all";
    expect_says(problem_of(folder_ / "text.hdr"), "text.hdr: the picture is no picture");
    const fs::path whole = write("whole.hdr", 64, 32, rgb, ramp(64 * 32 * 3));
    fs::resize_file(whole, fs::file_size(whole) / 2);
    expect_says(problem_of(whole), "damaged");
    expect_says(problem_of(write("two.exr", 2, 1, {"R", "G"}, {1, 2, 3, 4})), "2 channels");
    expect_says(problem_of(write("five.exr", 2, 1, {"R", "G", "B", "A", "Z"}, ramp(10))), "5 channels");
    std::vector<float> values = ramp(24);
    values[3 * 6 + 1] = std::nanf(""), values[23] = INFINITY;
    expect_says(problem_of(write("holes.exr", 4, 2, rgb, values)), "2 samples of the picture are no finite numbers, the first in column 2 of row 1");
    // A head that promises more pixels than may be, and no pixel.
    std::ofstream(folder_ / "giant.hdr") << "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 60000 +X 120000\n";
    expect_says(problem_of(folder_ / "giant.hdr"), "giant.hdr: the picture ");
}

TEST_F(PanoramaFile, WarnsOfWhatItMends) {
    const auto read = io::read_panorama(write("odd.exr", 3, 2, rgb, {1, 1, -1, 1, 1, 1, -0.5f, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}));
    ASSERT_TRUE(read) << read.error().text();
    ASSERT_EQ(read->warnings.size(), 2u);
    expect_says(read->warnings[0].text(), "2 samples of the picture are negative");
    expect_says(read->warnings[1].text(), "3 x 2");
    EXPECT_EQ(read->panorama->pixels()[2], (math::Rgb{0, 1, 1}));
}

TEST_F(PanoramaFile, RefusesStrips) {
    expect_says(problem_of(write("strip.exr", 65, 1, rgb, ramp(195))), "65 x 1 pixels cannot surround anything");
    expect_says(problem_of(write("tower.exr", 1, 65, rgb, ramp(195))), "1 x 65 pixels cannot surround anything");
    EXPECT_TRUE(io::read_panorama(write("wide.exr", 64, 1, rgb, ramp(192))));
}

TEST_F(PanoramaFile, WarningsReachWhoeverEdits) {
    const fs::path odd = write("odd.exr", 3, 2, rgb, ramp(18));
    scene::Scene s;
    const auto warned = io::apply_override(s, "environment.image=" + odd.string());
    ASSERT_TRUE(warned);
    ASSERT_EQ(warned->size(), 1u);
    expect_says(warned->front().text(), "3 x 2");
    for (const char* edit : {R"({"set": {"environment.image": "odd.exr"}})", R"({"environment": {"image": "odd.exr"}})"}) {
        Problems warnings;
        const auto json = [&] {
            io::ProblemList problems{"script"};
            return io::parse_json(edit, problems);
        }();
        ASSERT_TRUE(io::read_edit(*json, s, (folder_ / "script").string(), &warnings));
        ASSERT_EQ(warnings.size(), 1u) << edit;
    }
}

TEST_F(PanoramaFile, ASkyIsMadeWhereOneIsSaid) {
    std::ofstream(folder_ / "scene.json") << R"({"environment": {"sky": "160,40,2.5", "rotation": 20}, "objects": {"ball": {"shape": {"sphere": {}}}}})";
    const auto loaded = io::read_scene(folder_ / "scene.json");
    ASSERT_TRUE(loaded) << loaded.error().text();
    ASSERT_TRUE(loaded->scene.environment->panorama);
    EXPECT_TRUE(loaded->scene.environment->lights());
    EXPECT_TRUE(loaded->scene.lights.empty()) << "the sun is the sky's own";
    std::ofstream(folder_ / "again.json") << io::write_scene_text(loaded->scene);
    const auto again = io::read_scene(folder_ / "again.json");
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->scene.environment, loaded->scene.environment);

    std::ofstream(folder_ / "night.json") << R"({"environment": {"sky": "160,-4"}, "objects": {"ball": {"shape": {"sphere": {}}}}})";
    const auto night = io::read_scene(folder_ / "night.json");
    ASSERT_FALSE(night);
    expect_says(night.error().text(), "night.json: line 1, /environment/sky: ");
    expect_says(night.error().text(), "-4.0 degrees, below the horizon");

    scene::Scene s = loaded->scene;
    const auto edits = io::read_edit_text(R"({"set": {"environment.sky": "2024-06-21T14:30,38.7,-9.1"}})", s, "script");
    ASSERT_TRUE(edits) << edits.error().text();
    scene::apply_unchecked(*edits, s);
    EXPECT_NE(s.environment->panorama->content(), loaded->scene.environment->panorama->content());
}

TEST_F(PanoramaFile, IsReadWithItsScene) {
    write("sky.exr", 4, 2, rgb, ramp(24));
    std::ofstream(folder_ / "scene.json") << R"({"environment": {"image": "sky.exr", "rotation": 90, "intensity": 2}, "objects": {"ball": {"shape": {"sphere": {}}}}})";
    const auto loaded = io::read_scene(folder_ / "scene.json");
    ASSERT_TRUE(loaded) << loaded.error().text();
    const scene::Environment& e = *loaded->scene.environment;
    ASSERT_TRUE(e.panorama);
    EXPECT_DOUBLE_EQ(e.rotation, math::pi / 2);
    EXPECT_TRUE(e.lights());
    EXPECT_EQ(fs::path(e.image), folder_ / "sky.exr") << "so that the scene may be written elsewhere";

    std::ofstream(folder_ / "again.json") << io::write_scene_text(loaded->scene);
    const auto again = io::read_scene(folder_ / "again.json");
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(again->scene.environment, loaded->scene.environment);

    std::ofstream(folder_ / "broken.json") << R"({"environment": {"image": "absent.exr"}, "objects": {"ball": {"shape": {"sphere": {}}}}})";
    const auto broken = io::read_scene(folder_ / "broken.json");
    ASSERT_FALSE(broken);
    expect_says(broken.error().text(), "broken.json: line 1, /environment/image: ");
    expect_says(broken.error().text(), "absent.exr");
}

TEST_F(PanoramaFile, IsReadByEditsAndOverrides) {
    const fs::path sky = write("sky.exr", 4, 2, rgb, ramp(24)), other = write("other.exr", 2, 1, rgb, ramp(6));
    scene::Scene s;
    ASSERT_TRUE(io::apply_override(s, "environment.image=" + sky.string()));
    ASSERT_TRUE(s.environment->panorama);
    EXPECT_EQ(s.environment->panorama->width(), 4);
    ASSERT_TRUE(io::apply_override(s, "environment.rotation=30"));
    EXPECT_EQ(s.environment->panorama->width(), 4) << "kept";
    const auto edits = io::read_edit_text(R"({"set": {"environment.image": "other.exr"}})", s, (folder_ / "script").string());
    ASSERT_TRUE(edits) << edits.error().text();
    scene::apply_unchecked(*edits, s);
    EXPECT_EQ(s.environment->panorama->width(), 2);
    const auto absent = io::apply_override(s, "environment.image=absent.exr");
    ASSERT_FALSE(absent);
    expect_says(absent.error().text(), "absent.exr");
    ASSERT_TRUE(io::apply_override(s, "environment.image=\"\""));
    EXPECT_FALSE(s.environment->panorama);
}

}  // namespace
