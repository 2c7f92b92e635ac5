// The case store: one folder a case, one file a product, published whole or not at all.
//
//   STORE/cases/NAME/case.json              names the case's scan and the file of each product
//   STORE/cases/NAME/<product>-<key16>.hvol, .hline, .hmesh …: a product (store/products.h) of one
//                                           kind of content (store/content.h)
//   STORE/cases/NAME/.lock                  flocked by the one writer
//   STORE/cases/NAME/.tmp-*                 being written, or left by a writer that was killed
//
// A product becomes visible when case.json names it, and case.json is replaced in one step after
// the product's file is on the disk. A file never changes under its name's readers: what replaces
// it is another file, and readers that have the old one mapped keep it.
//
// A case is of one scan, to which case.json binds it; a product of another scan takes the place of
// all that the case had. Scans of one study (supine and prone) are cases beside each other, by
// custom CASE and CASE.SCAN, which their study's UID holds together.
#pragma once

#include "core/boxed_volume.h"
#include "core/centerline.h"
#include "core/ct_scan.h"
#include "core/flat_map.h"
#include "core/result.h"
#include "core/tissue.h"
#include "core/tri_mesh.h"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace haustra::store {

struct MappedProduct;

/// Names a product's content: a hash of the stage's name and version, its options and the keys of
/// its inputs. Equal keys mean equal bytes.
struct ProductKey {
    std::string hex;  ///< 64 lower-case hexadecimal digits
    bool operator==(const ProductKey&) const = default;
};

/// SHA-256 over its parts, each with its length, so that ("ab","c") and ("a","bc") differ.
ProductKey makeKey(std::string_view stage, int version, std::string_view options,
                   const std::vector<ProductKey>& inputs);

/// Free text stored with a product: patient position, series facts. Nothing of the patient's.
using Attributes = std::map<std::string, std::string>;

/// Which scan a case is of. UIDs name no patient, but an archive finds one by them: they go into
/// case.json and to no client and no log.
struct ScanIdentity {
    ProductKey key;  ///< names the scan under whatever case it lies; readers' records belong to it
    std::string studyUid, seriesUid;  ///< DICOM's; empty where the files do not tell
    bool operator==(const ScanIdentity&) const = default;
};

/// What `case.json` says of one product.
struct ProductEntry {
    std::string product;  ///< "ct", "lumen", "centerline", "surface" …
    ProductKey key;
    std::string file;  ///< name within the case folder
};

/// One case in a store. Reading is safe beside one writer, in any process, and from any number of
/// threads. A case from CaseStore::openCase only reads; one from CaseStore::createCase also
/// publishes, from one thread, and holds the case's lock until its last copy is gone.
class Case {
public:
    const std::string& name() const { return name_; }
    std::filesystem::path folder() const { return folder_; }

    /// The products now published, sorted by name, read afresh from disk.
    Result<std::vector<ProductEntry>> products() const;
    /// None where there is no such product, or the index cannot be read (products() says which).
    std::optional<ProductEntry> find(std::string_view product) const;
    bool has(std::string_view product, const ProductKey& key) const;
    /// The scan that the case is of. Where nothing has bound it (no UIDs are known then) its key is
    /// that of the product "ct"; none where there is no such product either.
    Result<std::optional<ScanIdentity>> scan() const;

    /// When a product of it was last published, by the clock of the file system; none where that
    /// cannot be told.
    std::optional<std::chrono::system_clock::time_point> changedAt() const;

    /// A view of the memory-mapped product; T (int16_t, uint8_t, float or TissueFractions) must be
    /// the type that was published. Reads the header alone: the values' pages come when they are
    /// touched.
    template <class T>
    Result<Volume<T>> readVolume(std::string_view product) const;
    Result<Centerline> readCenterline(std::string_view product = "centerline") const;
    /// A copy, checked: every vertex is finite and every corner of a triangle is a vertex.
    Result<TriMesh> readMesh(std::string_view product = "surface") const;
    /// A copy, checked: whoever walks over it finds every index in range, every number finite, x in
    /// [0, 1], y in [0, height], arcs that do not fall, and at least one triangle and one camera.
    /// How many triangles the closed surface has it cannot know.
    Result<FlatMap> readFlatMap(std::string_view product = "flatmap") const;
    Result<std::string> readText(std::string_view product) const;
    Result<Attributes> attributes(std::string_view product) const;
    /// Fails, naming the file, where a product is not byte for byte what was published. Reads all
    /// of it, at the speed of SHA-256 on all cores.
    Result<void> verify(std::string_view product) const;

    /// Binds the case to a scan. Where scan() has the same key this is durable when it returns;
    /// else it is once a product is published, which takes the place of all that the case had, in
    /// one step.
    Result<void> bind(const ScanIdentity& scan);

    /// Published durably under `key`: when this returns, the product survives a power cut, and
    /// the file that it replaces is gone. Unless the key is the one published before, the products
    /// named in `outdated`, which the old one went into, leave case.json in the same step.
    template <class T>
    Result<void> publishVolume(std::string_view product, const ProductKey& key,
                               const Volume<T>& volume, const Attributes& attributes = {},
                               const std::vector<std::string>& outdated = {});
    /// The same of a volume that is held in a box: the rest is made as it is written.
    template <class T>
    Result<void> publishVolume(std::string_view product, const ProductKey& key,
                               const BoxedVolume<T>& volume, const Attributes& attributes = {},
                               const std::vector<std::string>& outdated = {}, int threads = 0);
    Result<void> publishCenterline(std::string_view product, const ProductKey& key,
                                   const Centerline& centerline, const Attributes& attributes = {},
                                   const std::vector<std::string>& outdated = {});
    /// Fails (unsupported) beyond 2^28 vertices or triangles.
    Result<void> publishMesh(std::string_view product, const ProductKey& key, const TriMesh& mesh,
                             const Attributes& attributes = {},
                             const std::vector<std::string>& outdated = {});
    /// Fails (badInput) where readFlatMap would not read it, (unsupported) beyond 2^28 of anything.
    Result<void> publishFlatMap(std::string_view product, const ProductKey& key, const FlatMap& map,
                                const Attributes& attributes = {},
                                const std::vector<std::string>& outdated = {});
    /// UTF-8, at most 2^24 bytes.
    Result<void> publishText(std::string_view product, const ProductKey& key, std::string_view text,
                             const Attributes& attributes = {},
                             const std::vector<std::string>& outdated = {});

private:
    friend class CaseStore;
    Result<MappedProduct> map(std::string_view product) const;
    Result<void> announce(const ProductEntry& entry, const std::vector<std::string>& outdated);
    Result<void> checkWritable() const;
    void sweep(const std::vector<ProductEntry>& kept) const;

    std::string name_;
    std::filesystem::path folder_;
    std::shared_ptr<const void> lock_;   // of a writer only
    std::optional<ScanIdentity> bound_;  // what is published is of it
};

/// A store of cases. Immutable: safe from any number of threads.
class CaseStore {
public:
    /// Opens a folder, making it where `create`.
    static Result<CaseStore> open(const std::filesystem::path& folder, bool create);
    const std::filesystem::path& folder() const { return folder_; }

    /// Names of the cases that have an index, sorted.
    Result<std::vector<std::string>> cases() const;
    /// For reading. Fails (notFound) where there is no such case.
    Result<Case> openCase(const std::string& name) const;
    /// For writing, made where it does not exist. Fails at once where another writer, in this or
    /// any process, holds the case. Sweeps what a killed writer left.
    Result<Case> createCase(const std::string& name) const;

private:
    std::filesystem::path folder_;
};

}  // namespace haustra::store
