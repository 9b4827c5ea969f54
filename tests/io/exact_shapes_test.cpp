// Shapes whose exact faces are in another file.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <unistd.h>

#include "io/scene_file.h"

namespace crescente::io {
namespace {

namespace fs = std::filesystem;

std::string errors(const std::string& text) {
    const auto loaded = read_scene_text(text, "s.json", "/no folder");
    return loaded ? "none" : loaded.error().text();
}

TEST(ExactShapes, TellWhatIsWrongWithThem) {
    const auto wrong = [](const std::string& shape) { return errors("{\"shapes\": {\"a\": " + shape + "}}"); };
    EXPECT_NE(wrong(R"({"brep": {"file": "missing.step"}})").find("s.json: line 1, /shapes/a/brep/file: there is no file 'missing.step'"), std::string::npos);
    EXPECT_NE(wrong(R"({"brep": {"index": 1}})").find("/shapes/a/brep: has no member 'file'"), std::string::npos);
    EXPECT_NE(wrong(R"({"brep": {"file": "a.step", "index": 1.5}})").find("/shapes/a/brep/index: is a number, must be a whole number"), std::string::npos);
    EXPECT_NE(wrong(R"({"brep": {"flie": "a.step"}})").find("did you mean 'file'?"), std::string::npos);
    EXPECT_NE(wrong(R"({"brep": {"file": "a.step"}, "sphere": {}})").find("/shapes/a/sphere"), std::string::npos);
    EXPECT_NE(wrong(R"({"brep": 3})").find("/shapes/a/brep: is a number, must be an object"), std::string::npos);
    EXPECT_NE(errors(R"({"objects": [{"shape": {"brep": {"file": "a.step"}}}]})").find("/objects/0/shape/brep: exact faces of a model file are named among the `shapes`"), std::string::npos);

    const fs::path folder = fs::temp_directory_path() / ("crescente-exact-" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::ofstream(folder / "inner.json") << R"({"shapes": {"ball": {"sphere": {}}}})";
    std::ofstream(folder / "one.obj") << "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
    std::ofstream(folder / "s.json") << R"({"shapes": {"a": {"brep": {"file": "inner.json"}}, "b": {"brep": {"file": "one.obj"}}, "c": {"brep": {"file": "one.obj", "index": 7}}}})";
    const auto loaded = io::read_scene_file(folder / "s.json");
    fs::remove_all(folder);
    ASSERT_FALSE(loaded);
    EXPECT_NE(loaded.error().text().find("/shapes/a/brep/file: is a scene file"), std::string::npos) << loaded.error().text();
    EXPECT_NE(loaded.error().text().find("/shapes/b/brep: shape 0 of the file is no exact one"), std::string::npos) << loaded.error().text();
    EXPECT_NE(loaded.error().text().find("/shapes/c/brep: there is no shape 7 among the 1 of the file"), std::string::npos) << loaded.error().text();
}

}  // namespace
}  // namespace crescente::io
