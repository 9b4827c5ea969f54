// The viewer's server as a page meets it: the real program, pictures, edits.
#include "app/server/viewer_client.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;

const std::string primitives = (scenes / "primitives.json").string();
constexpr int width = 160, height = 100;

class Viewing : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        setenv("XDG_STATE_HOME", path("state").c_str(), 1);
        setenv("XDG_CACHE_HOME", path("cache").c_str(), 1);
        constexpr unsigned far_too_long = 300;
        alarm(far_too_long);  // a wait that never ends is a failure, not a hang
    }
    void TearDown() override {
        alarm(0);
        ProgramTest::TearDown();
    }
    Pixels rendered(const std::string& model, std::vector<std::string> more = {}) {
        std::vector<std::string> arguments{"render", model, "-o", path("picture.png"), "-q"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        const Outcome outcome = crescente(std::move(arguments));
        EXPECT_EQ(outcome.code, 0) << outcome.err;
        return read_png(read(path("picture.png")));
    }
    static void set_size(Client& client) { client.send({{"view", {{"width", width}, {"height", height}}}}); }
    static bool has_size(const FrameHeader& frame) { return frame.width == width && frame.height == height; }
};

const std::vector<std::string> size_option{"--size", "160x100"};

TEST_F(Viewing, FramesAddUpToThePictureOfTheCommandLine) {
    Server server({primitives});
    Client client(server);
    set_size(client);
    const FrameHeader last = client.wait_converged(has_size);
    EXPECT_GE(client.frames, 2u);
    EXPECT_TRUE(last.converged);
    EXPECT_EQ(client.picture(), rendered(primitives, size_option));
    EXPECT_EQ(client.scene()["name"], "primitives");
    EXPECT_EQ(client.scene()["opened"], true);
    EXPECT_EQ(client.welcome()["welcome"]["protocol"], 2);
    EXPECT_GT(client.wait_done()["fresh_rays"], width * height);
    server.program().send(SIGINT);
    EXPECT_EQ(client.wait_for("closed")["closed"]["reason"], "the program ends");
    EXPECT_EQ(server.program().finish().code, 0);
}

TEST_F(Viewing, AnEditCostsWhatItChangesAndUndoBringsThePictureBack) {
    Server server({primitives});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    const Pixels before = client.picture();

    const Json edited = client.request({{"set", {{"material.red.base_color", "#20a040"}, {"material.red.roughness", 0.9}}}});
    EXPECT_EQ(edited["edited"]["can_undo"], 1);
    EXPECT_EQ(edited["edited"]["began_anew"], false);
    client.wait_converged();
    EXPECT_NE(client.picture(), before);
    std::vector<std::string> options = size_option;
    options.insert(options.end(), {"--set", "material.red.base_color=#20a040", "--set", "material.red.roughness=0.9"});
    EXPECT_EQ(client.picture(), rendered(primitives, options));
    const Json progress = client.wait_done();
    EXPECT_LT(progress["edit_rays"], progress["fresh_rays"]);
    EXPECT_GT(progress["edit_tiles"], 0);

    const Json undone = client.request({{"undo", 1}});
    EXPECT_EQ(undone["edited"]["can_redo"], 1);
    client.wait_converged();
    EXPECT_EQ(client.picture(), before);
    EXPECT_EQ(client.request({{"undo", 1}})["error"]["problems"][0]["place"], "/undo");
    EXPECT_EQ(client.request({{"redo", 1}})["edited"]["can_undo"], 1);
}

TEST_F(Viewing, StepsOfOneGestureAreTakenBackTogether) {
    Server server({primitives});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    const Pixels before = client.picture();
    for (const double x : {0.1, 0.2, 0.3}) {
        const Json moved = client.request({{"move", {{"object", 1}, {"by", {{"translate", {x, 0, 0}}}}}}, {"gesture", "drag 1"}});
        EXPECT_EQ(moved["edited"]["can_undo"], 1) << moved;
    }
    EXPECT_EQ(client.request({{"move", {{"object", 1}, {"by", {{"translate", {0, 0.1, 0}}}}}}, {"gesture", "drag 2"}})["edited"]["can_undo"], 2);
    EXPECT_EQ(client.request({{"undo", 2}})["edited"]["can_undo"], 0);
    client.wait_converged();
    EXPECT_EQ(client.picture(), before);
}

