// haustra list: what a store holds.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "pipeline/scan_identity.h"
#include "store/case_store.h"
#include "store/case_trust.h"
#include "store/products.h"

#include <algorithm>
#include <map>
#include <memory>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

struct Listed {
    std::string name;
    std::string study;     ///< its code; empty where it is not known
    std::string position;  ///< "HFS" …; empty where there is no scan
};

Listed look(const store::CaseStore& store, const std::string& name) {
    Listed listed{name, {}, {}};
    const auto opened = store.openCase(name);
    if (!opened) return listed;
    if (const auto scan = opened->scan(); scan && *scan)
        listed.study = pipeline::studyCode((*scan)->studyUid);
    if (const auto attributes = opened->attributes(store::product::ct)) {
        if (const auto at = attributes->find("position"); at != attributes->end())
            listed.position = at->second;
    }
    return listed;
}

// Sorted by name, but for the scans of a study, which follow the first of them.
std::vector<Listed> byStudy(const store::CaseStore& store, const std::vector<std::string>& names) {
    std::vector<Listed> all;
    std::map<std::string, std::size_t> firstOfStudy;
    std::vector<std::size_t> place;
    for (const std::string& name : names) {
        all.push_back(look(store, name));
        const std::string& study = all.back().study;
        place.push_back(study.empty()
                            ? all.size() - 1
                            : firstOfStudy.try_emplace(study, all.size() - 1).first->second);
    }
    std::vector<std::size_t> order(all.size());
    for (std::size_t n = 0; n < order.size(); ++n)
        order[n] = n;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return place[a] < place[b]; });
    std::vector<Listed> sorted;
    for (const std::size_t n : order)
        sorted.push_back(std::move(all[n]));
    return sorted;
}

// How sure the colon is, in a line; empty where the case does not say.
std::string trustOf(const store::CaseStore& store, const std::string& name) {
    const auto opened = store.openCase(name);
    if (!opened || !opened->find(store::product::quality)) return {};
    const auto trust = store::readTrust(*opened);
    if (!trust) return "quality: " + describe(trust.error());
    const std::size_t warnings = trust->warnings.size();
    return fmt::format("colon found with confidence {:.0f} %, {} to look at",
                       100.0 * trust->confidence,
                       warnings == 1 ? "1 place" : fmt::format("{} places", warnings));
}

Result<void> runList(const fs::path& folder) {
    const auto store = TRY(store::CaseStore::open(folder, false));
    const auto names = TRY(store.cases());
    for (const auto& [name, study, position] : byStudy(store, names)) {
        fmt::print("{}{}{}\n", name, study.empty() ? "" : "  study " + study,
                   position.empty() ? "" : "  " + position);
        if (const std::string line = trustOf(store, name); !line.empty())
            fmt::print("    {}\n", line);
        const auto opened = store.openCase(name);
        const auto products = opened.and_then([](const auto& of) { return of.products(); });
        if (!products) {
            fmt::print("    {}\n", describe(products.error()));
            continue;
        }
        for (const store::ProductEntry& entry : *products) {
            std::error_code missing;
            const auto bytes = fs::file_size(store.folder() / "cases" / name / entry.file, missing);
            const auto header = opened->attributes(entry.product);
            fmt::print("    {:<14} {:>10}  {}{}\n", entry.product,
                       missing ? "missing" : fmt::format("{:.1f} MB", double(bytes) / 1e6),
                       entry.file, missing || header ? "" : "  " + header.error().message);
        }
    }
    return {};
}

}  // namespace

Command addList(CLI::App& program) {
    auto folder = std::make_shared<fs::path>();
    CLI::App* command =
        program.add_subcommand("list",
                               "List the cases of a store, their products and "
                               "sizes; a study's scans one after the other, each "
                               "with the study's code, the patient's position, and how sure "
                               "its colon is.");
    command->footer(store::catalogue().keptHelp());
    addStoreOption(*command, *folder);
    return {command, [folder] { return runList(*folder); }};
}

}  // namespace haustra::cli
