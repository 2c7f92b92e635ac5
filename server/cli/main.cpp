// haustra: everything offline, from a phantom to pictures.
#include "cli/commands.h"
#include "core/large_pages.h"
#include "core/version.h"
#include "store/lost_pages.h"

#include <csignal>
#include <cstdio>
#include <exception>
#include <new>
#include <vector>

#include <CLI/CLI.hpp>

namespace {

constexpr int exitDone = 0, exitFailed = 1, exitUsage = 2;

int failed(const std::string& what) {
    std::fprintf(stderr, "haustra: %s\n", what.c_str());
    return exitFailed;
}

int runProgram(int argc, char** argv) {
    CLI::App program("Haustra: virtual colonoscopy on the command line.", "haustra");
    program.set_version_flag("--version", haustra::softwareVersion);
    program.require_subcommand(1);
    program.set_help_all_flag("--help-all", "Print the help of all subcommands and exit");
    program.failure_message([](const CLI::App* app, const CLI::Error& error) {
        std::string command = app->get_name();
        for (auto used = app->get_subcommands(); !used.empty();
             used = used.front()->get_subcommands())
            command += " " + used.front()->get_name();
        const auto unknown = app->remaining();
        const std::string what = app->get_subcommands().empty() && !unknown.empty()
                                     ? "there is no command or option " + unknown.front()
                                     : error.what();
        return "haustra: " + what + " (see " + command + " --help)\n";
    });
    program.footer("Exit codes: 0 done, 1 failed, 2 wrong usage.");
    const std::vector<haustra::cli::Command> commands{
        haustra::cli::addPhantom(program), haustra::cli::addPrepare(program),
        haustra::cli::addExport(program),  haustra::cli::addList(program),
        haustra::cli::addRender(program),  haustra::cli::addEvaluate(program),
        haustra::cli::addDenoise(program), haustra::cli::addFlatten(program),
        haustra::cli::addCad(program),     haustra::cli::addCalibrate(program),
        haustra::cli::addCoverage(program)};
    try {
        program.parse(argc, argv);
        for (const auto& command : commands) {
            if (!command.app->parsed()) continue;
            if (command.wantsLargePages) haustra::useLargePages(argv);
            const auto done = command.run();
            if (!done) return failed(haustra::describe(done.error()));
            if (std::fflush(stdout) != 0 || std::ferror(stdout))
                return failed("standard output: it cannot be written");
            if (const auto lost = haustra::store::firstLostFile())
                return failed(lost->string() +
                              ": the product was cut short, or its disk fails, while it was read; "
                              "what was made of it is worth nothing");
            return exitDone;
        }
    } catch (const CLI::ParseError& error) {
        // Some options are known to be wrong only once a file has been read.
        return program.exit(error) == 0 ? exitDone : exitUsage;
    }
    return exitUsage;
}

}  // namespace

int main(int argc, char** argv) {
    haustra::store::surviveLostPages();
    // A file that would outgrow what it may have is a write that fails: it is named, and taken
    // back.
    std::signal(SIGXFSZ, SIG_IGN);
    try {
        return runProgram(argc, argv);
    } catch (const std::bad_alloc&) {
        return failed("there is not enough memory");
    } catch (const std::exception& error) {
        return failed(error.what());
    }
}
