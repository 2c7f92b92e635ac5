#include "end_to_end/server_process.h"

#include "store/case_store.h"

#include <cmath>
#include <stdexcept>

namespace haustra::tests {

SmallCase makeSmallCase() {
    const Grid grid = axisAlignedGrid({48, 44, 56}, {0.8, 0.8, 1.1}, {-20.0, -15.0, 100.0});
    SmallCase made{
        Volume<std::int16_t>(grid), Volume<std::int16_t>(grid), Volume<TissueFractions>(grid), {}};
    for (std::size_t n = 0; n < grid.voxelCount(); ++n) {
        const glm::ivec3 v = grid.voxelAt(n);
        const glm::dvec2 fromAxis(v.x - 23.5, v.y - 21.5);
        const double radius = 14.0 + 2.0 * std::sin(0.5 * v.z);
        const bool inside = glm::length(fromAxis) < radius && v.z > 4 && v.z < 52;
        const bool tagged = inside && fromAxis.y > 8.0;
        made.ct.writable()[n] = std::int16_t(tagged ? 400 : inside ? -1000 : 40 + (v.x + v.y) % 7);
        made.cleansed.writable()[n] = inside ? std::int16_t(-1000) : made.ct[n];
        // The row of voxels above the level counts as its interface.
        const bool level = inside && !tagged && fromAxis.y > 7.0;
        made.mixture.writable()[n] = level    ? TissueFractions{128, 127}
                                     : tagged ? TissueFractions{0, 255}
                                     : inside ? TissueFractions{255, 0}
                                              : TissueFractions{0, 0};
    }
    for (int k = 6; k <= 50; ++k) {
        const glm::dvec3 p = grid.patientFromVoxelPoint({23.5, 21.5, double(k)});
        made.centerline.points.push_back({p, 1.1 * (k - 6), 11.0, k > 30 && k < 33});
    }
    return made;
}

void makeSmallStore(const std::filesystem::path& folder) {
    const auto orThrow = [](auto result) {
        if (!result) throw std::runtime_error(describe(result.error()));
        if constexpr (!std::is_void_v<typename decltype(result)::value_type>)
            return std::move(*result);
    };
    const SmallCase made = makeSmallCase();
    const auto store = orThrow(store::CaseStore::open(folder, true));
    const auto key = [](const char* stage) { return store::makeKey(stage, 1, "", {}); };
    auto whole = orThrow(store.createCase(smallCaseName));
    orThrow(whole.publishVolume("ct", key("ct"), made.ct, {{"position", "supine"}}));
    orThrow(whole.publishVolume("mixture", key("mixture"), made.mixture));
    orThrow(whole.publishVolume("cleansed", key("cleansed"), made.cleansed));
    orThrow(whole.publishCenterline("centerline", key("centerline"), made.centerline));
    auto bare = orThrow(store.createCase("scan"));
    orThrow(bare.publishVolume("ct", key("another scan"), made.ct));
}

ServerProcess::ServerProcess(const std::filesystem::path& store,
                             std::vector<std::string> arguments) {
    const std::string portFile = folder_.path() / "port", logFile = folder_.path() / "log";
    const std::string outFile = folder_.path() / "out", path = programPath("haustra-server");
    arguments.insert(arguments.begin(),
                     {path, "--store", store, "--listen", "127.0.0.1:0", "--port-file", portFile});
    std::vector<char*> argv;
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    child_ = ::fork();
    if (child_ == 0) {
        ::dup2(::open(outFile.c_str(), O_WRONLY | O_CREAT, 0600), STDOUT_FILENO);
        ::dup2(::open(logFile.c_str(), O_WRONLY | O_CREAT, 0600), STDERR_FILENO);
        ::execv(path.c_str(), argv.data());
        ::_exit(127);
    }
    for (int n = 0; n < 6000 && port_ == 0; ++n) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        std::ifstream(portFile) >> port_;
        if (::waitpid(child_, nullptr, WNOHANG) != 0) {
            child_ = 0;
            break;
        }
    }
    if (port_ == 0) throw std::runtime_error("haustra-server did not start: " + log());
}

void ServerProcess::kill() {
    if (child_ <= 0) return;
    ::kill(child_, SIGKILL);
    ::waitpid(std::exchange(child_, 0), nullptr, 0);
}
int ServerProcess::terminate() {
    ::kill(child_, SIGTERM);
    int status = 0;
    ::waitpid(std::exchange(child_, 0), &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

}  // namespace haustra::tests
