#include "cli/arguments.h"

#include "cli/number_range.h"
#include "core/patient_point.h"

#include <charconv>
#include <cmath>

#include <CLI/CLI.hpp>

namespace haustra::cli {

std::optional<std::vector<double>> parseNumbers(const std::string& text, char separator,
                                                std::size_t count) {
    std::vector<double> numbers;
    const char* at = text.data();
    const char* const end = at + text.size();
    while (true) {
        double number = 0.0;
        const auto [next, error] = std::from_chars(at, end, number);
        if (error != std::errc() || !std::isfinite(number)) return std::nullopt;
        numbers.push_back(number);
        if (next == end) break;
        if (*next != separator) return std::nullopt;
        at = next + 1;
    }
    if (numbers.size() != count) return std::nullopt;
    return numbers;
}

namespace {

std::optional<glm::dvec3> parsePoint(const std::string& text) {
    const auto numbers = parseNumbers(text, ',', 3);
    if (!numbers) return std::nullopt;
    const glm::dvec3 point((*numbers)[0], (*numbers)[1], (*numbers)[2]);
    return isPatientPoint(point) ? std::optional(point) : std::nullopt;
}

}  // namespace

CLI::Option* addStoreOption(CLI::App& command, std::filesystem::path& store) {
    return command.add_option("--store", store, "The case store's folder")
        ->type_name("DIR")
        ->envname("HAUSTRA_STORE")
        ->required();
}

void addThreadsOption(CLI::App& command, int& threads) {
    command.add_option("--threads", threads, "Threads to use; 0 for all cores")
        ->type_name("N")
        ->check(CLI::Range(0, 1024))
        ->capture_default_str();
}

namespace {

CLI::Option* addPoints(CLI::App& command, const std::string& name, std::vector<glm::dvec3>& points,
                       const std::string& description) {
    const auto take = [&points, name](const std::vector<std::string>& texts) {
        points.clear();
        for (const std::string& text : texts) {
            const auto point = parsePoint(text);
            if (!point)
                throw CLI::ValidationError(name, "\"" + text + "\" is not x,y,z of a patient");
            points.push_back(*point);
        }
    };
    return command.add_option_function<std::vector<std::string>>(name, take, description);
}

}  // namespace

CLI::Option* addPointsOption(CLI::App& command, const std::string& name,
                             std::vector<glm::dvec3>& points, const std::string& description) {
    return addPoints(command, name, points, description)
        ->type_name("X,Y,Z")
        ->allow_extra_args(false);
}

CLI::Option* addBallsOption(CLI::App& command, const std::string& name, std::vector<CutBall>& balls,
                            const std::string& description) {
    const auto take = [&balls, name](const std::vector<std::string>& texts) {
        balls.clear();
        for (const std::string& text : texts) {
            auto numbers = parseNumbers(text, ',', 4);
            if (!numbers) numbers = parseNumbers(text, ',', 3);
            CutBall ball;
            if (numbers) ball.centerMm = {(*numbers)[0], (*numbers)[1], (*numbers)[2]};
            if (numbers && numbers->size() == 4) ball.radiusMm = (*numbers)[3];
            if (!numbers || !isPatientPoint(ball.centerMm) || !isCutRadius(ball.radiusMm))
                throw CLI::ValidationError(
                    name, "\"" + text + "\" is not x,y,z or x,y,z,r of a patient, r up to 100");
            balls.push_back(ball);
        }
    };
    return command.add_option_function<std::vector<std::string>>(name, take, description)
        ->type_name("X,Y,Z[,R]")
        ->allow_extra_args(false);
}

CLI::Option* addPairsOption(CLI::App& command, const std::string& name,
                            std::vector<std::pair<glm::dvec3, glm::dvec3>>& pairs,
                            const std::string& description) {
    const auto take = [&pairs, name](const std::vector<std::string>& texts) {
        pairs.clear();
        if (texts.size() % 2 != 0) throw CLI::ValidationError(name, "points come in pairs");
        for (std::size_t n = 0; n < texts.size(); n += 2) {
            const auto a = parsePoint(texts[n]), b = parsePoint(texts[n + 1]);
            if (!a || !b) {
                throw CLI::ValidationError(name, "\"" + texts[n] + "\" and \"" + texts[n + 1] +
                                                     "\" are not x,y,z x,y,z of a patient");
            }
            pairs.emplace_back(*a, *b);
        }
    };
    return command.add_option_function<std::vector<std::string>>(name, take, description)
        ->type_name("X,Y,Z X,Y,Z")
        ->type_size(2)
        ->allow_extra_args(false);
}

CLI::Option* addEndsOption(CLI::App& command, std::vector<glm::dvec3>& endsMm,
                           const std::string& description) {
    return addPoints(command, "--ends", endsMm, description)->type_name("X,Y,Z")->expected(2);
}

void addAreaWeightOption(CLI::App& command, double& areaWeight) {
    command
        .add_option(
            "--area-weight", areaWeight,
            "Of the flat map, how far angles are traded for areas: from 0, where small shapes "
            "are kept, to 1, where sizes nearly are")
        ->type_name("W")
        ->check(numberRange(0.0, 1.0))
        ->capture_default_str();
}

}  // namespace haustra::cli
