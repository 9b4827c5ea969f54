// Several pages that edit at once, for a while: everybody is served, and memory does not grow.
#include <thread>

#include "app/server/viewer_client.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;

class Soak : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        setenv("XDG_STATE_HOME", path("state").c_str(), 1);
        constexpr unsigned far_too_long = 300;
        alarm(far_too_long);
    }
    void TearDown() override {
        alarm(0);
        ProgramTest::TearDown();
    }
};

// A page that drags, changes materials, undoes, resizes, clicks and looks around.
void work(Client& client, int rounds, int seed) {
    for (int i = 0; i < rounds; ++i) {
        const double x = 0.01 * ((i * 7 + seed * 13) % 40);
        const std::string gesture = "drag " + std::to_string(i / 5);
        EXPECT_TRUE(client.request({{"move", {{"object", 1}, {"transform", {{"translate", {x, 0, 0}}}}}}, {"gesture", gesture}}).contains("edited"));
        EXPECT_TRUE(client.request({{"set", {{"material.red.roughness", 0.1 + x}}}, {"gesture", gesture + " red"}}).contains("edited"));
        if (i % 3 == 0) client.request({{"undo", 1}});
        if (i % 4 == 0) client.send({{"look", {{"position", {3 + x, 2, 5}}, {"target", {0, 0.5, 0}}}}});
        if (i % 5 == 0) client.request({{"pick", {{"x", 20}, {"y", 20}}}});
        if (i % 7 == 0) client.send({{"view", {{"width", 64 + 16 * (i % 3)}, {"height", 48}}}});
    }
}

TEST_F(Soak, ManyPagesEditAtOnceAndMemoryIsSteady) {
    Server server({(scenes / "primitives.json").string(), "--size", "64x48"});
    const auto everybody = [&](int rounds) {
        std::vector<std::thread> pages;
        for (int seed = 0; seed < 4; ++seed) {
            pages.emplace_back([&, seed] {
                Client client(server);
                work(client, rounds, seed);
                client.send({{"view", {{"width", 64}, {"height", 48}}}});
                client.wait_converged();
                if (seed % 2) client.vanish();
            });
        }
        for (std::thread& page : pages) page.join();
        return server.resident_bytes();
    };
#ifdef __SANITIZE_ADDRESS__
    constexpr std::size_t slack = std::size_t{400} << 20;  // freed memory is kept aside for a while
#else
    constexpr std::size_t slack = std::size_t{48} << 20;
#endif
    constexpr int rounds = 25;
    everybody(rounds);
    const std::size_t before = everybody(rounds);  // as many sessions as there may be
    everybody(rounds);
    const std::size_t after = everybody(rounds);
    EXPECT_GT(before, 0u);
    EXPECT_LT(after, before + slack);
}

}  // namespace
}  // namespace crescente::test
