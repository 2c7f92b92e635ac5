#include "store/case_index.h"

#include "core/durable_file.h"
#include "core/text_file.h"

#include <algorithm>

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

Result<CaseIndex> readCaseIndex(const std::filesystem::path& caseFolder) {
    const std::filesystem::path file = caseFolder / caseIndexName;
    auto content = readTextFile(file);
    if (!content && content.error().kind == ErrorKind::notFound) return CaseIndex{};
    const json index = json::parse(TRY(std::move(content)), nullptr, false);
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

    CaseIndex read;
    if (const auto scan = index.find("scan"); scan != index.end()) {
        const std::string* key = scan->is_object() ? text(*scan, "key") : nullptr;
        const std::string* study = scan->is_object() ? text(*scan, "study_uid") : nullptr;
        const std::string* series = scan->is_object() ? text(*scan, "series_uid") : nullptr;
        if (!key || !isKey(*key) || !study || !series)
            return damaged("it does not say which scan it is of");
        read.scan = ScanIdentity{ProductKey{*key}, *study, *series};
    }
    for (const auto& [name, value] : products->items()) {
        const std::string* key = value.is_object() ? text(value, "key") : nullptr;
        const std::string* productFile = value.is_object() ? text(value, "file") : nullptr;
        if (!key || !isKey(*key) || !productFile || !isPlainFileName(*productFile)) {
            return damaged("its entry of " + name + " has no sound key and file");
        }
        read.products.push_back({name, ProductKey{*key}, *productFile});
    }
    return read;
}

Result<void> writeCaseIndex(const std::filesystem::path& caseFolder, const CaseIndex& index) {
    json products = json::object();
    for (const ProductEntry& entry : index.products) {
        products[entry.product] = {{"key", entry.key.hex}, {"file", entry.file}};
    }
    json all{{"format", 1}, {"products", products}};
    if (const auto& scan = index.scan) {
        all["scan"] = {
            {"key", scan->key.hex}, {"study_uid", scan->studyUid}, {"series_uid", scan->seriesUid}};
    }
    return writeDurably(caseFolder / caseIndexName, all.dump(2) + "\n", 0640);
}

}  // namespace haustra::store
