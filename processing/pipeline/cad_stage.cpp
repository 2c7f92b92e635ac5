#include "cad/detect.h"
#include "core/printed_text.h"
#include "core/scan_coarseness.h"
#include "core/slice_steps.h"
#include "core/text_file.h"
#include "pipeline/colon_inputs.h"
#include "pipeline/product_attributes.h"
#include "pipeline/stages.h"
#include "store/sha256.h"

namespace haustra::pipeline {
namespace {

namespace product = store::product;

Result<std::string> modelText(const std::filesystem::path& file) {
    if (file.empty()) return std::string(cad::builtInModelText());
    return readTextFile(file);
}

Result<cad::CadModel> modelOf(const PrepareOptions& options, const std::string& text) {
    return cad::modelOfText(
        text, options.cadModel.empty() ? "built-in model" : options.cadModel.string());
}

}  // namespace

Result<void> checkCadModel(const PrepareOptions& options) {
    if (options.cadModel.empty()) return {};
    const std::string text = TRY(modelText(options.cadModel));
    TRY(modelOf(options, text));
    return {};
}

Result<ProductKey> detectPolyps(Preparation& preparation, const ProductKey& surfaceKey,
                                const ProductKey& centerlineKey,
                                const std::optional<ProductKey>& flatMapKey) {
    const StageMeter meter;
    const PrepareOptions& options = preparation.options();
    const std::string text = TRY(modelText(options.cadModel));
    const auto model = TRY(modelOf(options, text));
    const std::string hash = store::toHex(store::textDigest(text));
    const ProductKey key = store::makeKey(
        "cad", cad::detectionVersion, "model=" + hash,
        flatMapKey ? std::vector{*flatMapKey} : std::vector{surfaceKey, centerlineKey});
    StageCase stage = preparation.open("cad", key);
    return preparation.run(stage, meter, [&](const Progress& progress) -> Result<void> {
        ColonProducts products;
        products.quality = TRY(stage.holds(product::quality));
        products.cleansed = TRY(stage.holds(product::cleansed));
        products.flatMap = flatMapKey.has_value();
        const auto inputs = TRY(readColon(stage, products));
        cad::DetectOptions detection;
        detection.threads = options.threads;
        detection.progress = progress;
        Findings findings = cad::detectPolyps(inputs.colon(), model, detection);
        findings.model.sha256 = hash;
        std::optional<SourceSeries> series;
        if (TRY(stage.holds(product::source)))
            series = TRY(stage.readText(product::source).and_then([](const std::string& text) {
                return sourceSeriesOfJson(text);
            }));
        if (!flatMapKey)
            findings.warnings.push_back(
                "the colon was not flattened: the wall's texture was measured along other "
                "directions than detection has learnt from, and wall that is thick all around was "
                "not looked for");
        // What the path passes by may not have been looked at, or not be in the lumen at all.
        for (const std::string& line : piecesPassedBy(inputs.centerline, inputs.pieces))
            findings.warnings.insert(findings.warnings.begin(), "polyps may be missed: " + line);
        if (auto uneven = unevenStepsOf(inputs.ct, options.threads))
            findings.warnings.insert(findings.warnings.begin(), *std::move(uneven));
        if (auto coarse = coarsenessOf(inputs.ct.grid(), series ? &*series : nullptr))
            findings.warnings.insert(findings.warnings.begin(), *std::move(coarse));
        store::Attributes attributes{{"model", model.name},
                                     {"model-sha256", hash},
                                     {"findings", std::to_string(findings.findings.size())},
                                     {"candidates", std::to_string(findings.candidates.size())}};
        std::vector<std::string> notes{printed("%zu places may be polyps (%s, %s)",
                                               findings.findings.size(), model.name.c_str(),
                                               model.trainedOn.c_str())};
        for (const std::string& warning : findings.warnings)
            notes.push_back("warning: " + warning);
        setNotes(attributes, notes);
        return stage.publish(product::findings, findingsJson(findings), attributes);
    });
}

}  // namespace haustra::pipeline
