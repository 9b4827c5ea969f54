// CAD files by the real program: info, cache, compare.
#include <cstdlib>
#include <fstream>
#include <iterator>

#include <nlohmann/json.hpp>
#include <unistd.h>

#include "app/program.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;

class Cad : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists(fs::path(CRESCENTE_PROGRAM).parent_path() / "../lib/crescente_opencascade.so")) GTEST_SKIP() << "this build is without OpenCASCADE";
        if (!fs::exists(assembly_)) GTEST_SKIP() << "the shared CAD assets are not here";
        fs::create_directories(cache_);
        setenv("XDG_CACHE_HOME", cache_.c_str(), 1);
    }
    void TearDown() override {
        fs::remove_all(cache_);
        unsetenv("XDG_CACHE_HOME");
    }
    std::size_t entries() const {
        std::size_t count = 0;
        for (const auto& each : fs::recursive_directory_iterator(cache_)) count += each.is_regular_file();
        return count;
    }

    const std::string assembly_ = std::string(CRESCENTE_SHARED) + "/assets/cad/05_as1-oc-214.stp";
    const fs::path cache_ = fs::temp_directory_path() / ("crescente_app_cad_" + std::to_string(getpid()));
};

TEST_F(Cad, InfoTellsTreeAndSurfaces) {
    const Outcome outcome = crescente({"info", assembly_});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* words : {"53, shown 160 with instances", "25 plane, 28 b-spline", "nut-bolt-assembly_1 x 3", "plate_1: 18 faces"}) {
        EXPECT_TRUE(contains(outcome.out, words)) << words << '\n' << outcome.out;
    }
    const Outcome machine = crescente({"info", assembly_, "--json"});
    const Json cad = Json::parse(machine.out).at("cad");
    EXPECT_EQ(cad.at("exact"), 53);
    EXPECT_EQ(cad.at("surfaces").at("plane"), 25);
    EXPECT_EQ(cad.at("tree").size(), 14u);
    EXPECT_EQ(machine.out, crescente({"info", assembly_, "--json", "--no-cache"}).out);  // from the cache or not
}

TEST_F(Cad, TheCacheIsUsedUnlessForbidden) {
    ASSERT_EQ(crescente({"info", assembly_, "--no-cache"}).code, 0);
    EXPECT_EQ(entries(), 0u);
    ASSERT_EQ(crescente({"info", assembly_}).code, 0);
    EXPECT_EQ(entries(), 1u);
    ASSERT_EQ(crescente({"info", assembly_}).code, 0);
    EXPECT_EQ(entries(), 1u);
}

// What edits made of a CAD model is a scene file of its own, which names the model for its exact faces.
TEST_F(Cad, EditedModelsAreWrittenAsScenesAndRenderAlike) {
    fs::copy_file(assembly_, cache_ / "as1.stp");
    const fs::path script = cache_ / "edits.jsonl", scene = cache_ / "edited.json", again = cache_ / "again.json", first = cache_ / "first.png", second = cache_ / "second.png", third = cache_ / "third.png";
    std::ofstream(script) << R"({"material": {"name": "gold", "base_color": [1, 0.7, 0.3], "metallic": 1, "roughness": 0.2}}
{"assign": {"object": "plate_1", "material": "gold", "below": true}}
{"move": {"object": "rod-assembly_1", "by": [{"rotate": {"axis": "y", "angle": 20}}, {"translate": [7.3, 11, 0]}]}}
{"remove": "l-bracket-assembly_1"}
{"light": {"name": "lamp", "position": [50, 300, 200], "intensity": 0.3}}
{"hide": "nut_1"}
)";
    const std::vector<std::string> size{"--size", "160x100", "-q"};
    const auto run = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.end(), size.begin(), size.end());
        return crescente(std::move(arguments));
    };
    const Outcome edited = run({"edit", (cache_ / "as1.stp").string(), script.string(), "-o", first.string(), "-o", scene.string()});
    ASSERT_EQ(edited.code, 0) << edited.err;
    const auto content = [](const fs::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return std::string((std::istreambuf_iterator<char>(stream)), {});
    };
    EXPECT_TRUE(contains(content(scene), R"("file": "as1.stp")")) << "beside it, so by its name";
    const Outcome rendered = run({"render", scene.string(), "-o", second.string()});
    ASSERT_EQ(rendered.code, 0) << rendered.err;
    const auto pixels = [&](const fs::path& png) {  // without the command that made it
        const std::string bytes = content(png);
        return bytes.substr(bytes.find("IDAT"));
    };
    EXPECT_TRUE(pixels(first) == pixels(second));
    // The scene may be edited and written again, and elsewhere.
    fs::create_directory(cache_ / "elsewhere");
    std::ofstream(script) << "";
    ASSERT_EQ(run({"edit", scene.string(), script.string(), "-o", again.string(), "-o", (cache_ / "elsewhere/far.json").string()}).code, 0);
    EXPECT_TRUE(content(again) == content(scene));
    ASSERT_EQ(run({"render", (cache_ / "elsewhere/far.json").string(), "-o", third.string()}).code, 0);
    EXPECT_TRUE(pixels(third) == pixels(first));
}

TEST_F(Cad, CompareTellsHowFarTrianglesStray) {
    const fs::path picture = cache_ / "difference.png";
    const auto at = [&](const char* deflection) {
        const Outcome outcome = crescente({"compare", assembly_, "--deflection", deflection, "--size", "160x120", "--json", "-o", picture.string()});
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return Json::parse(outcome.out);
    };
    const Json coarse = at("2e-2"), fine = at("1e-4");
    EXPECT_TRUE(fs::exists(picture));
    EXPECT_EQ(fine.at("exact").at("pieces"), 53);
    EXPECT_GT(fine.at("triangles").at("pieces"), coarse.at("triangles").at("pieces"));
    EXPECT_GT(coarse.at("depth_mm").at("mean"), fine.at("depth_mm").at("mean"));
    EXPECT_LT(fine.at("depth_mm").at("mean").get<double>(), 0.05);
    EXPECT_GT(fine.at("pixels").at("both").get<int>(), 1000);
    EXPECT_EQ(crescente({"compare", (scenes / "balls4.nff").string()}).code, 2);
}

}  // namespace
}  // namespace crescente::test
