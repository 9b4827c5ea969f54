// What `info` and `bench` tell about real scenes.
#include <set>

#include <nlohmann/json.hpp>

#include "app/program.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;
const std::string balls = (scenes / "balls4.nff").string();

TEST(Info, CountsWhatTheSphereflakeHas) {
    const Outcome outcome = crescente({"info", balls, "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json info = Json::parse(outcome.out);
    EXPECT_EQ(info.at("format"), "NFF");
    EXPECT_EQ(info.at("lights"), 3);
    EXPECT_EQ(info.at("materials"), 2);
    EXPECT_EQ(info.at("camera"), true);
    EXPECT_EQ(info.at("instances"), 7382);
    EXPECT_TRUE(info.at("problems").empty());
    EXPECT_TRUE(info.at("bounds").at("metres").contains("lower"));
    EXPECT_GT(info.at("memory"), 0);
}

TEST(Info, TextHasTheSameNumbers) {
    const Outcome outcome = crescente({"info", (scenes / "2CylinderEngine.glb").string()});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* word : {"format", "unit", "shapes", "triangles", "nodes", "materials", "bounds", "memory"}) EXPECT_TRUE(contains(outcome.out, word));
}

TEST(Bench, TableHasEveryRowWithARatioToTheFirst) {
    const Outcome outcome = crescente({"bench", balls, "--size", "40x30", "--threads", "1", "--repeat", "2", "--json"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const Json bench = Json::parse(outcome.out);
    std::set<std::string> names;
    for (const Json& row : bench.at("rows")) names.insert(row.at("name"));
    EXPECT_EQ(names, (std::set<std::string>{"embree", "embree, shadow cache", "embree, shortcut exact", "embree, shortcut trust", "kay-kajiya",
                                            "kay-kajiya, no octant rejection", "kay-kajiya, no priority queue", "kay-kajiya, shadow cache",
                                            "linear"}));
    const Json& first = bench["rows"][0];
    EXPECT_EQ(first.at("ratio"), 1.0);
    EXPECT_EQ(first.at("times").size(), 2u);
    for (const Json& row : bench["rows"]) {
        if (row.at("name") == "embree, shortcut trust" || row.at("skipped").get<bool>()) continue;
        EXPECT_EQ(row.at("stats").at("rays"), first["stats"]["rays"]) << row["name"] << ": the same rays, however they find their objects";
    }
}

TEST(Bench, TableIsReadable) {
    const Outcome outcome = crescente({"bench", balls, "--size", "24x16", "--repeat", "1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    for (const char* word : {"embree", "kay-kajiya, no priority queue", "linear", "ratio", "cache hit", "memory"}) EXPECT_TRUE(contains(outcome.out, word));
}

TEST(Bench, BruteForceIsSkippedWhereItWouldTakeForever) {
    const Outcome outcome = crescente({"bench", (scenes / "2CylinderEngine.glb").string(), "--size", "32x24", "--repeat", "1"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.out, "parts are too many for brute force"));
}

}  // namespace
}  // namespace crescente::test