TEST_F(Viewing, TheNewestCameraWins) {
    Server server({primitives});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    constexpr int looks = 60;
    for (int i = 1; i <= looks; ++i) client.send({{"look", {{"position", {3.6 - 0.01 * (looks - i), 2, 5}}, {"target", {0, 0.5, 0}}}}});
    std::uint32_t last = 0;
    const FrameHeader frame = client.wait_converged([&](const FrameHeader& f) {
        EXPECT_GE(f.looks, last);
        last = f.looks;
        return f.looks == looks;
    });
    EXPECT_EQ(frame.looks, static_cast<std::uint32_t>(looks));
    EXPECT_EQ(client.request({{"undo", 1}})["error"]["problems"][0]["place"], "/undo");
    EXPECT_EQ(client.picture(), rendered(primitives, {"--size", "160x100", "--set", "camera.position=[3.6,2,5]", "--set", "camera.target=[0,0.5,0]", "--set", "camera.field_of_view=40"}));
}

// Of many objects only those are told that an edit changed: what is told adds up to what a page that comes now is told.
TEST_F(Viewing, OfObjectsOnlyWhatChangedIsTold) {
    Json objects = Json::object();
    constexpr int balls = 300;
    for (int i = 0; i < balls; ++i) objects["ball " + std::to_string(i)] = {{"shape", {{"sphere", {{"radius", 0.4}}}}}, {"transform", {{"translate", {i % 20, i / 20, 0}}}}};
    const std::string model = write("balls.json", Json{{"objects", std::move(objects)}}.dump());
    Server server({model});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    EXPECT_GE(client.told_objects, static_cast<std::size_t>(balls));
    const auto edit = [&](const Json& verb) {
        const std::size_t before = client.told_objects;
        const std::uint64_t revision = client.request(verb)["edited"]["revision"];
        while (client.scene()["revision"] < revision) client.wait_for("scene");
        return client.told_objects - before;
    };
    EXPECT_EQ(edit({{"move", {{"object", "ball 7"}, {"by", {{"translate", {0, 0, 0.5}}}}}}}), 1u);
    EXPECT_EQ(edit({{"hide", "ball 8"}}), 1u);
    EXPECT_EQ(edit({{"assign", {{"object", "ball 9"}, {"material", {{"name", "red"}, {"base_color", {1, 0, 0}}}}}}}), 1u);
    EXPECT_EQ(edit({{"duplicate", {{"object", "ball 10"}, {"name", "copy"}}}}), 1u);
    EXPECT_EQ(edit({{"remove", "ball 11"}}), 0u);
    EXPECT_EQ(edit({{"undo", 5}}), 4u);
    EXPECT_EQ(edit({{"redo", 4}}), 4u);
    const Json told = client.scene();
    client.vanish();
    Client again(server, client.session());
    again.wait_for("scene");
    for (const char* member : {"objects", "roots", "bounds"}) {
        Json before = told[member], now = again.scene()[member];
        if (std::string(member) == "objects") {
            const auto by_index = [](const Json& a, const Json& b) { return a["index"] < b["index"]; };
            std::sort(before.begin(), before.end(), by_index), std::sort(now.begin(), now.end(), by_index);
        }
        EXPECT_EQ(before, now) << member;
    }
}

TEST_F(Viewing, ThePixelTellsWhatIsThere) {
    Server server({primitives});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    const Json picked = client.request({{"pick", {{"x", 80}, {"y", 60}}}});
    ASSERT_TRUE(picked["picked"].is_object()) << picked;
    const Outcome outcome = crescente({"render", primitives, "-o", path("p.png"), "-q", "--size", "160x100", "--pick", "80,60"});
    const int object = picked["picked"]["path"].back();
    std::string name;
    for (const Json& one : client.scene()["objects"]) {
        if (one["index"] == object) name = one["name"];
    }
    EXPECT_TRUE(contains(outcome.out, name));
    EXPECT_TRUE(client.request({{"pick", {{"x", 5000}, {"y", 60}}}})["picked"].is_null());

    const Json replayed = client.request({{"replay", {{"x", 80}, {"y", 60}}}});
    EXPECT_TRUE(contains(replayed["replayed"]["text"], "pixel 80,60"));
    ASSERT_GE(replayed["replayed"]["trees"].size(), 4u);
    const Json& tree = replayed["replayed"]["trees"][0];
    EXPECT_EQ(tree["kind"], "camera");
    EXPECT_FALSE(tree["lights"].empty());
    EXPECT_GT(tree["distance"], 0.0);
}

