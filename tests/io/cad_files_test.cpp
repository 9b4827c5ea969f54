// Every CAD file of the shared assets comes in: how many faces of which kind, names, units, colours, instances. The short list runs by itself, all of
// them with CRESCENTE_CAD_FILES=all build/release/bin/test_io --gtest_filter='CadFiles.*'.
#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <map>
#include <numeric>

#include <unistd.h>

#include "io/cad_reader.h"
#include "io/cad_scene.h"
#include "io/module_file.h"
#include "reader_check.h"
#include "scene/hierarchy.h"

namespace crescente::io {
namespace {

#define REQUIRE_OPENCASCADE() \
    if (!module_file("crescente_opencascade.so")) GTEST_SKIP() << "this build is without OpenCASCADE"

ReadOptions without_cache() {
    ReadOptions options;
    options.cache = false;
    return options;
}

std::uint64_t faces_of(const CadModel& model) { return std::accumulate(model.counts.faces.begin(), model.counts.faces.end(), std::uint64_t{0}); }

struct Known {
    const char* file;
    std::uint64_t faces, shown;  // as published in the assets' list, degenerate ones included; shown: with instances
    const char* unit;
    bool quick;  // read in ctest
};
constexpr Known known_files[] = {
    {"01_red_cube_blue_cylinder.step", 9, 9, "m", true},       {"02_as1_pe_203.stp", 53, 160, "in", true},
    {"03_as1_pe_203.igs", 160, 160, "mm", true},               {"04_as1_pe_203.brep", 53, 160, "mm", true},
    {"05_as1-oc-214.stp", 53, 160, "mm", true},                {"06_dm1-id-214.stp", 24, 48, "in", true},
    {"07_io1-cm-214.stp", 29, 29, "mm", true},                 {"08_screw.step", 10, 10, "mm", true},
    {"10_bearing.iges", 213, 213, "mm", true},                 {"12_Motor-c.brep", 223, 223, "mm", true},
    {"13_Top.brep", 324, 324, "mm", true},                     {"15_EngineBlock.brep", 12, 12, "mm", true},
    {"16_shell1.brep", 99, 99, "mm", true},                    {"17_terrain.brep", 1, 1, "mm", false},
    {"18_NIST_MBE_PMI_2.stp", 597, 597, "mm", false},          {"20_NIST_MBE_PMI_6.stp", 152, 152, "in", false},
    {"21_NIST_MBE_PMI_11.stp", 10, 10, "mm", true},            {"23_frame.step", 375, 375, "in", false},
    {"24_PQFP-256.step", 3864, 3864, "mm", false},             {"25_Toroid_Bourns_8100.step", 464, 464, "mm", false},
    {"27_Valve_Mini_Pentode.step", 74, 74, "mm", true},        {"28_USB_C_Receptacle.step", 646, 646, "mm", false},
    {"29_SO101_Wrist_Roll_Pitch.step", 291, 291, "mm", false}, {"31_ODRI_lower_leg.STEP", 329, 329, "mm", false},
    {"32_Framework_hinge_R.stp", 269, 276, "mm", false},       {"34_Framework_ExpansionCard.stp", 259, 291, "mm", false},
    {"35_Voron_Hotend_Mount_X1C.step", 1287, 1537, "mm", false}, {"38_Ploopy_Secondary_Buttons.stp", 220, 220, "in", false},
    {"40_openDogV3_internals.stp", 218, 218, "mm", false},
};

TEST(CadFiles, AllFacesComeInExactly) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/01_red_cube_blue_cylinder.step");
    const char* which = std::getenv("CRESCENTE_CAD_FILES");
    const bool all = which && std::string(which) == "all";
    for (const Known& known : known_files) {
        if (!all && !known.quick) continue;
        SCOPED_TRACE(known.file);
        const auto model = read_cad_model(asset(std::string("cad/") + known.file), without_cache());
        ASSERT_TRUE(model) << model.error().text();
        EXPECT_EQ(faces_of(*model), known.faces);
        EXPECT_EQ(model->counts.shown, known.shown);
        EXPECT_EQ(model->counts.exact + model->counts.degenerate, known.faces);
        EXPECT_EQ(model->counts.tessellated, 0u);
        EXPECT_EQ(model->unit, known.unit);
        EXPECT_TRUE(model->warnings.empty()) << model->warnings.front().text();
        for (const CadPart& part : model->parts) {
            EXPECT_EQ(part.faces.size(), part.numbers.size());
            for (const geometry::Face& face : part.faces) {
                for (const geometry::Loop& loop : face.loops) {
                    for (const geometry::LoopEdge& edge : loop) EXPECT_GT(edge.band, 0);
                }
            }
        }
    }
}

TEST(CadFiles, TheSameModelInThreeFormatsHasTheSameKinds) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/02_as1_pe_203.stp");
    const auto kinds = [](const char* file) {
        const auto model = read_cad_model(asset(file), without_cache());
        std::map<std::size_t, std::size_t> count;  // by the kind that is traced
        if (!model) return count;
        std::vector<std::size_t> times(model->nodes.size(), 0);
        for (const std::uint32_t root : model->roots) ++times[root];
        for (std::size_t node = model->nodes.size(); node-- > 0;) {  // parents come after their children
            for (const std::uint32_t child : model->nodes[node].children) times[child] += times[node];
            if (model->nodes[node].part >= model->parts.size()) continue;
            for (const auto& face : model->parts[model->nodes[node].part].faces) count[face.surface.index()] += times[node];
        }
        return count;
    };
    const std::map<std::size_t, std::size_t> planes_and_cylinders{{0, 90}, {1, 70}};
    EXPECT_EQ(kinds("cad/02_as1_pe_203.stp"), planes_and_cylinders);
    EXPECT_EQ(kinds("cad/03_as1_pe_203.igs"), planes_and_cylinders);  // there as surfaces of revolution
    EXPECT_EQ(kinds("cad/04_as1_pe_203.brep"), planes_and_cylinders);
}

