// A case as one stage of prepare sees it.
#pragma once

#include "core/ct_scan.h"
#include "store/case_store.h"
#include "store/products.h"

#include <set>
#include <string>
#include <vector>

namespace haustra::pipeline {

/// One run of a stage. It reads what the catalogue names as parents of its products, and publishes
/// its products, all under one key; reading or publishing another is refused (wrongState), so that
/// the catalogue's closures are those of what truly is read.
///
/// Stages hand products on through the store alone: each maps what it reads, page by page as it is
/// touched, and lets go of it at its end, so that no volume is held longer than it is needed.
/// Belongs to one thread at a time.
class StageCase {
public:
    /// `target` and `catalogue` outlive it. `without`: products that the stage does not make of
    /// this organ.
    StageCase(store::Case& target, std::string stage, store::ProductKey key,
              const std::vector<std::string>& without = {},
              const store::Catalogue& catalogue = store::catalogue());

    const std::string& name() const { return stage_; }
    const store::ProductKey& key() const { return key_; }
    /// What it publishes.
    const std::vector<std::string>& products() const { return products_; }
    /// What was asked for until now.
    const std::set<std::string>& read() const { return read_; }
    /// What another StageCase of this stage read for it.
    void addRead(const std::set<std::string>& read) { read_.insert(read.begin(), read.end()); }

    Result<bool> holds(const std::string& product);
    template <class T>
    Result<Volume<T>> readVolume(const std::string& product) {
        return admit(product).and_then([&] { return target_.readVolume<T>(product); });
    }
    Result<Centerline> readCenterline(const std::string& product);
    Result<TriMesh> readMesh(const std::string& product);
    Result<FlatMap> readFlatMap(const std::string& product);
    Result<std::string> readText(const std::string& product);
    Result<store::Attributes> attributes(const std::string& product);
    /// The product `ct`, with its patient position.
    Result<CtScan> readScan();

    /// What is made from the product leaves the case in the same step, and so does what the stage
    /// made beside it under another key, with what is made from that, and `alsoOutdated`. Fails
    /// (wrongState) where the catalogue says that the product is of another content, too.
    template <class T>
    Result<void> publish(const std::string& product, const Volume<T>& volume,
                         const store::Attributes& attributes = {},
                         const std::vector<std::string>& alsoOutdated = {}) {
        return outdatedBy(product, store::volumeOf<T>, alsoOutdated).and_then([&](const auto& old) {
            return target_.publishVolume(product, key_, volume, attributes, old);
        });
    }
    template <class T>
    Result<void> publish(const std::string& product, const BoxedVolume<T>& volume,
                         const store::Attributes& attributes = {}, int threads = 0) {
        return outdatedBy(product, store::volumeOf<T>).and_then([&](const auto& old) {
            return target_.publishVolume(product, key_, volume, attributes, old, threads);
        });
    }
    Result<void> publish(const std::string& product, const Centerline& centerline,
                         const store::Attributes& attributes = {});
    Result<void> publish(const std::string& product, const TriMesh& mesh,
                         const store::Attributes& attributes = {});
    Result<void> publish(const std::string& product, const FlatMap& map,
                         const store::Attributes& attributes = {});
    Result<void> publish(const std::string& product, const std::string& text,
                         const store::Attributes& attributes = {});

private:
    Result<void> admit(const std::string& product);
    Result<std::vector<std::string>> outdatedBy(
        const std::string& product, store::Content content,
        const std::vector<std::string>& alsoOutdated = {}) const;

    store::Case& target_;
    const store::Catalogue& catalogue_;
    std::string stage_;
    store::ProductKey key_;
    std::vector<std::string> products_, sources_;
    std::set<std::string> read_;
};

}  // namespace haustra::pipeline
