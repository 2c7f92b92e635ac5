// What products of every kind do alike on their way to and from a file.
#pragma once

#include "store/case_store.h"
#include "store/product_file.h"

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace haustra::store {

/// Fails (badInput) where `mapped` holds another kind of content than `wanted`.
Result<void> checkContent(const MappedProduct& mapped, Content wanted, std::string_view product,
                          const std::filesystem::path& folder);

/// "product-0123456789abcdef.hvol"
std::string productFileName(std::string_view product, const ProductKey& key, const char* extension);

template <class T>
void appendBytes(std::vector<std::byte>& bytes, const std::vector<T>& values) {
    const auto more = std::as_bytes(std::span(values));
    bytes.insert(bytes.end(), more.begin(), more.end());
}

}  // namespace haustra::store