TEST(CadFiles, AssembliesShareTheirParts) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/05_as1-oc-214.stp");
    const auto model = read_cad_model(asset("cad/05_as1-oc-214.stp"), without_cache());
    ASSERT_TRUE(model);
    EXPECT_EQ(model->parts.size(), 5u);
    ASSERT_EQ(model->roots.size(), 1u);
    const CadNode& top = model->nodes[model->roots[0]];
    EXPECT_EQ(top.name, "as1");
    std::vector<std::string> names;
    for (const std::uint32_t child : top.children) names.push_back(model->nodes[child].name);
    EXPECT_EQ(names, (std::vector<std::string>{"rod-assembly_1", "l-bracket-assembly_1", "plate_1", "l-bracket-assembly_2"}));
    // Both bracket assemblies show the same nodes, at different places.
    const CadNode &one = model->nodes[top.children[1]], &other = model->nodes[top.children[3]];
    EXPECT_EQ(one.children, other.children);
    EXPECT_FALSE(one.transform == other.transform);
    EXPECT_EQ(model->colors.size(), 5u);
}

// So that an edit which moves a part of an assembly may speak of metres, y up.
TEST(CadFiles, AssembliesAreInTheScenesSpace) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/02_as1_pe_203.stp");
    const auto model = read_cad_model(asset("cad/02_as1_pe_203.stp"), without_cache());
    ASSERT_TRUE(model);
    std::vector<UntraceableFace> untraceable;
    const scene::Scene scene = cad_scene(*model, untraceable).scene;
    std::size_t assemblies = 0;
    for (const scene::Node& node : scene.nodes) {
        EXPECT_NEAR(std::cbrt(node.transform.determinant()), node.shape.valid() ? 1e-3 : 1, 1e-12) << node.name;
        if (!node.shape.valid()) ++assemblies;
    }
    EXPECT_GT(assemblies, 3u);
    // What is seen is where the file has it.
    math::Bounds seen, expected;
    scene::for_each_appearance(scene, [&](std::uint32_t node, const math::Affine& to_world, const auto&) {
        const math::Bounds box = math::transform(to_world, geometry::bounds(scene.shapes[scene.nodes[node].shape.value].shape));
        seen.include(box);
    });
    expected.lower = {-3.81002, -1.90502, -1.52401}, expected.upper = {1.27002, 1.90502, 0.685805};
    EXPECT_LT(length(seen.lower - expected.lower) + length(seen.upper - expected.upper), 1e-3);
}

TEST(CadFiles, ColorsOfFacesAndPartsComeIn) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/07_io1-cm-214.stp");
    const auto cubes = read_cad_model(asset("cad/01_red_cube_blue_cylinder.step"), without_cache());
    ASSERT_TRUE(cubes);
    ASSERT_EQ(cubes->colors.size(), 2u);
    const auto near_screen = [](math::Rgb got, float r, float g, float b) {  // linear light; the file's are meant for the screen
        const auto linear = [](float c) { return std::pow((c + 0.055f) / 1.055f, 2.4f); };
        return std::abs(got.r - linear(r)) + std::abs(got.g - linear(g)) + std::abs(got.b - linear(b)) < 2e-3f;
    };
    const auto &blue = cubes->colors[0].rgb, &red = cubes->colors[1].rgb;
    EXPECT_TRUE(near_screen(blue, 0.231f, 0.380f, 0.706f)) << blue.r << ' ' << blue.g << ' ' << blue.b;
    EXPECT_TRUE(near_screen(red, 0.867f, 0.322f, 0.157f)) << red.r << ' ' << red.g << ' ' << red.b;
    const auto faces = read_cad_model(asset("cad/07_io1-cm-214.stp"), without_cache());
    ASSERT_TRUE(faces);
    EXPECT_EQ(faces->nodes.at(0).colors.size(), 2u);
    std::map<std::uint16_t, int> by_slot;
    for (const auto& face : faces->parts.at(0).faces) ++by_slot[face.slot];
    EXPECT_EQ(by_slot.size(), 2u);
}

