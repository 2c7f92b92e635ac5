// PLY: a header that describes elements and their properties, then the elements.
#include "mesh/polygon_soup.h"
#include "mesh/text_scanner.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <limits>

namespace haustra::mesh {
namespace {

enum class Encoding { text, littleEndian, bigEndian };

struct NumberType {
    char kind;  // i(nteger), u(nsigned), f(loat)
    int bytes;
};

struct Property {
    std::string_view name;
    NumberType type{};
    std::optional<NumberType> countType;  // of a list
};

struct Element {
    std::string_view name;
    std::int64_t count = 0;
    std::vector<Property> properties;
};

struct Header {
    Encoding encoding = Encoding::text;
    std::vector<Element> elements;
    std::string_view body;
};

std::optional<NumberType> numberType(std::string_view name) {
    struct Named {
        std::string_view name;
        NumberType type;
    };
    static constexpr Named names[] = {
        {"char", {'i', 1}},  {"int8", {'i', 1}},    {"uchar", {'u', 1}},  {"uint8", {'u', 1}},
        {"short", {'i', 2}}, {"int16", {'i', 2}},   {"ushort", {'u', 2}}, {"uint16", {'u', 2}},
        {"int", {'i', 4}},   {"int32", {'i', 4}},   {"uint", {'u', 4}},   {"uint32", {'u', 4}},
        {"float", {'f', 4}}, {"float32", {'f', 4}}, {"double", {'f', 8}}, {"float64", {'f', 8}},
    };
    for (const Named& known : names) {
        if (known.name == name) return known.type;
    }
    return {};
}

std::optional<Property> scanProperty(TextScanner& line) {
    Property property;
    std::string_view type = line.word();
    if (type == "list") {
        property.countType = numberType(line.word());
        if (!property.countType) return {};
        type = line.word();
    }
    const auto known = numberType(type);
    property.name = line.word();
    if (!known || property.name.empty()) return {};
    property.type = *known;
    return property;
}

std::optional<Header> scanHeader(TextScanner scanner) {
    Header header;
    bool hasFormat = false;
    if (scanner.line() != "ply") return {};
    while (!scanner.atEnd()) {
        TextScanner line(scanner.line());
        const std::string_view keyword = line.word();
        if (keyword == "format") {
            const std::string_view encoding = line.word();
            hasFormat = true;
            if (encoding == "binary_little_endian")
                header.encoding = Encoding::littleEndian;
            else if (encoding == "binary_big_endian")
                header.encoding = Encoding::bigEndian;
            else if (encoding != "ascii")
                return {};
        } else if (keyword == "element") {
            Element element;
            element.name = line.word();
            const auto count = line.integer();
            if (!count || *count < 0) return {};
            element.count = *count;
            header.elements.push_back(element);
        } else if (keyword == "property") {
            const auto property = scanProperty(line);
            if (!property || header.elements.empty()) return {};
            header.elements.back().properties.push_back(*property);
        } else if (keyword == "end_header") {
            header.body = scanner.rest();
            return hasFormat ? std::optional(header) : std::nullopt;
        } else if (keyword != "comment" && keyword != "obj_info" && !keyword.empty()) {
            return {};
        }
    }
    return {};
}

/// The body's numbers, one by one, whatever the encoding. Every number is exact in a double.
class NumberReader {
public:
    NumberReader(std::string_view body, Encoding encoding) : rest_(body), encoding_(encoding) {}

    std::optional<double> next(NumberType type) {
        if (encoding_ == Encoding::text) {
            TextScanner scanner(rest_);
            const auto value = scanner.number();
            rest_ = scanner.rest();
            return value;
        }
        if (rest_.size() < std::size_t(type.bytes)) return {};
        std::array<char, 8> bytes{};
        std::copy_n(rest_.data(), type.bytes, bytes.data());
        rest_.remove_prefix(std::size_t(type.bytes));
        if (encoding_ == Encoding::bigEndian) std::reverse(bytes.data(), bytes.data() + type.bytes);
        return decode(bytes, type);
    }

private:
    template <class Number>
    static double as(const std::array<char, 8>& bytes) {
        Number value;
        std::memcpy(&value, bytes.data(), sizeof value);
        return double(value);
    }

