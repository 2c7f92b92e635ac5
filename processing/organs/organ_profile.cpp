#include "organs/organ_profile.h"

#include "core/printed_text.h"
#include "core/text_file.h"
#include "organs/built_in_profiles.h"

#include <algorithm>
#include <charconv>
#include <initializer_list>
#include <optional>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

namespace haustra::organs {
namespace {

using nlohmann::json;

constexpr int lowestHu = -1024, highestHu = 3071;
constexpr double largestOpeningMm = 50.0, largestSmoothingMm = 10.0;
constexpr std::size_t mostBytes = std::size_t(1) << 20;

template <class T>
using Names = std::initializer_list<std::pair<const char*, T>>;
constexpr Names<LumenFinder> finders{{"gas-and-tagged", LumenFinder::gasAndTagged},
                                     {"hu-range", LumenFinder::huRange}};
constexpr Names<ExpectedTopology> topologies{{"ball", ExpectedTopology::ball},
                                             {"any", ExpectedTopology::any}};
constexpr Names<EndPoints> endPointRules{{"rectum-cecum", EndPoints::rectumCecum},
                                         {"farthest", EndPoints::farthest}};
constexpr const char* tissueNames[tissueCount] = {"air", "fat", "soft", "tagged-or-bone"};

template <class T>
const char* nameOf(T value, const Names<T>& names) {
    for (const auto& [name, named] : names) {
        if (named == value) return name;
    }
    return "";
}

// Takes fields out of one object of the profile and remembers the first thing that is wrong: the
// callers read on with whatever they had, and ask once at the end.
class Fields {
public:
    Fields(const json& object, std::string path, std::string place)
        : object_(object), path_(std::move(path)), place_(std::move(place)) {}

    bool has(const char* field) const { return object_.contains(field); }

    const json* find(const char* field) {
        known_.push_back(field);
        const auto found = object_.find(field);
        if (found == object_.end()) {
            wrong(field, "is missing");
            return nullptr;
        }
        return &*found;
    }

    void text(const char* field, std::string& value) {
        const json* found = find(field);
        if (!found) return;
        if (!found->is_string() || found->get_ref<const std::string&>().empty())
            return wrong(field, "is not a text");
        value = found->get<std::string>();
    }

    void flag(const char* field, bool& value) {
        const json* found = find(field);
        if (!found) return;
        if (!found->is_boolean()) return wrong(field, "is neither true nor false");
        value = found->get<bool>();
    }

    void number(const char* field, double lowest, double highest, double& value) {
        const json* found = find(field);
        if (!found) return;
        if (!found->is_number()) return wrong(field, "is not a number");
        const double read = found->get<double>();
        if (!(read >= lowest && read <= highest)) {
            return wrong(field, "is not between " + std::to_string(int(lowest)) + " and " +
                                    std::to_string(int(highest)));
        }
        value = read;
    }

    void range(const char* field, HuRange& value) {
        const json* found = find(field);
        if (!found) return;
        const auto isHu = [](const json& number) {
            return number.is_number_integer() && number >= lowestHu && number <= highestHu;
        };
        if (!found->is_array() || found->size() != 2 || !isHu((*found)[0]) || !isHu((*found)[1])) {
            return wrong(field, "is not [lowest, highest] in whole HU between " +
                                    std::to_string(lowestHu) + " and " + std::to_string(highestHu));
        }
        const HuRange read{(*found)[0].get<int>(), (*found)[1].get<int>()};
        if (read.fromHu >= read.toHu) return wrong(field, "does not run from low to high");
        value = read;
    }

    template <class T>
    void choice(const char* field, const Names<T>& names, T& value) {
        std::string chosen;
        text(field, chosen);
        if (chosen.empty()) return;
        std::string known;
        for (const auto& [name, named] : names) {
            if (chosen == name) {
                value = named;
                return;
            }
            known += (known.empty() ? "" : " nor ") + std::string(name);
        }
        wrong(field, "is neither " + known);
    }

    void wrong(const std::string& field, const std::string& what) {
        if (!error_) {
            error_ =
                Error{ErrorKind::badInput,
                      "the field " + path_ + field + " of the organ's profile " + what, place_};
        }
    }

