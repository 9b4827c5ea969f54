// Models as bytes: back as they were, never believed when they are cut or changed; the cache keeps them, and forgets what is damaged or out of date.
#include <fstream>

#include <unistd.h>

#include "io/cad_cache.h"
#include "io/cad_messages.h"
#include "io/isolated_messages.h"
#include "reader_check.h"

namespace crescente::io {
namespace {

namespace fs = std::filesystem;
using namespace geometry;

CadModel small_model() {
    CadModel model;
    model.unit = "in", model.unit_metres = 0.0254;
    CadPart part;
    part.name = "part";
    const Frame frame{{1, 2, 3}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const Loop loop{{LinePiece{{0, 0}, {1, 0}}, 1e-3}, {ArcPiece{{0.5, 0}, {0.5, 0}, {0, 0.5}, 0, 3.14}, 2e-3}, {BezierPiece{{{0, 0, 1}, {0.1, 0.2, 0.5}, {0, 0, 1}}}, 0}};
    const BezierPatch bilinear{1, 1, false, 0, 1, 0, 1, {{{0, 0, 0}, 1}, {{0, 1, 0}, 1}, {{1, 0, 0}, 1}, {{1, 1, 0}, 1}}};
    const FaceSurface surfaces[] = {PlaneSurface{frame}, CylinderSurface{frame, 2}, ConeSurface{frame, 1, 0.3}, SphereSurface{frame, 2}, TorusSurface{frame, 3, 1},
                                    PatchSurface{{bilinear}, {}}, PatchSurface{{bilinear, bilinear}, frame}};
    for (const FaceSurface& surface : surfaces) {
        part.faces.push_back({surface, 0, 1, -1, 2, {loop, loop}, true, 1});
        part.numbers.push_back(static_cast<std::uint32_t>(part.faces.size()));
    }
    part.mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    part.mesh.triangles = {{0, 1, 2}};
    part.mesh.slots = {0};
    part.unmatched_edges = 3;
    model.parts = {part};
    CadNode leaf;
    leaf.name = "leaf", leaf.part = 0, leaf.colors = {0, CadPart::no_color};
    CadNode top;
    top.name = "top", top.children = {0, 0};
    model.nodes = {leaf, top};
    model.roots = {1};
    model.colors = {{{0.1f, 0.2f, 0.3f}, 0.5f}};
    model.counts.exact = 7;
    model.referenced = {"sub/other.step"};
    model.warnings = {{"f", "p", "r", "h"}};
    return model;
}

TEST(CadMessages, ComeBackAsTheyWere) {
    const CadModel model = small_model();
    const std::string bytes = pack_cad(model);
    const auto back = unpack_cad(bytes);
    ASSERT_TRUE(back && *back);
    EXPECT_EQ((*back)->parts.at(0).faces, model.parts[0].faces);
    EXPECT_EQ((*back)->nodes, model.nodes);
    EXPECT_EQ((*back)->colors, model.colors);
    EXPECT_EQ((*back)->counts, model.counts);
    EXPECT_EQ((*back)->unit, "in");
    EXPECT_EQ((*back)->referenced, model.referenced);
    EXPECT_EQ((*back)->warnings.at(0).text(), model.warnings[0].text());
    EXPECT_EQ(pack_cad(*back), bytes);
    for (std::size_t length = 0; length < bytes.size(); ++length) EXPECT_FALSE(unpack_cad(std::string_view(bytes).substr(0, length))) << length;
    EXPECT_FALSE(unpack_cad(bytes + "x"));

    const auto error = unpack_cad(pack_cad(failure(ErrorKind::resource, {"a", "b", "c", "d"})));
    ASSERT_TRUE(error && !*error);
    EXPECT_EQ(error->error().kind, ErrorKind::resource);
    EXPECT_EQ(error->error().text(), "a: b: c (d)");
}

TEST(CadMessages, ModelsThatDoNotHoldTogetherAreRefused) {
    const auto refused = [](auto&& break_it) {
        CadModel model = small_model();
        break_it(model);
        return !unpack_cad(pack_cad(model));
    };
    EXPECT_FALSE(refused([](CadModel&) {}));
    EXPECT_TRUE(refused([](CadModel& m) { m.nodes[0].children = {1}; }));  // a ring
    EXPECT_TRUE(refused([](CadModel& m) { m.nodes[0].children = {0}; }));
    EXPECT_TRUE(refused([](CadModel& m) { m.nodes[1].children = {2}; }));
    EXPECT_TRUE(refused([](CadModel& m) { m.nodes[0].part = 1; }));
    EXPECT_TRUE(refused([](CadModel& m) { m.nodes[0].colors = {1}; }));
    EXPECT_TRUE(refused([](CadModel& m) { m.roots = {7}; }));
    EXPECT_TRUE(refused([](CadModel& m) { m.parts[0].mesh.triangles = {{0, 1, 3}}; }));
    EXPECT_TRUE(refused([](CadModel& m) { std::get<CylinderSurface>(m.parts[0].faces[1].surface).radius = 0; }));
    EXPECT_TRUE(refused([](CadModel& m) { std::get<PatchSurface>(m.parts[0].faces[5].surface).patches[0].points.pop_back(); }));
    EXPECT_TRUE(refused([](CadModel& m) { std::get<PatchSurface>(m.parts[0].faces[5].surface).patches[0].degree_u = 1 << 30; }));
    EXPECT_TRUE(refused([](CadModel& m) { std::get<PatchSurface>(m.parts[0].faces[5].surface).patches[0].points[0].weight = -1; }));
    EXPECT_TRUE(refused([](CadModel& m) { m.parts[0].faces[0].u1 = std::numeric_limits<double>::quiet_NaN(); }));
    EXPECT_TRUE(refused([](CadModel& m) { std::get<LinePiece>(m.parts[0].faces[0].loops[0][0].piece).to.u = 1 / 0.0; }));
    EXPECT_TRUE(refused([](CadModel& m) {  // few nodes, endless places
        for (std::uint32_t i = 2; i < 60; ++i) m.nodes.push_back({"", {}, CadNode{}.part, {}, {i - 1, i - 1}});
        m.roots = {59};
    }));
}

class CadCacheTest : public testing::Test {
protected:
    void SetUp() override {
        fs::create_directories(folder_);
        write("model.step", "one");
        fs::create_directories(folder_ / "sub");
        write("sub/other.step", "two");
    }
    void TearDown() override { fs::remove_all(folder_); }

    void write(const std::string& name, const std::string& text) const { std::ofstream(folder_ / name, std::ios::binary) << text; }
    fs::path only_entry() const { return fs::directory_iterator(cache_.folder())->path(); }

    const fs::path folder_ = fs::temp_directory_path() / ("crescente_cache_" + std::to_string(getpid()));
    const fs::path file_ = folder_ / "model.step";
    const CadCache cache_{folder_ / "cache" / "deep"};
};

TEST_F(CadCacheTest, KeepsAModelUntilItsFilesChange) {
    EXPECT_FALSE(cache_.find(file_));
    ASSERT_TRUE(cache_.keep(file_, small_model()));
    const auto found = cache_.find(file_);
    ASSERT_TRUE(found);
    EXPECT_EQ(pack_cad(*found), pack_cad(small_model()));
    // The content counts, not the name; but a file of the same bytes with other neighbours is another model.
    fs::copy_file(file_, folder_ / "again.step");
    EXPECT_TRUE(cache_.find(folder_ / "again.step"));
    fs::copy_file(file_, folder_ / "sub" / "model.step");
    EXPECT_FALSE(cache_.find(folder_ / "sub" / "model.step"));
    write("sub/other.step", "three");
    EXPECT_FALSE(cache_.find(file_));
    write("sub/other.step", "two");
    EXPECT_TRUE(cache_.find(file_));
    write("model.step", "another");
    EXPECT_FALSE(cache_.find(file_));
}

TEST_F(CadCacheTest, DamagedEntriesAreNotFound) {
    ASSERT_TRUE(cache_.keep(file_, small_model()));
    const std::string whole = bytes_of(only_entry());
    for (std::size_t i = 0; i < whole.size(); ++i) {
        std::string damaged = whole;
        damaged[i] = static_cast<char>(damaged[i] ^ 0x10);
        EXPECT_FALSE(cad_cache_entry(damaged)) << i;
        EXPECT_FALSE(cad_cache_entry(std::string_view(whole).substr(0, i))) << i;
    }
    std::ofstream(only_entry(), std::ios::binary) << whole.substr(0, whole.size() / 2);
    EXPECT_FALSE(cache_.find(file_));
    ASSERT_TRUE(cache_.keep(file_, small_model()));
    EXPECT_TRUE(cache_.find(file_));
}

TEST_F(CadCacheTest, DropsWhatWasUnusedForLongest) {
    const std::uint64_t one = [&] {
        EXPECT_TRUE(cache_.keep(file_, small_model()));
        return fs::file_size(only_entry());
    }();
    const CadCache narrow(folder_ / "narrow", one * 5 + one / 2);  // room for five
    for (int i = 0; i < 8; ++i) {
        write("model.step", std::to_string(i));
        ASSERT_TRUE(narrow.keep(file_, small_model()));
        fs::last_write_time(narrow.folder(), fs::file_time_type::clock::now());
        if (i == 4) {
            write("model.step", "0");
            EXPECT_TRUE(narrow.find(file_));  // used again: now the newest
        }
        usleep(20'000);  // so that the times of use differ
    }
    std::vector<int> kept;
    for (int i = 0; i < 8; ++i) {
        write("model.step", std::to_string(i));
        if (narrow.find(file_)) kept.push_back(i);
    }
    EXPECT_EQ(kept, (std::vector<int>{0, 4, 5, 6, 7}));
    EXPECT_FALSE(CadCache(folder_ / "tiny", 10).keep(file_, small_model()));
}

TEST(IsolatedMessages, ComeInAnyPieces) {
    const std::string all = progress_message(0.25, "one") + progress_message(2, std::string(1000, 'x')) + answer_message_header(5) + "hello" + answer_end;
    for (const std::size_t step : {std::size_t{1}, std::size_t{2}, std::size_t{7}, all.size()}) {
        std::vector<std::pair<double, std::string>> told;
        MessageReader reader(100, [&](double fraction, std::string_view stage) { told.emplace_back(fraction, stage); });
        for (std::size_t i = 0; i < all.size(); i += step) {
            EXPECT_FALSE(reader.complete());
            ASSERT_TRUE(reader.take(std::string_view(all).substr(i, step)));
        }
        EXPECT_TRUE(reader.complete());
        EXPECT_EQ(reader.answer(), "hello");
        ASSERT_EQ(told.size(), 2u);
        EXPECT_EQ(told[0], std::pair(0.25, std::string("one")));
        EXPECT_EQ(told[1], std::pair(1.0, std::string(255, 'x')));
    }
    EXPECT_FALSE(MessageReader(100, {}).take("?"));
    EXPECT_FALSE(MessageReader(4, {}).take(answer_message_header(5)));
    EXPECT_FALSE(MessageReader(100, {}).take(all + "more"));
}

}  // namespace
}  // namespace crescente::io
