#include "session/case_list.h"

#include "session/open_case.h"
#include "store/products.h"

#include <chrono>
#include <ctime>
#include <filesystem>
#include <utility>

#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

std::string utc(std::chrono::system_clock::time_point at) {
    const std::time_t seconds = std::chrono::system_clock::to_time_t(at);
    std::tm parts{};
    gmtime_r(&seconds, &parts);
    char text[32];
    return {text, std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts)};
}

}  // namespace

// The products' keys, and the sizes of their files: what is cut short shows.
std::string CaseReader::filesOf(const std::string& name) const {
    const auto source = store_.openCase(name);
    if (!source) return {};
    const auto products = source->products();
    if (!products) return {};
    std::string files;
    for (const store::ProductEntry& entry : *products) {
        std::error_code error;
        const auto bytes = std::filesystem::file_size(source->folder() / entry.file, error);
        files += entry.product + ':' + entry.key.hex + ':' +
                 (error ? error.message() : std::to_string(bytes)) + ' ';
    }
    return files;
}

CaseReader::Known CaseReader::readOne(const std::string& name, const std::string& files) const {
    Known known{files, {}, {}};
    CaseSummary& found = known.summary;
    found.name = name;
    const auto damaged = [&](const Error& error) {
        found.state = CaseSummary::State::damaged;
        found.reason = error.message;
        return known;
    };
    const auto source = store_.openCase(name);
    if (!source) return damaged(source.error());
    if (const auto at = source->changedAt()) found.preparedUtc = utc(*at);
    const auto products = source->products();
    if (!products) return damaged(products.error());
    if (!source->find(store::product::ct)) {
        found.state = CaseSummary::State::incomplete;
        found.reason = "there is no scan in it yet";
        return known;
    }
    const auto read = readCase(*source);
    if (!read) return damaged(read.error());
    known.scan = read->facts.scan;
    found.size = read->facts.grid.size;
    found.spacingMm = read->facts.grid.spacingMm();
    found.cleansed = read->facts.cleansed;
    found.flattened = read->flattened;
    if (const auto& trust = read->facts.trust) {
        found.confidence = trust->confidence;
        found.warnings = trust->warnings.size();
    }
    return known;
}

Result<std::vector<CaseSummary>> CaseReader::read(records::BookmarkStore& bookmarks) {
    const auto names = TRY(store_.cases());
    const auto counts = bookmarks.counts();
    if (!counts) spdlog::error("bookmarks cannot be counted: {}", counts.error().message);
    std::map<std::string, Known> known;
    std::vector<CaseSummary> all;
    for (const std::string& name : names) {
        const std::string files = filesOf(name);
        const auto before = known_.find(name);
        // What is repaired in place keeps its size: damage is looked for anew.
        const bool isKnown = before != known_.end() && !files.empty() &&
                             before->second.files == files &&
                             before->second.summary.state != CaseSummary::State::damaged;
        Known one = isKnown ? std::move(before->second) : readOne(name, files);
        one.summary.bookmarks = counts ? counts->of(name, one.scan) : 0;
        all.push_back(one.summary);
        known.emplace(name, std::move(one));
    }
    known_ = std::move(known);
    return all;
}

std::shared_ptr<const void> OpenCounts::enter(const std::string& name) {
    ++(*counts_)[name];
    return {counts_.get(), [counts = counts_, name](const void*) {
                if (--(*counts)[name] == 0) counts->erase(name);
            }};
}

int OpenCounts::of(const std::string& name) const {
    const auto found = counts_->find(name);
    return found == counts_->end() ? 0 : found->second;
}

}  // namespace haustra::session
