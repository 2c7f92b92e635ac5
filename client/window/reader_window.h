// The reader's window.
#pragma once

#include "link/connection.h"
#include "reader/bookmark_journal.h"

#include <filesystem>
#include <optional>
#include <string>

namespace haustra::window {

struct WindowOptions {
    link::ConnectionOptions connection;
    std::string caseName;  ///< empty: the window offers the server's cases
    std::optional<reader::BookmarkJournal> journal;
    int width = 1440, height = 900;
    std::optional<double> scale;  ///< of text and controls; default: what the display asks for
    std::optional<std::filesystem::path> screenshot;  ///< write the window's picture here and quit
    int screenshotAfterMs = 3000;
};

/// Opens the window and runs until the reader closes it. Must be called on the main thread. Fails
/// where there is no display, no OpenGL 3, or the link fails for good before the first picture.
Result<void> run(WindowOptions options);

}  // namespace haustra::window
