// The case store: one folder a case, one file a product, published whole or not at all.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/centerline.h"
#include "core/ct_scan.h"
#include "core/result.h"

namespace haustra::store {

/// Names a product's content: a hash of the stage's name and version, its options and the keys of
/// its inputs. Equal keys mean equal bytes.
struct ProductKey {
    std::string hex;  ///< 64 lower-case hexadecimal digits
    bool operator==(const ProductKey&) const = default;
};

/// SHA-256 over its parts, each with its length, so that ("ab","c") and ("a","bc") differ.
ProductKey makeKey(std::string_view stage, int version, std::string_view options,
                   const std::vector<ProductKey>& inputs);

/// What `case.json` says of one product.
struct ProductEntry {
    std::string product;  ///< "ct", "lumen", "distance", "centerline" …
    ProductKey key;
    std::string file;  ///< name within the case folder
};

/// One case in a store. Reading is safe beside one writer, in any process: a product is a file
/// that is complete under its name and never changes.
class Case {
public:
    const std::string& name() const { return name_; }
    std::filesystem::path folder() const { return folder_; }

    /// The products now published, read afresh from disk.
    Result<std::vector<ProductEntry>> products() const;
    std::optional<ProductEntry> find(std::string_view product) const;
    bool has(std::string_view product, const ProductKey& key) const;

    /// Volumes are memory-mapped; T must be the type that was published.
    template <class T>
    Result<Volume<T>> readVolume(std::string_view product) const;
    Result<Centerline> readCenterline(std::string_view product = "centerline") const;
    /// Free text stored with the case beside its products (patient position, series facts …).
    Result<std::map<std::string, std::string>> attributes(std::string_view product) const;

    /// Written under a temporary name, fsynced, renamed, and then named in case.json likewise.
    template <class T>
    Result<void> publishVolume(std::string_view product, const ProductKey& key, const Volume<T>& volume,
                               const std::map<std::string, std::string>& attributes = {});
    Result<void> publishCenterline(std::string_view product, const ProductKey& key, const Centerline& centerline,
                                   const std::map<std::string, std::string>& attributes = {});

private:
    friend class CaseStore;
    std::string name_;
    std::filesystem::path folder_;
};

class CaseStore {
public:
    /// Opens a folder, making it where `create`.
    static Result<CaseStore> open(const std::filesystem::path& folder, bool create);
    /// Names of the cases, sorted.
    Result<std::vector<std::string>> cases() const;
    Result<Case> openCase(const std::string& name) const;
    /// Name: 1…64 of letters, digits, '.', '_', '-', not starting with '.'.
    Result<Case> createCase(const std::string& name) const;

private:
    std::filesystem::path folder_;
};

}  // namespace haustra::store
