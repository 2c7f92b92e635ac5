// What a reader who chooses among the store's cases is told of them, and how many read each.
#pragma once

#include "core/result.h"
#include "records/bookmarks.h"
#include "store/case_store.h"

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace haustra::session {

struct CaseSummary {
    enum class State {
        ready,       ///< what it needs to be opened can be read
        incomplete,  ///< there is no scan in it yet
        damaged,     ///< it cannot be opened: `reason`
    };
    std::string name;
    State state = State::ready;
    std::string reason;       ///< a sentence that names no file; empty where it is ready
    std::string preparedUtc;  ///< when a product was last published, "2020-01-31T23:59:59Z"
    glm::ivec3 size{0};       ///< of the scan, voxels
    glm::dvec3 spacingMm{0.0};
    bool cleansed = false, flattened = false;
    std::optional<double> confidence;  ///< where a colon was searched for
    std::size_t warnings = 0;          ///< about it
    std::size_t bookmarks = 0;
};

/// Reads a case's products as opening does, but for those without which it opens as well, and
/// remembers what it found, but damage, until one of its files is another: half a millisecond for a
/// case that is new, some 50 µs for one that is known. Belongs to one thread.
class CaseReader {
public:
    explicit CaseReader(store::CaseStore store) : store_(std::move(store)) {}
    /// All cases, by name; fails where the store's folder cannot be read. Without bookmarks where
    /// these cannot be.
    Result<std::vector<CaseSummary>> read(records::BookmarkStore& bookmarks);

private:
    struct Known {
        std::string files;  // what is read again when it has changed
        CaseSummary summary;
        std::string scan;
    };
    Known readOne(const std::string& name, const std::string& files) const;
    std::string filesOf(const std::string& name) const;

    store::CaseStore store_;
    std::map<std::string, Known> known_;
};

/// How many sessions have each case open. Belongs to the io thread; what it lends may go later.
class OpenCounts {
public:
    /// One more has it open, for as long as what is returned lives.
    std::shared_ptr<const void> enter(const std::string& name);
    int of(const std::string& name) const;

private:
    using Counts = std::map<std::string, int>;
    std::shared_ptr<Counts> counts_ = std::make_shared<Counts>();
};

}  // namespace haustra::session
