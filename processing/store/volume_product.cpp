// A case's volumes: from memory to product files and back.
#include "store/case_store.h"
#include "store/product_file.h"

#include <span>

namespace haustra::store {

template <class T>
Result<Volume<T>> Case::readVolume(std::string_view product) const {
    auto mapped = TRY(map(product));
    TRY(checkContent(mapped, volumeOf<T>, product));
    // The values start on a page, so they are aligned for any T.
    const T* voxels = reinterpret_cast<const T*>(mapped.values.data());
    return Volume<T>::view(mapped.header.grid, voxels, mapped.mapping);
}

template <class T>
Result<void> Case::publishVolume(std::string_view product, const ProductKey& key,
                                 const Volume<T>& volume, const Attributes& attributes,
                                 const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    const ProductEntry entry{std::string(product), key,
                             productFileName(product, key.hex, volumeOf<T>)};
    const std::filesystem::path file = folder_ / entry.file;
    TRY(checkGrid(volume.grid(), file.string()));
    const ProductHeader header{volumeOf<T>, volume.grid(), digestFromHex(key.hex), {}, attributes};
    return writeProduct(folder_, entry.file, header, {std::as_bytes(volume.voxels())})
        .and_then([&] { return announce(entry, outdated); });
}

template <class T>
Result<void> Case::publishVolume(std::string_view product, const ProductKey& key,
                                 const BoxedVolume<T>& volume, const Attributes& attributes,
                                 const std::vector<std::string>& outdated, int threads) {
    TRY(checkWritable());
    const ProductEntry entry{std::string(product), key,
                             productFileName(product, key.hex, volumeOf<T>)};
    const std::filesystem::path file = folder_ / entry.file;
    TRY(checkGrid(volume.grid, file.string()));
    const ProductHeader header{volumeOf<T>, volume.grid, digestFromHex(key.hex), {}, attributes};
    const auto values = [&](std::size_t offset, std::span<std::byte> out) {
        // Blocks are whole voxels, in memory that is aligned for any.
        volume.read(offset / sizeof(T), {reinterpret_cast<T*>(out.data()), out.size() / sizeof(T)});
    };
    return writeProduct(folder_, entry.file, header, volume.grid.voxelCount() * sizeof(T), values,
                        threads)
        .and_then([&] { return announce(entry, outdated); });
}

template Result<Volume<std::int16_t>> Case::readVolume(std::string_view) const;
template Result<Volume<std::uint8_t>> Case::readVolume(std::string_view) const;
template Result<Volume<float>> Case::readVolume(std::string_view) const;
template Result<Volume<TissueFractions>> Case::readVolume(std::string_view) const;
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const Volume<std::int16_t>&, const Attributes&,
                                          const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const Volume<std::uint8_t>&, const Attributes&,
                                          const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&, const Volume<float>&,
                                          const Attributes&, const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const Volume<TissueFractions>&, const Attributes&,
                                          const std::vector<std::string>&);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<std::int16_t>&, const Attributes&,
                                          const std::vector<std::string>&, int);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<std::uint8_t>&, const Attributes&,
                                          const std::vector<std::string>&, int);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<float>&, const Attributes&,
                                          const std::vector<std::string>&, int);
template Result<void> Case::publishVolume(std::string_view, const ProductKey&,
                                          const BoxedVolume<TissueFractions>&, const Attributes&,
                                          const std::vector<std::string>&, int);

}  // namespace haustra::store
