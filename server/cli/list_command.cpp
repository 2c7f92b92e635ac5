// haustra list: what a store holds.
#include "cli/arguments.h"
#include "cli/commands.h"
#include "store/case_store.h"

#include <memory>
#include <system_error>

#include <CLI/CLI.hpp>
#include <fmt/format.h>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;

Result<void> runList(const fs::path& folder) {
    const auto store = store::CaseStore::open(folder, false);
    if (!store) return tl::make_unexpected(store.error());
    const auto names = store->cases();
    if (!names) return tl::make_unexpected(names.error());
    for (const std::string& name : *names) {
        fmt::print("{}\n", name);
        const auto products =
            store->openCase(name).and_then([](const auto& opened) { return opened.products(); });
        if (!products) {
            fmt::print("    {}\n", describe(products.error()));
            continue;
        }
        for (const store::ProductEntry& entry : *products) {
            std::error_code missing;
            const auto bytes =
                fs::file_size(store->folder() / "cases" / name / entry.file, missing);
            fmt::print("    {:<14} {:>10}  {}\n", entry.product,
                       missing ? "missing" : fmt::format("{:.1f} MB", double(bytes) / 1e6),
                       entry.file);
        }
    }
    return {};
}

}  // namespace

Command addList(CLI::App& program) {
    auto folder = std::make_shared<fs::path>();
    CLI::App* command =
        program.add_subcommand("list", "List the cases of a store, their products and sizes.");
    addStoreOption(*command, *folder);
    return {command, [folder] { return runList(*folder); }};
}

}  // namespace haustra::cli
