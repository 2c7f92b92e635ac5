#include "core/findings.h"

#include "core/printed_text.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace haustra {
namespace {

using OrderedJson = nlohmann::ordered_json;

// Far below what a scan resolves, or a probability is worth: the text stays the same on every
// machine.
double thousandths(double value) {
    return std::round(value * 1e3) / 1e3;
}
OrderedJson placeJson(glm::dvec3 p) {
    return {thousandths(p.x), thousandths(p.y), thousandths(p.z)};
}

OrderedJson findingJson(const Finding& finding) {
    OrderedJson json{{"position_mm", placeJson(finding.positionMm)},
                     {"diameter_mm", thousandths(finding.diameterMm)},
                     {"score", std::round(finding.score * 1e6) / 1e6},
                     {"kind", finding.kind}};
    if (finding.voxels.empty() && finding.features.empty()) return json;
    json["wall_mm"] = placeJson(finding.wallMm);
    json["diameter_ends_mm"] = {placeJson(finding.diameterEndsMm.first),
                                placeJson(finding.diameterEndsMm.second)};
    json["height_mm"] = thousandths(finding.heightMm);
    json["arc_mm"] = thousandths(finding.arcMm);
    if (finding.segment) json["segment"] = toString(*finding.segment);
    OrderedJson features = OrderedJson::object();
    for (const auto& [name, value] : finding.features)
        features[name] = std::round(value * 1e6) / 1e6;
    json["features"] = features;
    OrderedJson voxels = OrderedJson::array();
    for (const VoxelRun& run : finding.voxels)
        voxels.push_back({run.first.x, run.first.y, run.first.z, run.count});
    json["voxels"] = voxels;
    return json;
}

OrderedJson biopsyJson(const ScanBiopsy& biopsy) {
    OrderedJson points = OrderedJson::array();
    for (const TransferFunctionPoint& point : biopsy.transferFunction.points)
        points.push_back(
            {{"hu", thousandths(point.hu)},
             {"color",
              {thousandths(point.color.r), thousandths(point.color.g), thousandths(point.color.b)}},
             {"opacity", std::round(point.opacity * 1e6) / 1e6}});
    return {{"wall_hu", thousandths(biopsy.wallHu)},
            {"fat_hu", thousandths(biopsy.fatHu)},
            {"noise_hu", thousandths(biopsy.noiseHu)},
            {"transfer_function", points}};
}

// A line each.
std::string findingLines(const std::vector<Finding>& findings) {
    std::string lines = "[";
    for (const Finding& finding : findings)
        lines += (lines.size() > 1 ? ",\n" : "\n") + findingJson(finding).dump();
    return lines + "]";
}

// Of a number that a body can have, in whatever unit.
double numberIn(const OrderedJson& json) {
    const double value = json.get<double>();
    if (!std::isfinite(value) || std::abs(value) > 1e9)
        throw std::invalid_argument("a number is out of range");
    return value;
}

glm::dvec3 placeIn(const OrderedJson& json) {
    if (json.size() != 3) throw std::invalid_argument("a place has three coordinates");
    return {numberIn(json.at(0)), numberIn(json.at(1)), numberIn(json.at(2))};
}

ColonSegment segmentOfName(const std::string& name) {
    for (int n = 0; n < colonSegments; ++n)
        if (name == toString(ColonSegment(n))) return ColonSegment(n);
    throw std::invalid_argument("there is no segment " + name);
}

VoxelRun runOf(const OrderedJson& json, const Grid& grid) {
    if (json.size() != 4) throw std::invalid_argument("a run of voxels has four numbers");
    const VoxelRun run{{json.at(0).get<int>(), json.at(1).get<int>(), json.at(2).get<int>()},
                       json.at(3).get<int>()};
    if (!grid.contains(run.first) || run.count < 1 || run.count > grid.size.x - run.first.x)
        throw std::invalid_argument("voxels lie outside the grid");
    return run;
}

Finding findingOf(const OrderedJson& json, const Grid& grid) {
    Finding finding;
    finding.positionMm = placeIn(json.at("position_mm"));
    finding.diameterMm = numberIn(json.at("diameter_mm"));
    finding.score = json.contains("score") ? numberIn(json.at("score")) : 1.0;
    if (finding.diameterMm < 0.0 || finding.score < 0.0 || finding.score > 1.0)
        throw std::invalid_argument("a diameter or a score is out of range");
    finding.kind = json.value("kind", "");
    finding.wallMm = json.contains("wall_mm") ? placeIn(json.at("wall_mm")) : finding.positionMm;
    if (json.contains("diameter_ends_mm")) {
        finding.diameterEndsMm = {placeIn(json.at("diameter_ends_mm").at(0)),
                                  placeIn(json.at("diameter_ends_mm").at(1))};
    }
    if (json.contains("height_mm")) finding.heightMm = numberIn(json.at("height_mm"));
    if (json.contains("arc_mm")) finding.arcMm = numberIn(json.at("arc_mm"));
    if (json.contains("segment")) finding.segment = segmentOfName(json.at("segment"));
    if (json.contains("features")) {
        for (const auto& [name, value] : json.at("features").items())
            finding.features.emplace_back(name, numberIn(value));
    }
    if (json.contains("voxels")) {
        if (json.at("voxels").size() > std::size_t(maxFindingRuns))
            throw std::invalid_argument("a finding has too many voxels");
        for (const OrderedJson& run : json.at("voxels"))
            finding.voxels.push_back(runOf(run, grid));
    }
    return finding;
}

ScanBiopsy biopsyOf(const OrderedJson& json) {
    ScanBiopsy biopsy{numberIn(json.at("wall_hu")),
                      numberIn(json.at("fat_hu")),
                      numberIn(json.at("noise_hu")),
                      {}};
    if (biopsy.noiseHu < 0.0) throw std::invalid_argument("noise is not negative");
    if (json.at("transfer_function").size() > mostTransferPoints)
        throw std::invalid_argument("a transfer function has too many points");
    for (const OrderedJson& point : json.at("transfer_function")) {
        const OrderedJson& color = point.at("color");
        if (color.size() != 3) throw std::invalid_argument("a colour has three numbers");
        biopsy.transferFunction.points.push_back(
            {numberIn(point.at("hu")),
             {numberIn(color.at(0)), numberIn(color.at(1)), numberIn(color.at(2))},
             numberIn(point.at("opacity"))});
    }
    if (const auto sound = checkTransferFunction(biopsy.transferFunction); !sound)
        throw std::invalid_argument(describe(sound.error()));
    return biopsy;
}

Grid gridOf(const OrderedJson& json) {
    Grid grid;
    const OrderedJson &size = json.at("size"), &affine = json.at("patient_from_voxel");
    if (size.size() != 3 || affine.size() != 16)
        throw std::invalid_argument("a grid has three sizes and sixteen numbers");
    for (int axis = 0; axis < 3; ++axis)
        grid.size[axis] = size.at(std::size_t(axis)).get<int>();
    for (int n = 0; n < 16; ++n)
        grid.patientFromVoxel[n % 4][n / 4] = numberIn(affine.at(std::size_t(n)));
    if (const auto sound = checkGrid(grid, "grid"); !sound)
        throw std::invalid_argument(describe(sound.error()));
    return grid;
}

}  // namespace

