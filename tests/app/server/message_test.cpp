// The parts of the server that need no network.
#include <cmath>
#include <fstream>

#include <gtest/gtest.h>

#include "app/server/areas.h"
#include "app/server/color_map.h"
#include "app/server/guard.h"
#include "app/server/message.h"
#include "app/server/protocol_schema.h"
#include "app/server/replies.h"
#include "io/edit_text.h"

namespace crescente::app {
namespace {

TEST(Message, IdAndGestureStandBesideTheVerb) {
    const Message message = read_message(R"({"gesture": "drag", "undo": 3, "id": 7})");
    ASSERT_TRUE(message.request);
    EXPECT_EQ(message.id, 7);
    EXPECT_EQ(message.gesture, "drag");
    EXPECT_EQ(std::get<UndoEdits>(*message.request).times, 3);
}

TEST(Message, TheIdIsKnownOfWhatIsWrong) {
    const Message message = read_message(R"({"id": 9, "pick": {"x": 1}})");
    EXPECT_EQ(message.id, 9);
    ASSERT_FALSE(message.request);
    EXPECT_EQ(message.request.error().problems.at(0).place, "line 1, /pick");
}

TEST(Message, EditsAreLeftToTheirReader) {
    const Message message = read_message(R"({"hide": "wheel", "id": 1})");
    ASSERT_TRUE(message.request);
    const io::Json& edit = std::get<EditScene>(*message.request).edit;
    ASSERT_EQ(edit.object()->size(), 1u);
    EXPECT_EQ(edit.object()->front().key, "hide");
}

TEST(Message, EveryVerbIsReadByItsOwnReader) {
    for (const io::Word& word : request_words()) {
        const Message message = read_message("{\"" + word.name + "\": {\"none of these\": []}}");
        const bool is_look = word.name == "look";  // whose members are those of a camera
        EXPECT_EQ(message.request.has_value(), is_look) << word.name;
    }
    for (const io::Word& word : io::edit_words()) EXPECT_TRUE(read_message("{\"" + word.name + "\": 1}").request) << word.name;
}

TEST(Message, PicturesAreNotTooLarge) {
    EXPECT_TRUE(read_message(R"({"view": {"width": 4096, "height": 4096}})").request);
    EXPECT_FALSE(read_message(R"({"view": {"width": 4096, "height": 4097}})").request);
    EXPECT_TRUE(read_message(R"({"export": {"format": "png", "width": 16384, "height": 16384, "level": "soft"}})").request);
    EXPECT_FALSE(read_message(R"({"export": {"format": "png", "width": 32768, "height": 16384, "level": "soft"}})").request);
}

TEST(Protocol, TheSchemaInTheDocumentsIsCurrent) {
    std::ifstream file(std::string(CRESCENTE_ROOT) + "/docs/protocol.schema.json");
    const std::string there((std::istreambuf_iterator<char>(file)), {});
    EXPECT_EQ(there, protocol_schema()) << "crescente schema --protocol > docs/protocol.schema.json";
}

TEST(Protocol, TheSchemaHasEveryMessage) {
    const auto schema = nlohmann::json::parse(protocol_schema());
    EXPECT_EQ(schema["$defs"]["request"]["oneOf"].size(), io::edit_words().size() + request_words().size());
    EXPECT_EQ(schema["$defs"]["reply"]["oneOf"].size(), reply_words().size());
    for (std::size_t i = 0; i < reply_words().size(); ++i) EXPECT_EQ(schema["$defs"]["reply"]["oneOf"][i]["required"], nlohmann::json::array({reply_words()[i].name}));
}

TEST(Areas, CoverEveryMarkedTileOnceAndNoOther) {
    const TileGrid grid{300, 200, 64};
    for (unsigned seed = 1; seed < 200; ++seed) {
        std::vector<bool> marked(grid.size());
        unsigned state = seed * 2654435761u;
        for (std::size_t i = 0; i < marked.size(); ++i) state = state * 1664525u + 1013904223u, marked[i] = state >> 30 > seed % 3;
        std::vector<int> covered(300 * 200, 0);
        for (const render::Area& area : rectangles_of(grid, marked, 2)) {
            EXPECT_LE(area.height, 128);
            for (int y = area.y; y < area.y + area.height; ++y) {
                for (int x = area.x; x < area.x + area.width; ++x) ++covered.at(static_cast<std::size_t>(y * 300 + x));
            }
        }
        for (int y = 0; y < 200; ++y) {
            for (int x = 0; x < 300; ++x) {
                const bool wanted = marked[static_cast<std::size_t>(y / 64 * grid.across() + x / 64)];
                ASSERT_EQ(covered[static_cast<std::size_t>(y * 300 + x)], wanted ? 1 : 0);
            }
        }
    }
}

TEST(Areas, AWholePictureIsFewRectangles) {
    const TileGrid grid{1280, 720, 64};
    EXPECT_EQ(rectangles_of(grid, std::vector<bool>(grid.size(), true), 4).size(), 3u);
}

TEST(ColorMap, GetsLighterAllTheWay) {
    float last = -1;
    for (int i = 0; i <= 100; ++i) {
        const auto [r, g, b] = viridis(static_cast<float>(i) / 100);
        const float luminance = 0.2126f * r + 0.7152f * g + 0.0722f * b;
        EXPECT_GT(luminance, last);
        last = luminance;
    }
    EXPECT_EQ(viridis(-1), viridis(0));
    EXPECT_EQ(viridis(2), viridis(1));
    EXPECT_EQ(viridis(std::nanf("")), viridis(0));
}

TEST(Guard, HostsAreThisServerByItsAddress) {
    EXPECT_TRUE(is_own_host("127.0.0.1:80", "127.0.0.1", 80, false));
    EXPECT_TRUE(is_own_host("localhost", "127.0.0.1", 80, false));
    EXPECT_TRUE(is_own_host("[::1]:8080", "::1", 8080, false));
    EXPECT_FALSE(is_own_host("localhost", "127.0.0.1", 8080, false));
    EXPECT_FALSE(is_own_host("localhost:81", "127.0.0.1", 8080, false));
    EXPECT_FALSE(is_own_host("10.0.0.7:8080", "127.0.0.1", 8080, false));
    EXPECT_TRUE(is_own_host("10.0.0.7:8080", "0.0.0.0", 8080, true));
    EXPECT_FALSE(is_own_host("rebound.example:8080", "0.0.0.0", 8080, true));
    EXPECT_FALSE(is_own_host("", "127.0.0.1", 8080, false));
}

TEST(Guard, TargetsAreClean) {
    const auto target = parse_target("/export/ab_-/3?token=x%2By&empty=&alone");
    ASSERT_TRUE(target);
    EXPECT_EQ(target->path, "/export/ab_-/3");
    EXPECT_EQ(target->value("token"), "x+y");
    EXPECT_EQ(target->value("empty"), "");
    for (const char* bad : {"", "x", "//", "/a//b", "/..", "/a/../b", "/%2e%2e", "/a%2f%2e%2e%2fb", "/a%00", "/%", "/%4", "/a\\b", "/a\nb", "/a/b/c/d/e/f/g/h/i"}) EXPECT_FALSE(parse_target(bad)) << bad;
}

TEST(Guard, SecretsAreRandomAndCompared) {
    const std::string a = random_text(24), b = random_text(24);
    EXPECT_EQ(a.size(), 32u);
    EXPECT_NE(a, b);
    EXPECT_EQ(a.find_first_not_of("ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789-_"), std::string::npos);
    EXPECT_TRUE(same_secret(a, a));
    EXPECT_FALSE(same_secret(a, b));
    EXPECT_FALSE(same_secret(a, a.substr(1)));
    EXPECT_FALSE(same_secret(a, ""));
}

}  // namespace
}  // namespace crescente::app
