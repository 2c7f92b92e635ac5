// Readers who fly through one case at once, each by a connection of its own to a real server: how
// many pictures each gets, and what of the GPU. Needs HAUSTRA_BIN, the folder of the programs.
#include "core/raycasters.h"
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"
#include "stopwatch.h"

#include <algorithm>
#include <cstdio>
#include <map>
#include <thread>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::tests {
namespace {

using bench::median, bench::milliseconds;

struct Reader {
    int width = 512, height = 512;
    bool coarse = false;
};

struct Flown {
    int pictures = 0;
    double gpuMs = 0.0;  // of those pictures
    std::vector<double> latencyMs;
    std::map<int, int> widths;
    std::uint8_t raycaster = 0;
    double restMs = 0.0;  // from the last moving picture to the exact one
};

// Each camera is sent when the picture of the one before has come.
Flown fly(std::uint16_t port, const std::string& caseName, const Reader& reader, int start,
          double warmUpSeconds, double seconds) {
    TestClient client(port);
    std::vector<std::string> capabilities{"jpeg", "lossless"};
    if (reader.coarse) capabilities.push_back("coarse");
    client.hello(protocol::protocolVersion, capabilities);
    const auto opened = client.openCase(caseName);
    if (!opened || !opened->has_case_opened())
        throw std::runtime_error("the case cannot be opened");
    const auto& path = opened->case_opened().centerline();
    const int samples = path.size() / 5;
    if (samples < 50) throw std::runtime_error("the case has no centerline");
    client.viewport(1, 0, protocol::ENDOSCOPIC, reader.width, reader.height);

    Flown flown;
    const double begun = milliseconds();
    const auto flownFor = [&] { return 1e-3 * (milliseconds() - begun); };
    const int ahead = 20;
    double sample = start % (samples - ahead - 1);
    for (std::uint64_t sequence = 2; flownFor() < warmUpSeconds + seconds; ++sequence) {
        sample += 1.0;
        if (sample >= samples - ahead - 1) sample = 0.0;
        const auto at = [&](int n) {
            return TestClient::Vector{path[5 * n], path[5 * n + 1], path[5 * n + 2]};
        };
        const auto here = at(int(sample)), there = at(int(sample) + ahead);
        const double asked = milliseconds();
        client.camera(sequence, 0, here, true,
                      {there[0] - here[0], there[1] - here[1], there[2] - here[2]});
        std::optional<TestPicture> picture;
        do
            picture = client.picture();
        while (picture && picture->header.sequence < sequence);
        if (!picture) throw std::runtime_error("the server is silent");
        if (flownFor() < warmUpSeconds) continue;
        ++flown.pictures;
        flown.gpuMs += 1e-3 * picture->header.renderMicroseconds;
        flown.latencyMs.push_back(milliseconds() - asked);
        ++flown.widths[picture->header.pictureWidth];
        flown.raycaster = picture->header.raycaster;
    }
    const double rested = milliseconds();
    while (const auto picture = client.picture())
        if (picture->header.exact) break;
    flown.restMs = milliseconds() - rested;
    return flown;
}

void run(const char* title, std::uint16_t port, const std::string& caseName,
         const std::vector<Reader>& readers, double seconds) {
    std::vector<Flown> flown(readers.size());
    std::vector<std::thread> threads;
    for (std::size_t n = 0; n < readers.size(); ++n)
        threads.emplace_back([&, n] {
            // One behind the other, so that all see the same places.
            flown[n] = fly(port, caseName, readers[n], 200 + 5 * int(n), 3.0, seconds);
        });
    for (std::thread& thread : threads)
        thread.join();
    double all = 0.0, used = 0.0;
    for (const Flown& one : flown) {
        all += one.pictures;
        used += one.gpuMs;
    }
    const double mean = all / double(flown.size());
    fmt::print("{}\n", title);
    for (std::size_t n = 0; n < flown.size(); ++n) {
        const Flown& one = flown[n];
        std::string widths;
        for (const auto& [width, count] : one.widths)
            widths += fmt::format(" {} px {:.0f} %", width, 100.0 * count / one.pictures);
        fmt::print(
            "  reader {} at {}x{}: {:5.1f} pictures/s ({:+.0f} % of the mean), GPU {:4.1f} %, "
            "{:.1f} ms a picture, latency {:.0f} ms, still after {:.0f} ms;{}\n",
            n + 1, readers[n].width, readers[n].height, one.pictures / seconds,
            100.0 * (one.pictures / mean - 1.0), 0.1 * one.gpuMs / seconds,
            one.gpuMs / std::max(one.pictures, 1), median(one.latencyMs), one.restMs, widths);
    }
    fmt::print("  together {:.1f} pictures/s, GPU {:.0f} %, by the {} raycaster\n\n", all / seconds,
               0.1 * used / seconds, raycasterName(flown.front().raycaster));
    std::fflush(stdout);
}

int benchmark(int argc, char** argv) {
    std::string store, caseName, raycaster = "auto";
    double seconds = 20.0;
    int side = 512;
    CLI::App program("Readers who fly through one case at once: rates, shares, latencies.");
    program.add_option("store", store)->required();
    program.add_option("case", caseName)->required();
    program.add_option("--seconds", seconds)->capture_default_str();
    program.add_option("--side", side, "Of the pictures, pixels")->capture_default_str();
    program.add_option("--raycaster", raycaster)->capture_default_str();
    CLI11_PARSE(program, argc, argv);

    ServerProcess server(store, {"--raycaster", raycaster});
    const Reader usual{side, side}, coarse{side, side, true};
    // Ten times the pixels, as near as the protocol's bound lets it.
    const Reader costly{std::min(2048, side * 4), std::min(2048, side * 5 / 2)};
    run("one reader", server.port(), caseName, {usual}, seconds);
    run("one reader, coarse where it would be late", server.port(), caseName, {coarse}, seconds);
    run("eight readers", server.port(), caseName, std::vector<Reader>(8, usual), seconds);
    std::vector<Reader> mixed(8, usual);
    mixed[3] = costly;
    run("eight readers, one of them with ten times the pixels", server.port(), caseName, mixed,
        seconds);
    run("eight readers, coarse where they would be late", server.port(), caseName,
        std::vector<Reader>(8, coarse), seconds);
    std::fputs(server.log().c_str(), stdout);
    return 0;
}

}  // namespace
}  // namespace haustra::tests

int main(int argc, char** argv) {
    try {
        return haustra::tests::benchmark(argc, argv);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "fair_bench: %s\n", error.what());
        return 1;
    }
}
