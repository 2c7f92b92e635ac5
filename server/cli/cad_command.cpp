// haustra cad train, calibrate, evaluate: detection is learnt from cases whose truth is known,
// calibrated on others, and judged on others again.
#include "cad/biopsy_transfer.h"
#include "cad/candidate_table.h"
#include "cad/evaluate.h"
#include "cad/examined_colon.h"
#include "cad/train.h"
#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/froc_picture.h"
#include "cli/number_range.h"
#include "cli/progress_bar.h"
#include "cli/provenance.h"
#include "cli/text_files.h"
#include "core/durable_file.h"
#include "core/text_file.h"
#include "pictures/picture_file.h"
#include "pipeline/colon_inputs.h"
#include "store/case_store.h"
#include "store/products.h"
#include "store/sha256.h"

#include <algorithm>
#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace haustra::cli {
namespace {

namespace fs = std::filesystem;
namespace product = store::product;

constexpr const char* builtIn = "built-in";

struct CadArguments {
    fs::path store, truth, model, texture, from = builtIn, report, froc;
    std::optional<fs::path> kept;  // the folder of candidates
    std::vector<std::string> cases, without;
    std::string name, description;
    double falsePositives = 2.0;
    int threads = 0;
};

struct Truth {
    std::string file, text;  // the lesions'; the text with that of the mimics
    std::vector<cad::TrueLesion> lesions, mimics;
};

// Of the case's own folder of the truths, which may be a phantom's: growths.json, or polyps.json.
Result<Truth> readTruth(const fs::path& truths, const std::string& name) {
    // None where there is none.
    const auto read = [](const fs::path& file) -> Result<std::optional<std::string>> {
        auto text = readTextFile(file);
        if (text) return *std::move(text);
        if (text.error().kind == ErrorKind::notFound) return std::nullopt;
        return tl::make_unexpected(text.error());
    };
    for (const fs::path& folder : {truths / name / "truth", truths / name}) {
        for (const char* file : {"growths.json", "polyps.json"}) {
            auto text = TRY(read(folder / file));
            if (!text) continue;
            Truth truth{(folder / file).string(), *std::move(text), {}, {}};
            truth.lesions = TRY(cad::truthOfJson(truth.text, truth.file));
            // What else a false finding may be on.
            if (const auto structure = TRY(read(folder / "structure.json"))) {
                truth.mimics =
                    TRY(cad::mimicsOfJson(*structure, (folder / "structure.json").string()));
                truth.text += *structure;
            }
            return truth;
        }
    }
    return fail(ErrorKind::notFound, "there is no truth/growths.json or truth/polyps.json",
                (truths / name).string());
}

// What changes a case's evidence, and with it the candidates and how texture is learnt.
constexpr std::array<std::string_view, 3> evidenceParts{"automatic-transfer", "pca", "cleansing"};
constexpr std::array<std::string_view, 3> otherParts{"texture", "shape", "past"};
constexpr std::string_view featurePart = "feature:";

bool isWithout(const CadArguments& arguments, std::string_view part) {
    return std::find(arguments.without.begin(), arguments.without.end(), part) !=
           arguments.without.end();
}

std::string checkPart(const std::string& part) {
    if (std::ranges::count(evidenceParts, part) || std::ranges::count(otherParts, part)) return {};
    const bool named = part.starts_with(featurePart) && part.size() > featurePart.size();
    const std::string prefix = named ? part.substr(featurePart.size()) : "";
    if (named && std::any_of(cad::featureNames.begin(), cad::featureNames.end(),
                             [&](std::string_view name) { return name.starts_with(prefix); }))
        return {};
    return "detection has no part \"" + part + "\" to leave out";
}

// The parts of a case's evidence that are left out: its candidates are others.
std::string variantOf(const CadArguments& arguments) {
    std::string variant;
    for (const std::string_view part : evidenceParts)
        if (isWithout(arguments, part)) variant += std::string(part) + ' ';
    return variant;
}

struct LoadedCase {
    store::Case source;
    std::vector<cad::TrueLesion> truth;
    std::string truthMark;  // digest of the truth's text
    std::string ct;         // key of its scan's volume
    std::string prepared;   // keys of its last products before detection
    // As a model remembers it: the scan under whatever case it lies, and its study, so that
    // another scan of the patient's visit counts as seen, too (empty where there is no UID).
    std::string scanMark, studyMark;
};

// The beginning of a key: enough to know it again by.
std::string markOf(const std::string& hex) {
    return hex.substr(0, 16);
}

Result<LoadedCase> load(const store::CaseStore& store, const CadArguments& arguments,
                        const std::string& name) {
    LoadedCase loaded{TRY(store.openCase(name)), {}, {}, {}, {}, {}, {}};
    const auto key = [&](const char* wanted) -> Result<std::string> {
        const auto entry = loaded.source.find(wanted);
        if (!entry)
            return fail(ErrorKind::notFound, std::string("the case has no ") + wanted, name);
        return entry->key.hex;
    };
    const Truth truth = TRY(readTruth(arguments.truth, name));
    loaded.truth = truth.lesions;
    loaded.truth.insert(loaded.truth.end(), truth.mimics.begin(), truth.mimics.end());
    loaded.truthMark = store::toHex(store::textDigest(truth.text));
    loaded.ct = TRY(key(product::ct));
    const auto identity = TRY(loaded.source.scan());
    loaded.scanMark = markOf(identity ? identity->key.hex : loaded.ct);
    if (identity && !identity->studyUid.empty())
        loaded.studyMark = markOf(store::toHex(store::textDigest("study " + identity->studyUid)));
    const Volume<std::int16_t> scan = TRY(loaded.source.readVolume<std::int16_t>(product::ct));
    for (const cad::TrueLesion& lesion : truth.lesions) {
        if (scan.grid().contains(
                glm::ivec3(glm::floor(scan.grid().voxelFromPatientPoint(lesion.positionMm) + 0.5))))
            continue;
        const glm::dvec3 at = lesion.positionMm;
        return fail(ErrorKind::badInput,
                    fmt::format("the truth has something at ({:.0f}, {:.0f}, {:.0f}) mm, outside "
                                "the scan of case {}: is it another scan's?",
                                at.x, at.y, at.z, name),
                    truth.file);
    }
    loaded.prepared = loaded.source.find(product::flatMap)
                          ? TRY(key(product::flatMap))
                          : TRY(key(product::surface)) + ' ' + TRY(key(product::centerline));
    return loaded;
}

// What a model remembers of a case that it has learnt from.
std::vector<std::string> remembered(const LoadedCase& loaded) {
    std::vector<std::string> marks{loaded.scanMark};
    if (!loaded.studyMark.empty()) marks.push_back(loaded.studyMark);
    return marks;
}

// Whether the model has learnt from this scan or from another one of its study. Models up to
// phantoms-11 remember the volumes' keys, and so do those that are calibrated from them.
bool hasSeen(const cad::CadModel& model, const LoadedCase& loaded) {
    const auto has = [&](const std::string& mark) {
        return !mark.empty() &&
               std::ranges::find(model.trainingScans, mark) != model.trainingScans.end();
    };
    return has(loaded.scanMark) || has(loaded.studyMark) || has(markOf(loaded.ct));
}

void checkArguments(const CadArguments& arguments) {
    if (isWithout(arguments, "texture") &&
        (isWithout(arguments, "shape") || isWithout(arguments, "past")))
        throw CLI::ValidationError("--without",
                                   "without texture and shape there are no candidates");
    // That model has learnt its texture already.
    for (const std::string_view part : evidenceParts)
        if (!arguments.texture.empty() && isWithout(arguments, part))
            throw CLI::ValidationError(
                "--texture", fmt::format("a model's texture cannot be taken without {}", part));
    std::set<std::string> seen;
    for (const std::string& name : arguments.cases)
        if (!seen.insert(name).second)
            throw CLI::ValidationError("CASES", "the case is given twice: " + name);
}

// The cases, each with a scan of its own: one that is given twice would count twice, and its
// copies teach and judge each other.
Result<std::vector<LoadedCase>> loadCases(const store::CaseStore& store,
                                          const CadArguments& arguments) {
    std::vector<LoadedCase> loaded;
    std::map<std::string, std::string> caseOfScan;
    for (const std::string& name : arguments.cases) {
        loaded.push_back(TRY(load(store, arguments, name)));
        const LoadedCase& last = loaded.back();
        const auto [first, isNew] = caseOfScan.emplace(last.scanMark, name);
        if (!isNew)
            return fail(ErrorKind::badInput, "the case has the same scan as case " + first->second,
                        name);
    }
    return loaded;
}

Result<void> checkFolderOfCandidates(const CadArguments& arguments) {
    return arguments.kept ? checkOutputFolder(*arguments.kept) : Result<void>();
}

Result<void> makeFolderOfCandidates(const CadArguments& arguments) {
    if (!arguments.kept) return {};
    std::error_code error;
    fs::create_directories(*arguments.kept, error);
    if (error) return fail(ErrorKind::io, error.message(), arguments.kept->string());
    return {};
}

Result<pipeline::ColonInputs> readInputs(const LoadedCase& loaded, const CadArguments& arguments) {
    const bool cleansed =
        loaded.source.find(product::cleansed).has_value() && !isWithout(arguments, "cleansing");
    return pipeline::readColon(loaded.source,
                               {loaded.source.find(product::quality).has_value(), cleansed,
                                loaded.source.find(product::flatMap).has_value()});
}

cad::EvidenceOptions evidenceOptions(const CadArguments& arguments) {
    cad::EvidenceOptions options;
    options.threads = arguments.threads;
    if (isWithout(arguments, "automatic-transfer"))
        options.transferFunction = cad::fixedBiopsyTransfer();
    return options;
}

// All candidates of a case, which are kept for the next time where --candidates says. Where they
// are not, and are weighed by their own features, only what `model` finds worth it is looked at
// again at other levels.
Result<std::vector<cad::Candidate>> candidatesOf(const LoadedCase& loaded,
                                                 const CadArguments& arguments,
                                                 const cad::TextureModel& texture,
                                                 const cad::CadModel* model) {
    fs::path file;
    if (arguments.kept) {
        const std::string key = store::toHex(
            store::textDigest(fmt::format("{} {} {} {}", cad::detectionVersion, loaded.prepared,
                                          variantOf(arguments), cad::textureText(texture))));
        file = *arguments.kept / fmt::format("{}.{}.json", loaded.source.name(), key.substr(0, 16));
        std::error_code ignored;
        if (fs::exists(file, ignored)) {
            const auto text = TRY(readTextFile(file));
            return cad::candidatesOfTable(text, file.string());
        }
    }
    const auto inputs = TRY(readInputs(loaded, arguments));
    const cad::ExaminedColon examined(inputs.colon(), evidenceOptions(arguments));
    cad::DetectOptions options;
    options.threads = arguments.threads;
    const bool own = std::ranges::none_of(
        arguments.without, [](const std::string& part) { return part.starts_with(featurePart); });
    auto candidates = cad::findCandidates(examined.colon(), examined.evidence(), &texture, options,
                                          file.empty() && own ? model : nullptr);
    if (!file.empty()) TRY(writeDurably(file, cad::candidateTable(candidates)));
    return candidates;
}

bool usesClassifier(const CadArguments& arguments) {
    return !isWithout(arguments, "past");
}

// Leaves out what some generators found alone, and features as if nobody had measured them.
void leaveOut(std::vector<cad::Candidate>& candidates, const CadArguments& arguments) {
    const bool texture = !isWithout(arguments, "texture"),
               shape = !isWithout(arguments, "shape") && usesClassifier(arguments);
    // Those of other levels go with the candidates that they stand beside.
    std::vector<std::int32_t> numberOf(candidates.size(), -1);
    std::vector<cad::Candidate> left;
    for (std::size_t n = 0; n < candidates.size(); ++n) {
        cad::Candidate& candidate = candidates[n];
        if (!(candidate.lesion.patch.by == cad::Generator::texture ? texture : shape)) continue;
        if (candidate.levelOf >= 0) candidate.levelOf = numberOf[std::size_t(candidate.levelOf)];
        numberOf[n] = std::int32_t(left.size());
        left.push_back(std::move(candidate));
    }
    candidates = std::move(left);
    for (const std::string& part : arguments.without) {
        if (!part.starts_with(featurePart)) continue;
        const std::string prefix = part.substr(featurePart.size());
        for (std::size_t n = 0; n < cad::featureNames.size(); ++n)
            if (cad::featureNames[n].starts_with(prefix))
                for (cad::Candidate& candidate : candidates)
                    candidate.features[n] = 0.0f;
    }
}

Result<cad::CadModel> builtInModel() {
    return cad::modelOfText(cad::builtInModelText(), "built-in model");
}

Result<cad::CadModel> readModel(const fs::path& file) {
    if (file == builtIn) return builtInModel();
    const auto text = TRY(readTextFile(file));
    return cad::modelOfText(text, file.string());
}

// What the cases' polyps look like in the electronic biopsy, which is kept as candidates are.
Result<cad::TextureModel> learnTexture(const std::vector<LoadedCase>& cases,
                                       const CadArguments& arguments, ProgressBar& bar) {
    fs::path file;
    if (arguments.kept) {
        std::string key = fmt::format("{} {}", cad::detectionVersion, variantOf(arguments));
        for (const LoadedCase& each : cases)
            key += each.prepared + ' ' + each.truthMark + ' ';
        file = *arguments.kept /
               fmt::format("texture.{}.json", store::toHex(store::textDigest(key)).substr(0, 16));
        std::error_code ignored;
        if (fs::exists(file, ignored)) {
            const auto text = TRY(readTextFile(file));
            return cad::textureOfText(text, file.string());
        }
    }
    std::vector<cad::TextureVector> walls, polyps;
    for (std::size_t n = 0; n < cases.size(); ++n) {
        bar.show("texture", double(n) / double(cases.size()));
        const auto inputs = TRY(readInputs(cases[n], arguments));
        const cad::ExaminedColon examined(inputs.colon(), evidenceOptions(arguments));
        const auto examples =
            cad::textureExamples(examined.evidence(), examined.colon().flat, cases[n].truth);
        walls.insert(walls.end(), examples.all.begin(), examples.all.end());
        polyps.insert(polyps.end(), examples.polyps.begin(), examples.polyps.end());
    }
    if (polyps.empty())
        return fail(ErrorKind::badInput, "no polyp of the cases lies on a wall that was found",
                    arguments.truth.string());
    const std::string text =
        cad::textureText(cad::learnTexture(walls, polyps, !isWithout(arguments, "pca")));
    if (!file.empty()) TRY(writeDurably(file, text));
    return cad::textureOfText(text, "texture");  // as it is when it is kept
}

void remember(const std::string& mark, std::vector<std::string>& marks) {
    if (std::ranges::find(marks, mark) == marks.end()) marks.push_back(mark);
}

void rememberAll(const std::vector<LoadedCase>& cases, std::vector<std::string>& marks) {
    for (const LoadedCase& each : cases)
        for (const std::string& mark : remembered(each))
            remember(mark, marks);
}

Result<void> checkUnseen(const cad::CadModel& model, const std::vector<LoadedCase>& cases,
                         const char* what) {
    for (const LoadedCase& each : cases)
        if (hasSeen(model, each))
            return fail(ErrorKind::badInput,
                        fmt::format("the model has learnt from this case's scan, or from another "
                                    "one of its study, or was calibrated on it, so it cannot be "
                                    "{} it",
                                    what),
                        each.source.name());
    return {};
}

// What would else be told after hours of measuring.
Result<void> checkTeaching(const std::vector<LoadedCase>& cases, const CadArguments& arguments) {
    if (std::ranges::none_of(cases, [](const LoadedCase& each) {
            return std::ranges::any_of(each.truth,
                                       [](const auto& lesion) { return lesion.neoplastic; });
        }))
        return fail(ErrorKind::badInput, "the cases hold no polyp", arguments.truth.string());
    return {};
}

void sayUnflattened(const std::vector<LoadedCase>& cases, ProgressBar& bar) {
    for (const LoadedCase& each : cases)
        if (!each.source.find(product::flatMap))
            bar.say(
                fmt::format("{}: warning: it is not flattened: texture was measured along the "
                            "scan's axis in place of the colon's",
                            each.source.name()));
}

// Places in RAS in place of LPS, or those of another scan, would otherwise read as a detector that
// finds nothing.
void sayTruthElsewhere(const LoadedCase& loaded, const std::vector<cad::Candidate>& candidates,
                       ProgressBar& bar) {
    constexpr double farMm = 20.0;
    const auto isNear = [&](const cad::TrueLesion& lesion) {
        return std::ranges::any_of(candidates, [&](const cad::Candidate& each) {
            return lesion.distanceMm(each.lesion.centerMm) < farMm;
        });
    };
    std::size_t polyps = 0;
    for (const cad::TrueLesion& lesion : loaded.truth) {
        if (lesion.isPolyp() != true) continue;
        if (isNear(lesion)) return;
        ++polyps;
    }
    if (polyps > 0)
        bar.say(
            fmt::format("{}: warning: not one of its truth's {} polyps lies within {:g} mm of "
                        "any place that may be one: is that the truth of this scan, with "
                        "places in DICOM's coordinates (LPS)?",
                        loaded.source.name(), polyps, farMm));
}

// Cases of one study are of one patient, and are left out together.
Result<void> checkStudies(const std::vector<LoadedCase>& cases) {
    std::set<std::string> named;
    std::size_t studies = 0;
    for (const LoadedCase& each : cases)
        studies += each.studyMark.empty() || named.insert(each.studyMark).second;
    if (studies >= std::size_t(cad::trainingFolds)) return {};
    return fail(ErrorKind::badInput,
                fmt::format("the {} cases are of {} studies; training takes {}, which are left out "
                            "in turns",
                            cases.size(), studies, cad::trainingFolds));
}

Result<std::vector<cad::TrainingCase>> examplesOf(const std::vector<LoadedCase>& loaded,
                                                  const CadArguments& arguments,
                                                  const cad::TextureModel& texture,
                                                  const cad::CadModel* model, ProgressBar& bar) {
    std::vector<cad::TrainingCase> cases;
    for (std::size_t n = 0; n < loaded.size(); ++n) {
        bar.show("candidates", double(n) / double(loaded.size()));
        auto candidates = TRY(candidatesOf(loaded[n], arguments, texture, model));
        sayTruthElsewhere(loaded[n], candidates, bar);
        leaveOut(candidates, arguments);
        cases.push_back({arguments.cases[n], loaded[n].truth,
                         cad::examplesOf(candidates, loaded[n].truth), loaded[n].studyMark});
    }
    return cases;
}

void sayCurve(const char* what, const std::vector<cad::EvaluatedCase>& cases,
              const cad::CadModel& model, ProgressBar& bar) {
    std::vector<const cad::EvaluatedCase*> every;
    for (const cad::EvaluatedCase& each : cases)
        every.push_back(&each);
    for (const std::string_view note : frocNotes)
        bar.say(std::string(note));
    for (const cad::FrocPoint& point : cad::frocCurve(every))
        bar.say(
            fmt::format("{}: {:.2f} false positives a scan, {:.1f} % of polyps from 6 mm "
                        "({:.1f} to {:.1f})",
                        what, point.falsePositives, 100.0 * point.sensitivity, 100.0 * point.low,
                        100.0 * point.high));
    bar.say(fmt::format("operating point {:.3f}", model.operatingPoint));
}

Result<void> runTrain(const CadArguments& arguments) {
    checkArguments(arguments);
    TRY(checkOutputFile(arguments.model));
    TRY(checkFolderOfCandidates(arguments));
    if (int(arguments.cases.size()) < cad::trainingFolds)
        throw CLI::ValidationError(
            "CASES", fmt::format("training takes cases of at least {} studies: as many parts of "
                                 "them are left out in turns, to see what learning from the others "
                                 "is worth",
                                 cad::trainingFolds));
    cad::TrainOptions options;
    const auto store = TRY(store::CaseStore::open(arguments.store, false));
    std::optional<cad::CadModel> textureFrom;
    if (!arguments.texture.empty()) textureFrom = TRY(readModel(arguments.texture));
    ProgressBar bar;
    store::Sha256 hash;
    const std::vector<LoadedCase> loaded = TRY(loadCases(store, arguments));
    TRY(checkStudies(loaded));
    TRY(checkTeaching(loaded, arguments));
    sayUnflattened(loaded, bar);
    for (const LoadedCase& each : loaded)
        hash.addWithLength(each.ct);
    rememberAll(loaded, options.trainingScans);
    TRY(makeFolderOfCandidates(arguments));
    // Colours first: what candidates texture gives depends on what all cases look like.
    cad::TextureModel texture;
    if (textureFrom) {
        // What it has seen is as little unseen as the cases.
        texture = textureFrom->texture;
        options.textureFrom =
            textureFrom->textureFrom.empty() ? textureFrom->name : textureFrom->textureFrom;
        for (const std::string& mark : textureFrom->trainingScans)
            remember(mark, options.trainingScans);
    } else {
        texture = TRY(learnTexture(loaded, arguments, bar));
    }
    bar.say(fmt::format("texture: {} components hold {:.1f} % of the variance; T {:.3f}",
                        texture.count(), 100.0 * texture.varianceShare, texture.threshold));
    const auto cases = TRY(examplesOf(loaded, arguments, texture, nullptr, bar));
    options.name = arguments.name.empty() ? "cases" : arguments.name;
    options.trainedOn =
        arguments.description.empty() ? "cases that somebody chose" : arguments.description;
    options.trainingSha256 = store::toHex(hash.finish());
    options.falsePositives = arguments.falsePositives;
    options.threads = arguments.threads;
    bar.show("trees and networks", 0.0);
    const auto trained = TRY(cad::trainModel(texture, cases, options));
    sayCurve("cross-validation by study, of texture learnt from all", trained.crossValidated,
             trained.model, bar);
    return writeDurably(arguments.model, cad::modelText(trained.model));
}

Result<void> runCalibrate(const CadArguments& arguments) {
    checkArguments(arguments);
    if (!usesClassifier(arguments))
        throw CLI::ValidationError("--without",
                                   "past leaves out the classifier, which is what is calibrated");
    TRY(checkOutputFile(arguments.model));
    TRY(checkFolderOfCandidates(arguments));
    const auto store = TRY(store::CaseStore::open(arguments.store, false));
    cad::CadModel model = TRY(readModel(arguments.from));
    const std::vector<LoadedCase> loaded = TRY(loadCases(store, arguments));
    TRY(checkUnseen(model, loaded, "calibrated on"));
    TRY(checkTeaching(loaded, arguments));
    model.name = arguments.name.empty() ? model.name + "-calibrated" : arguments.name;
    model.trainedOn = arguments.description.empty()
                          ? fmt::format("{}; calibrated on {} other case{}", model.trainedOn,
                                        loaded.size(), loaded.size() == 1 ? "" : "s")
                          : arguments.description;
    const auto tooLong = [&](const char* what, const char* option) {
        return fail(ErrorKind::badInput,
                    fmt::format("the calibrated model's {} would be too long; give one by {}", what,
                                option),
                    arguments.from.string());
    };
    if (!cad::isModelLine(model.name, cad::longestModelName)) return tooLong("name", "--name");
    if (!cad::isModelLine(model.trainedOn, cad::longestModelDescription))
        return tooLong("description", "--description");
    TRY(makeFolderOfCandidates(arguments));
    ProgressBar bar;
    sayUnflattened(loaded, bar);
    const auto cases = TRY(examplesOf(loaded, arguments, model.texture, &model, bar));
    const auto told = TRY(cad::calibrate(model, cases, arguments.falsePositives));
    // What it must not be judged by now.
    store::Sha256 hash;
    hash.addWithLength(model.trainingSha256);
    for (const LoadedCase& each : loaded)
        hash.addWithLength(each.ct);
    model.trainingSha256 = store::toHex(hash.finish());
    rememberAll(loaded, model.trainingScans);
    sayCurve("calibration", told, model, bar);
    if (constexpr std::size_t some = 24; loaded.size() < some)
        bar.say(
            fmt::format("warning: {} case{} can tell little of how probable a place is, or how "
                        "many false findings a scan has: calibrate on some dozens",
                        loaded.size(), loaded.size() == 1 ? "" : "s"));
    return writeDurably(arguments.model, cad::modelText(model));
}

constexpr const char* columnsHelp =
    "Columns: polyps found of all, at the model's operating point, by largest diameter, and of "
    "those from 6 mm: plain (the truth says of no denser core than the wall's), dense (of one), "
    "submerged (under tagged fluid), coated (with tagged residue), hidden (in fluid or stool "
    "without tagging). FP: false findings a scan, before: those before they were weighed, reduced: "
    "the share that weighing took away. |d|: mean error of the diameter of what was found, in mm, "
    "95 %: what 95 % of the errors do not exceed; -: nothing was found. Below each group: found of "
    "all by the truth's "
    "kinds, what the false ones lie on, and those that are small benign growths, which count as "
    "neither.";

// What a group of phantoms is called: a case's name up to its first hyphen.
std::string groupOf(const std::string& name) {
    return name.substr(0, name.find('-'));
}

nlohmann::ordered_json jsonOf(const cad::Share& share) {
    return {{"hit", share.hit}, {"of", share.of}};
}

// null where there is none.
nlohmann::ordered_json jsonOf(const std::optional<double>& number) {
    return number ? nlohmann::ordered_json(*number) : nlohmann::ordered_json();
}

nlohmann::ordered_json jsonOf(const cad::Evaluation& sum) {
    nlohmann::ordered_json kinds = nlohmann::ordered_json::object(),
                           byKind = nlohmann::ordered_json::object();
    for (const auto& [kind, count] : sum.falseKinds)
        kinds[kind] = count;
    for (const auto& [kind, share] : sum.byKind)
        byKind[kind] = jsonOf(share);
    return {{"cases", sum.cases},
            {"from_6_mm", jsonOf(sum.from6Mm)},
            {"from_5_to_6_mm", jsonOf(sum.from5To6Mm)},
            {"from_10_mm", jsonOf(sum.from10Mm)},
            {"plain", jsonOf(sum.plain)},
            {"dense", jsonOf(sum.dense)},
            {"submerged", jsonOf(sum.submerged)},
            {"coated", jsonOf(sum.coated)},
            {"hidden", jsonOf(sum.hidden)},
            {"by_kind", byKind},
            {"false_positives_per_scan", sum.falsePositives},
            {"before_reduction_per_scan", sum.falseBefore},
            {"false_positives_by_kind", kinds},
            {"hyperplastic", sum.hyperplastic},
            {"diameter_error_mean_mm", jsonOf(sum.diameterMean)},
            {"diameter_error_95_mm", jsonOf(sum.diameter95)},
            {"diameter_bias_mm", jsonOf(sum.diameterBias)},
            {"diameter_error_submerged_mm", jsonOf(sum.submergedDiameterMean)},
            {"diameter_error_pedunculated_mm", jsonOf(sum.pedunculatedDiameterMean)}};
}

nlohmann::ordered_json jsonOf(const std::vector<cad::JudgedPlace>& places) {
    auto list = nlohmann::ordered_json::array();
    for (const cad::JudgedPlace& each : places)
        list.push_back({{"case", each.caseName},
                        {"position_mm", {each.positionMm.x, each.positionMm.y, each.positionMm.z}},
                        {"diameter_mm", each.diameterMm},
                        {"kind", each.kind},
                        {"probability", each.score}});
    return list;
}

void print(const std::string& group, const cad::Evaluation& sum) {
    const auto of = [](const cad::Share& s) { return fmt::format("{}/{}", s.hit, s.of); };
    const auto mm = [](const std::optional<double>& length) {
        return length ? fmt::format("{:.2f}", *length) : std::string("-");
    };
    fmt::print(
        "{:<10} {:>4} {:>9} {:>8} {:>8} {:>9} {:>9} {:>9} {:>7} {:>6} {:>7.2f} {:>7.1f} "
        "{:>6.1f}% {:>6} {:>6}\n",
        group, sum.cases, of(sum.from6Mm), of(sum.from5To6Mm), of(sum.from10Mm), of(sum.plain),
        of(sum.dense), of(sum.submerged), of(sum.coated), of(sum.hidden), sum.falsePositives,
        sum.falseBefore,
        sum.falseBefore > 0.0 ? 100.0 * (1.0 - sum.falsePositives / sum.falseBefore) : 0.0,
        mm(sum.diameterMean), mm(sum.diameter95));
    std::string kinds;
    for (const auto& [kind, share] : sum.byKind)
        kinds += fmt::format("  {} {}", kind, of(share));
    if (!sum.falseKinds.empty()) kinds += "; false:";
    for (const auto& [kind, count] : sum.falseKinds)
        kinds += fmt::format(" {} {}", kind, count);
    if (sum.hyperplastic > 0) kinds += fmt::format("; neither: hyperplastic {}", sum.hyperplastic);
    fmt::print("          {}\n", kinds);
}

Result<void> runEvaluate(const CadArguments& arguments) {
    checkArguments(arguments);
    for (const fs::path& file : {arguments.report, arguments.froc}) {
        if (file.empty()) continue;
        TRY(checkOutputFile(file));
    }
    if (std::error_code ignored;
        !arguments.report.empty() && fs::weakly_canonical(arguments.report, ignored) ==
                                         fs::weakly_canonical(arguments.froc, ignored))
        throw CLI::ValidationError("--froc",
                                   "--report writes the same file: " + arguments.report.string());
    TRY(checkFolderOfCandidates(arguments));
    const auto store = TRY(store::CaseStore::open(arguments.store, false));
    const auto model = TRY(arguments.model.empty() ? builtInModel() : readModel(arguments.model));
    ProgressBar bar;
    // A case that is not there is told of before the first is measured.
    const std::vector<LoadedCase> loaded = TRY(loadCases(store, arguments));
    TRY(checkUnseen(model, loaded, "judged by"));
    sayUnflattened(loaded, bar);
    if (!arguments.froc.empty() && std::ranges::none_of(loaded, [](const LoadedCase& each) {
            return std::ranges::any_of(each.truth, cad::countsInCurve);
        }))
        return fail(ErrorKind::badInput, "no polyp from 6 mm is in these cases: there is no curve",
                    arguments.truth.string());
    TRY(makeFolderOfCandidates(arguments));
    std::vector<cad::EvaluatedCase> cases;
    for (std::size_t n = 0; n < loaded.size(); ++n) {
        bar.show("detect", double(n) / double(loaded.size()));
        const std::string& name = arguments.cases[n];
        auto all = TRY(candidatesOf(loaded[n], arguments, model.texture, &model));
        sayTruthElsewhere(loaded[n], all, bar);
        leaveOut(all, arguments);
        if (usesClassifier(arguments))
            cad::weigh(all, model);
        else
            cad::weighByThresholds(all, model.thresholds);
        cases.push_back(cad::evaluateCase(name, groupOf(name), all, loaded[n].truth));
    }
    std::map<std::string, std::vector<const cad::EvaluatedCase*>> groups;
    std::vector<const cad::EvaluatedCase*> every;
    for (const cad::EvaluatedCase& each : cases)
        groups[each.group].push_back(&each), every.push_back(&each);
    for (const std::string_view note : frocNotes)
        fmt::print("{}\n", note);
    fmt::print(
        "{:<10} {:>4} {:>9} {:>8} {:>8} {:>9} {:>9} {:>9} {:>7} {:>6} {:>7} {:>7} {:>7} {:>6} "
        "{:>6}\n",
        "group", "scans", ">=6 mm", "5-6 mm", ">=10 mm", "plain", "dense", "submerged", "coated",
        "hidden", "FP", "before", "reduced", "|d|", "95 %");
    // Without the classifier a candidate passes (1) or does not (0).
    const double point = usesClassifier(arguments) ? model.operatingPoint : 0.5;
    nlohmann::ordered_json report{{"model", model.name},
                                  {"trained_on", model.trainedOn},
                                  {"notes", frocNotes},
                                  {"operating_point", point}};
    for (const auto& [group, members] : groups) {
        const cad::Evaluation sum = cad::evaluate(members, point);
        print(group, sum);
        report["groups"][group] = jsonOf(sum);
    }
    const cad::Evaluation sum = cad::evaluate(every, point);
    if (groups.size() > 1) print("all", sum);
    report["all"] = jsonOf(sum);
    report["missed"] = jsonOf(cad::missedLesions(every, point));
    report["false_findings"] = jsonOf(cad::falseFindings(every, point));
    report["hyperplastic_findings"] = jsonOf(cad::hyperplasticFindings(every, point));
    const auto hasPolyps = [](const cad::EvaluatedCase* each) {
        return std::ranges::any_of(each->truth, cad::countsInCurve);
    };
    const auto curve = cad::frocCurve(every);
    if (curve.empty())
        fmt::print("No polyp from 6 mm is in these cases: nothing was found or missed.\n");
    else if (std::ranges::count_if(every, hasPolyps) < 2)
        fmt::print(
            "Fewer than two cases have polyps from 6 mm: of others nothing is known, and the "
            "bands are all.\n");
    report["froc"] = nlohmann::ordered_json::array();
    for (const cad::FrocPoint& p : curve)
        report["froc"].push_back({p.falsePositives, p.sensitivity, p.low, p.high});
    if (!arguments.froc.empty()) {
        if (arguments.froc.extension() == ".png") {
            const Image picture =
                TRY(frocPicture(curve, fmt::format("{}, {} scan{}", model.name, every.size(),
                                                   every.size() == 1 ? "" : "s")));
            TRY(pictures::writePicture(arguments.froc, picture, ownProvenance()));
        } else {
            TRY(writeDurably(arguments.froc, frocCsv(curve)));
        }
    }
    if (arguments.report.empty()) return {};
    return writeDurably(arguments.report, report.dump(2) + "\n");
}

void addCases(CLI::App& command, CadArguments& arguments) {
    command.add_option("CASES", arguments.cases, "The cases' names")->required();
    addStoreOption(command, arguments.store);
    command
        .add_option(
            "--truth", arguments.truth,
            "Folder that has of each case CASE/truth/growths.json or CASE/truth/polyps.json, "
            "as haustra phantom writes them; a structure.json beside it tells false findings on "
            "the ileocecal valve and a rectal tube from others")
        ->type_name("DIR")
        ->required();
    addThreadsOption(command, arguments.threads);
    command
        .add_option(
            "--candidates", arguments.kept,
            "Keep what was found in each case in this folder, made where it is missing, and "
            "take it from there: to learn or judge again without measuring again")
        ->type_name("DIR");
    command
        .add_option(
            "--without", arguments.without,
            "For comparisons leave out: automatic-transfer, pca, cleansing, texture, shape, "
            "past (all that is not the dissertation's), or feature:NAME, those whose names "
            "begin so; give it to train, calibrate and evaluate alike; may be repeated")
        ->type_name("PART")
        ->check(checkPart);
}

CLI::Validator modelLine(std::size_t longest) {
    return CLI::Validator(
        [longest](const std::string& text) {
            return cad::isModelLine(text, longest)
                       ? std::string()
                       : fmt::format("it must be one line of UTF-8, of at most {} bytes", longest);
        },
        "");
}

// What is written, and what it tells of itself.
void addModel(CLI::App& command, CadArguments& arguments, const char* name,
              const char* description) {
    command.add_option("--model", arguments.model, "The model to write")
        ->type_name("FILE.json")
        ->required();
    command.add_option("--name", arguments.name, name)->check(modelLine(cad::longestModelName));
    command.add_option("--description", arguments.description, description)
        ->check(modelLine(cad::longestModelDescription));
}

std::string checkModelFile(const std::string& text) {
    std::error_code ignored;
    return text == builtIn || fs::is_regular_file(text, ignored)
               ? std::string()
               : fmt::format("\"{}\" is neither a file nor the word {}", text, builtIn);
}

}  // namespace

