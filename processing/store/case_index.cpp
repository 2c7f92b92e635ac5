#include "store/case_index.h"

#include "store/durable_file.h"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <system_error>

#include <nlohmann/json.hpp>

namespace haustra::store {
namespace {

using nlohmann::json;

bool isKey(const std::string& hex) {
    return hex.size() == 64 && hex.find_first_not_of("0123456789abcdef") == std::string::npos;
}

bool isPlainFileName(const std::string& name) {
    return !name.empty() && name.size() < 256 && name[0] != '.' &&
           name.find_first_of(std::string_view("/\0", 2)) == std::string::npos;
}

const std::string* text(const json& object, const char* field) {
    const auto found = object.find(field);
    return found == object.end() ? nullptr : found->get_ptr<const json::string_t*>();
}

}  // namespace

Result<std::vector<ProductEntry>> readCaseIndex(const std::filesystem::path& caseFolder) {
    const std::filesystem::path file = caseFolder / caseIndexName;
    std::ifstream in(file, std::ios::binary);
    if (!in) {
        std::error_code error;
        if (!std::filesystem::exists(file, error) && !error) return std::vector<ProductEntry>{};
        return fail(ErrorKind::io, "cannot open", file.string());
    }
    const std::string content{std::istreambuf_iterator<char>(in), {}};
    const json index = json::parse(content, nullptr, false);
    const auto damaged = [&](const std::string& what) {
        return fail(ErrorKind::badInput,
                    "the case's index is damaged: " + what +
                        "; remove this file and prepare the case again from its series",
                    file.string());
    };
    if (!index.is_object()) return damaged("it is not a JSON object");
    const auto format = index.find("format");
    if (format == index.end() || *format != 1) {
        return fail(ErrorKind::unsupported, "the case's index is not of format 1", file.string());
    }
    const auto products = index.find("products");
    if (products == index.end() || !products->is_object()) return damaged("it lists no products");

    std::vector<ProductEntry> entries;
    for (const auto& [name, value] : products->items()) {
        const std::string* key = value.is_object() ? text(value, "key") : nullptr;
        const std::string* productFile = value.is_object() ? text(value, "file") : nullptr;
        if (!key || !isKey(*key) || !productFile || !isPlainFileName(*productFile)) {
            return damaged("its entry of " + name + " has no sound key and file");
        }
        entries.push_back({name, ProductKey{*key}, *productFile});
    }
    return entries;
}

Result<void> writeCaseIndex(const std::filesystem::path& caseFolder,
                            const std::vector<ProductEntry>& entries) {
    json products = json::object();
    for (const ProductEntry& entry : entries) {
        products[entry.product] = {{"key", entry.key.hex}, {"file", entry.file}};
    }
    const std::string content = json{{"format", 1}, {"products", products}}.dump(2) + "\n";
    return writeDurably(caseFolder, caseIndexName, {std::as_bytes(std::span(content))});
}

}  // namespace haustra::store
