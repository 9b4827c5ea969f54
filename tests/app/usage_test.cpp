// What the command line says about itself, and about requests that it cannot understand.
#include "app/program.h"

namespace crescente::test {
namespace {

constexpr int usage = 2;

using Usage = ProgramTest;

TEST_F(Usage, HelpIsShortAndHasExamples) {
    const Outcome outcome = crescente({"--help"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_TRUE(contains(outcome.out, "crescente render model.glb -o picture.png"));
    EXPECT_TRUE(contains(outcome.out, "Exit codes"));
    EXPECT_LT(count(outcome.out, "\n"), 40u);
}

TEST_F(Usage, EverySubcommandHasHelp) {
    for (const char* name : {"render", "info", "bench", "formats", "schema"}) {
        const Outcome outcome = crescente({name, "--help"});
        EXPECT_EQ(outcome.code, 0) << name;
        EXPECT_TRUE(contains(outcome.out, name));
    }
}

TEST_F(Usage, VersionIsPrinted) {
    const Outcome outcome = crescente({"--version"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out.rfind("crescente ", 0), 0u) << outcome.out;
}

TEST_F(Usage, NoCommand) {
    const Outcome outcome = crescente({});
    EXPECT_EQ(outcome.code, usage);
    EXPECT_TRUE(contains(outcome.err, "error: a command is missing"));
}

TEST_F(Usage, UnknownCommandGetsTheNearest) {
    const Outcome outcome = crescente({"rendr", "a.glb"});
    EXPECT_EQ(outcome.code, usage);
    EXPECT_TRUE(contains(outcome.err, "did you mean 'render'?"));
}

TEST_F(Usage, UnknownOptionGetsTheNearest) {
    const Outcome outcome = crescente({"render", (scenes / "balls4.nff").string(), "-o", path("a.png"), "--sise", "10x10"});
    EXPECT_EQ(outcome.code, usage);
    EXPECT_TRUE(contains(outcome.err, "did you mean '--size'?"));
    EXPECT_TRUE(files().empty());
}

TEST_F(Usage, OutputIsRequired) {
    const Outcome outcome = crescente({"render", (scenes / "balls4.nff").string()});
    EXPECT_EQ(outcome.code, usage);
    EXPECT_TRUE(contains(outcome.err, "--output"));
}

TEST_F(Usage, TheModelMayComeLast) {
    const Outcome outcome = crescente({"render", "--set", "settings.depth=1", "-o", path("a.png"), "--size", "8x8", (scenes / "balls4.nff").string()});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(files(), std::vector<std::string>{"a.png"});
}

TEST_F(Usage, EveryProblemIsToldAtOnce) {
    const Outcome outcome = crescente({"render", (scenes / "balls4.nff").string(), "-o", path("a.png"), "--size", "12by13", "--level", "shadow",
                                       "--depth", "-1", "--threshold", "x", "--time", "soon", "--memory", "much", "--camera", "frnt", "--fov",
                                       "400", "--replay", "1", "--pick", "x,y", "--aperture", "-1", "--focus", "near", "--blades", "2.5", "--shutter", "0.5"});
    EXPECT_EQ(outcome.code, usage);
    EXPECT_EQ(count(outcome.err, "error: "), 14u) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "did you mean 'shadows'?"));
    EXPECT_TRUE(contains(outcome.err, "did you mean 'front'?"));
    EXPECT_TRUE(contains(outcome.err, "from 0 to 250"));
    EXPECT_TRUE(files().empty());
}

TEST_F(Usage, ZeroAndAbsurdSizes) {
    for (const char* size : {"0x10", "10x0", "-5x10", "70000x10", "99999999999x10", "10", "x", "10x10x10", ""}) {
        const Outcome outcome = crescente({"render", (scenes / "balls4.nff").string(), "-o", path("a.png"), std::string("--size=") + size});
        EXPECT_EQ(outcome.code, usage) << size << ": " << outcome.err;
        EXPECT_TRUE(contains(outcome.err, "--size"));
    }
    EXPECT_TRUE(files().empty());
}

TEST_F(Usage, MorePixelsThanCanBeHeld) {
    const Outcome outcome = crescente({"render", (scenes / "balls4.nff").string(), "-o", path("a.png"), "--size", "65536x65536"});
    EXPECT_EQ(outcome.code, usage);
    EXPECT_TRUE(contains(outcome.err, "65536 x 65536"));
    EXPECT_TRUE(files().empty());
}

TEST_F(Usage, OverridesAreChecked) {
    const Outcome outcome = crescente({"render", (scenes / "balls4.nff").string(), "-o", path("a.png"), "--set", "settings.dpeth=3", "--set",
                                       "settings.depth=900"});
    EXPECT_EQ(outcome.code, usage);
    EXPECT_EQ(count(outcome.err, "error: "), 2u) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "depth"));
    EXPECT_TRUE(files().empty());
}

TEST_F(Usage, FormatsAreListed) {
    const Outcome outcome = crescente({"formats"});
    EXPECT_EQ(outcome.code, 0);
    for (const char* extension : {".json", ".nff", ".glb", ".gltf"}) EXPECT_TRUE(contains(outcome.out, extension));
}

TEST_F(Usage, SchemaIsJson) {
    const Outcome outcome = crescente({"schema"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_TRUE(contains(outcome.out, "\"$schema\""));
    const Outcome manual = crescente({"schema", "--manual"});
    EXPECT_EQ(manual.code, 0);
    EXPECT_TRUE(contains(manual.out, "roughness"));
}

}  // namespace
}  // namespace crescente::test
