#include "session/marked_bookmark.h"

#include <utility>

namespace haustra::session {

MarkedBookmark marked(records::Bookmark bookmark, const OpenCase& of) {
    MarkedBookmark made{std::move(bookmark), {}};
    if (of.wall) made.mark = markOf(*of.wall, made.bookmark.positionMm, made.bookmark.forward);
    return made;
}

}  // namespace haustra::session
