#include "store/case_store.h"

#include "core/case_name.h"
#include "core/durable_file.h"
#include "store/case_index.h"
#include "store/file_lock.h"
#include "store/lost_pages.h"
#include "store/product_file.h"
#include "store/products.h"

#include <algorithm>
#include <set>
#include <system_error>

namespace haustra::store {
namespace {

namespace fs = std::filesystem;

constexpr char lockName[] = ".lock";

Result<std::shared_ptr<const void>> lockCase(const fs::path& folder, const std::string& name) {
    auto lock = lockFile(folder / lockName, WhereLocked::refuse);
    if (!lock && lock.error().kind == ErrorKind::wrongState)
        return fail(ErrorKind::wrongState, "case " + name + " is being written by another process",
                    folder.string());
    return lock;
}

std::optional<ScanIdentity> scanOf(const CaseIndex& index) {
    if (index.scan) return index.scan;
    for (const ProductEntry& entry : index.products)
        if (entry.product == product::ct) return ScanIdentity{entry.key, {}, {}};
    return std::nullopt;
}

}  // namespace

ProductKey makeKey(std::string_view stage, int version, std::string_view options,
                   const std::vector<ProductKey>& inputs) {
    Sha256 hash;
    hash.addWithLength(stage);
    hash.addWithLength(std::to_string(version));
    hash.addWithLength(options);
    for (const ProductKey& input : inputs)
        hash.addWithLength(input.hex);
    return {toHex(hash.finish())};
}

Result<std::vector<ProductEntry>> Case::products() const {
    return readCaseIndex(folder_).map([](CaseIndex index) { return std::move(index.products); });
}

Result<std::optional<ScanIdentity>> Case::scan() const {
    return readCaseIndex(folder_).map([](const CaseIndex& index) { return scanOf(index); });
}

Result<void> Case::bind(const ScanIdentity& scan) {
    TRY(checkWritable());
    auto index = TRY(readCaseIndex(folder_));
    bound_ = scan;
    const auto held = scanOf(index);
    if (!held || held->key != scan.key || index.scan == scan) return {};
    index.scan = scan;
    return writeCaseIndex(folder_, index);
}

std::optional<ProductEntry> Case::find(std::string_view product) const {
    const auto entries = products();
    if (!entries) return std::nullopt;
    const auto found =
        std::find_if(entries->begin(), entries->end(),
                     [&](const ProductEntry& entry) { return entry.product == product; });
    if (found == entries->end()) return std::nullopt;
    return *found;
}

bool Case::has(std::string_view product, const ProductKey& key) const {
    const auto entry = find(product);
    return entry && entry->key == key;
}

Result<MappedProduct> Case::map(std::string_view product) const {
    // Between reading case.json and opening the file a writer may publish a newer product and
    // remove this one; the newer case.json then names another file.
    std::string triedFile;
    while (true) {
        const auto entries = TRY(products());
        const auto entry = std::find_if(
            entries.begin(), entries.end(),
            [&](const ProductEntry& candidate) { return candidate.product == product; });
        if (entry == entries.end()) {
            return fail(ErrorKind::notFound,
                        "case " + name_ + " has no product " + std::string(product),
                        folder_.string());
        }
        const fs::path file = folder_ / entry->file;
        auto mapped = mapProduct(file);
        if (mapped && mapped->header.key != digestFromHex(entry->key.hex)) {
            return fail(ErrorKind::badInput,
                        "the product is damaged: its key is not the one that case.json names",
                        file.string());
        }
        if (mapped || mapped.error().kind != ErrorKind::notFound || entry->file == triedFile) {
            return mapped;
        }
        triedFile = entry->file;
    }
}

Result<Attributes> Case::attributes(std::string_view product) const {
    auto mapped = TRY(map(product));
    return std::move(mapped.header.attributes);
}

Result<void> Case::verify(std::string_view product) const {
    const auto mapped = TRY(map(product));
    return checkValues(mapped);
}

Result<void> Case::checkWritable() const {
    if (lock_) return {};
    return fail(ErrorKind::wrongState, "case " + name_ + " is open for reading only",
                folder_.string());
}

Result<void> Case::announce(const ProductEntry& entry, const std::vector<std::string>& outdated) {
    if (const auto lost = firstLostFile())
        return fail(ErrorKind::io,
                    entry.product +
                        " is not kept: what it was made from was cut short, or its "
                        "disk fails",
                    lost->string());
    auto index = TRY(readCaseIndex(folder_));
    if (bound_) {
        const auto held = scanOf(index);
        if (!held || held->key != bound_->key) index.products.clear();
        index.scan = bound_;
    }
    std::vector<ProductEntry>& entries = index.products;
    // Made again under its key, after damage, it leaves what came from it as good as it was.
    const bool unchanged =
        std::any_of(entries.begin(), entries.end(), [&](const ProductEntry& old) {
            return old.product == entry.product && old.key == entry.key;
        });
    std::erase_if(entries, [&](const ProductEntry& old) {
        if (old.product == entry.product) return true;
        return !unchanged &&
               std::find(outdated.begin(), outdated.end(), old.product) != outdated.end();
    });
    entries.push_back(entry);
    TRY(writeCaseIndex(folder_, index));
    sweep(entries);
    return {};
}

// Removes what no index names: products that were replaced, and what a killed writer left. A file
// that cannot be removed costs space only, so errors are ignored; the next writer tries again.
void Case::sweep(const std::vector<ProductEntry>& kept) const {
    std::set<std::string> names;
    for (const ProductEntry& entry : kept)
        names.insert(entry.file);
    std::error_code ignored;
    std::vector<fs::path> rubbish;
    for (fs::directory_iterator at(folder_, ignored), end; !ignored && at != end;
         at.increment(ignored)) {
        const std::string name = at->path().filename().string();
        const bool temporary = name.rfind(temporaryPrefix, 0) == 0;
        if (temporary || (isProductFileName(name) && !names.count(name)))
            rubbish.push_back(at->path());
    }
    for (const fs::path& file : rubbish)
        fs::remove(file, ignored);
}

Result<CaseStore> CaseStore::open(const fs::path& folder, bool create) {
    std::error_code error;
    if (create) {
        fs::create_directories(folder / "cases", error);
        if (error)
            return fail(ErrorKind::io, "cannot make the store: " + error.message(),
                        folder.string());
    }
    if (!fs::is_directory(folder / "cases", error)) {
        return fail(ErrorKind::notFound, "there is no case store", folder.string());
    }
    CaseStore store;
    store.folder_ = folder;
    return store;
}

std::optional<std::chrono::system_clock::time_point> Case::changedAt() const {
    std::error_code error;
    const auto at = fs::last_write_time(folder_ / caseIndexName, error);
    if (error) return std::nullopt;
    return std::chrono::time_point_cast<std::chrono::system_clock::duration>(
        std::chrono::file_clock::to_sys(at));
}

Result<std::vector<std::string>> CaseStore::cases() const {
    std::error_code error;
    std::vector<std::string> names;
    for (fs::directory_iterator at(folder_ / "cases", error), end; !error && at != end;
         at.increment(error)) {
        const std::string name = at->path().filename().string();
        std::error_code ignored;
        if (isCaseName(name) && fs::is_regular_file(at->path() / caseIndexName, ignored)) {
            names.push_back(name);
        }
    }
    if (error)
        return fail(ErrorKind::io, "cannot list the cases: " + error.message(), folder_.string());
    std::sort(names.begin(), names.end());
    return names;
}

Result<Case> CaseStore::openCase(const std::string& name) const {
    if (!isCaseName(name)) return fail(ErrorKind::badInput, "not a case name", name);
    Case opened;
    opened.name_ = name;
    opened.folder_ = folder_ / "cases" / name;
    std::error_code ignored;
    if (!fs::is_regular_file(opened.folder_ / caseIndexName, ignored)) {
        return fail(ErrorKind::notFound, "there is no case " + name, folder_.string());
    }
    return opened;
}

Result<Case> CaseStore::createCase(const std::string& name) const {
    if (!isCaseName(name)) {
        return fail(
            ErrorKind::badInput,
            "a case name is 1 to 64 letters, digits, '.', '_' or '-', not starting with '.'", name);
    }
    Case created;
    created.name_ = name;
    created.folder_ = folder_ / "cases" / name;
    std::error_code error;
    const bool made = fs::create_directories(created.folder_, error);
    if (error) {
        return fail(ErrorKind::io, "cannot make the case: " + error.message(),
                    created.folder_.string());
    }
    if (made) {
        TRY(syncFolder(folder_ / "cases"));
    }
    auto lock = TRY(lockCase(created.folder_, name));
    created.lock_ = std::move(lock);
    auto entries = TRY(created.products());
    created.sweep(entries);
    return created;
}

}  // namespace haustra::store
