#include "pipeline/stage_case.h"

#include <algorithm>

namespace haustra::pipeline {
namespace {

using Names = std::vector<std::string>;

bool contains(const Names& names, const std::string& name) {
    return std::ranges::find(names, name) != names.end();
}

}  // namespace

StageCase::StageCase(store::Case& target, std::string stage, store::ProductKey key,
                     const Names& without, const store::Catalogue& catalogue)
    : target_(target),
      catalogue_(catalogue),
      stage_(std::move(stage)),
      key_(std::move(key)),
      products_(catalogue.madeBy(stage_)),
      sources_(catalogue.readBy(stage_)) {
    std::erase_if(products_,
                  [&](const std::string& product) { return contains(without, product); });
}

Result<void> StageCase::admit(const std::string& product) {
    if (!contains(sources_, product)) {
        return fail(ErrorKind::wrongState,
                    "it reads " + product + ", which is no parent of what it makes", stage_);
    }
    read_.insert(product);
    return {};
}

Result<Names> StageCase::outdatedBy(const std::string& product, store::Content content,
                                    const Names& alsoOutdated) const {
    if (!contains(products_, product))
        return fail(ErrorKind::wrongState, "it publishes " + product + ", which it does not make",
                    stage_);
    if (catalogue_.find(product)->content != content)
        return fail(ErrorKind::wrongState,
                    "it publishes " + product + " as " + store::kindOf(content)->description,
                    stage_);
    Names outdated = alsoOutdated;
    for (const std::string& made : catalogue_.madeBy(stage_)) {
        if (made != product && target_.has(made, key_)) continue;  // this run published it
        const Names dependents = catalogue_.madeFrom(made);
        outdated.push_back(made);
        outdated.insert(outdated.end(), dependents.begin(), dependents.end());
    }
    return outdated;
}

Result<bool> StageCase::holds(const std::string& product) {
    return admit(product).map([&] { return target_.find(product).has_value(); });
}

Result<Centerline> StageCase::readCenterline(const std::string& product) {
    return admit(product).and_then([&] { return target_.readCenterline(product); });
}

Result<TriMesh> StageCase::readMesh(const std::string& product) {
    return admit(product).and_then([&] { return target_.readMesh(product); });
}

Result<FlatMap> StageCase::readFlatMap(const std::string& product) {
    return admit(product).and_then([&] { return target_.readFlatMap(product); });
}

Result<std::string> StageCase::readText(const std::string& product) {
    return admit(product).and_then([&] { return target_.readText(product); });
}

Result<store::Attributes> StageCase::attributes(const std::string& product) {
    return admit(product).and_then([&] { return target_.attributes(product); });
}

Result<CtScan> StageCase::readScan() {
    auto hu = TRY(readVolume<std::int16_t>(store::product::ct));
    const auto attributes = TRY(this->attributes(store::product::ct));
    const auto position = attributes.find("position");
    return CtScan{std::move(hu), position == attributes.end()
                                     ? PatientPosition::unknown
                                     : patientPositionFromString(position->second)};
}

Result<void> StageCase::publish(const std::string& product, const Centerline& centerline,
                                const store::Attributes& attributes) {
    return outdatedBy(product, store::Content::centerline).and_then([&](const Names& outdated) {
        return target_.publishCenterline(product, key_, centerline, attributes, outdated);
    });
}

Result<void> StageCase::publish(const std::string& product, const TriMesh& mesh,
                                const store::Attributes& attributes) {
    return outdatedBy(product, store::Content::mesh).and_then([&](const Names& outdated) {
        return target_.publishMesh(product, key_, mesh, attributes, outdated);
    });
}

Result<void> StageCase::publish(const std::string& product, const FlatMap& map,
                                const store::Attributes& attributes) {
    return outdatedBy(product, store::Content::flatMap).and_then([&](const Names& outdated) {
        return target_.publishFlatMap(product, key_, map, attributes, outdated);
    });
}

Result<void> StageCase::publish(const std::string& product, const std::string& text,
                                const store::Attributes& attributes) {
    return outdatedBy(product, store::Content::text).and_then([&](const Names& outdated) {
        return target_.publishText(product, key_, text, attributes, outdated);
    });
}

}  // namespace haustra::pipeline
