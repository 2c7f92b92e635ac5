// Options that several subcommands take, and values written as text.
#pragma once

#include "core/colon_edits.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

namespace CLI {
class App;
class Option;
}  // namespace CLI

namespace haustra::cli {

/// `count` finite numbers with `separator` between them and nothing else.
std::optional<std::vector<double>> parseNumbers(const std::string& text, char separator,
                                                std::size_t count);

/// --store DIR, or $HAUSTRA_STORE; wrong usage without either, unless the option is told otherwise.
CLI::Option* addStoreOption(CLI::App& command, std::filesystem::path& store);

/// --threads N, 0 for all cores.
void addThreadsOption(CLI::App& command, int& threads);

/// --NAME x,y,z in patient millimetres, which may be given again and again; the first coordinate
/// may be negative.
CLI::Option* addPointsOption(CLI::App& command, const std::string& name,
                             std::vector<glm::dvec3>& points, const std::string& description);

/// --NAME x,y,z or x,y,z,r in patient millimetres: balls, of 3 mm radius where none is given; may
/// be given again and again.
CLI::Option* addBallsOption(CLI::App& command, const std::string& name, std::vector<CutBall>& balls,
                            const std::string& description);

/// --NAME x,y,z x,y,z in patient millimetres: pairs of points, which may be given again and again.
CLI::Option* addPairsOption(CLI::App& command, const std::string& name,
                            std::vector<std::pair<glm::dvec3, glm::dvec3>>& pairs,
                            const std::string& description);

/// --ends x,y,z x,y,z in patient millimetres: none, or two points.
CLI::Option* addEndsOption(CLI::App& command, std::vector<glm::dvec3>& endsMm,
                           const std::string& description);

/// --area-weight W of a flat map, from 0 (conformal) to 1 (as nearly area-preserving as can be).
void addAreaWeightOption(CLI::App& command, double& areaWeight);

}  // namespace haustra::cli
