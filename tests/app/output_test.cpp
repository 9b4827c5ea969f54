// Output that cannot be written is found out before rendering where that is possible, and never costs what was there.
#include "app/program.h"

namespace crescente::test {
namespace {

constexpr int usage = 2, output = 4;
const std::string balls = (scenes / "balls4.nff").string();

class Output : public ProgramTest {
protected:
    // The render must fail with the code and before any work.
    void refused(const std::vector<std::string>& files_asked, int code, const std::string& reason) {
        std::vector<std::string> arguments{"render", balls, "--size", "16x16"};
        arguments.insert(arguments.end(), files_asked.begin(), files_asked.end());
        const Outcome outcome = crescente(arguments);
        EXPECT_EQ(outcome.code, code) << outcome.err;
        EXPECT_TRUE(contains(outcome.err, reason));
        EXPECT_EQ(count(outcome.err, "rendering"), 0u) << outcome.err;
    }
};

TEST_F(Output, FolderThatDoesNotExist) {
    refused({"-o", path("none/a.png")}, output, "none");
    EXPECT_TRUE(files().empty());
}

TEST_F(Output, FolderInThePlaceOfTheFile) {
    fs::create_directory(path("a.png"));
    refused({"-o", path("a.png")}, output, "a.png");
}

TEST_F(Output, UnknownExtension) { refused({"-o", path("a.pgn")}, usage, "did you mean '.png'?"); }

TEST_F(Output, EveryOutputIsChecked) {
    const Outcome outcome = crescente({"render", balls, "--size", "16x16", "-o", path("none/a.png"), "-o", path("good.png"), "-o",
                                       path("nowhere/b.png"), "--stats", path("nix/s.json")});
    EXPECT_EQ(outcome.code, output);
    EXPECT_EQ(count(outcome.err, "error: "), 3u) << outcome.err;
    EXPECT_TRUE(files().empty());
}

TEST_F(Output, FolderWithoutPermission) {
    if (geteuid() == 0) GTEST_SKIP() << "the superuser may write everywhere";
    fs::create_directory(path("closed"));
    fs::permissions(path("closed"), fs::perms::owner_read | fs::perms::owner_exec);
    refused({"-o", path("closed/a.png")}, output, "closed");
}

TEST_F(Output, DevicesAreNotReplaced) {
    refused({"-o", path("a.png"), "--stats", "/dev/null"}, output, "/dev/null");
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

// A limit on file sizes fails a write as a full disk does.
TEST_F(Output, WriteThatFailsLeavesTheOldFile) {
    write("a.png", "what was here before");
    const Outcome outcome = crescente({"render", balls, "-o", path("a.png"), "--size", "64x64"}, {.file_size = 500});
    EXPECT_EQ(outcome.code, output) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "a.png"));
    EXPECT_EQ(read(path("a.png")), "what was here before");
    EXPECT_EQ(files(), std::vector<std::string>{"a.png"});
}

TEST_F(Output, FullDiskLeavesTheOldFile) {
    fs::create_directory(path("disk"));
    const std::string script = "mount -t tmpfs -o size=16k tmpfs '" + path("disk") + "' || exit 77\n"
                               "printf old > '" + path("disk/a.png") + "'\n"
                               "'" CRESCENTE_PROGRAM "' render '" + balls + "' -o '" + path("disk/a.png") + "' --size 200x200 -q\n"
                               "code=$?\n"
                               "cat '" + path("disk/a.png") + "'; ls '" + path("disk") + "' | wc -l\n"
                               "exit $code";
    const Outcome outcome = Running({"unshare", "--map-root-user", "--mount", "sh", "-c", script}, {}).finish();
    if (outcome.code == 77 || outcome.code == 127 || outcome.err.find("unshare") != std::string::npos) {
        GTEST_SKIP() << "no file system can be mounted here: " << outcome.err;
    }
    EXPECT_EQ(outcome.code, output) << outcome.err;
    EXPECT_TRUE(contains(outcome.err, "No space left on device"));
    EXPECT_EQ(outcome.out, "old1\n");
}

}  // namespace
}  // namespace crescente::test