TEST_F(Viewing, ExportsAreThePicturesOfTheCommandLine) {
    Server server({primitives});
    Client client(server);
    set_size(client);
    client.request({{"set", {{"material.red.base_color", {0.1, 0.2, 0.7}}}}});
    client.send({{"look", {{"position", {2, 2.5, 6}}, {"target", {0, 0.5, 0}}}}});
    const Json scene = client.request({{"export", {{"format", "json"}}}});
    const Json picture = client.request({{"export", {{"format", "png"}, {"width", 123}, {"height", 77}, {"level", "edges"}}}});
    EXPECT_EQ(picture["exported"]["name"], "primitives.png");
    const auto download = [&](const Json& exported) { return ask(server, "/" + exported["exported"]["address"].get<std::string>()); };
    const std::string model = write("exported.json", download(scene).body);
    EXPECT_EQ(read_png(download(picture).body), rendered(model, {"--size", "123x77"}));
    EXPECT_EQ(download(picture).body.size(), picture["exported"]["bytes"]);

    const std::string address = picture["exported"]["address"];
    EXPECT_EQ(ask(server, "/" + address.substr(0, address.find('?'))).status, 403);
    EXPECT_EQ(ask(server, "/export/" + client.session() + "/99?token=" + server.token()).status, 404);
    EXPECT_TRUE(client.request({{"export", {{"format", "bmp"}}}}).contains("error"));
    const Json wide = client.request({{"export", {{"format", "png"}, {"width", 32768}, {"height", 32768}, {"level", "edges"}}}});
    EXPECT_TRUE(wide.contains("error")) << wide;
}

// The scene names the model for its exact parts, and has all that was done to them.
TEST_F(Viewing, ACadModelIsSavedAsASceneThatRendersAlike) {
    if (!fs::exists(fs::path(CRESCENTE_PROGRAM).parent_path() / "../lib/crescente_opencascade.so")) GTEST_SKIP() << "this build is without OpenCASCADE";
    Server server({(scenes / "as1-oc-214.stp").string()});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    const Pixels before = client.picture();
    for (const Json& edit : std::vector<Json>{{{"material", {{"name", "brass"}, {"library", "brass polished"}}}},
                                              {{"assign", {{"object", "plate_1"}, {"material", "brass"}, {"below", true}}}},
                                              {{"move", {{"object", "rod-assembly_1"}, {"by", {{{"rotate", {{"axis", "y"}, {"angle", 25}}}}, {{"translate", {3.7, 12.1, 0}}}}}}}},
                                              {{"remove", "l-bracket-assembly_1"}},
                                              {{"duplicate", {{"object", "plate_1"}, {"name", "second"}, {"by", {{"translate", {0, 77.7, 0}}}}}}},
                                              {{"ground", "none"}}}) {
        const Json answer = client.request(edit);
        ASSERT_TRUE(answer.contains("edited")) << answer;
    }
    client.send({{"look", {{"position", {0.3, 250, 400}}, {"target", {10, 20, 0}}}}});
    const Json picture = client.request({{"export", {{"format", "png"}, {"width", 123}, {"height", 77}, {"level", "edges"}}}});
    const Json scene = client.request({{"export", {{"format", "json"}}}});
    ASSERT_TRUE(scene.contains("exported")) << scene;
    const auto download = [&](const Json& exported) { return ask(server, "/" + exported["exported"]["address"].get<std::string>()).body; };
    const Pixels exported = read_png(download(picture));
    EXPECT_NE(exported, before);
    EXPECT_EQ(exported, rendered(write("exported.json", download(scene)), {"--size", "123x77", "--level", "edges"}));
}

