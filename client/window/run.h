// The program's window: from its start to its end.
#pragma once

#include "link/connection.h"
#include "reader/bookmark_journal.h"

#include <filesystem>
#include <optional>
#include <string>

namespace haustra::window {

struct WindowOptions {
    link::ConnectionOptions connection;
    std::optional<reader::BookmarkJournal> journal;
    std::string caseName;         ///< empty: the window offers the server's cases
    int width = 0, height = 0;    ///< 0: as it was last
    std::optional<double> scale;  ///< of text and controls; default: what the display asks for
    std::string theme, language;  ///< empty: as the settings have it
    std::optional<std::filesystem::path> screenshot;  ///< write the window's picture here and quit
    int screenshotAfterMs = 3000;
};

/// Opens the window and runs until the reader closes it. Must be called on the main thread. Fails
/// where there is no display, and, once it is closed, where no case could be opened.
Result<void> run(const WindowOptions& options);

}  // namespace haustra::window
