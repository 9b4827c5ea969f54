// What the viewer's server refuses, and what it survives.
#include <chrono>
#include <fstream>
#include <sstream>
#include <thread>

#include "app/server/viewer_client.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;

const std::string primitives = (scenes / "primitives.json").string();

class Safety : public ProgramTest {
protected:
    void SetUp() override {
        ProgramTest::SetUp();
        setenv("XDG_STATE_HOME", path("state").c_str(), 1);
        temporary = folder / "temporary";
        fs::create_directories(temporary);
        setenv("TMPDIR", temporary.c_str(), 1);
        constexpr unsigned far_too_long = 300;
        alarm(far_too_long);
    }
    void TearDown() override {
        alarm(0);
        unsetenv("TMPDIR");
        ProgramTest::TearDown();
    }
    fs::path temporary;  // of the program
    // A picture of few pixels, for tests that are not about it.
    static void be_small(Client& client) {
        client.send({{"view", {{"width", 32}, {"height", 20}}}});
        client.wait_converged([](const FrameHeader& frame) { return frame.width == 32; });
    }
    static std::string reason(const Json& reply) { return reply["error"]["problems"][0]["reason"]; }
};

TEST_F(Safety, OnlyThePageOfTheTokenIsServed) {
    Server server({});
    const std::string token = "?token=" + server.token();
    const HttpReply page = ask(server, "/" + token);
    EXPECT_EQ(page.status, 200);
    EXPECT_TRUE(contains(page.policy, "default-src 'none'"));
    EXPECT_EQ(page.sniffing, "nosniff");
    EXPECT_EQ(ask(server, "/").status, 403);
    EXPECT_EQ(ask(server, "/?token=" + std::string(server.token().size(), 'A')).status, 403);
    EXPECT_EQ(ask(server, "/" + token.substr(0, token.size() - 1)).status, 403);
    EXPECT_EQ(ask(server, "/" + token, "GET", {}, {{"Host", "evil.example"}}).status, 403);
    EXPECT_EQ(ask(server, "/" + token, "GET", {}, {{"Host", "evil.example:" + server.host().substr(server.host().rfind(':') + 1)}}).status, 403);
    EXPECT_EQ(ask(server, "/" + token, "GET", {}, {{"Origin", "http://evil.example"}}).status, 403);
    EXPECT_EQ(ask(server, "/" + token, "DELETE").status, 405);
    for (const char* target : {"/../etc/passwd", "/%2e%2e/etc/passwd", "/assets/../../etc/passwd", "//etc/passwd", "/..%5cetc", "/a%00b", "/%zz", "etc", "/.hidden"}) {
        const HttpReply refused = ask(server, target + token);
        EXPECT_NE(refused.status, 200) << target;
        EXPECT_FALSE(refused.body.find("root:") != std::string::npos) << target;
    }
    const Fields upgrade{{"Upgrade", "websocket"}, {"Connection", "Upgrade"}, {"Sec-WebSocket-Version", "13"}, {"Sec-WebSocket-Key", "dGhlIHNhbXBsZSBub25jZQ=="}};
    const auto with = [&](const std::string& name, const std::string& value) {
        Fields fields = upgrade;
        fields.emplace_back(name, value);
        return fields;
    };
    EXPECT_EQ(ask(server, "/socket?token=x", "GET", {}, upgrade).status, 403);
    EXPECT_EQ(ask(server, "/socket" + token, "GET", {}, with("Origin", "")).status, 403);
    EXPECT_EQ(ask(server, "/socket" + token, "GET", {}, with("Origin", "http://evil.example")).status, 403);
    EXPECT_EQ(ask(server, "/other" + token, "GET", {}, upgrade).status, 403);
    EXPECT_EQ(ask(server, "/" + std::string(20'000, 'a')).status, 0);  // a header without end is not read to it
    EXPECT_EQ(ask(server, "/" + token).status, 200);
}

TEST_F(Safety, OnlyAllowedFilesAreOpened) {
    fs::create_directories(folder / "allowed" / "inner");
    fs::copy_file(scenes / "primitives.json", folder / "allowed" / "inner" / "model.json");
    fs::copy_file(scenes / "primitives.json", folder / "secret.json");
    fs::create_symlink(folder / "secret.json", folder / "allowed" / "link.json");
    fs::create_directories(folder / "allowed-not");
    fs::copy_file(scenes / "primitives.json", folder / "allowed-not" / "model.json");
    Server server({"--folder", path("allowed")});
    Client client(server);
    EXPECT_EQ(reason(client.request({{"undo", 1}})), "no model is open");
    const Json start = client.request({{"files", nullptr}});
    ASSERT_EQ(start["files"]["folders"].size(), 1u);
    EXPECT_GE(start["files"]["examples"].size(), 5u);
    const Json top = client.request({{"files", path("allowed")}});
    EXPECT_EQ(top["files"]["folders"], Json::array({"inner"}));
    EXPECT_TRUE(top["files"]["files"].empty()) << "the link leads out of the folder";
    for (const std::string& name : {path("secret.json"), path("allowed/link.json"), path("allowed/../secret.json"), path("allowed-not/model.json"), std::string("/etc/passwd"),
                                    std::string("upload/../../x"), std::string("example/../README.md"), std::string("example/LICENCES.txt"), path("allowed"), path("allowed/none.json")}) {
        EXPECT_TRUE(client.request({{"open", name}}).contains("error")) << name;
    }
    for (const std::string& name : {folder.string(), path("allowed/.."), std::string("/")}) EXPECT_TRUE(client.request({{"files", name}}).contains("error")) << name;
    EXPECT_TRUE(client.request({{"open", path("allowed/inner/model.json")}}).contains("opened"));
    EXPECT_TRUE(client.request({{"open", "example/primitives.json"}}).contains("opened"));
    be_small(client);
    // Nor do edits read what may not be read.
    EXPECT_TRUE(contains(reason(client.request({{"environment", {{"image", path("secret.hdr")}}}})), "may not be read"));
    EXPECT_TRUE(contains(reason(client.request({{"set", {{"environment.image", "/etc/passwd"}}}})), "may not be read"));
    EXPECT_TRUE(contains(reason(client.request(Json::parse(R"({"batch": [{"material": {"name": "m", "textures": {"base_color": {"image": "../../../secret.png"}}}}]})"))), "may not be read"));
    EXPECT_TRUE(contains(reason(client.request({{"light", {{"name", "l"}, {"profile", "/etc/passwd"}}}})), "may not be read"));
    EXPECT_TRUE(client.request({{"environment_file", path("secret.hdr")}}).contains("error"));
    EXPECT_EQ(client.request({{"set", {{"settings.contrast", 0.2}}}})["edited"]["can_undo"], 1);
    // What was opened is found again.
    EXPECT_EQ(client.request({{"files", nullptr}})["files"]["recent"][0]["file"], path("allowed/inner/model.json"));
}

TEST_F(Safety, WrongMessagesAreAnsweredAndHarmNobody) {
    Server server({primitives, "--size", "32x20"});
    Client client(server), other(server);
    be_small(client);
    be_small(other);
    const Pixels before = client.picture();
    for (const char* text :
         {"", "{", "null", "[]", "7", "\"x\"", "{}", R"({"id": 1})", R"({"unknown": 1})", R"({"undo": 1, "redo": 1})", R"({"undo": 0})", R"({"undo": -1})", R"({"undo": 1e99})", R"({"undo": "1"})",
          R"({"look": 3})", R"({"view": {"width": 0, "height": 1}})", R"({"view": {"width": 100000, "height": 1}})", R"({"view": {"width": 8}})", R"({"view": []})", R"({"until": "never"})",
          R"({"until": 17})", R"({"pause": 1})", R"({"attend": {"x": 1}})", R"({"layer": "colour"})", R"({"pick": {"x": -1, "y": 0}})", R"({"pick": {"x": 0.5, "y": 0}})", R"({"replay": null})",
          R"({"shown": -1})", R"({"open": ""})", R"({"open": 3})", R"({"files": {}})", R"({"studio": 1})", R"({"ground": "sand"})", R"({"environment_file": []})", R"({"export": {}})",
          R"({"export": {"format": "png"}})", R"({"export": {"format": "png", "width": 1, "height": 1, "level": "edges", "camera": 3}})", R"({"cancel": "x"})", R"({"id": "x", "undo": 1})",
          R"({"gesture": 4, "undo": 1})", R"({"set": {"material.nothing.ior": 2}})", R"({"set": {"material.red.ior": "x"}})", R"({"move": {"object": 99999, "by": []}})", R"({"batch": [{"batch": 1}]})",
          R"({"add": {"file": "/etc/passwd"}})", R"({"look": {"position": [0, 0, 0], "target": [0, 0, 0]}})", R"({"camera": {"position": ["x", 0, 0]}})", "{\"open\": \"a\\u0000b\"}",
          R"({"set": {"settings.width": 100000000}})"}) {
        client.send_text(text);
        const Json answer = client.wait_for("error");
        EXPECT_FALSE(answer["error"]["problems"].empty()) << text;
    }
    client.send_text(std::string(100'000, '['));
    EXPECT_FALSE(reason(client.wait_for("error")).empty());
    EXPECT_EQ(client.request({{"undo", 1}})["error"]["kind"], "input");
    EXPECT_EQ(client.picture(), before);
    EXPECT_EQ(other.request({{"set", {{"material.red.roughness", 0.9}}}})["edited"]["can_undo"], 1);
    other.wait_converged();
}

TEST_F(Safety, TooMuchEndsTheConnectionButNotTheSession) {
    Server server({primitives, "--size", "32x20"});
    std::string key;
    {
        Client client(server);
        key = client.session();
        EXPECT_EQ(client.request({{"set", {{"material.red.roughness", 0.9}}}})["edited"]["can_undo"], 1);
        try {
            client.send_text("{\"open\": \"" + std::string(std::size_t{2} << 20, 'x') + "\"}");
        } catch (const boost::system::system_error&) {
            // It may be ended before all is sent.
        }
        EXPECT_TRUE(client.is_ended());
    }
    {
        Client client(server, key);
        EXPECT_EQ(client.welcome()["welcome"]["taken_up"], true);
        try {
            for (int i = 0; i < 10'000; ++i) client.send_text("{\"look\": {}}");
        } catch (const boost::system::system_error&) {
        }
        EXPECT_TRUE(client.is_ended());
    }
    Client client(server, key);
    EXPECT_EQ(client.request({{"undo", 1}})["edited"]["can_undo"], 0);
}

TEST_F(Safety, SessionsAreFewAndEndWithoutAPage) {
    Server server({primitives, "--size", "32x20", "--sessions", "2", "--keep", "500ms"});
    std::string first;
    {
        Client a(server), b(server), c(server, "no-such-key");
        first = a.session();
        EXPECT_EQ(c.welcome()["closed"]["reason"], "there are too many sessions");
        EXPECT_TRUE(c.is_ended());
        be_small(a);
        a.vanish();
        b.vanish();
    }
    // Those without a page are freed after a while.
    const std::string upload = "/upload?token=" + server.token() + "&name=x.json&session=" + first;
    while (ask(server, upload, "POST", "{}").status != 403) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    Client again(server, first);
    EXPECT_EQ(again.welcome()["welcome"]["taken_up"], false);
    EXPECT_NE(again.session(), first);
    be_small(again);
}

TEST_F(Safety, ClientsThatVanishHarmNobody) {
    Server server({primitives, "--size", "32x20"});
    Client stays(server);
    be_small(stays);
    for (int i = 0; i < 12; ++i) {
        Client client(server);
        client.send({{"view", {{"width", 320}, {"height", 200}}}});
        client.send({{"look", {{"position", {3, 2, 5}}}}});
        if (i % 2) client.wait_frame();
        client.vanish();
    }
    EXPECT_EQ(stays.request({{"set", {{"material.red.roughness", 0.9}}}})["edited"]["can_undo"], 1);
    stays.wait_converged();
}

TEST_F(Safety, UploadsStayTogetherAndInTheirFolder) {
    Server server({"--upload", "64K"});
    Client client(server);
    const auto upload = [&](const std::string& name, const std::string& body, const std::string& token) {
        return ask(server, "/upload?token=" + token + "&session=" + client.session() + "&name=" + name, "POST", body);
    };
    const std::string token = server.token();
    const std::string scene = R"({"objects": {"part": {"file": "parts/ball.json"}}})", part = R"({"objects": {"ball": {"shape": {"sphere": {}}}}})";
    EXPECT_EQ(upload("scene.json", scene, token).body, R"({"file":"upload/scene.json"})");
    EXPECT_EQ(upload("parts/ball.json", part, token).status, 200);
    EXPECT_TRUE(client.request({{"open", "upload/scene.json"}}).contains("opened"));
    be_small(client);
    EXPECT_GE(client.scene()["objects"].size(), 2u);

    for (const char* name : {"../x.json", "/etc/x.json", "a/../../x.json", "..%2fx.json", ".x", "", "a%00.json", "a//b"}) EXPECT_NE(upload(name, part, token).status, 200) << name;
    EXPECT_EQ(upload("x.json", part, "wrong").status, 403);
    EXPECT_EQ(ask(server, "/upload?token=" + token + "&session=none&name=x.json", "POST", part).status, 403);
    EXPECT_EQ(ask(server, "/upload?token=" + token + "&session=" + client.session() + "&name=x.json", "POST", part, {{"Origin", ""}}).status, 403);
    EXPECT_EQ(upload("large.json", std::string(70'000, ' '), token).status, 413);
    EXPECT_EQ(upload("most.json", std::string(40'000, ' '), token).status, 200);
    EXPECT_EQ(upload("more.json", std::string(40'000, ' '), token).status, 413);
    // A model that names files elsewhere is not read.
    EXPECT_EQ(upload("thief.json", R"({"objects": {"part": {"file": "/etc/passwd"}}})", token).status, 200);
    EXPECT_TRUE(contains(reason(client.request({{"open", "upload/thief.json"}})), "may not be read"));
}

// Seconds of processor time that the program has used.
double processor_seconds(pid_t process) {
    std::ifstream stat("/proc/" + std::to_string(process) + "/stat");
    const std::string text((std::istreambuf_iterator<char>(stat)), {});
    std::istringstream fields(text.substr(text.rfind(')') + 2));  // from the third on
    std::string field;
    long user = 0, system = 0;
    for (int i = 3; i < 14; ++i) fields >> field;
    fields >> user >> system;
    return static_cast<double>(user + system) / static_cast<double>(sysconf(_SC_CLK_TCK));
}

TEST_F(Safety, WhoWaitsUsesNoProcessor) {
    Server server({primitives, "--size", "32x20"});
    Client stays(server);
    be_small(stays);
    {
        Client leaves(server);
        leaves.send({{"until", "indirect"}});
        leaves.vanish();
    }
    stays.request({{"files", nullptr}});
    std::this_thread::sleep_for(std::chrono::milliseconds(500));  // for the one that left to come to rest
    const double before = processor_seconds(server.program().process());
    std::this_thread::sleep_for(std::chrono::seconds(1));
    EXPECT_LT(processor_seconds(server.program().process()) - before, 0.2);  // a share of that second that no loop without a wait keeps to
}

TEST_F(Safety, TheProgramEndsWhoeverIsThere) {
    Server server({primitives});
    Client stays(server);
    {
        Client leaves(server);
        leaves.vanish();
    }
    stays.send({{"export", {{"format", "png"}, {"width", 4000}, {"height", 4000}, {"level", "indirect"}}}});
    stays.wait_for("exporting");
    server.program().send(SIGTERM);
    EXPECT_EQ(stays.wait_for("closed")["closed"]["reason"], "the program ends");
    EXPECT_EQ(server.program().finish().code, 0);
    for (const auto& entry : fs::directory_iterator(temporary)) ADD_FAILURE() << "left behind: " << entry.path();
}

TEST_F(Safety, WhatCannotBeServedIsTold) {
    EXPECT_EQ(crescente({"view", "--no-browser", path("none.json")}).code, 2);
    EXPECT_EQ(crescente({"view", "--no-browser", folder.string()}).code, 2);
    EXPECT_EQ(crescente({"view", "--no-browser", "--folder", path("none")}).code, 2);
    EXPECT_EQ(crescente({"view", "--no-browser", "--listen", "nowhere"}).code, 2);
    Server server({});
    const std::string port = server.host().substr(server.host().rfind(':') + 1);
    const Outcome taken = crescente({"view", "--no-browser", "--port", port});
    EXPECT_EQ(taken.code, 2);
    EXPECT_TRUE(contains(taken.err, "cannot listen"));
    Server broken({write("broken.json", "{")});
    Client client(broken);
    EXPECT_EQ(client.wait_for("error")["error"]["kind"], "input");
    Client again(broken, client.session());  // a page that comes later hears of it too
    EXPECT_EQ(again.wait_for("error")["error"]["kind"], "input");
    EXPECT_TRUE(again.request({{"open", "example/primitives.json"}}).contains("opened"));
}

}  // namespace
}  // namespace crescente::test
