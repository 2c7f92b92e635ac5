// Runs one of the project's programs as a user does, and looks at what comes out.
#pragma once

#include "temporary_folder.h"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

namespace haustra::tests {

struct Outcome {
    int exitCode = -1;  ///< −1 where a signal ended it
    int signal = 0;     ///< that signal
    std::string out, err;
};

inline std::string fileContent(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::filesystem::path programPath(const std::string& program) {
    const char* bin = std::getenv("HAUSTRA_BIN");
    return std::filesystem::path(bin ? bin : ".") / program;
}

/// Runs a program to its end; `meanwhile` is called with its process once it has started.
inline Outcome runProgram(const std::string& program, const std::vector<std::string>& arguments,
                          const std::function<void(pid_t)>& meanwhile) {
    const TemporaryFolder folder;
    const std::string outFile = folder.path() / "out", errFile = folder.path() / "err";
    const std::string path = programPath(program);
    std::vector<char*> argv{const_cast<char*>(path.c_str())};
    for (const std::string& argument : arguments)
        argv.push_back(const_cast<char*>(argument.c_str()));
    argv.push_back(nullptr);

    const pid_t child = ::fork();
    if (child == 0) {
        ::dup2(::open(outFile.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        ::dup2(::open(errFile.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        ::execv(path.c_str(), argv.data());
        ::_exit(127);
    }
    meanwhile(child);
    int status = 0;
    ::waitpid(child, &status, 0);
    return {WIFEXITED(status) ? WEXITSTATUS(status) : -1,
            WIFSIGNALED(status) ? WTERMSIG(status) : 0, fileContent(outFile), fileContent(errFile)};
}

/// Runs a program to its end, or kills it (SIGKILL) after `killAfter`.
inline Outcome runProgram(const std::string& program, const std::vector<std::string>& arguments,
                          std::optional<std::chrono::microseconds> killAfter = std::nullopt) {
    return runProgram(program, arguments, [&](pid_t child) {
        if (!killAfter) return;
        std::this_thread::sleep_for(*killAfter);
        ::kill(child, SIGKILL);
    });
}

inline std::size_t lineCount(const std::string& text) {
    return std::size_t(std::count(text.begin(), text.end(), '\n'));
}

/// The small phantom that CTest makes before the tests that ask for it (FIXTURES phantom).
inline std::filesystem::path phantomFolder() {
    const char* set = std::getenv("HAUSTRA_PHANTOM");
    return set ? set : "";
}

}  // namespace haustra::tests