Command addCad(CLI::App& program) {
    // Each of its own: an option's environment variable is read for the subcommands that are not
    // given, too.
    const auto forTrain = std::make_shared<CadArguments>(),
               forCalibrate = std::make_shared<CadArguments>(),
               forEvaluate = std::make_shared<CadArguments>();
    CLI::App* command = program.add_subcommand(
        "cad", "Train or calibrate polyp detection, or see how well it does.");
    command->require_subcommand(1);
    CLI::App* train = command->add_subcommand(
        "train",
        "Learn a model from prepared cases of five studies or more, whose polyps are known.");
    addCases(*train, *forTrain);
    addModel(*train, *forTrain, "What the model is called (default: cases)",
             "What it was trained on and what that means, for a reader (default: cases that "
             "somebody chose)");
    train
        ->add_option("--false-positives", forTrain->falsePositives,
                     "How many a scan the operating point allows, in cross-validation")
        ->capture_default_str()
        ->check(numberRange(0.1, 50.0));
    train
        ->add_option("--texture", forTrain->texture,
                     "Take what polyps look like in the electronic biopsy from this model, or from "
                     "the built-in one, in place of learning it: candidates that were kept hold "
                     "while cases are added. What that model has seen counts as seen")
        ->type_name("FILE.json|built-in")
        ->check(checkModelFile);
    CLI::App* calibrate = command->add_subcommand(
        "calibrate",
        "Fit how probable a place is, and the operating point, to a hospital's own cases, some "
        "dozens of them: prepared ones whose polyps are known and that the model has not learnt "
        "from. Trees and networks stay, and with them which place is more probable than which.");
    addCases(*calibrate, *forCalibrate);
    addModel(*calibrate, *forCalibrate,
             "What the new model is called (default: as the old one, and -calibrated)",
             "What it was trained on and what that means, for a reader (default: as the old one's, "
             "and on how many cases it was calibrated)");
    calibrate
        ->add_option("--false-positives", forCalibrate->falsePositives,
                     "How many a scan the operating point allows in these cases; the built-in "
                     "model's allows 4 in phantoms")
        ->capture_default_str()
        ->check(numberRange(0.1, 50.0));
    calibrate->add_option("--from", forCalibrate->from, "The model that is calibrated")
        ->type_name("FILE.json|built-in")
        ->capture_default_str()
        ->check(checkModelFile);
    CLI::App* evaluate = command->add_subcommand(
        "evaluate",
        "Sensitivity, false positives and errors of size on prepared cases whose polyps are known, "
        "by group: a case's name up to its first hyphen.");
    evaluate->footer(columnsHelp);
    addCases(*evaluate, *forEvaluate);
    evaluate->add_option("--model", forEvaluate->model, "In place of the built-in model")
        ->type_name("FILE.json|built-in")
        ->check(checkModelFile);
    evaluate
        ->add_option(
            "--report", forEvaluate->report,
            "Write all figures, and where each polyp that is missed, each false finding and each "
            "that counts as neither lies")
        ->type_name("FILE.json");
    evaluate
        ->add_option("--froc", forEvaluate->froc,
                     "Write the free-response ROC curve with 95 % bands by bootstrap over cases")
        ->type_name("FILE.csv|FILE.png")
        ->check([](const std::string& file) {
            const std::string ending = fs::path(file).extension().string();
            return ending == ".png" || ending == ".csv"
                       ? std::string()
                       : "\"" + file + "\": a curve is written as .png or .csv";
        });
    return {.app = command,
            .run =
                [forTrain, forCalibrate, forEvaluate, train, calibrate] {
                    return train->parsed()       ? runTrain(*forTrain)
                           : calibrate->parsed() ? runCalibrate(*forCalibrate)
                                                 : runEvaluate(*forEvaluate);
                },
            .wantsLargePages = true};
}

}  // namespace haustra::cli