    Result<void> finish() {
        for (const auto& [field, value] : object_.items()) {
            if (std::find(known_.begin(), known_.end(), field) == known_.end())
                wrong(field, "is unknown");
        }
        if (error_) return tl::make_unexpected(*error_);
        return {};
    }

private:
    const json& object_;
    std::string path_, place_;
    std::vector<std::string> known_;
    std::optional<Error> error_;
};

Result<void> readTissues(const json& object, const std::string& place, TissuePriors& tissues) {
    Fields fields(object, "tissues.", place);
    for (int t = 0; t < tissueCount; ++t)
        fields.range(tissueNames[t], tissues.meanHu[std::size_t(t)]);
    for (int t = 1; t < tissueCount; ++t) {
        const HuRange below = tissues.meanHu[std::size_t(t - 1)],
                      above = tissues.meanHu[std::size_t(t)];
        if (above.fromHu < below.toHu)
            fields.wrong(tissueNames[t], std::string("overlaps ") + tissueNames[t - 1]);
    }
    return fields.finish();
}

Result<void> readLumen(const json& object, const std::string& place, OrganProfile& profile) {
    Fields fields(object, "lumen.", place);
    fields.choice("finder", finders, profile.finder);
    if (profile.finder == LumenFinder::huRange) {
        fields.range("hu", profile.contentHu);
        if (fields.has("smoothing-mm"))
            fields.number("smoothing-mm", 0.0, largestSmoothingMm, profile.smoothingMm);
        if (fields.has("opening-mm"))
            fields.number("opening-mm", 0.0, largestOpeningMm, profile.openingMm);
    }
    return fields.finish();
}

// "parse error at line 3, column 7", without the file's own words.
std::string briefly(const json::exception& error) {
    const std::string reason = reasonOf(error);
    return reason.substr(0, reason.find(':'));
}

// The shortest text that reads back as the same double.
std::string exactText(double value) {
    char buffer[32];
    return {buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr};
}

}  // namespace

const char* toString(ExpectedTopology topology) {
    return nameOf(topology, topologies);
}

const char* toString(EndPoints endPoints) {
    return nameOf(endPoints, endPointRules);
}

Result<OrganProfile> parseProfile(std::string_view text, const std::string& place) {
    json root;
    try {
        root = json::parse(text);
    } catch (const json::exception& error) {
        return fail(ErrorKind::badInput, "the organ's profile is not JSON: " + briefly(error),
                    place);
    }
    if (!root.is_object())
        return fail(ErrorKind::badInput, "the organ's profile is not a JSON object", place);
    OrganProfile profile;
    Fields fields(root, "", place);
    fields.text("organ", profile.organ);
    fields.flag("cleanse", profile.cleanse);
    fields.choice("topology", topologies, profile.topology);
    fields.choice("end-points", endPointRules, profile.endPoints);
    fields.flag("branches", profile.branches);
    if (fields.has("flatten")) fields.flag("flatten", profile.flatten);
    if (profile.flatten && profile.topology != ExpectedTopology::ball)
        fields.wrong("flatten", "needs the topology ball");
    if (fields.has("detect-polyps")) fields.flag("detect-polyps", profile.detectPolyps);
    if (profile.detectPolyps && !profile.flatten) fields.wrong("detect-polyps", "needs flatten");
    const auto readObject = [&](const char* name, auto read) -> Result<void> {
        const json* object = fields.find(name);
        if (!object) return {};
        if (!object->is_object()) {
            fields.wrong(name, "is not an object");
            return {};
        }
        return read(*object);
    };
    TRY(readObject("lumen", [&](const json& object) { return readLumen(object, place, profile); }));
    if (profile.finder == LumenFinder::gasAndTagged) {
        TRY(readObject("tissues", [&](const json& object) {
            return readTissues(object, place, profile.tissues);
        }));
    } else {
        if (fields.has("tissues")) fields.wrong("tissues", "is of no use to the finder hu-range");
        if (profile.cleanse) fields.wrong("cleanse", "needs the finder gas-and-tagged");
    }
    TRY(fields.finish());
    return profile;
}

Result<OrganProfile> readProfile(const std::string& nameOrFile) {
    const auto builtIn = builtInProfiles().find(nameOrFile);
    if (builtIn != builtInProfiles().end()) return parseProfile(builtIn->second, nameOrFile);
    const auto text = readTextFile(nameOrFile, mostBytes);
    if (!text && text.error().kind == ErrorKind::notFound) {
        std::string names;
        for (const auto& [name, profile] : builtInProfiles())
            names += (names.empty() ? "" : ", ") + std::string(name);
        return fail(ErrorKind::notFound,
                    "there is no such organ's profile: neither a file nor one of " + names,
                    nameOrFile);
    }
    if (!text) return tl::make_unexpected(text.error());
    if (text->empty())
        return fail(ErrorKind::badInput, "the organ's profile is an empty file", nameOrFile);
    return parseProfile(*text, nameOrFile);
}

std::string segmentationOptions(const OrganProfile& profile) {
    const auto rangeText = [](HuRange range) {
        return std::to_string(range.fromHu) + ".." + std::to_string(range.toHu) + ";";
    };
    std::string text = std::string("finder=") + nameOf(profile.finder, finders) + ";";
    if (profile.finder == LumenFinder::huRange) {
        text += "hu=" + rangeText(profile.contentHu);
        return text + "smoothing-mm=" + exactText(profile.smoothingMm) +
               ";opening-mm=" + exactText(profile.openingMm) + ";";
    }
    for (int t = 0; t < tissueCount; ++t) {
        text +=
            std::string(tissueNames[t]) + "=" + rangeText(profile.tissues.meanHu[std::size_t(t)]);
    }
    return text;
}

}  // namespace haustra::organs
