// STEP files that refer to others: written by OpenCASCADE from an assembly, read back by us.
#include <filesystem>
#include <fstream>
#include <iterator>
#include <numeric>

#include <gtest/gtest.h>
#include <unistd.h>

#include <STEPCAFControl_Writer.hxx>

#include "io/cad_cache.h"
#include "io/cad_reader.h"
#include "io/occt/document.h"

namespace crescente::io {
namespace {

namespace fs = std::filesystem;

ReadOptions without_cache() {
    ReadOptions options;
    options.cache = false;
    return options;
}

class CadReferences : public testing::Test {
protected:
    void SetUp() override {
        const fs::path assembly = fs::path(CRESCENTE_SHARED) / "assets" / "cad" / "05_as1-oc-214.stp";
        if (!fs::exists(assembly)) GTEST_SKIP() << "the shared CAD assets are not here";
        fs::create_directories(folder_);
        const auto document = occt::read_document(assembly.string(), "as1", [](double, const char*) {});
        ASSERT_TRUE(document);
        STEPCAFControl_Writer writer;
        ASSERT_TRUE(writer.Transfer(document->document, STEPControl_AsIs, "part_"));  // each part into a file of its own
        ASSERT_EQ(writer.Write((folder_ / "main.step").c_str()), IFSelect_RetDone);
        for (const auto& each : fs::directory_iterator(folder_)) others_ += each.path().filename() != "main.step";
    }
    void TearDown() override { fs::remove_all(folder_); }

    static std::uint64_t faces_of(const CadModel& model) { return std::accumulate(model.counts.faces.begin(), model.counts.faces.end(), std::uint64_t{0}); }
    static std::string text_of(const fs::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }
    static bool warns(const CadModel& model, const std::string& words) {
        return std::any_of(model.warnings.begin(), model.warnings.end(), [&](const Problem& w) { return w.text().find(words) != std::string::npos; });
    }
    fs::path a_part() const {
        for (const auto& each : fs::directory_iterator(folder_)) {
            if (each.path().filename() != "main.step") return each.path();
        }
        return {};
    }

    const fs::path folder_ = fs::temp_directory_path() / ("crescente_references_" + std::to_string(getpid()));
    int others_ = 0;
};

TEST_F(CadReferences, AreReadWithAPathOfAnyKind) {
    ASSERT_GT(others_, 1);
    const auto model = read_cad_model(folder_ / "main.step", without_cache());
    ASSERT_TRUE(model) << model.error().text();
    EXPECT_EQ(faces_of(*model), 53u);
    EXPECT_EQ(model->counts.shown, 160u);
    EXPECT_EQ(model->referenced.size(), static_cast<std::size_t>(others_));  // what the cache compares
    const fs::path relative = fs::relative(folder_ / "main.step");  // from wherever the test runs
    const auto again = read_cad_model(relative, without_cache());
    ASSERT_TRUE(again);
    EXPECT_EQ(again->counts.shown, 160u);
}

TEST_F(CadReferences, OneThatIsMissingIsTold) {
    const fs::path gone = a_part();
    fs::remove(gone);
    const auto model = read_cad_model(folder_ / "main.step", without_cache());
    ASSERT_TRUE(model) << model.error().text();
    EXPECT_LT(faces_of(*model), 53u);
    EXPECT_TRUE(warns(*model, gone.filename().string()));
}

TEST_F(CadReferences, NothingOutsideOfTheFolderIsRead) {
    const fs::path part = a_part();
    const std::string name = part.filename().string();
    fs::create_directories(folder_ / "inner");
    for (const auto& each : fs::directory_iterator(folder_)) {
        if (each.is_regular_file() && each.path() != part) fs::rename(each.path(), folder_ / "inner" / each.path().filename());
    }
    std::string text = text_of(folder_ / "inner" / "main.step");
    const std::string quoted = "'" + name + "'";
    std::size_t replaced = 0;
    for (std::size_t at = text.find(quoted); at != std::string::npos; at = text.find(quoted, at + 1), ++replaced) text.replace(at, quoted.size(), "'../" + name + "'");
    ASSERT_GT(replaced, 0u);
    std::ofstream(folder_ / "inner" / "main.step", std::ios::binary) << text;
    const auto model = read_cad_model(folder_ / "inner" / "main.step", without_cache());
    ASSERT_FALSE(model);
    EXPECT_NE(model.error().text().find("does not lie in its folder"), std::string::npos) << model.error().text();
    // Nor by way of a file that does lie there.
    std::ofstream(folder_ / "inner" / name, std::ios::binary) << "ISO-10303-21;\nDATA;\n#1=DOCUMENT_FILE('../" << name << "','',$,#2,'',$);\nENDSEC;\nEND-ISO-10303-21;\n";
    text = text_of(folder_ / "inner" / "main.step");
    const std::string outside = "'../" + name + "'";
    for (std::size_t at = text.find(outside); at != std::string::npos; at = text.find(outside)) text.replace(at, outside.size(), quoted);
    std::ofstream(folder_ / "inner" / "main.step", std::ios::binary) << text;
    EXPECT_FALSE(read_cad_model(folder_ / "inner" / "main.step", without_cache()));
}

TEST_F(CadReferences, TheCacheKnowsThem) {
    const CadCache cache(folder_ / "cache");
    const auto model = read_cad_model(folder_ / "main.step", without_cache());
    ASSERT_TRUE(model);
    ASSERT_TRUE(cache.keep(folder_ / "main.step", *model));
    EXPECT_TRUE(cache.find(folder_ / "main.step"));
    std::ofstream(a_part(), std::ios::app) << "\n";
    EXPECT_FALSE(cache.find(folder_ / "main.step"));
}

}  // namespace
}  // namespace crescente::io
