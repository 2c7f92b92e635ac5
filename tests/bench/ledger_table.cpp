// What the ledger of seen wall costs: flights through a case, each camera sent when the picture of
// the one before has come, by a client that tells what it has had on screen and by one that does
// not, in turns. Needs HAUSTRA_BIN, the folder of the programs.
#include "core/raycasters.h"
#include "end_to_end/server_process.h"
#include "end_to_end/server_test_client.h"
#include "stopwatch.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::tests {
namespace {

using bench::median, bench::milliseconds;

/// CPU time of all threads of a process so far, ms.
double cpuMs(pid_t process) {
    double sum = 0.0;
    for (const auto& task :
         std::filesystem::directory_iterator("/proc/" + std::to_string(process) + "/task")) {
        std::ifstream in(task.path() / "schedstat");
        double ns = 0.0;
        if (in >> ns) sum += 1e-6 * ns;
    }
    return sum;
}

struct Flown {
    double cpuMs = 0.0, frameMs = 0.0, drawnMs = 0.0;  // a picture, of the server; medians
    double share = 0.0;
    std::string raycaster;
};

struct Course {
    int pictures = 300, side = 512;
    double stepMm = 1.5;
};

Flown fly(const ServerProcess& server, const std::string& caseName, const Course& course,
          bool tells, const std::string& reader) {
    TestClient client(server.port());
    protocol::ClientMessage message;
    message.mutable_hello()->set_protocol_version(protocol::protocolVersion);
    for (const char* name : {"jpeg", "lossless", "ledger"})
        message.mutable_hello()->add_capabilities(name);
    message.mutable_hello()->set_reader(reader);
    client.send(message);
    client.answer();
    const auto opened = client.openCase(caseName);
    if (!opened || !opened->has_case_opened())
        throw std::runtime_error("the case cannot be opened");
    const auto& path = opened->case_opened().centerline();
    const int samples = path.size() / 5, ahead = 20;
    client.viewport(1, 0, protocol::ENDOSCOPIC, course.side, course.side);
    Flown flown;
    std::vector<double> frames, drawn;
    const double before = cpuMs(server.pid());
    std::uint64_t told = 0;
    for (int n = 0; n < course.pictures; ++n) {
        const int here = int(n * course.stepMm) % (samples - ahead - 1);
        const auto at = [&](int sample) {
            return TestClient::Vector{path[5 * sample], path[5 * sample + 1], path[5 * sample + 2]};
        };
        const auto from = at(here), to = at(here + ahead);
        const std::uint64_t sequence = std::uint64_t(n) + 2;
        const double asked = milliseconds();
        client.camera(sequence, 0, from, true, {to[0] - from[0], to[1] - from[1], to[2] - from[2]});
        std::optional<TestPicture> picture;
        do
            picture = client.picture();
        while (picture && picture->header.sequence < sequence);
        if (!picture) throw std::runtime_error("the server is silent");
        const double ms = milliseconds() - asked;
        frames.push_back(ms);
        drawn.push_back(1e-3 * picture->header.renderMicroseconds);
        flown.raycaster = raycasterName(picture->header.raycaster);
        if (!tells) continue;
        message.Clear();
        message.mutable_tell_shown()->set_number(++told);
        auto* one = message.mutable_tell_shown()->add_pictures();
        one->set_picture(picture->header.picture);
        one->set_ms(std::uint32_t(std::max(1.0, ms)));
        client.send(message);
    }
    message.Clear();
    message.mutable_ask_seen()->set_request(1);
    client.send(message);
    for (auto answer = client.answer(); answer; answer = client.answer()) {
        if (!answer->has_wall_seen() || answer->wall_seen().request() != 1) continue;
        flown.share = answer->wall_seen().share();
        break;
    }
    flown.cpuMs = (cpuMs(server.pid()) - before) / course.pictures;
    flown.frameMs = median(frames);
    flown.drawnMs = median(drawn);
    return flown;
}

int run(int argc, char** argv) {
    CLI::App app("What the ledger of seen wall costs");
    std::string store, caseName, raycaster = "native";
    int rounds = 5;
    Course course;
    app.add_option("store", store)->required();
    app.add_option("case", caseName)->required();
    app.add_option("--raycaster", raycaster);
    app.add_option("--rounds", rounds);
    app.add_option("--pictures", course.pictures, "of a flight");
    app.add_option("--side", course.side, "pixels of a picture");
    app.add_option("--step", course.stepMm, "mm from picture to picture");
    CLI11_PARSE(app, argc, argv);
    const ServerProcess server(store, {"--raycaster", raycaster});
    fly(server, caseName, course, false, "");  // what is made once a case
    std::vector<double> cpu[2], frame[2], more;
    fmt::print("round  ledger  CPU ms a picture  hand to picture ms  drawn ms  seen\n");
    for (int round = 0; round < rounds; ++round) {
        for (const bool tells : {round % 2 == 0, round % 2 != 0}) {
            const Flown flown =
                fly(server, caseName, course, tells, fmt::format("bench-{}-{}", ::getpid(), round));
            cpu[tells].push_back(flown.cpuMs);
            frame[tells].push_back(flown.frameMs);
            fmt::print("{:5}  {:6}  {:16.2f}  {:18.2f}  {:8.2f}  {:.4f}  {}\n", round, tells,
                       flown.cpuMs, flown.frameMs, flown.drawnMs, flown.share, flown.raycaster);
            std::fflush(stdout);
        }
        more.push_back(cpu[1].back() - cpu[0].back());
    }
    fmt::print(
        "CPU {:.2f} ms without, {:.2f} with: {:+.2f} ms, {:+.1f} %; hand to picture {:.2f}, "
        "{:.2f} ms ({:+.1f} %)\n",
        median(cpu[0]), median(cpu[1]), median(more), 100.0 * median(more) / median(cpu[0]),
        median(frame[0]), median(frame[1]), 100.0 * (median(frame[1]) / median(frame[0]) - 1.0));
    return 0;
}

}  // namespace
}  // namespace haustra::tests

int main(int argc, char** argv) {
    return haustra::tests::run(argc, argv);
}