    static double decode(const std::array<char, 8>& bytes, NumberType type) {
        if (type.kind == 'f') return type.bytes == 4 ? as<float>(bytes) : as<double>(bytes);
        const bool isSigned = type.kind == 'i';
        if (type.bytes == 1) return isSigned ? as<std::int8_t>(bytes) : as<std::uint8_t>(bytes);
        if (type.bytes == 2) return isSigned ? as<std::int16_t>(bytes) : as<std::uint16_t>(bytes);
        return isSigned ? as<std::int32_t>(bytes) : as<std::uint32_t>(bytes);
    }

    std::string_view rest_;
    Encoding encoding_;
};

/// The number as an index, or one that no mesh has where it is none.
std::int64_t toIndex(double value) {
    const bool isIndex = value >= 0.0 && value < 4294967296.0 && value == std::floor(value);
    return isIndex ? std::int64_t(value) : -1;
}

/// Reads one property; `use` takes its numbers, one or a list. False where the body ends early.
template <class Use>
bool readProperty(NumberReader& numbers, const Property& property, const Use& use) {
    std::int64_t count = 1;
    if (property.countType) {
        const auto stated = numbers.next(*property.countType);
        if (!stated) return false;
        count = toIndex(*stated);
        if (count < 0) return false;
    }
    for (std::int64_t i = 0; i < count; ++i) {
        const auto value = numbers.next(property.type);
        if (!value) return false;
        use(*value);
    }
    return true;
}

bool readVertex(NumberReader& numbers, const Element& element, PolygonSoup& soup) {
    glm::dvec3 point(std::numeric_limits<double>::quiet_NaN());
    for (const Property& property : element.properties) {
        const bool isAxis = !property.countType && property.name.size() == 1 &&
                            property.name[0] >= 'x' && property.name[0] <= 'z';
        const bool read = readProperty(numbers, property, [&](double value) {
            if (isAxis) point[property.name[0] - 'x'] = value;
        });
        if (!read) return false;
    }
    soup.points.push_back(point);
    return true;
}

bool readFace(NumberReader& numbers, const Element& element, PolygonSoup& soup) {
    for (const Property& property : element.properties) {
        const bool isCorners = property.countType && (property.name == "vertex_indices" ||
                                                      property.name == "vertex_index");
        const bool read = readProperty(numbers, property, [&](double value) {
            if (isCorners) soup.corners.push_back(toIndex(value));
        });
        if (!read) return false;
    }
    soup.endPolygon();
    return true;
}

bool readIgnored(NumberReader& numbers, const Element& element) {
    return std::all_of(
        element.properties.begin(), element.properties.end(),
        [&](const Property& property) { return readProperty(numbers, property, [](double) {}); });
}

}  // namespace

Result<PolygonSoup> readPly(std::span<const char> bytes, const std::string& place) {
    const auto header = scanHeader(TextScanner(bytes));
    if (!header) return fail(ErrorKind::badInput, "the file has no valid PLY header", place);
    NumberReader numbers(header->body, header->encoding);
    PolygonSoup soup;
    for (const Element& element : header->elements) {
        if (element.properties.empty()) continue;  // takes no bytes, however many are claimed
        for (std::int64_t i = 0; i < element.count; ++i) {
            const bool read = element.name == "vertex" ? readVertex(numbers, element, soup)
                              : element.name == "face" ? readFace(numbers, element, soup)
                                                       : readIgnored(numbers, element);
            if (!read) return fail(ErrorKind::badInput, "the PLY file ends early", place);
        }
    }
    return soup;
}

}  // namespace haustra::mesh
