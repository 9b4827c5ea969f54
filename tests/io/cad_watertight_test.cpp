// Rays aimed at the edges of every closed shell of CAD files: none gets through. A short list of files by itself; all of them, with a table for docs/cad.md:
//   CRESCENTE_AIMED_RAYS=100000 CRESCENTE_CAD_FILES=all build/release/bin/test_io --gtest_filter='CadWatertight.*'
// (or the name of one file).
#include <cstdio>
#include <cstdlib>

#include <unistd.h>

#include "io/cad_cache.h"
#include "io/cad_reader.h"
#include "io/module_file.h"
#include "reader_check.h"
#include "watertight.h"

namespace crescente::io::test {
namespace {

namespace fs = std::filesystem;

// Models read once, kept in a folder of their own.
class CadWatertight : public ::testing::Test {
protected:
    void SetUp() override {
        if (!module_file("crescente_opencascade.so")) GTEST_SKIP() << "this build is without OpenCASCADE";
        if (!fs::exists(asset("cad"))) GTEST_SKIP() << "the shared CAD assets are not here";
    }
    void TearDown() override { fs::remove_all(folder_); }

    Expected<CadModel> model_of(const std::string& file) {
        const CadCache cache(folder_);
        if (auto kept = cache.find(asset("cad/" + file))) return std::move(*kept);
        ReadOptions options;
        options.cache = false;
        auto model = read_cad_model(asset("cad/" + file), options);
        if (model) {
            EXPECT_TRUE(cache.keep(asset("cad/" + file), *model));
        }
        return model;
    }

    const fs::path folder_ = fs::temp_directory_path() / ("crescente_watertight_" + std::to_string(getpid()));
};

struct Result {
    WatertightTally tally;
    std::size_t unmatched = 0;  // edges of one face only
};

// Twelve points an edge, four rays each, unless many more or fewer are wanted.
Result measure(const CadModel& model, std::size_t wanted) {
    std::size_t edges = 0;
    for (const CadPart& part : model.parts) {
        for (const Face& face : part.faces) {
            for (const auto& loop : face.loops) edges += loop.size();
        }
    }
    const std::size_t per_edge = wanted == 0 ? 12 : std::max<std::size_t>(wanted > 50000 ? 12 : 1, (wanted / 4 + edges - 1) / std::max<std::size_t>(1, edges));
    Result result;
    RandomRays random(11);
    for (const CadPart& part : model.parts) {
        if (part.faces.empty()) continue;
        result.unmatched += part.unmatched_edges;
        WatertightMeasure measure(part, 7);
        result.tally.shells += measure.shells(), result.tally.closed += measure.closed();
        std::vector<AimedRay> rays;
        const auto shoot = [&] {
            const auto crossings = measure.crossings(rays);
            for (std::size_t i = 0; i < rays.size(); ++i) WatertightMeasure::count(measure.verdict(rays[i], crossings[i]), result.tally);
            rays.clear();
        };
        for (const EdgePoint& point : edge_points(part, static_cast<int>(per_edge), random)) {
            measure.aim_at(point, rays);
            if (rays.size() >= 65536) shoot();
        }
        shoot();
    }
    return result;
}

TEST_F(CadWatertight, NoRayGetsThroughAnEdge) {
    std::vector<std::string> files = {"01_red_cube_blue_cylinder.step", "02_as1_pe_203.stp", "06_dm1-id-214.stp", "07_io1-cm-214.stp", "08_screw.step",
                                      "15_EngineBlock.brep", "21_NIST_MBE_PMI_11.stp", "27_Valve_Mini_Pentode.step"};
    const char *which = std::getenv("CRESCENTE_CAD_FILES"), *count = std::getenv("CRESCENTE_AIMED_RAYS");
    const std::size_t wanted = count ? std::strtoull(count, nullptr, 10) : 6000;
    if (which && std::string(which) == "all") {
        files.clear();
        for (const auto& each : fs::directory_iterator(asset("cad"))) files.push_back(each.path().filename().string());
        std::sort(files.begin(), files.end());
    } else if (which) {
        files = {which};
    }
    std::printf("| file | closed shells | aimed rays | escaped | lost | first inward / M | odd / M |\n|---|---|---|---|---|---|---|\n");
    for (const std::string& file : files) {
        SCOPED_TRACE(file);
        const auto model = model_of(file);
        ASSERT_TRUE(model) << model.error().text();
        const auto [tally, unmatched] = measure(*model, wanted);
        const auto per_million = [&](std::size_t n) { return tally.rays ? 1e6 * static_cast<double>(n) / static_cast<double>(tally.rays) : 0.0; };
        std::printf("| %s | %zu of %zu | %zu | %zu | %zu | %.0f | %.0f |\n", file.c_str(), tally.closed, tally.shells, tally.rays, tally.escaped, tally.lost,
                    per_million(tally.inward), per_million(tally.odd));
        std::fflush(stdout);
        if (unmatched == 0) {
            EXPECT_EQ(tally.closed, tally.shells) << "a shell whose edges all have two faces lets rays at random through";
        }
        EXPECT_EQ(tally.escaped, 0u);
        EXPECT_EQ(tally.lost, 0u);
        if (!which) {
            EXPECT_GT(tally.rays, 3000u);
            EXPECT_LE(tally.inward + tally.odd, tally.rays / 50);  // rays along edges, mostly
        }
    }
}

// What the measure is worth: faces that end where their curves say leave slits, and it sees them.
TEST_F(CadWatertight, WithoutBandsRaysGetThrough) {
    auto model = model_of("06_dm1-id-214.stp");
    ASSERT_TRUE(model) << model.error().text();
    for (CadPart& part : model->parts) {
        for (Face& face : part.faces) {
            for (auto& loop : face.loops) {
                for (auto& edge : loop) edge.band = 0;
            }
        }
    }
    const auto result = measure(*model, 6000);
    EXPECT_GT(result.tally.closed, 0u);
    EXPECT_GT(result.tally.escaped, 0u);
    EXPECT_GT(result.tally.lost, 0u);
}

}  // namespace
}  // namespace crescente::io::test
