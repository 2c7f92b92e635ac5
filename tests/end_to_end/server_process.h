// A small store, and the real haustra-server on it.
#pragma once

#include "core/centerline.h"
#include "core/ct_scan.h"
#include "core/tissue.h"
#include "end_to_end/run_program.h"

#include <gtest/gtest.h>

namespace haustra::tests {

inline constexpr char smallCaseName[] = "tube";

/// An air-filled, folded tube along z in soft tissue, with a pool of tagged fluid.
struct SmallCase {
    Volume<std::int16_t> ct, cleansed;
    Volume<TissueFractions> mixture;
    Centerline centerline;
};

SmallCase makeSmallCase();

/// Publishes the small case, and another with a scan alone, called "scan".
void makeSmallStore(const std::filesystem::path& folder);

/// haustra-server on a free port of the loopback. Ended with the object.
class ServerProcess {
public:
    explicit ServerProcess(const std::filesystem::path& store,
                           std::vector<std::string> arguments = {});
    ~ServerProcess() { kill(); }
    ServerProcess(const ServerProcess&) = delete;
    ServerProcess& operator=(const ServerProcess&) = delete;

    std::uint16_t port() const { return port_; }
    std::string log() const { return fileContent(folder_.path() / "log"); }
    std::string output() const { return fileContent(folder_.path() / "out"); }
    pid_t pid() const { return child_; }
    bool running() const { return child_ > 0 && ::waitpid(child_, nullptr, WNOHANG) == 0; }

    void kill();
    /// SIGTERM; its exit code, −1 where a signal ended it.
    int terminate();

private:
    TemporaryFolder folder_;
    pid_t child_ = 0;
    std::uint16_t port_ = 0;
};

}  // namespace haustra::tests
