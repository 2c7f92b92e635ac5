// Plays a script through a session: what the headless client does.
#pragma once

#include "reader/session.h"
#include "script/report.h"
#include "script/script.h"

#include <filesystem>

namespace haustra::reader {

struct PlayOptions {
    std::filesystem::path outFolder;  ///< exists; files of the script go here
    std::string scriptName;           ///< for the place of errors
    std::string software;
    int width = 512, height = 512;               ///< of viewports that the script does not size
    std::chrono::milliseconds patience{30'000};  ///< for each answer of the server
};

/// Waits until the session's case is open, then plays `actions` in order. Stops at the first that
/// fails: a refusal by the server, no answer within `patience`, the link lost for good, or a file
/// that cannot be written; `failure` then names the line. What was measured until then is in the
/// report. Where no case was named and the server has exactly one, that one is opened.
PlayReport play(Session& session, const std::vector<Action>& actions, const PlayOptions& options);

}  // namespace haustra::reader
