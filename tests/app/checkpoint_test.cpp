// Renders that are stopped, killed and gone on with.
#include <nlohmann/json.hpp>

#include "app/program.h"

namespace crescente::test {
namespace {

using Json = nlohmann::json;

const std::string balls = (scenes / "balls4.nff").string();

class Checkpoint : public ProgramTest {
protected:
    std::vector<std::string> arguments(const std::string& picture, std::vector<std::string> more) const {
        std::vector<std::string> all{"render", balls, "-o", path(picture), "--size", "160x120", "--tonemap", "srgb", "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome render(const std::string& picture, std::vector<std::string> more, Running::Limits limits = {}) const {
        return crescente(arguments(picture, std::move(more)), limits);
    }
    // The picture's rows as they are packed in the file; what stands around them names the command.
    std::string pixels(const std::string& picture) const {
        const std::string bytes = read(path(picture));
        const std::size_t at = bytes.find("IDAT");
        return at == std::string::npos ? "no picture: " + picture : bytes.substr(at);
    }
    Json stats(const std::string& file) const { return Json::parse(read(path(file))); }

    // A render of hours, killed as soon as it has left its first checkpoint.
    void kill_a_render() const {
        Running running(command(arguments("never.png", {"--accel", "linear", "--threads", "1", "--checkpoint", path("c"), "--checkpoint-every", "0s"})), {});
        while (!fs::exists(path("c"))) usleep(1000);
        running.send(SIGKILL);
        ASSERT_EQ(running.finish().code, 128 + SIGKILL);
        ASSERT_FALSE(fs::exists(path("never.png")));
    }
};

TEST_F(Checkpoint, AKilledRenderEndsInThePictureOfAnUninterruptedOne) {
    ASSERT_EQ(render("whole.png", {"--stats", path("whole.json")}).code, 0);
    kill_a_render();
    const int nameless = open(folder.c_str(), O_WRONLY | O_TMPFILE, 0600);
    if (nameless >= 0) {
        EXPECT_EQ(files(), (std::vector<std::string>{"c", "whole.json", "whole.png"})) << "half a checkpoint is left behind";
        close(nameless);
    }
    const Outcome outcome = render("resumed.png", {"--checkpoint", path("c"), "--resume", "--stats", path("resumed.json")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(pixels("resumed.png"), pixels("whole.png"));
    const Json whole = stats("whole.json"), resumed = stats("resumed.json");
    EXPECT_EQ(resumed["rays"], whole["rays"]);
    EXPECT_EQ(resumed["checkpoint"]["resumed"], true);
    EXPECT_GT(resumed["checkpoint"]["rays_before"]["total"], 0);
    EXPECT_LT(resumed["checkpoint"]["rays_before"]["total"], whole["rays"]["total"]);
    EXPECT_FALSE(whole.contains("checkpoint"));
    // And the finished one is there to be gone on with.
    ASSERT_EQ(render("again.png", {"--checkpoint", path("c"), "--resume", "--stats", path("again.json")}).code, 0);
    EXPECT_EQ(pixels("again.png"), pixels("whole.png"));
    EXPECT_EQ(stats("again.json")["checkpoint"]["rays_before"], whole["rays"]);
}

TEST_F(Checkpoint, AStoppedRenderIsSavedBeforeItEnds) {
    ASSERT_EQ(render("whole.png", {}).code, 0);
    ASSERT_EQ(render("first.png", {"--time", "0s", "--checkpoint", path("c")}).code, 0);
    EXPECT_NE(pixels("first.png"), pixels("whole.png"));
    ASSERT_EQ(render("resumed.png", {"--checkpoint", path("c"), "--resume"}).code, 0);
    EXPECT_EQ(pixels("resumed.png"), pixels("whole.png"));

    Running running(command({"render", balls, "-o", path("stopped.png"), "--size", "4000x3000", "--threads", "1", "--checkpoint", path("d")}), {});
    ASSERT_TRUE(running.wait_for_error_text("rendering"));
    running.send(SIGTERM);
    const Outcome stopped = running.finish();
    EXPECT_EQ(stopped.code, 0);
    EXPECT_TRUE(contains(stopped.err, "--resume goes on from " + path("d")));
    EXPECT_TRUE(fs::exists(path("d")));
    EXPECT_TRUE(fs::exists(path("stopped.png")));
}

TEST_F(Checkpoint, NothingThatIsThereIsLostUnasked) {
    ASSERT_EQ(render("a.png", {"--level", "0", "--checkpoint", path("c")}).code, 0);
    const std::string kept = read(path("c"));
    Outcome outcome = render("b.png", {"--level", "0", "--checkpoint", path("c")});
    EXPECT_EQ(outcome.code, 4);
    EXPECT_TRUE(contains(outcome.err, "c: there is a checkpoint already (--resume goes on from it, --fresh begins afresh and replaces it)"));
    outcome = render("b.png", {"--checkpoint", write("notes.txt", "what was here before"), "--resume", "--fresh"});
    EXPECT_EQ(outcome.code, 4);
    EXPECT_TRUE(contains(outcome.err, "notes.txt: is there already and no checkpoint: it is not overwritten"));
    EXPECT_EQ(read(path("notes.txt")), "what was here before");
    EXPECT_EQ(read(path("c")), kept);
    EXPECT_FALSE(fs::exists(path("b.png")));
    EXPECT_EQ(render("b.png", {"--level", "0", "--checkpoint", path("c"), "--fresh"}).code, 0);
}

TEST_F(Checkpoint, WhatDoesNotFitIsRefusedOrBegunAfreshIfToldSo) {
    Outcome outcome = render("a.png", {"--checkpoint", path("c"), "--resume"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "c: there is no such checkpoint (--resume --fresh begins afresh where there is none)"));
    ASSERT_EQ(render("whole.png", {"--checkpoint", path("c"), "--resume", "--fresh"}).code, 0);

    outcome = render("a.png", {"--checkpoint", path("c"), "--resume", "--camera", "front"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "is of another scene: it differs in camera"));

    const std::string sound = read(path("c"));
    std::string damaged = sound;
    damaged[17] = 9;  // the version, which the head is refused by before the model is read
    write("c", damaged);
    outcome = render("a.png", {"--checkpoint", path("c"), "--resume"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "is a checkpoint of version 9, this program reads version"));
    EXPECT_TRUE(contains(outcome.err, "(--resume --fresh begins afresh and replaces it)"));
    damaged = sound;
    damaged[damaged.size() / 2] ^= 4;
    write("c", damaged);
    outcome = render("a.png", {"--checkpoint", path("c"), "--resume"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "is damaged: the checksum does not fit (--resume --fresh begins afresh and replaces it)"));
    EXPECT_EQ(read(path("c")), damaged);
    EXPECT_FALSE(fs::exists(path("a.png")));
    outcome = render("a.png", {"--checkpoint", path("c"), "--resume", "--fresh"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_TRUE(contains(outcome.err, "warning: ")) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "begins afresh"));
    EXPECT_EQ(pixels("a.png"), pixels("whole.png"));
    EXPECT_EQ(render("a.png", {"--checkpoint", path("c"), "--resume"}).code, 0);
}

// A full disk, played by a limit on the size of files: told, the picture is made all the same, the old checkpoint stays.
TEST_F(Checkpoint, AFullDiskDoesNotEndTheRender) {
    ASSERT_EQ(render("whole.png", {}).code, 0);
    ASSERT_EQ(render("first.png", {"--size", "16x16", "--level", "0", "--checkpoint", path("c")}).code, 0);
    const std::string old = read(path("c"));
    ASSERT_LT(old.size(), 100'000u);
    const Outcome outcome = render("a.png", {"--checkpoint", path("c"), "--fresh", "--checkpoint-every", "0s"}, {.file_size = 100'000});
    EXPECT_EQ(outcome.code, 4);
    EXPECT_TRUE(contains(outcome.err, "c: cannot be written: File too large"));
    EXPECT_EQ(pixels("a.png"), pixels("whole.png"));
    EXPECT_EQ(read(path("c")), old);
    EXPECT_EQ(files(), (std::vector<std::string>{"a.png", "c", "first.png", "whole.png"}));
}

// One tile of a million pixels: there is memory for its trees, but not for their bytes besides.
TEST_F(Checkpoint, TooLittleMemoryDoesNotEndTheRender) {
    const std::vector<std::string> large{"--size", "1200x1200", "--level", "0", "--threads", "1", "--set", "settings.order=even", "--set", "settings.tile=4096"};
    const auto with = [&](std::vector<std::string> more) {
        more.insert(more.begin(), large.begin(), large.end());
        return more;
    };
    ASSERT_EQ(render("whole.png", large).code, 0);
    ASSERT_EQ(render("first.png", {"--size", "16x16", "--level", "0", "--checkpoint", path("c")}).code, 0);
    const std::string old = read(path("c"));
    const Outcome outcome = render("a.png", with({"--checkpoint", path("c"), "--fresh"}), {.memory = rlim_t{600} << 20});
    EXPECT_EQ(outcome.code, 6);
    EXPECT_TRUE(contains(outcome.err, "c: cannot be written: not enough memory"));
    EXPECT_EQ(pixels("a.png"), pixels("whole.png"));
    EXPECT_EQ(read(path("c")), old);
}

// --- Scripts of edits

const std::string primitives = (scenes / "primitives.json").string();

class ScriptCheckpoint : public Checkpoint {
protected:
    std::vector<std::string> script_arguments(const std::string& script, std::vector<std::string> more) const {
        std::vector<std::string> all{"edit", primitives, write("script.jsonl", script), "--size", "96x64", "--quiet"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Outcome play(const std::string& script, std::vector<std::string> more) const { return crescente(script_arguments(script, std::move(more))); }
};

const std::string first_lines = R"({"set": {"settings.contrast": 0.05}}
{"add": {"name": "extra", "shape": {"sphere": {"radius": 0.4}}, "transform": {"translate": [0, 1, 0]}}}
{"move": {"object": "extra", "by": {"translate": [0.3, 0, 0]}}}
{"move": {"object": "extra", "by": {"translate": [0, 0.5, 0]}}}
)";
const std::string last_lines = R"({"undo": 1}
{"set": {"camera.field_of_view": 35}}
{"undo": 1}
{"redo": 1}
)";

TEST_F(ScriptCheckpoint, AFailedScriptIsMendedAndGoesOn) {
    ASSERT_EQ(play(first_lines + last_lines, {"-o", path("whole.png")}).code, 0);
    Outcome outcome = play(first_lines + "{\"hide\": \"nobody\"}\n" + last_lines, {"-o", path("a.png"), "--checkpoint", path("c")});
    EXPECT_EQ(outcome.code, 3);
    outcome = play(first_lines + last_lines, {"-o", path("a.png"), "--checkpoint", path("c"), "--resume", "--check", "--json", path("report.json")});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(pixels("a.png"), pixels("whole.png"));
    const Json report = Json::parse(read(path("report.json")));
    EXPECT_EQ(report["checkpoint"]["played_before"], 4);
    EXPECT_EQ(report["checkpoint"]["saved"], 1);
    EXPECT_EQ(report["edits"].size(), 4u);
    EXPECT_GT(report["fresh"]["rays"]["total"], 0);
    EXPECT_LT(report["fresh"]["rays"]["total"], report["checkpoint"]["rays_before"]["total"]);

    outcome = play(last_lines + first_lines, {"--checkpoint", path("c"), "--resume"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "c: is of another script: the lines of " + path("script.jsonl") + " up to 8 are not those that had been played"));
    outcome = play(first_lines + last_lines, {"--checkpoint", path("c"), "--resume", "--set", "camera.pixel_aspect=1.5"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_TRUE(contains(outcome.err, "is of another scene: it differs in camera")) << outcome.err;
    outcome = play(first_lines + last_lines, {"--checkpoint", path("c"), "--resume", "--fresh", "--set", "camera.pixel_aspect=1.5", "--check"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "begins afresh"));
}

TEST_F(ScriptCheckpoint, AKilledScriptEndsInThePictureOfAnUninterruptedOne) {
    std::string script = first_lines;
    for (int i = 0; i < 40; ++i) script += "{\"move\": {\"object\": \"extra\", \"by\": {\"translate\": [" + std::to_string(0.01 * i) + ", 0, 0.01]}}}\n";
    script += last_lines;
    ASSERT_EQ(play(script, {"-o", path("whole.png")}).code, 0);
    Running running(command(script_arguments(script, {"--checkpoint", path("c"), "--checkpoint-every", "0s", "--threads", "1"})), {});
    const auto begun = [&] { return fs::exists(path("c")) && read(path("c")).find("\"fresh\"") != std::string::npos; };
    while (!begun()) usleep(1000);
    running.send(SIGKILL);
    ASSERT_EQ(running.finish().code, 128 + SIGKILL);
    const Outcome outcome = play(script, {"-o", path("a.png"), "--checkpoint", path("c"), "--resume", "--check"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(pixels("a.png"), pixels("whole.png"));
}

TEST_F(Checkpoint, OptionsThatNeedAFileSaySo) {
    const Outcome outcome = render("a.png", {"--resume", "--fresh", "--checkpoint-every", "soon"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(count(outcome.err, "name its file by --checkpoint"), 3u) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "soon"));
    EXPECT_EQ(render("a.png", {"--checkpoint", path("no/folder/c")}).code, 4);
}

}  // namespace
}  // namespace crescente::test
