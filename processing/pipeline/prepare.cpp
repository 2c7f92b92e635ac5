#include "pipeline/prepare.h"

#include "cleansing/tissue_mixture.h"
#include "pipeline/read_inputs.h"
#include "pipeline/source_key.h"
#include "pipeline/stage_meter.h"
#include "topology/centerline_path.h"
#include "topology/distance_field.h"
#include "topology/lumen.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <new>
#include <optional>
#include <sstream>
#include <system_error>

namespace haustra::pipeline {
namespace {

using store::Attributes;
using store::ProductKey;

// Raise a stage's version whenever its products change for the same input and options.
constexpr int importVersion = 1;
constexpr int lumenVersion = 1;
constexpr int lumenMaskVersion = 1;
constexpr int distanceVersion = 1;
constexpr int centerlineVersion = 1;

// The shortest text that reads back as the same double.
std::string exactText(double value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

std::string exactText(glm::dvec3 v) {
    return exactText(v.x) + "," + exactText(v.y) + "," + exactText(v.z);
}

std::string exactText(const char* name, const std::vector<glm::dvec3>& points) {
    std::string text;
    for (const glm::dvec3& point : points)
        text += std::string(name) + "=" + exactText(point) + ";";
    return text;
}

std::string joinLines(const std::vector<std::string>& lines) {
    std::string text;
    for (const std::string& line : lines)
        text += text.empty() ? line : "\n" + line;
    return text;
}

// One call of prepare: the case it writes, and the scan, labels and distances as the stages hand
// them on. A stage that was reused hands on nothing; the next takes the product from the store.
class Preparation {
public:
    Preparation(store::Case target, const PrepareOptions& options)
        : case_(std::move(target)), options_(options) {}

    Result<PrepareReport> run();

private:
    struct Stage {
        std::string name, product;
        std::vector<std::string> outdated;  // products made from this one
    };

    Result<void> importScan();
    Result<void> takeMask();
    Result<void> findLumen();
    Result<void> measureDistance();
    Result<void> traceCenterline();

    template <class Make>
    Result<void> stage(const Stage& stage, const ProductKey& key, const StageMeter& meter,
                       Make make);
    bool reusable(const std::string& product, const ProductKey& key);
    bool wanted(const std::string& stage) const;
    Progress progressOf(const std::string& stage) const;
    void log(const std::string& line) const;
    Result<void> loadScan();
    Result<void> loadLabels();

    store::Case case_;
    const PrepareOptions& options_;
    PrepareReport report_;
    std::optional<ProductKey> ctKey_;
    ProductKey lumenKey_, distanceKey_;
    CtScan scan_;
    Volume<std::uint8_t> labels_;
    Volume<float> distanceMm_;
};

void Preparation::log(const std::string& line) const {
    if (options_.log) options_.log(line);
}

bool Preparation::wanted(const std::string& stage) const {
    const auto& names = stageNames();
    const auto last = std::find(names.begin(), names.end(), options_.until);
    return std::find(names.begin(), names.end(), stage) <= last;
}

Progress Preparation::progressOf(const std::string& stage) const {
    return [this, stage](double fraction) {
        if (options_.progress) options_.progress(stage, std::clamp(fraction, 0.0, 1.0));
    };
}

bool Preparation::reusable(const std::string& product, const ProductKey& key) {
    if (!case_.has(product, key)) return false;
    const auto sound = case_.verify(product);
    if (!sound) report_.notes.push_back(product + " is made again: " + describe(sound.error()));
    return bool(sound);
}

// Runs `make`, which publishes the stage's product, unless the store holds it.
template <class Make>
Result<void> Preparation::stage(const Stage& stage, const ProductKey& key, const StageMeter& meter,
                                Make make) {
    const Progress progress = progressOf(stage.name);
    const bool reused = reusable(stage.product, key);
    if (!reused) {
        progress(0.0);
        if (Result<void> made = make(progress, stage.outdated); !made) {
            if (made.error().place.empty()) made.error().place = stage.name;
            return made;
        }
    }
    progress(1.0);
    const auto attributes = case_.attributes(stage.product);
    if (!attributes) return tl::make_unexpected(attributes.error());
    if (const auto notes = attributes->find("notes"); notes != attributes->end()) {
        std::istringstream lines(notes->second);
        for (std::string line; std::getline(lines, line);) {
            report_.notes.push_back(stage.name + ": " + line);
        }
    }
    report_.stages.push_back({stage.name, reused, meter.wallSeconds(), meter.peakMemoryMib()});
    log(stage.name +
        (reused ? ": already done"
                : ": done in " + exactText(std::round(meter.wallSeconds() * 10) / 10) + " s"));
    return {};
}

Result<void> Preparation::importScan() {
    const StageMeter meter;
    const auto source = sourceKey(options_.series, options_.threads);
    if (!source) return tl::make_unexpected(source.error());
    const ProductKey key = store::makeKey("import", importVersion, options_.seriesUid, {*source});
    ctKey_ = key;
    return stage({"import", "ct", {"lumen", "distance", "centerline"}}, key, meter,
                 [&](const Progress& progress, const auto& outdated) -> Result<void> {
                     auto input =
                         readScan(options_.series, options_.seriesUid, options_.threads, progress);
                     if (!input) return tl::make_unexpected(input.error());
                     scan_ = std::move(input->scan);
                     Attributes attributes{{"position", toString(scan_.position)},
                                           {"images", std::to_string(input->images)}};
                     if (!input->notes.empty()) attributes["notes"] = joinLines(input->notes);
                     return case_.publishVolume("ct", key, scan_.hu, attributes, outdated);
                 });
}

Result<void> Preparation::loadScan() {
    if (!scan_.hu.empty()) return {};
    auto hu = case_.readVolume<std::int16_t>("ct");
    if (!hu) return tl::make_unexpected(hu.error());
    const auto attributes = case_.attributes("ct");
    if (!attributes) return tl::make_unexpected(attributes.error());
    const auto position = attributes->find("position");
    scan_ = {std::move(*hu), position == attributes->end()
                                 ? PatientPosition::unknown
                                 : patientPositionFromString(position->second)};
    return {};
}

Result<void> Preparation::takeMask() {
    const StageMeter meter;
    const auto mask = sourceKey(options_.lumenMask, options_.threads);
    if (!mask) return tl::make_unexpected(mask.error());
    std::vector<ProductKey> inputs{*mask};
    if (ctKey_) inputs.push_back(*ctKey_);
    lumenKey_ = store::makeKey("lumen-mask", lumenMaskVersion, "", inputs);
    return stage({"lumen", "lumen", {"distance", "centerline"}}, lumenKey_, meter,
                 [&](const Progress&, const auto& outdated) -> Result<void> {
                     if (ctKey_) {
                         if (auto loaded = loadScan(); !loaded) return loaded;
                     }
                     const Grid scanGrid = scan_.hu.grid();
                     auto input = readLumenMask(options_.lumenMask, ctKey_ ? &scanGrid : nullptr);
                     if (!input) return tl::make_unexpected(input.error());
                     labels_ = std::move(input->labels);
                     Attributes attributes{{"source", "mask"}};
                     if (!input->notes.empty()) attributes["notes"] = joinLines(input->notes);
                     return case_.publishVolume("lumen", lumenKey_, labels_, attributes, outdated);
                 });
}

Result<void> Preparation::findLumen() {
    const StageMeter meter;
    const std::string overruled =
        exactText("seed", options_.seedsMm) + exactText("exclude", options_.excludesMm);
    lumenKey_ = store::makeKey("lumen", lumenVersion, overruled, {*ctKey_});
    return stage({"lumen", "lumen", {"distance", "centerline"}}, lumenKey_, meter,
                 [&](const Progress& progress, const auto& outdated) -> Result<void> {
                     if (auto loaded = loadScan(); !loaded) return loaded;
                     const auto tissue = cleansing::fitTissueModel(scan_, options_.threads);
                     if (!tissue) return tl::make_unexpected(tissue.error());
                     auto lumen = topology::findLumen(
                         scan_, *tissue,
                         {options_.seedsMm, options_.excludesMm, options_.threads, progress});
                     if (!lumen) return tl::make_unexpected(lumen.error());
                     labels_ = std::move(lumen->labels);
                     Attributes attributes{{"source", "scan"},
                                           {"segments", std::to_string(lumen->segments.size())},
                                           {"gravity", exactText(lumen->gravity)},
                                           {"air-below-hu", exactText(tissue->airBelowHu)},
                                           {"tagged-above-hu", exactText(tissue->taggedAboveHu)}};
                     if (!lumen->notes.empty()) attributes["notes"] = joinLines(lumen->notes);
                     return case_.publishVolume("lumen", lumenKey_, labels_, attributes, outdated);
                 });
}

Result<void> Preparation::loadLabels() {
    if (!labels_.empty()) return {};
    auto labels = case_.readVolume<std::uint8_t>("lumen");
    if (!labels) return tl::make_unexpected(labels.error());
    labels_ = std::move(*labels);
    return {};
}

// The distance transform goes axis by axis, which needs axes at right angles.
Result<void> checkOrthogonal(const Grid& grid) {
    const glm::dmat3 axes(grid.patientFromVoxel);
    for (int a = 0; a < 3; ++a) {
        const int b = (a + 1) % 3;
        const double cosine =
            glm::dot(axes[a], axes[b]) / (glm::length(axes[a]) * glm::length(axes[b]));
        if (!(std::abs(cosine) <= 1e-3)) {
            return fail(ErrorKind::unsupported, "the lumen's voxel axes are not at right angles");
        }
    }
    return {};
}

Result<void> Preparation::measureDistance() {
    const StageMeter meter;
    distanceKey_ = store::makeKey("distance", distanceVersion, "", {lumenKey_});
    return stage({"distance", "distance", {"centerline"}}, distanceKey_, meter,
                 [&](const Progress&, const auto& outdated) -> Result<void> {
                     if (auto loaded = loadLabels(); !loaded) return loaded;
                     if (auto sound = checkOrthogonal(labels_.grid()); !sound) return sound;
                     distanceMm_ = topology::distanceToBoundaryMm(labels_, options_.threads);
                     return case_.publishVolume("distance", distanceKey_, distanceMm_, {},
                                                outdated);
                 });
}

Result<void> Preparation::traceCenterline() {
    const StageMeter meter;
    const ProductKey key =
        store::makeKey("centerline", centerlineVersion, "", {lumenKey_, distanceKey_});
    return stage({"centerline", "centerline", {}}, key, meter,
                 [&](const Progress& progress, const auto& outdated) -> Result<void> {
                     if (auto loaded = loadLabels(); !loaded) return loaded;
                     if (distanceMm_.empty()) {
                         auto distance = case_.readVolume<float>("distance");
                         if (!distance) return tl::make_unexpected(distance.error());
                         distanceMm_ = std::move(*distance);
                     }
                     topology::CenterlineOptions tracing;
                     tracing.threads = options_.threads;
                     tracing.progress = progress;
                     const auto traced = topology::traceCenterline(labels_, distanceMm_, tracing);
                     if (!traced) return tl::make_unexpected(traced.error());
                     Attributes attributes{{"length-mm", exactText(traced->centerline.lengthMm())}};
                     if (!traced->notes.empty()) attributes["notes"] = joinLines(traced->notes);
                     return case_.publishCenterline("centerline", key, traced->centerline,
                                                    attributes, outdated);
                 });
}

Result<PrepareReport> Preparation::run() {
    if (!options_.series.empty()) {
        if (auto done = importScan(); !done) return tl::make_unexpected(done.error());
    } else if (const auto published = case_.find("ct")) {
        ctKey_ = published->key;
    }
    if (wanted("lumen")) {
        auto done = options_.lumenMask.empty() ? findLumen() : takeMask();
        if (!done) return tl::make_unexpected(done.error());
        scan_ = {};
    }
    if (wanted("distance")) {
        if (auto done = measureDistance(); !done) return tl::make_unexpected(done.error());
    }
    if (wanted("centerline")) {
        if (auto done = traceCenterline(); !done) return tl::make_unexpected(done.error());
    }
    return std::move(report_);
}

}  // namespace

const std::vector<std::string>& stageNames() {
    static const std::vector<std::string> names{"import", "lumen", "distance", "centerline"};
    return names;
}

namespace {

// A case that was refused before its first product leaves no folder behind.
void removeIfEmpty(const std::filesystem::path& folder) {
    std::error_code ignored;
    for (const auto& entry : std::filesystem::directory_iterator(folder, ignored)) {
        if (entry.path().filename() != ".lock") return;
    }
    std::filesystem::remove(folder / ".lock", ignored);
    std::filesystem::remove(folder, ignored);
}

}  // namespace

Result<PrepareReport> prepare(const store::CaseStore& store, const std::string& caseName,
                              const PrepareOptions& options) {
    const auto& names = stageNames();
    if (!options.until.empty() &&
        std::find(names.begin(), names.end(), options.until) == names.end()) {
        return fail(ErrorKind::badInput, "there is no stage " + options.until);
    }
    if (options.series.empty() && options.lumenMask.empty()) {
        return fail(ErrorKind::badInput, "there is neither a series nor a mask to prepare");
    }
    for (const std::filesystem::path& source : {options.series, options.lumenMask}) {
        std::error_code ignored;
        if (!source.empty() && !std::filesystem::exists(source, ignored)) {
            return fail(ErrorKind::notFound, "there is no such file or folder", source.string());
        }
    }
    auto target = store.createCase(caseName);
    if (!target) return tl::make_unexpected(target.error());
    const store::Case held = *target;  // keeps the lock until the folder is tidied
    try {
        auto report = Preparation(std::move(*target), options).run();
        if (!report) removeIfEmpty(held.folder());
        return report;
    } catch (const std::bad_alloc&) {
        return fail(ErrorKind::io, "there is not enough memory", "prepare");
    }
}

}  // namespace haustra::pipeline
