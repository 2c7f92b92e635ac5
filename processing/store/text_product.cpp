// A case's texts: from memory to product files and back.
#include "store/case_store.h"
#include "store/product_file.h"

#include <span>

namespace haustra::store {

Result<std::string> Case::readText(std::string_view product) const {
    const auto mapped = TRY(map(product));
    TRY(checkContent(mapped, Content::text, product));
    std::string text(reinterpret_cast<const char*>(mapped.values.data()), mapped.values.size());
    TRY(checkWhole(mapped));
    return text;
}

Result<void> Case::publishText(std::string_view product, const ProductKey& key,
                               std::string_view text, const Attributes& attributes,
                               const std::vector<std::string>& outdated) {
    TRY(checkWritable());
    ProductHeader header{Content::text, {}, digestFromHex(key.hex), {}, attributes};
    const ProductEntry entry{std::string(product), key,
                             productFileName(product, key.hex, Content::text)};
    header.grid.size =
        TRY(elementNumbers(Content::text, {text.size(), 1, 1}, folder_ / entry.file));
    return writeProduct(folder_, entry.file, header, {std::as_bytes(std::span(text))})
        .and_then([&] { return announce(entry, outdated); });
}

}  // namespace haustra::store
