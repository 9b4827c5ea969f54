// Runs the real program as a user would and keeps what it says.
#pragma once

#include <fcntl.h>
#include <poll.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace crescente::test {

namespace fs = std::filesystem;

inline const fs::path scenes = fs::path(CRESCENTE_ROOT) / "scenes";

struct Outcome {
    int code = -1;  // 128 + number where a signal ended it, as shells have it
    std::string out, err;
};

// A program that is running. Its standard input is empty.
class Running {
public:
    struct Limits {
        rlim_t file_size = RLIM_INFINITY;  // bytes that a written file may have
        rlim_t memory = RLIM_INFINITY;     // bytes of address space
    };

    explicit Running(std::vector<std::string> command, Limits limits) {
        std::vector<char*> arguments;
        for (auto& word : command) arguments.push_back(word.data());
        arguments.push_back(nullptr);
        std::array<std::array<int, 2>, 2> pipes{};
        for (auto& pipe : pipes) EXPECT_EQ(::pipe2(pipe.data(), O_CLOEXEC), 0);
        process_ = fork();
        if (process_ == 0) {
            dup2(open("/dev/null", O_RDONLY), STDIN_FILENO);
            dup2(pipes[0][1], STDOUT_FILENO);
            dup2(pipes[1][1], STDERR_FILENO);
            signal(SIGINT, SIG_DFL);  // a test run in the background inherits "ignored"
            limit(RLIMIT_FSIZE, limits.file_size);
            limit(RLIMIT_AS, limits.memory);
            execvp(arguments[0], arguments.data());
            _exit(127);
        }
        for (std::size_t i = 0; i < 2; ++i) {
            close(pipes[i][1]);
            streams_[i] = pipes[i][0];
        }
    }
    ~Running() {
        if (process_ > 0) {
            kill(process_, SIGKILL);
            waitpid(process_, nullptr, 0);
        }
        for (const int stream : streams_) {
            if (stream >= 0) close(stream);
        }
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;

    void send(int signal) { kill(process_, signal); }

    // Reads on until stderr has the text; false if the program ended without it.
    bool wait_for_error_text(const std::string& text) {
        while (outcome_.err.find(text) == std::string::npos) {
            if (!read_some()) return false;
        }
        return true;
    }

    // The first line of standard output, without its end; what came so far if the program ended without one.
    std::string first_line() {
        while (outcome_.out.find('\n') == std::string::npos && read_some()) {
        }
        return outcome_.out.substr(0, outcome_.out.find('\n'));
    }

    pid_t process() const { return process_; }

    Outcome finish() {
        while (read_some()) {
        }
        int status = 0;
        waitpid(process_, &status, 0);
        process_ = -1;
        outcome_.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return outcome_;
    }

private:
    static void limit(int resource, rlim_t most) {
        if (most == RLIM_INFINITY) return;
        const rlimit value{most, most};
        setrlimit(static_cast<__rlimit_resource>(resource), &value);
    }

    bool read_some() {
        std::array<pollfd, 2> waits{pollfd{streams_[0], POLLIN, 0}, pollfd{streams_[1], POLLIN, 0}};
        if (streams_[0] < 0 && streams_[1] < 0) return false;
        poll(waits.data(), waits.size(), -1);
        for (std::size_t i = 0; i < 2; ++i) {
            if (streams_[i] < 0 || waits[i].revents == 0) continue;
            char block[4096];
            const ssize_t got = read(streams_[i], block, sizeof block);
            if (got > 0) {
                (i == 0 ? outcome_.out : outcome_.err).append(block, static_cast<std::size_t>(got));
            } else {
                close(streams_[i]);
                streams_[i] = -1;
            }
        }
        return true;
    }

    pid_t process_ = -1;
    std::array<int, 2> streams_{-1, -1};
    Outcome outcome_;
};

inline std::vector<std::string> command(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), CRESCENTE_PROGRAM);
    return arguments;
}

inline Outcome crescente(std::vector<std::string> arguments, Running::Limits limits = {}) {
    return Running(command(std::move(arguments)), limits).finish();
}

inline std::string read(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    return content.str();
}

// A folder of its own for each test, removed afterwards.
class ProgramTest : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder = fs::temp_directory_path() / ("crescente-" + std::to_string(getpid()) + "-" + info->name());
        fs::create_directories(folder);
    }
    void TearDown() override { fs::remove_all(folder); }

    std::string path(const std::string& name) const { return (folder / name).string(); }
    std::string write(const std::string& name, const std::string& content) const {
        std::ofstream(folder / name, std::ios::binary) << content;
        return path(name);
    }
    // What is in the folder, sorted: to see that nothing was left behind.
    std::vector<std::string> files() const {
        std::vector<std::string> names;
        for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
        std::sort(names.begin(), names.end());
        return names;
    }

    fs::path folder;
};

inline testing::AssertionResult contains(const std::string& text, const std::string& part) {
    if (text.find(part) != std::string::npos) return testing::AssertionSuccess();
    return testing::AssertionFailure() << "'" << part << "' is not in:\n" << text;
}

inline std::size_t count(const std::string& text, const std::string& part) {
    std::size_t found = 0;
    for (std::size_t at = text.find(part); at != std::string::npos; at = text.find(part, at + part.size())) ++found;
    return found;
}

}  // namespace crescente::test
