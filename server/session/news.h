// What one part of the server tells all that listen.
#pragma once

#include <functional>
#include <memory>
#include <utility>
#include <vector>

namespace haustra::session {

/// Belongs to the io thread.
template <class T>
class News {
public:
    using Heard = std::function<void(const T&)>;
    /// `heard` is called for all that is told while `listener` lives, in place of what it gave
    /// before.
    void listen(std::weak_ptr<const void> listener, Heard heard) {
        std::erase_if(listeners_, [&](const auto& known) {
            const bool same =
                !known.first.owner_before(listener) && !listener.owner_before(known.first);
            return same || known.first.expired();
        });
        listeners_.emplace_back(std::move(listener), std::move(heard));
    }
    void tell(const T& news) const {
        // What is heard may make somebody listen.
        const auto listeners = listeners_;
        for (const auto& [listener, heard] : listeners)
            if (const auto alive = listener.lock()) heard(news);
    }

private:
    std::vector<std::pair<std::weak_ptr<const void>, Heard>> listeners_;
};

}  // namespace haustra::session
