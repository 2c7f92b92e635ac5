// Between sessions: what one adds, the others show.
#pragma once

#include "records/bookmarks.h"

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace haustra::session {

/// Belongs to the io thread.
class BookmarkNews {
public:
    using Heard = std::function<void(const records::Bookmark&)>;
    /// `heard` is called for each bookmark of whichever case while `listener` lives.
    void listen(std::weak_ptr<const void> listener, Heard heard) {
        std::erase_if(listeners_, [](const auto& known) { return known.first.expired(); });
        listeners_.emplace_back(std::move(listener), std::move(heard));
    }
    /// The bookmark is in the store.
    void tell(const records::Bookmark& bookmark) const {
        for (const auto& [listener, heard] : listeners_)
            if (const auto alive = listener.lock()) heard(bookmark);
    }

private:
    std::vector<std::pair<std::weak_ptr<const void>, Heard>> listeners_;
};

}  // namespace haustra::session
