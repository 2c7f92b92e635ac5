#include "store/product_values.h"

namespace haustra::store {
namespace {

const char* describeContent(Content content) {
    switch (content) {
        case Content::int16Volume:
            return "a volume of 16-bit integers";
        case Content::uint8Volume:
            return "a volume of bytes";
        case Content::floatVolume:
            return "a volume of floats";
        case Content::centerline:
            return "a centerline";
        case Content::fractionsVolume:
            return "a volume of tissue fractions";
        case Content::mesh:
            return "a mesh";
        case Content::flatMap:
            return "a flat map";
        case Content::text:
            return "a text";
    }
    return "something unknown";
}

}  // namespace

Result<void> checkContent(const MappedProduct& mapped, Content wanted, std::string_view product,
                          const std::filesystem::path& folder) {
    if (mapped.header.content == wanted) return {};
    return fail(ErrorKind::badInput,
                std::string(product) + " is " + describeContent(mapped.header.content) + ", not " +
                    describeContent(wanted),
                folder.string());
}

std::string productFileName(std::string_view product, const ProductKey& key,
                            const char* extension) {
    return std::string(product) + "-" + key.hex.substr(0, 16) + extension;
}

}  // namespace haustra::store
