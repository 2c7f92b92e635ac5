// Bookmarks with the places of the wall that they mean, as clients are told of them.
#pragma once

#include "records/bookmarks.h"
#include "session/open_case.h"

#include <memory>
#include <optional>

namespace haustra::session {

struct MarkedBookmark {
    records::Bookmark bookmark;
    std::optional<WallPlace> mark;  ///< none where the case has no wall, or it looks at none
};
/// Some 10 µs, of a case with a wall.
MarkedBookmark marked(records::Bookmark bookmark, const OpenCase& of);

/// A bookmark that is in the store now.
struct BookmarkNews {
    MarkedBookmark added;
    std::shared_ptr<const OpenCase> of;  ///< whose wall the mark is on
    std::uint64_t by = 0;                ///< session
};

}  // namespace haustra::session
