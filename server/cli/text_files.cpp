#include "cli/text_files.h"

#include "cli/arguments.h"
#include "core/text_file.h"

#include <sstream>

#include <fmt/format.h>
#include <unistd.h>

namespace haustra::cli {

namespace fs = std::filesystem;

Result<void> checkOutputFile(const fs::path& file) {
    std::error_code ignored;
    if (fs::is_directory(file, ignored))
        return fail(ErrorKind::io, "this is a folder, not a file to write", file.string());
    const fs::path folder = file.has_parent_path() ? file.parent_path() : fs::path(".");
    if (!fs::is_directory(folder, ignored))
        return fail(ErrorKind::io, "there is no folder to write this file in", file.string());
    if (::access(folder.c_str(), W_OK | X_OK) != 0)
        return fail(ErrorKind::io, "files cannot be made in this file's folder", file.string());
    return {};
}

Result<void> checkOutputFolder(const fs::path& folder) {
    if (folder.empty()) return fail(ErrorKind::badInput, "a folder's name is empty", "\"\"");
    // What is not there yet is made in the nearest one above that is.
    std::error_code ignored;
    fs::path nearest = fs::absolute(folder, ignored);
    while (!fs::exists(nearest, ignored) && nearest.has_relative_path())
        nearest = nearest.parent_path();
    if (!fs::is_directory(nearest, ignored))
        return fail(ErrorKind::io, "this is a file, not a folder", nearest.string());
    if (::access(nearest.c_str(), W_OK | X_OK) != 0)
        return fail(ErrorKind::io, "nothing can be made in this folder", nearest.string());
    return {};
}

std::string centerlineCsv(const Centerline& centerline) {
    std::string csv = "x_mm,y_mm,z_mm,arc_mm,radius_mm,gap\n";
    for (const CenterlinePoint& p : centerline.points) {
        csv += fmt::format("{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{}\n", p.positionMm.x,
                           p.positionMm.y, p.positionMm.z, p.arcMm, p.radiusMm, p.gap ? 1 : 0);
    }
    return csv;
}

Result<Centerline> readCenterlineCsv(const std::filesystem::path& file) {
    std::istringstream in(TRY(readTextFile(file)));
    std::string line;
    std::getline(in, line);
    const bool hasGap = line.find(",gap") != std::string::npos;
    Centerline centerline;
    for (int number = 2; std::getline(in, line); ++number) {
        if (!line.empty() && line.back() == '\r') line.pop_back();
        if (line.empty()) continue;
        const auto values = parseNumbers(line, ',', hasGap ? 6 : 5);
        if (!values) {
            return fail(ErrorKind::badInput,
                        "line " + std::to_string(number) + " is not a centerline sample",
                        file.string());
        }
        const auto& v = *values;
        centerline.points.push_back({{v[0], v[1], v[2]}, v[3], v[4], hasGap && v[5] != 0.0});
    }
    return centerline;
}

}  // namespace haustra::cli