TEST_F(Viewing, AReloadedPageTakesItsSessionUp) {
    Server server({primitives});
    std::string key;
    Pixels edited;
    {
        Client client(server);
        set_size(client);
        key = client.session();
        EXPECT_EQ(client.welcome()["welcome"]["taken_up"], false);
        client.request({{"set", {{"material.red.base_color", "#20a040"}}}});
        client.wait_converged(has_size);
        edited = client.picture();
        client.vanish();
    }
    Client again(server, key);
    EXPECT_EQ(again.session(), key);
    EXPECT_EQ(again.welcome()["welcome"]["taken_up"], true);
    const FrameHeader first = again.wait_frame();
    EXPECT_EQ(first.number, 1u);
    EXPECT_EQ(first.looks, 0u);
    EXPECT_TRUE(first.anew);
    EXPECT_EQ(first.area, width * height);
    if (!first.converged) again.wait_converged();
    EXPECT_EQ(again.picture(), edited);
    EXPECT_EQ(again.request({{"undo", 1}})["edited"]["can_undo"], 0);

    Client third(server, key);  // while the other page is still there
    EXPECT_EQ(third.welcome()["welcome"]["taken_up"], true);
    EXPECT_EQ(again.wait_for("closed")["closed"]["reason"], "the session was taken up by another page");
    EXPECT_TRUE(again.is_ended());
    third.wait_converged();
}

TEST_F(Viewing, ASlowPageGetsFewFramesAndTheLastOneIsUpToDate) {
    Server server({primitives});
    Client client(server);
    client.acknowledging = false;
    set_size(client);
    client.wait_for("scene");
    // Answers come, and frames end after two, however much happens.
    for (int i = 1; i <= 20; ++i) client.request({{"set", {{"material.red.roughness", 0.04 * i}}}});
    client.wait_done();
    client.request({{"files", nullptr}});
    EXPECT_LE(client.frames, 2u);
    client.acknowledging = true;
    client.acknowledge(static_cast<std::uint32_t>(client.frames));
    client.wait_converged(has_size);
    EXPECT_LE(client.frames, 4u);
    EXPECT_EQ(client.picture(), rendered(primitives, {"--size", "160x100", "--set", "material.red.roughness=0.8"}));
}

TEST_F(Viewing, LayersAreShownAsMaps) {
    Server server({primitives});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    const Pixels color = client.picture();
    for (const char* layer : {"level", "influence", "samples"}) {
        client.send({{"layer", layer}});
        EXPECT_TRUE(client.wait_converged().anew) << layer;
        EXPECT_NE(client.picture(), color) << layer;
    }
    client.send({{"layer", "color"}});
    client.wait_converged();
    EXPECT_EQ(client.picture(), color);
}

TEST_F(Viewing, StudioGroundAndLevelAreEdits) {
    const std::string model = write("bare.json", R"({"objects": {"ball": {"shape": {"sphere": {"radius": 0.5}}}}})");
    Server server({model});
    Client client(server);
    set_size(client);
    client.wait_converged(has_size);
    const Pixels before = client.picture();
    EXPECT_EQ(client.scene()["studio"], "default");
    EXPECT_EQ(client.scene()["ground"], "solid");
    EXPECT_EQ(client.request({{"studio", "tent"}})["edited"]["can_undo"], 1);
    EXPECT_EQ(client.request({{"ground", "none"}})["edited"]["can_undo"], 2);
    client.wait_for("scene");
    client.wait_converged();
    EXPECT_EQ(client.scene()["studio"], "tent");
    EXPECT_EQ(client.scene()["ground"], "none");
    EXPECT_TRUE(client.request({{"studio", "tnet"}})["error"]["problems"][0]["hint"].get<std::string>().find("tent") != std::string::npos);
    EXPECT_TRUE(client.request({{"until", "shadows"}}).contains("edited"));
    EXPECT_EQ(client.request({{"undo", 2}})["edited"]["can_undo"], 0);
    EXPECT_EQ(client.wait_done()["until"], "shadows");  // which undo leaves alone
    client.request({{"until", "edges"}});
    client.wait_converged();
    EXPECT_EQ(client.picture(), before);
}

}  // namespace
}  // namespace crescente::test