TEST(CadFiles, WhatIsNoCadFileIsToldSo) {
    REQUIRE_OPENCASCADE();
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("crescente_cad_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    const std::pair<const char*, const char*> contents[] = {
        {"empty.step", ""},
        {"words.step", "these are words\n"},
        {"head.stp", "ISO-10303-21;\nHEADER;\n"},
        {"nothing.step", "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\nENDSEC;\nEND-ISO-10303-21;\n"},
        {"self.step", "ISO-10303-21;\nHEADER;\nFILE_DESCRIPTION((''),'2;1');\nFILE_NAME('','',(''),(''),'','','');\nFILE_SCHEMA(('AUTOMOTIVE_DESIGN'));\nENDSEC;\nDATA;\n#1=MANIFOLD_SOLID_BREP('',#1);\n#2=CLOSED_SHELL('',(#1,#2));\nENDSEC;\nEND-ISO-10303-21;\n"},
        {"words.iges", "these are words\n"},
        {"empty.igs", ""},
        {"words.brep", "these are words\n"},
        {"head.brep", "DBRep_DrawableShape\n\nCASCADE Topology V1, (c) Matra-Datavision\nLocations 1000000000\n"},
        {"binary.brep", "\nOpen CASCADE Topology V4, (c) Open Cascade\nLocations 4294967295\n"},
    };
    for (const auto& [name, text] : contents) {
        SCOPED_TRACE(name);
        std::ofstream(folder / name) << text;
        const auto model = read_cad_model(folder / name, without_cache());
        ASSERT_FALSE(model);
        EXPECT_TRUE(tells(model.error(), name)) << model.error().text();
        EXPECT_EQ(model.error().kind, ErrorKind::input) << model.error().text();
    }
    EXPECT_TRUE(tells(read_cad_model(folder / "missing.step", without_cache()).error(), "there is no such file"));
    EXPECT_TRUE(tells(read_cad_model(folder, without_cache()).error(), "is not a file"));
    std::filesystem::remove_all(folder);
}

TEST(CadFiles, CutFilesGiveAnErrorOrPartOfTheModel) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/08_screw.step");
    const std::filesystem::path folder = std::filesystem::temp_directory_path() / ("crescente_cut_" + std::to_string(getpid()));
    std::filesystem::create_directories(folder);
    for (const char* name : {"cad/08_screw.step", "cad/15_EngineBlock.brep", "cad/03_as1_pe_203.igs"}) {
        const std::string whole = bytes_of(asset(name));
        const std::filesystem::path cut = folder / std::filesystem::path(name).filename();
        for (const double share : {0.02, 0.3, 0.7, 0.95}) {
            SCOPED_TRACE(std::string(name) + " cut at " + std::to_string(share));
            std::ofstream(cut, std::ios::binary) << whole.substr(0, static_cast<std::size_t>(share * static_cast<double>(whole.size())));
            const auto model = read_cad_model(cut, without_cache());
            if (!model) EXPECT_TRUE(tells(model.error(), cut.filename().string())) << model.error().text();
            else EXPECT_GT(faces_of(*model), 0u);
        }
    }
    std::filesystem::remove_all(folder);
}

TEST(CadFiles, ProgressIsToldAndReadingCanBeStopped) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/13_Top.brep");
    ReadOptions options = without_cache();
    std::vector<double> told;
    options.progress = [&](double fraction, std::string_view stage) {
        told.push_back(fraction);
        EXPECT_FALSE(stage.empty());
    };
    ASSERT_TRUE(read_cad_model(asset("cad/13_Top.brep"), options));
    ASSERT_FALSE(told.empty());
    EXPECT_TRUE(std::is_sorted(told.begin(), told.end()));
    EXPECT_LE(told.back(), 1);
    options.cancelled = [] { return true; };
    const auto stopped = read_cad_model(asset("cad/13_Top.brep"), options);
    ASSERT_FALSE(stopped);
    EXPECT_TRUE(tells(stopped.error(), "stopped"));
}

TEST(CadFiles, TrianglesInPlaceOfFacesOnRequest) {
    REQUIRE_OPENCASCADE();
    REQUIRE_ASSET("cad/08_screw.step");
    const auto all = read_cad_anew(asset("cad/08_screw.step"), {1e-3, {}}, without_cache());
    ASSERT_TRUE(all);
    EXPECT_TRUE(all->parts.at(0).faces.empty());
    EXPECT_EQ(all->counts.tessellated, 10u);
    EXPECT_GT(all->parts[0].mesh.triangles.size(), 100u);
    // One face as triangles is named.
    const auto one = read_cad_anew(asset("cad/08_screw.step"), {0, {{0, 3}}}, without_cache());
    ASSERT_TRUE(one);
    EXPECT_EQ(one->parts.at(0).faces.size(), 9u);
    EXPECT_EQ(one->counts.tessellated, 1u);
    EXPECT_FALSE(one->parts[0].mesh.triangles.empty());
    ASSERT_EQ(one->warnings.size(), 1u);
    EXPECT_NE(one->warnings[0].text().find("face 3"), std::string::npos);
}

}  // namespace
}  // namespace crescente::io
