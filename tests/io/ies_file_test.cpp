#include "io/ies_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <unistd.h>

#include "io/edit_text.h"
#include "io/formats.h"
#include "io/overrides.h"
#include "io/scene_file.h"
#include "scene/edit.h"
#include "scene/validate.h"

using namespace crescente;
namespace fs = std::filesystem;

namespace {

constexpr double degree = math::pi / 180;

// A lamp of four quadrants: 3 vertical and 2 horizontal angles, twice the candela that are written.
const std::string lamp = "IESNA:LM-63-2002\r\n[TEST] none\r\n[MANUFAC] nobody, TILT is below\r\nTILT=NONE\r\n"
                         "1 1000 2.0 3 2 1 2 0.1 0.1 0\r\n1.0 1.0 100\r\n0 45 90\r\n0 90\r\n100 80,40\r\n100 60\r\n 20\r\n";

std::string problem_of(const std::string& text) {
    const auto read = io::read_ies(text, "lamp.ies");
    return read ? "none" : read.error().text();
}

void expect_says(const std::string& text, const std::string& part) { EXPECT_NE(text.find(part), std::string::npos) << text; }

std::string with(const std::string& from, const std::string& to) {
    std::string text = lamp;
    const auto at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(IesFile, ReadsAnglesAndCandela) {
    const auto read = io::read_ies(lamp, "lamp.ies");
    ASSERT_TRUE(read) << read.error().text();
    const scene::LightProfile& p = **read;
    EXPECT_DOUBLE_EQ(p.intensity(0, 0), 200);
    EXPECT_DOUBLE_EQ(p.intensity(45 * degree, 0), 160);
    EXPECT_DOUBLE_EQ(p.intensity(90 * degree, 90 * degree), 40);
    EXPECT_DOUBLE_EQ(p.intensity(22.5 * degree, 0), 180) << "between angles it is linear";
    EXPECT_NEAR(p.intensity(45 * degree, 45 * degree), 140, 1e-9);
    for (const double about : {30.0, 150.0, 210.0, 330.0, -30.0, 390.0}) EXPECT_NEAR(p.intensity(45 * degree, about * degree), 160 - 40.0 / 3, 1e-9) << "the quadrants are alike";
    EXPECT_EQ(p.intensity(91 * degree, 0), 0) << "nothing was measured there";
    EXPECT_EQ(p.strongest(), 200);
}

TEST(IesFile, KnowsHalvesAndWholeTurns) {
    const auto whole = io::read_ies("IESNA91\nTILT=NONE\n1 -1 1 2 5 1 1 0 0 0\n1 1 5\n0 180\n0 90 180 270 360\n1 1\n2 2\n3 3\n4 4\n1 1\n", "lamp.ies");
    ASSERT_TRUE(whole) << whole.error().text();
    EXPECT_NEAR((*whole)->intensity(1, 270 * degree), 4, 1e-9);
    EXPECT_NEAR((*whole)->intensity(1, 315 * degree), 2.5, 1e-9);
    const auto half = io::read_ies("TILT=NONE\n1 -1 1 2 3 1 1 0 0 0\n1 1 5\n0 180\n0 90 180\n1 1\n2 2\n3 3\n", "lamp.ies");
    ASSERT_TRUE(half) << half.error().text();
    EXPECT_NEAR((*half)->intensity(1, 270 * degree), 2, 1e-9);
    EXPECT_NEAR((*half)->intensity(1, 180 * degree), 3, 1e-9);
    const auto even = io::read_ies("TILT=NONE\n1 -1 1 2 1 1 1 0 0 0\n0.5 1 5\n90 180\n0\n8 10\n", "lamp.ies");
    ASSERT_TRUE(even) << even.error().text();
    EXPECT_NEAR((*even)->intensity(135 * degree, 2), 4.5, 1e-9);
    EXPECT_EQ((*even)->intensity(80 * degree, 2), 0);
}

TEST(IesFile, TellsWhatIsWrongAndInWhichLine) {
    expect_says(problem_of(""), "lamp.ies: line 1: there is no line TILT=");
    expect_says(problem_of(with("TILT=NONE", "TILT=INCLUDE")), "line 4: 'TILT=INCLUDE'");
    expect_says(problem_of(with("2.0 3", "two 3")), "line 5: 'two' should be the candela multiplier");
    expect_says(problem_of(with("3 2 1 2", "3 2 3 2")), "type C");
    expect_says(problem_of(with("3 2 1 2", "3000 2000 1 2")), "there cannot be so many angles");
    expect_says(problem_of(with("3 2 1 2", "3 0 1 2")), "there cannot be so many angles");
    expect_says(problem_of(with("0 45 90", "0 95 90")), "line 7: the vertical angles must rise");
    expect_says(problem_of(with("\r\n0 90\r\n", "\r\n0 70\r\n")), "line 8: the horizontal angles must rise");
    expect_says(problem_of(with("80,40", "-80,40")), "line 9: a candela value");
    expect_says(problem_of(with(" 20\r\n", "")), "the file ends where there should be a candela value");
    expect_says(problem_of(with("2.0 3", "1e999 3")), "line 5");
}

TEST(IesFile, IsReadWithItsScene) {
    const fs::path folder = fs::temp_directory_path() / ("crescente-ies-" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "lamp.ies") << lamp;
    std::ofstream(folder / "scene.json") << R"({"lights": {"lamp": {"profile": "lamp.ies", "intensity": 3}}, "objects": {"ball": {"shape": {"sphere": {}}}}})";
    const auto loaded = io::read_scene(folder / "scene.json");
    ASSERT_TRUE(loaded) << loaded.error().text();
    const scene::Light& light = loaded->scene.lights[0];
    ASSERT_TRUE(light.measured);
    EXPECT_EQ(light.measured->strongest(), 200);
    std::ofstream(folder / "again.json") << io::write_scene_text(loaded->scene);
    const auto again = io::read_scene(folder / "again.json");
    ASSERT_TRUE(again) << again.error().text();
    EXPECT_EQ(*again->scene.lights[0].measured, *light.measured);

    scene::Scene s = loaded->scene;
    ASSERT_TRUE(io::apply_override(s, "light.lamp.profile=\"\""));
    EXPECT_FALSE(s.lights[0].measured);
    const auto edits = io::read_edit_text(R"({"light": {"name": "lamp", "profile": "lamp.ies"}})", s, (folder / "script").string());
    ASSERT_TRUE(edits) << edits.error().text();
    scene::apply_unchecked(*edits, s);
    EXPECT_TRUE(s.lights[0].measured);
    s.lights[0].kind = scene::LightKind::disk;
    const Problems problems = scene::validate(s, "");
    ASSERT_FALSE(problems.empty());
    expect_says(problems[0].text(), "only point lights have one");

    std::ofstream(folder / "broken.json") << R"({"lights": {"lamp": {"profile": "absent.ies"}}, "objects": {"ball": {"shape": {"sphere": {}}}}})";
    const auto broken = io::read_scene(folder / "broken.json");
    ASSERT_FALSE(broken);
    expect_says(broken.error().text(), "/lights/lamp/profile: ");
    fs::remove_all(folder);
}

}  // namespace
