#include "cad/candidate_table.h"

#include "core/printed_text.h"

#include <cstdio>
#include <limits>
#include <stdexcept>

#include <nlohmann/json.hpp>

namespace haustra::cad {
namespace {

constexpr std::size_t ownNumbers = 7;  // before a candidate's features

std::int64_t integer(const nlohmann::json& number) {
    if (!number.is_number_integer()) throw std::invalid_argument("a number is not whole");
    return number.get<std::int64_t>();
}

Generator generatorOf(const nlohmann::json& number) {
    const std::int64_t by = integer(number);
    if (by < 0 || by > std::int64_t(Generator::broadShape))
        throw std::invalid_argument("a candidate is of no generator");
    return Generator(by);
}

// Of the candidate that comes after these: other levels come after all that they may be of.
std::int32_t levelOf(const nlohmann::json& number, const std::vector<Candidate>& before,
                     Generator by) {
    const std::int64_t of = integer(number);
    if (of == -1 && (before.empty() || before.back().levelOf < 0)) return -1;
    if (of < 0 || of >= std::int64_t(before.size()) || before[std::size_t(of)].levelOf >= 0 ||
        before[std::size_t(of)].lesion.patch.by != by || by == Generator::texture)
        throw std::invalid_argument("a candidate is another level of none");
    return std::int32_t(of);
}

}  // namespace

std::string candidateTable(const std::vector<Candidate>& candidates) {
    std::string text =
        "{\"haustra_cad_candidates\": " + std::to_string(modelVersion) + ",\n\"features\": [";
    for (const std::string_view name : featureNames)
        text += (name == featureNames.front() ? "\"" : ",\"") + std::string(name) + '"';
    text += "],\n\"candidates\": [";
    bool first = true;
    // With as many digits as bring the same number back.
    const auto exact = [](auto value) {
        char digits[32];
        std::snprintf(digits, sizeof digits, "%.*g",
                      std::numeric_limits<decltype(value)>::max_digits10, double(value));
        return std::string(digits);
    };
    for (const Candidate& candidate : candidates) {
        const Lesion& lesion = candidate.lesion;
        text += first ? "\n[" : ",\n[";
        first = false;
        for (const double value :
             {lesion.centerMm.x, lesion.centerMm.y, lesion.centerMm.z, lesion.diameter.mm,
              lesion.areaMm2, double(lesion.patch.by), double(candidate.levelOf)})
            text += exact(value) + ',';
        for (const float value : candidate.features)
            text += exact(value) + ',';
        text.back() = ']';
    }
    return text + "]}\n";
}

Result<std::vector<Candidate>> candidatesOfTable(std::string_view text, const std::string& place) {
    try {
        const auto json = nlohmann::json::parse(text);
        if (integer(json.at("haustra_cad_candidates")) != modelVersion ||
            json.at("features") != nlohmann::json(featureNames))
            return fail(ErrorKind::unsupported, "the candidates are of other features", place);
        if (!json.at("candidates").is_array()) throw std::invalid_argument("they are no list");
        std::vector<Candidate> candidates;
        for (const auto& row : json.at("candidates")) {
            if (row.size() != ownNumbers + featureNames.size())
                throw std::invalid_argument("a row has another length");
            Candidate candidate;
            Lesion& lesion = candidate.lesion;
            lesion.centerMm = {row[0].get<double>(), row[1].get<double>(), row[2].get<double>()};
            lesion.diameter.mm = row[3], lesion.areaMm2 = row[4];
            if (!(lesion.diameter.mm >= 0.0 && lesion.areaMm2 >= 0.0))
                throw std::invalid_argument("a candidate has no size");
            lesion.patch.by = generatorOf(row[5]);
            candidate.levelOf = levelOf(row[6], candidates, lesion.patch.by);
            for (std::size_t n = 0; n < featureNames.size(); ++n)
                candidate.features[n] = row[ownNumbers + n];
            candidates.push_back(std::move(candidate));
        }
        return candidates;
    } catch (const std::exception& error) {
        return fail(ErrorKind::badInput, "these are no candidates: " + reasonOf(error), place);
    }
}

}  // namespace haustra::cad
