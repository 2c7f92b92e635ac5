// OBJ, OFF and STL; ply_format.cpp reads PLY.
#include "mesh/polygon_soup.h"
#include "mesh/text_scanner.h"

#include <bit>
#include <cstring>

static_assert(std::endian::native == std::endian::little);

namespace haustra::mesh {
namespace {

constexpr std::size_t stlHeaderBytes = 84, stlFacetBytes = 50;

std::optional<glm::dvec3> scanPoint(TextScanner& scanner) {
    const auto x = scanner.number(), y = scanner.number(), z = scanner.number();
    if (!x || !y || !z) return {};
    return glm::dvec3(*x, *y, *z);
}

/// Drops comments: # to the end of its line.
std::string withoutComments(std::span<const char> bytes) {
    std::string text;
    text.reserve(bytes.size());
    TextScanner scanner(bytes);
    while (!scanner.atEnd()) {
        const std::string_view line = scanner.line();
        text.append(line.substr(0, line.find('#'))).push_back('\n');
    }
    return text;
}

Result<PolygonSoup> readTextStl(std::span<const char> bytes, const std::string& place) {
    PolygonSoup soup;
    TextScanner scanner(bytes);
    scanner.line();  // "solid", and a name that may hold any word
    bool inFacet = false, ended = false;
    while (!scanner.atEnd()) {
        const std::string_view word = scanner.word();
        const std::size_t corners = soup.corners.size() - soup.firstCorner.back();
        if (word == "facet" && !inFacet) {
            inFacet = true;
        } else if (word == "vertex" && inFacet && corners < 3) {
            const auto point = scanPoint(scanner);
            if (!point) return fail(ErrorKind::badInput, "the STL file has a bad vertex", place);
            soup.corners.push_back(std::int64_t(soup.points.size()));
            soup.points.push_back(*point);
        } else if (word == "endfacet" && inFacet && corners == 3) {
            soup.endPolygon();
            inFacet = false;
        } else if (word == "endsolid" && !inFacet) {
            scanner.line();
            ended = true;
        } else if (word == "solid" && !inFacet) {
            scanner.line();
            ended = false;
        } else if (word == "vertex" || word == "facet" || word == "endfacet") {
            return fail(ErrorKind::badInput, "the STL file has a bad facet", place);
        }
    }
    if (!ended) return fail(ErrorKind::badInput, "the STL file ends early", place);
    return soup;
}

PolygonSoup readBinaryStl(std::span<const char> facets) {
    PolygonSoup soup;
    for (std::size_t at = 0; at + stlFacetBytes <= facets.size(); at += stlFacetBytes) {
        float values[12];  // the normal, then three corners
        std::memcpy(values, facets.data() + at, sizeof values);
        for (int corner = 1; corner <= 3; ++corner) {
            const float* p = values + 3 * corner;
            soup.corners.push_back(std::int64_t(soup.points.size()));
            soup.points.push_back({p[0], p[1], p[2]});
        }
        soup.endPolygon();
    }
    return soup;
}

}  // namespace

Result<PolygonSoup> readObj(std::span<const char> bytes, const std::string& place) {
    PolygonSoup soup;
    TextScanner lines(bytes);
    while (!lines.atEnd()) {
        TextScanner line(lines.line());
        const std::string_view keyword = line.word();
        if (keyword == "v") {
            const auto point = scanPoint(line);
            if (!point) return fail(ErrorKind::badInput, "the OBJ file has a bad vertex", place);
            soup.points.push_back(*point);
        } else if (keyword == "f") {
            std::string_view corner;
            while (!(corner = line.word()).empty() && !corner.starts_with('#')) {
                // vertex/texture/normal: only the first counts here.
                const auto index =
                    TextScanner::parse<std::int64_t>(corner.substr(0, corner.find('/')));
                if (!index || *index == 0)
                    return fail(ErrorKind::badInput, "the OBJ file has a bad face", place);
                // A negative index counts back from the last vertex so far.
                soup.corners.push_back(*index > 0 ? *index - 1
                                                  : std::int64_t(soup.points.size()) + *index);
            }
            soup.endPolygon();
        }
    }
    return soup;
}

Result<PolygonSoup> readOff(std::span<const char> bytes, const std::string& place) {
    const std::string text = withoutComments(bytes);
    TextScanner scanner{std::string_view(text)};
    if (scanner.word() != "OFF")
        return fail(ErrorKind::unsupported, "the file is not a plain OFF file", place);
    const auto points = scanner.integer(), polygons = scanner.integer(), edges = scanner.integer();
    if (!points || !polygons || !edges || *points < 0 || *polygons < 0)
        return fail(ErrorKind::badInput, "the OFF file has bad counts", place);
    PolygonSoup soup;
    for (std::int64_t i = 0; i < *points; ++i) {
        const auto point = scanPoint(scanner);
        if (!point) return fail(ErrorKind::badInput, "the OFF file has a bad vertex", place);
        soup.points.push_back(*point);
    }
    scanner.line();  // ends the last vertex's line
    for (std::int64_t i = 0; i < *polygons; ++i) {
        std::string_view words;
        while (!scanner.atEnd() && words.find_first_not_of(" \t") == words.npos)
            words = scanner.line();
        TextScanner line(words);  // what follows the corners is the polygon's colour
        const auto count = line.integer();
        bool good = count && *count >= 0;
        for (std::int64_t corner = 0; good && corner < *count; ++corner) {
            const auto index = line.integer();
            good = index.has_value();
            if (good) soup.corners.push_back(*index);
        }
        if (!good) return fail(ErrorKind::badInput, "the OFF file has a bad polygon", place);
        soup.endPolygon();
    }
    return soup;
}

Result<PolygonSoup> readStl(std::span<const char> bytes, const std::string& place) {
    std::uint32_t facets = 0;
    if (bytes.size() >= stlHeaderBytes)
        std::memcpy(&facets, bytes.data() + stlHeaderBytes - 4, sizeof facets);
    const std::size_t binaryBytes = stlHeaderBytes + stlFacetBytes * std::size_t(facets);
    // A binary header may begin with "solid" too, so the size decides first.
    const bool text = std::string_view(bytes.data(), bytes.size()).starts_with("solid");
    if (text && bytes.size() != binaryBytes) return readTextStl(bytes, place);
    if (bytes.size() < binaryBytes || bytes.size() < stlHeaderBytes)
        return fail(ErrorKind::badInput, "the STL file ends early", place);
    return readBinaryStl(bytes.subspan(stlHeaderBytes, binaryBytes - stlHeaderBytes));
}

}  // namespace haustra::mesh
