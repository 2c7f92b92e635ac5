#include "pipeline/preparation.h"

#include "pipeline/product_attributes.h"
#include "pipeline/scan_identity.h"

#include <algorithm>
#include <cmath>
#include <iomanip>
#include <sstream>
#include <utility>

namespace haustra::pipeline {

namespace product = store::product;

Preparation::Preparation(store::Case target, const PrepareOptions& options,
                         organs::OrganProfile organ, std::string studyUid)
    : target_(std::move(target)),
      options_(options),
      organ_(std::move(organ)),
      studyUid_(std::move(studyUid)) {
    report_.caseName = target_.name();
}

Result<void> Preparation::bind(store::ScanIdentity scan,
                               const std::optional<store::ProductKey>& importKey) {
    const auto refuse = [&](const std::string& why) {
        return fail(ErrorKind::badInput, why, "case " + target_.name());
    };
    if (!studyUid_.empty() && !scan.studyUid.empty() && studyUid_ != scan.studyUid)
        return refuse("this series is of another study than the case's other scans");
    const auto held = TRY(target_.scan());
    // A case of before cases were bound, and the series that it was made from.
    const bool adopted = held && importKey && held->key == *importKey;
    if (held && (adopted || sameScan(*held, scan))) {
        scan.key = held->key;
        return target_.bind(scan);
    }
    const auto products = TRY(target_.products());
    if (!products.empty() && !options_.replace) {
        const bool ofStudy = held && !scan.studyUid.empty() && held->studyUid == scan.studyUid;
        return refuse(
            std::string(ofStudy ? "the case holds another series of the same study: prepare this "
                                  "one as a scan of its own (--scan prone)"
                                : "the case holds another scan: choose another name (--case)") +
            ", or let it take that one's place (--replace)");
    }
    return target_.bind(scan);
}

bool Preparation::wanted(const std::string& stage) const {
    const auto& names = stageNames();
    const auto last = std::find(names.begin(), names.end(), options_.until);
    return std::find(names.begin(), names.end(), stage) <= last;
}

std::optional<store::ProductKey> Preparation::keyOf(const std::string& product) const {
    const auto entry = target_.find(product);
    return entry ? std::optional(entry->key) : std::nullopt;
}

Result<ColonEdits> Preparation::takeEdits() {
    ColonEdits edits{options_.seedsMm, options_.excludesMm, options_.cuts, options_.joins};
    if (edits.empty() && !options_.forgetEdits) {
        if (!target_.find(product::edits)) return edits;
        const auto text = TRY(target_.readText(product::edits));
        auto kept = editsFromJson(text);
        if (kept && !kept->empty())
            note("segmentation: what an earlier call said of the colon stands (edits)");
        return kept;
    }
    if (edits.empty() && !target_.find(product::edits)) return edits;
    const std::string text = editsJson(edits);
    const auto key = store::makeKey("edits", 1, text, {});
    return target_.publishText(product::edits, key, text).map([&] { return edits; });
}

bool Preparation::reusable(const StageCase& stage) {
    for (const std::string& product : stage.products()) {
        if (!target_.has(product, stage.key())) return false;
    }
    bool all = true;
    for (const std::string& product : stage.products()) {
        if (const auto sound = target_.verify(product); !sound) {
            report_.notes.push_back(product + " is made again: " + describe(sound.error()));
            all = false;
        }
    }
    return all;
}

Result<store::ProductKey> Preparation::run(
    const StageCase& stage, const StageMeter& meter,
    const std::function<Result<void>(const Progress&)>& make) {
    const Progress progress = [this, &stage](double fraction) {
        if (options_.progress) options_.progress(stage.name(), std::clamp(fraction, 0.0, 1.0));
    };
    const bool reused = reusable(stage);
    if (!reused) {
        progress(0.0);
        if (Result<void> made = make(progress); !made) {
            std::string& place = made.error().place;
            if (place.find('/') == std::string::npos)
                place = "case " + target_.name() + ", " + (place.empty() ? stage.name() : place);
            return tl::make_unexpected(made.error());
        }
    }
    progress(1.0);
    for (const std::string& product : stage.products()) {
        const auto attributes = TRY(target_.attributes(product));
        for (const std::string& note : notesOf(attributes))
            report_.notes.push_back(stage.name() + ": " + note);
    }
    report_.stages.push_back({stage.name(),
                              reused,
                              {stage.read().begin(), stage.read().end()},
                              meter.wallSeconds(),
                              meter.besideSeconds(),
                              meter.peakMemoryMib()});
    if (options_.log) {
        options_.log(
            stage.name() +
            (reused ? ": already done"
                    : ": done in " + exactText(std::round(meter.wallSeconds() * 10) / 10) + " s"));
    }
    return stage.key();
}

Result<void> Preparation::noteBridges() {
    const auto centerline = TRY(target_.readCenterline(product::centerline));
    report_.bridges = bridgesOf(centerline);
    for (const Bridge& bridge : report_.bridges) {
        std::ostringstream line;
        line << std::fixed << std::setprecision(0) << "centerline: a bridge of "
             << bridge.lengthMm() << " mm, from " << bridge.fromArcMm << " to " << bridge.toArcMm
             << " mm along the path: the colon is collapsed or filled there, and no wall is seen";
        note(line.str());
    }
    return {};
}

Result<void> Preparation::noteBridgedWall() {
    const auto surface = TRY(target_.readMesh(product::surface));
    const auto labels = TRY(target_.readVolume<std::uint8_t>(product::lumen));
    const auto bridged = bridgedTriangles(surface, labels);
    for (std::size_t n = 0; n < bridged.size(); ++n) {
        if (bridged[n]) report_.bridgedMm2 += triangleAreaMm2(surface, surface.triangles[n]);
    }
    if (report_.bridgedMm2 > 0.0) {
        note("surface: " + exactText(std::round(report_.bridgedMm2)) +
             " mm2 enclose bridges; all views hatch them, and they are no wall to be seen");
    }
    return {};
}

}  // namespace haustra::pipeline
