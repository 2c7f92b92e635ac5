// haustra-client: reads a case that a Haustra server streams, in a window or from a script.
#include "core/durable_file.h"
#include "core/version.h"
#include "link/fingerprint.h"
#include "link/known_servers.h"
#include "protocol/limits.h"
#include "reader/reader_name.h"
#include "script/script.h"
#include "script/script_player.h"
#include "window/run.h"

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iostream>

#include <CLI/CLI.hpp>

namespace {

using namespace haustra;

constexpr int exitDone = 0, exitFailed = 1, exitUsage = 2;
const std::string software = std::string("haustra-client ") + softwareVersion;

struct Arguments {
    std::string server, caseName, script, out, size, fingerprint, knownServers, screenshot;
    std::string theme, language, readerName;
    bool list = false, headless = false, reconnect = false;
    double timeoutSeconds = 30.0, scale = 0.0;
    int screenshotAfterMs = 3000;
};

// In lines of a help page.
std::string actionNames() {
    std::string names = "  " + reader::scriptActionNames();
    for (std::size_t line = 0; names.size() - line > 78;) {
        const std::size_t space = names.rfind(' ', line + 78);
        if (space <= line + 2) break;  // a name longer than a line
        names.replace(space, 1, "\n  ");
        line = space + 1;
    }
    return names;
}

void declare(CLI::App& app, Arguments& a) {
    app.description(
        "Reads a case that a Haustra server streams: in a window, or by a script with --headless.\n"
        "The connection is TLS 1.3. The server's certificate is pinned when it is first met, and "
        "refused\n"
        "when it changes. For a physician's judgement; not a certified medical device.");
    app.footer(
        "In the window, ? or F1 shows the keys, which can be changed. Settings, layouts and keys "
        "are\n"
        "kept in $XDG_CONFIG_HOME/haustra.\n"
        "Scripts have one JSON object a line; \"do\" names its action, one of\n" +
        actionNames() +
        "\n"
        "For example:\n"
        "  {\"do\":\"go\",\"arc_mm\":120,\"direction\":\"antegrade\"}\n"
        "  {\"do\":\"still\",\"png\":\"rectum.png\"}\n"
        "  {\"do\":\"fly\",\"from_mm\":0,\"to_mm\":1500,\"positions\":200}\n"
        "Pictures and latencies.json go to --out. client/SCRIPT.md describes every action.\n"
        "Exit codes: 0 done, 1 failed (one line on stderr says what and where), 2 wrong usage.");
    app.set_version_flag("--version", software);
    app.failure_message([](const CLI::App*, const CLI::Error& error) {
        return "haustra-client: " + std::string(error.what()) + " (see haustra-client --help)\n";
    });
    app.option_defaults()->always_capture_default(false);
    app.add_option("server", a.server,
                   "HOST, HOST:PORT or [IPV6]:PORT; the port is " +
                       std::to_string(link::defaultPort) + " unless given")
        ->required()
        ->type_name("HOST[:PORT]");
    app.add_option("--case", a.caseName,
                   "open this case (default: choose in the window, or the only one)")
        ->type_name("NAME");
    app.add_flag("--list", a.list, "print the names of the server's cases, and quit");
    app.add_option("--size", a.size,
                   "the window's size, or with --headless that of pictures (default as it was "
                   "last; 512x512)")
        ->type_name("WxH");
    app.add_option("--fingerprint", a.fingerprint,
                   "SHA-256 of the server's certificate, as the server prints it: must match, and "
                   "is pinned")
        ->type_name("SHA256");
    app.add_option("--known-servers", a.knownServers,
                   "file of pinned certificates (default $XDG_CONFIG_HOME/haustra/known_servers)")
        ->type_name("FILE");
    app.add_option("--reader", a.readerName,
                   "whose record it is of which wall has been on screen, kept by the server "
                   "(default: a random\nname in $XDG_DATA_HOME/haustra/reader; with --headless "
                   "nobody's, and nothing is kept)")
        ->type_name("NAME");
    app.add_option("--timeout", a.timeoutSeconds,
                   "seconds to wait for each answer of the server (default 30)")
        ->type_name("S")
        ->check(CLI::Range(0.1, 3600.0));
    auto* headless = app.add_flag("--headless", a.headless, "no window: play --script")
                         ->group("Without a window");
    app.add_option("--script", a.script, "JSON-lines actions to play (- for standard input)")
        ->type_name("FILE")
        ->needs(headless)
        ->group("Without a window");
    app.add_option("--out", a.out, "folder for pictures and latencies.json; made where missing")
        ->type_name("DIR")
        ->needs(headless)
        ->group("Without a window");
    app.add_flag("--reconnect", a.reconnect,
                 "after a lost connection try again until --timeout, as the window does; bookmarks "
                 "not yet "
                 "acknowledged are sent again")
        ->needs(headless)
        ->group("Without a window");
    app.add_option("--scale", a.scale,
                   "size of text and controls (default: what the display asks for)")
        ->type_name("FACTOR")
        ->check(CLI::Range(0.5, 4.0))
        ->group("Window");
    app.add_option("--theme", a.theme, "colours of the window (default: as chosen in it; dark)")
        ->type_name("dark|light|contrast")
        ->check(CLI::IsMember({"dark", "light", "contrast"}))
        ->group("Window");
    app.add_option("--language", a.language,
                   "of the window (default: as chosen in it; the system's)")
        ->type_name("en|de")
        ->check(CLI::IsMember({"en", "de"}))
        ->group("Window");
    auto* screenshot = app.add_option("--screenshot", a.screenshot,
                                      "write a picture of the window as PNG, and quit")
                           ->type_name("FILE.png")
                           ->group("Window");
    app.add_option(
           "--screenshot-after-ms", a.screenshotAfterMs,
           "when to take it, from the start (default 3000); up to 20 s later where pictures "
           "are still on their way")
        ->type_name("N")
        ->check(CLI::Range(0, 600'000))
        ->needs(screenshot)
        ->group("Window");
}

int failed(const Error& error) {
    std::cerr << "haustra-client: " << describe(error) << "\n";
    return exitFailed;
}
int wrongUsage(const std::string& message) {
    std::cerr << "haustra-client: " << message << " (see haustra-client --help)\n";
    return exitUsage;
}

bool readSize(const std::string& text, int& width, int& height) {
    char rest = 0;
    return std::sscanf(text.c_str(), "%dx%d%c", &width, &height, &rest) == 2 &&
           std::min(width, height) >= int(protocol::minViewportPixels) &&
           std::max(width, height) <= int(protocol::maxViewportPixels) * 4;
}

void tellFirstUse(const reader::Session& session, const link::ConnectionOptions& options) {
    if (!session.server().firstUse) return;
    std::cerr << "haustra-client: first meeting with " << link::toString(options.address)
              << "; its certificate is now pinned: " << session.server().fingerprint << "\n";
}

int listCases(const link::ConnectionOptions& options, std::chrono::milliseconds patience) {
    reader::Session session(options, "");
    const auto deadline = reader::Clock::now() + patience;
    while (session.phase() != reader::Phase::choosing) {
        if (session.phase() == reader::Phase::failed) return failed(session.failure());
        if (reader::Clock::now() > deadline)
            return failed({ErrorKind::device, "the list of cases did not come in time",
                           link::toString(options.address)});
        session.poll(std::chrono::milliseconds(100));
    }
    tellFirstUse(session, options);
    for (const std::string& name : session.caseNames())
        std::cout << name << "\n";
    if (!std::cout.flush())
        return failed({ErrorKind::io, "it cannot be written", "standard output"});
    return exitDone;
}

int playScript(const Arguments& a, link::ConnectionOptions connection,
               reader::PlayOptions options) {
    options.scriptName = a.script == "-" ? "standard input" : a.script;
    options.outFolder = a.out;
    options.software = software;
    std::ifstream file;
    if (a.script != "-") {
        file.open(a.script);
        if (!file) return failed({ErrorKind::notFound, "cannot read the script", a.script});
    }
    const auto actions = reader::parseScript(a.script == "-" ? std::cin : file, options.scriptName);
    if (!actions) return failed(actions.error());
    std::error_code error;
    std::filesystem::create_directories(options.outFolder, error);
    if (error)
        return failed({ErrorKind::io, "cannot make the output folder: " + error.message(), a.out});

    connection.reconnect = a.reconnect;
    reader::Session session(connection, a.caseName);
    const reader::PlayReport report = reader::play(session, *actions, options);
    tellFirstUse(session, connection);
    const auto written = writeDurably(options.outFolder / "latencies.json", reader::toJson(report));
    if (report.failure) failed(*report.failure);
    if (!written) failed(written.error());
    return report.failure || !written ? exitFailed : exitDone;
}

}  // namespace

int main(int argc, char** argv) {
    CLI::App app;
    Arguments a;
    declare(app, a);
    try {
        app.parse(argc, argv);
        // CLI::Range lets NaN through.
        if (std::isnan(a.timeoutSeconds)) throw CLI::ValidationError("--timeout", "nan is no time");
        if (std::isnan(a.scale)) throw CLI::ValidationError("--scale", "nan is no size");
    } catch (const CLI::ParseError& error) {
        return app.exit(error) == 0 ? exitDone : exitUsage;
    }

    const auto address = link::parseServerAddress(a.server);
    if (!address) return wrongUsage(describe(address.error()));
    link::ConnectionOptions connection;
    connection.address = *address;
    connection.software = software;
    const auto patience = std::chrono::milliseconds(int(a.timeoutSeconds * 1000.0));
    connection.connectPatience = std::min(connection.connectPatience, patience);
    if (!a.fingerprint.empty()) {
        const auto fingerprint = link::normalizeFingerprint(a.fingerprint);
        if (!fingerprint) return wrongUsage("--fingerprint: " + fingerprint.error().message);
        connection.pinning.expectedFingerprint = *fingerprint;
    }
    if (a.knownServers.empty()) {
        const auto file = link::KnownServers::defaultFile();
        if (!file) return failed(file.error());
        connection.pinning.knownServersFile = *file;
    } else {
        connection.pinning.knownServersFile = a.knownServers;
    }

    if (!a.readerName.empty()) {
        const auto name = reader::checkReaderName(a.readerName);
        if (!name) return wrongUsage("--reader: " + name.error().message);
        connection.reader = *name;
    }
    int width = 0, height = 0;
    if (!a.size.empty() && !readSize(a.size, width, height))
        return wrongUsage("--size: not WxH, such as 512x512: " + a.size);
    if (a.list) return listCases(connection, patience);
    if (a.headless) {
        if (a.script.empty() || a.out.empty())
            return wrongUsage("--headless needs --script FILE and --out DIR");
        reader::PlayOptions options;
        options.patience = patience;
        if (width > 0) options.width = width, options.height = height;
        if (std::max(options.width, options.height) > int(protocol::maxViewportPixels))
            return wrongUsage("--size: pictures have at most " +
                              std::to_string(protocol::maxViewportPixels) + " pixels a side");
        return playScript(a, connection, options);
    }
    if (connection.reader.empty()) {
        const auto file = reader::defaultReaderFile();
        const auto name = file ? reader::readerNameIn(*file)
                               : Result<std::string>(tl::make_unexpected(file.error()));
        if (name)
            connection.reader = *name;
        else  // what is seen is this session's alone, as the window tells
            std::cerr << "haustra-client: " << describe(name.error()) << "\n";
    }
    window::WindowOptions options;
    options.connection = connection;
    options.caseName = a.caseName;
    if (const auto folder = reader::BookmarkJournal::defaultFolder())
        options.journal.emplace(*folder);
    else
        std::cerr << "haustra-client: " << describe(folder.error()) << "\n";
    if (width > 0) options.width = width, options.height = height;
    if (a.scale > 0.0) options.scale = a.scale;
    options.theme = a.theme;
    options.language = a.language;
    if (!a.screenshot.empty()) options.screenshot = a.screenshot;
    options.screenshotAfterMs = a.screenshotAfterMs;
    if (const auto ran = window::run(options); !ran) return failed(ran.error());
    return exitDone;
}
