// haustra-server: streams the store's cases to clients.
#include "core/durable_file.h"
#include "core/raycasters.h"
#include "core/version.h"
#include "net/server.h"
#include "store/lost_pages.h"

#include <cmath>
#include <csignal>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <string>

#include <CLI/CLI.hpp>
#include <google/protobuf/stubs/logging.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace {

namespace fs = std::filesystem;
using haustra::Result;

constexpr int exitDone = 0, exitFailed = 1, exitUsage = 2;

const char* const automatic = "auto";

struct Arguments {
    haustra::net::ServerOptions server;
    fs::path certificate, key, portFile, presets;
    std::string listen = toString(haustra::net::ListenAddress{}), logLevel = "info";
    std::string raycaster = automatic;
    double gpuBudgetMiB = 0.0;
};

int failed(const std::string& what) {
    std::fprintf(stderr, "haustra-server: %s\n", what.c_str());
    return exitFailed;
}

void addOptions(CLI::App& program, Arguments& arguments) {
    program.add_option("--store", arguments.server.store, "The case store to serve")
        ->type_name("DIR")
        ->envname("HAUSTRA_STORE")
        ->required();
    program
        .add_option("--listen", arguments.listen,
                    "Address to listen on; port 0 takes any that is free")
        ->type_name("IP:PORT")
        ->capture_default_str();
    auto* certificate =
        program
            .add_option("--certificate", arguments.certificate,
                        "PEM certificate chain, in place of the store's self-signed one, which is "
                        "made in DIR/tls on first start")
            ->type_name("FILE");
    auto* key =
        program.add_option("--key", arguments.key, "PEM key of --certificate")->type_name("FILE");
    certificate->needs(key);
    key->needs(certificate);
    program
        .add_option("--port-file", arguments.portFile,
                    "Write the port to this file once clients can connect")
        ->type_name("FILE");
    program
        .add_option("--max-sessions", arguments.server.maxSessions,
                    "Clients at a time; others are told to come again. The limit of open files is "
                    "raised for them, as far as the system lets it")
        ->type_name("N")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    program
        .add_option("--encoders", arguments.server.encoders,
                    "Threads that compress pictures; one serves some hundred pictures a second")
        ->type_name("N")
        ->check(CLI::Range(1, 64))
        ->capture_default_str();
    program
        .add_option("--raycaster", arguments.raycaster,
                    "What draws: auto tries those that work on this machine when a "
                    "case is opened, for a moment, and takes the fastest; or " +
                        haustra::raycasterNames())
        ->type_name("KIND")
        ->capture_default_str();
    program
        .add_option("--gpu-budget", arguments.gpuBudgetMiB,
                    "GPU memory for all cases together, in MiB; one that does not fit makes those "
                    "that nobody reads any more go, then is drawn from cells that come and go "
                    "within what is left, or from main memory. 0: what the device has")
        ->type_name("MIB")
        ->check(CLI::Range(0.0, 1048576.0))
        ->capture_default_str();
    program
        .add_option("--presets", arguments.presets,
                    "Transfer functions for clients beside the built-in ones: a folder of *.json "
                    "files, as the client's optics panel saves them")
        ->type_name("DIR");
    program.add_option("--log-level", arguments.logLevel, "How much to log, on standard error")
        ->check(CLI::IsMember({"debug", "info", "warning", "error"}))
        ->capture_default_str();
}

Result<void> serve(const Arguments& arguments) {
    auto server = TRY(haustra::net::Server::create(arguments.server));
    const auto& address = server->address();
    if (!arguments.portFile.empty())
        TRY(haustra::writeDurably(arguments.portFile, std::to_string(address.port) + "\n"));
    std::printf("listening on %s\ncertificate SHA-256 %s\nrendering with %s\n",
                toString(address).c_str(), server->fingerprint().c_str(),
                server->renderer().c_str());
    std::fflush(stdout);
    server->run();
    return {};
}

int runProgram(int argc, char** argv) {
    Arguments arguments;
    arguments.server.software = std::string("haustra-server ") + haustra::softwareVersion;
    CLI::App program("Haustra's server: renders the cases of a store and streams them to clients.",
                     "haustra-server");
    program.set_version_flag("--version", haustra::softwareVersion);
    program.failure_message([](const CLI::App*, const CLI::Error& error) {
        return "haustra-server: " + std::string(error.what()) + " (see haustra-server --help)\n";
    });
    program.footer(
        "Runs until SIGTERM or SIGINT.\nExit codes: 0 stopped, 1 failed, 2 wrong usage.");
    addOptions(program, arguments);
    try {
        program.parse(argc, argv);
        auto listen = haustra::net::parseListenAddress(arguments.listen);
        if (!listen) throw CLI::ValidationError("--listen", listen.error().message);
        arguments.server.listen = std::move(*listen);
        if (!arguments.presets.empty()) arguments.server.presets = arguments.presets;
        if (arguments.raycaster != automatic) {
            const auto kind = haustra::raycasterFromString(arguments.raycaster);
            if (!kind) throw CLI::ValidationError("--raycaster", kind.error().message);
            arguments.server.drawing.raycaster = *kind;
        }
        if (std::isnan(arguments.gpuBudgetMiB))  // CLI::Range lets it through
            throw CLI::ValidationError("--gpu-budget", "nan is no number of MiB");
        arguments.server.drawing.gpuBudgetBytes =
            std::size_t(std::ceil(arguments.gpuBudgetMiB * double(1 << 20)));
        if (!arguments.certificate.empty())
            arguments.server.identity = {arguments.certificate, arguments.key};
    } catch (const CLI::ParseError& error) {
        return program.exit(error) == 0 ? exitDone : exitUsage;
    }
    spdlog::set_default_logger(spdlog::stderr_logger_mt("haustra-server"));
    google::protobuf::SetLogHandler(nullptr);  // clients' bad messages are answered, not logged
    spdlog::set_level(spdlog::level::from_str(arguments.logLevel));
    const auto served = serve(arguments);
    return served ? exitDone : failed(haustra::describe(served.error()));
}

}  // namespace

int main(int argc, char** argv) {
    haustra::store::surviveLostPages();
    // Whoever took the log may end before the server does, and a file may reach the greatest size
    // that it may have: the line, or the record, is lost, not the readers' sessions.
    std::signal(SIGPIPE, SIG_IGN);
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return runProgram(argc, argv);
    } catch (const std::exception& error) {
        return failed(error.what());
    }
}
