// Every kind of bad input gets a clear error and its exit code, and costs nothing that was there.
#include <cmath>
#include <cstring>

#include "app/program.h"

namespace crescente::test {
namespace {

constexpr int usage = 2, input = 3;

class Input : public ProgramTest {
protected:
    // Rendering and describing the file must fail with the code and name the file and the reason; nothing is written.
    void refused(const std::string& file, const std::string& reason, int code = input) {
        write("a.png", "what was here before");
        const auto before = files();
        const Outcome render = crescente({"render", file, "-o", path("a.png"), "--size", "16x16"});
        EXPECT_EQ(render.code, code) << render.err;
        EXPECT_TRUE(contains(render.err, "error: " + file));
        EXPECT_TRUE(contains(render.err, reason));
        EXPECT_EQ(read(path("a.png")), "what was here before");
        EXPECT_EQ(files(), before);
    }
    std::string model(const std::string& objects) {
        return write("scene.json", R"({"materials": {"chrome": {"model": "physical", "roughness": 0.1}}, "objects": [)" + objects + "]}");
    }
};

constexpr const char* nff_head = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 0.1\nresolution 64 64\nl 3 4 5\nf 1 1 1 1 0 1 0 1\n";

TEST_F(Input, MissingFile) { refused(path("none.glb"), "none.glb"); }

TEST_F(Input, FolderInsteadOfFile) {
    fs::create_directory(path("folder.glb"));
    refused(path("folder.glb"), "folder.glb");
}

TEST_F(Input, UnknownExtension) {
    const Outcome outcome = crescente({"render", write("model.glbb", "x"), "-o", path("a.png")});
    EXPECT_TRUE(outcome.code == input || outcome.code == usage || outcome.code == 5) << outcome.code << outcome.err;
    EXPECT_TRUE(contains(outcome.err, ".glb"));
}

TEST_F(Input, WrongMagic) {
    for (const char* name : {"a.glb", "a.ply", "a.stl"}) refused(write(name, "this is not a model at all, but a sentence of text\n"), name);
}

TEST_F(Input, EmptyFile) {
    for (const char* name : {"a.json", "a.nff", "a.gltf", "a.glb", "a.ply", "a.stl", "a.obj"}) refused(write(name, ""), name);
}

TEST_F(Input, TruncatedGlb) {
    const std::string whole = read(scenes / "2CylinderEngine.glb");
    for (const std::size_t length : {std::size_t(4), std::size_t(12), std::size_t(1000), whole.size() / 2, whole.size() - 1}) {
        refused(write("cut.glb", whole.substr(0, length)), "cut.glb");
    }
}

TEST_F(Input, TruncatedNff) { refused(write("cut.nff", std::string(nff_head) + "p 3\n0 0 0\n1 0 0\n"), "cut.nff: line 1"); }

TEST_F(Input, TruncatedJson) { refused(write("cut.json", R"({"objects": [{"shape": {"kind": "sph)"), "line 1"); }

TEST_F(Input, NotANumberInNff) {
    for (const char* number : {"nan", "inf", "-infinity", "1e999"}) refused(write("a.nff", nff_head + std::string("s 0 0 ") + number + " 1\n"), "line 10");
}

TEST_F(Input, NotANumberInStl) {
    const std::uint32_t triangles = 1;
    float numbers[12] = {0, 0, 1, 0, 0, 0, 1, 0, 0, 0, std::nanf(""), 0};
    std::string stl(80, ' ');
    stl.append(reinterpret_cast<const char*>(&triangles), 4);
    stl.append(reinterpret_cast<const char*>(numbers), sizeof numbers);
    stl.append(2, '\0');
    refused(write("a.stl", stl), "a.stl");
}

TEST_F(Input, EmptyScene) {
    refused(write("a.json", "{}"), "nothing in the scene can be seen");
    refused(write("b.nff", nff_head), "b.nff");
}

TEST_F(Input, UnknownFieldGetsTheNearest) {
    const std::string file = write("a.json", R"({"materials": {"m": {"model": "physical", "roughnes": 0.5, "metalic": 1}}})");
    refused(file, "did you mean 'roughness'?");
    EXPECT_TRUE(contains(crescente({"info", file}).err, "did you mean 'metallic'?"));
}

TEST_F(Input, OutOfRangeValueIsToldWithItsPlace) {
    refused(write("a.json", R"({"materials": {"m": {"model": "physical", "roughness": 7}}, "objects": [{"sphere": {"radius": 1}}]})"), "/materials/m/roughness");
}

TEST_F(Input, SizesOfAFile) {
    refused(write("zero.json", R"({"settings": {"width": 0}, "objects": [{"sphere": {"radius": 1}}]})"), "/settings/width");
    refused(write("huge.json", R"({"settings": {"height": 1000000}, "objects": [{"sphere": {"radius": 1}}]})"), "/settings/height");
}

TEST_F(Input, FilesThatReferToEachOther) {
    write("b.json", R"({"objects": [{"file": "a.json"}]})");
    const Outcome outcome = crescente({"render", write("a.json", R"({"objects": [{"file": "b.json"}]})"), "-o", path("a.png")});
    EXPECT_EQ(outcome.code, input);
    EXPECT_TRUE(contains(outcome.err, "a.json -> b.json -> a.json"));
    EXPECT_FALSE(fs::exists(path("a.png")));
}

TEST_F(Input, ReferenceToAMissingFile) { refused(write("a.json", R"({"objects": [{"file": "none.glb"}]})"), "none.glb"); }

TEST_F(Input, InfoFailsAlike) {
    const Outcome outcome = crescente({"info", write("a.nff", "what is this\n")});
    EXPECT_EQ(outcome.code, input);
    EXPECT_TRUE(contains(outcome.err, "error: "));
}

TEST_F(Input, NotEnoughMemoryIsToldAsSuch) {
    const Outcome outcome = crescente({"render", (scenes / "balls4.nff").string(), "-o", path("a.png"), "--size", "40000x40000", "-q"},
                                      {.memory = rlim_t(4) << 30});
    EXPECT_EQ(outcome.code, 6) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "error: "));
    EXPECT_TRUE(files().empty());
}

TEST_F(Input, CameraInsideAnObjectIsFine) {
    const std::string file = write("a.nff", "v\nfrom 0 0 0\nat 0 0 1\nup 0 1 0\nangle 45\nhither 0.01\nresolution 64 64\nl 0.2 0.3 0\nf 1 1 1 1 0 1 0 1\ns 0 0 0 1\n");
    const Outcome outcome = crescente({"render", file, "-o", path("a.png"), "--size", "16x16", "-q"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(fs::exists(path("a.png")));
}

TEST_F(Input, TrianglesWithoutAreaAreTold) {
    const std::string file = write("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 2 0 0\nf 1 2 3\nf 1 2 4\nf 1 1 2\n");
    const Outcome outcome = crescente({"render", file, "-o", path("a.png"), "--size", "16x16", "-q"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "warning: " + file)) << "the triangles that were left out";
}

}  // namespace
}  // namespace crescente::test
