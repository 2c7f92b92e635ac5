// The subcommands of `haustra`, one file each.
#pragma once

#include "core/result.h"

#include <functional>

namespace CLI {
class App;
}

namespace haustra::cli {

/// A subcommand that has been added to the program: what the command line is parsed into lives in
/// `run`, which does the work once `app` has been parsed.
struct Command {
    CLI::App* app;
    std::function<Result<void>()> run;
    bool wantsLargePages = false;  ///< it walks through gigabytes for a long time (useLargePages)
};

Command addPhantom(CLI::App& program);
Command addPrepare(CLI::App& program);
Command addExport(CLI::App& program);
Command addList(CLI::App& program);
Command addRender(CLI::App& program);
Command addEvaluate(CLI::App& program);
Command addDenoise(CLI::App& program);
Command addFlatten(CLI::App& program);
Command addCad(CLI::App& program);
Command addCalibrate(CLI::App& program);
Command addCoverage(CLI::App& program);

}  // namespace haustra::cli