std::string findingsJson(const Findings& findings) {
    std::string text = "{";
    const bool detected = !findings.model.software.empty();
    const auto add = [&](const char* name, const OrderedJson& value) {
        text += '"' + std::string(name) + "\": " + value.dump() + ",\n";
    };
    if (detected) {
        add("software", findings.model.software);
        add("model", {{"name", findings.model.name},
                      {"sha256", findings.model.sha256},
                      {"trained_on", findings.model.trainedOn}});
        add("operating_point", std::round(findings.operatingPoint * 1e6) / 1e6);
        add("warnings", findings.warnings);
        add("unexamined_mm2", std::round(findings.unexaminedMm2 * 10.0) / 10.0);
        OrderedJson affine = OrderedJson::array();
        for (int n = 0; n < 16; ++n)
            affine.push_back(findings.grid.patientFromVoxel[n % 4][n / 4]);
        const glm::ivec3 size = findings.grid.size;
        add("grid", {{"size", {size.x, size.y, size.z}}, {"patient_from_voxel", affine}});
    }
    if (findings.biopsy) add("biopsy", biopsyJson(*findings.biopsy));
    text += "\"findings\": " + findingLines(findings.findings);
    if (detected) text += ",\n\"candidates\": " + findingLines(findings.candidates);
    return text + "}\n";
}

Result<Findings> findingsOfJson(const std::string& text, const std::string& where) {
    try {
        const OrderedJson json = OrderedJson::parse(text);
        Findings findings;
        findings.model.software = json.value("software", "");
        if (json.contains("model")) {
            const OrderedJson& model = json.at("model");
            findings.model.name = model.at("name");
            findings.model.sha256 = model.at("sha256");
            findings.model.trainedOn = model.at("trained_on");
        }
        if (json.contains("operating_point"))
            findings.operatingPoint = numberIn(json.at("operating_point"));
        findings.warnings = json.value("warnings", std::vector<std::string>());
        if (json.contains("unexamined_mm2"))
            findings.unexaminedMm2 = numberIn(json.at("unexamined_mm2"));
        if (json.contains("grid")) findings.grid = gridOf(json.at("grid"));
        if (json.contains("biopsy")) findings.biopsy = biopsyOf(json.at("biopsy"));
        const OrderedJson &list = json.at("findings"),
                          rest = json.value("candidates", OrderedJson::array());
        if (list.size() + rest.size() > std::size_t(maxFindings))
            throw std::invalid_argument("there are too many findings");
        for (const OrderedJson& finding : list)
            findings.findings.push_back(findingOf(finding, findings.grid));
        for (const OrderedJson& finding : rest)
            findings.candidates.push_back(findingOf(finding, findings.grid));
        return findings;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "these are no findings: " + reasonOf(error), where);
    }
}

}  // namespace haustra
