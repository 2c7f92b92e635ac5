// What the writers of mesh files share.
#pragma once

#include <charconv>
#include <filesystem>
#include <string>

namespace haustra::mesh {

/// The value's bytes as they lie in memory.
template <class Number>
void appendRaw(std::string& bytes, const Number& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

/// The shortest text that reads back as the same number, and what follows it.
template <class Number>
void appendText(std::string& bytes, Number value, char after) {
    char text[32];
    bytes.append(text, std::to_chars(text, text + sizeof text, value).ptr);
    bytes.push_back(after);
}

/// Three numbers on a line.
template <class Vector>
void appendTextLine(std::string& bytes, const Vector& v) {
    appendText(bytes, v.x, ' ');
    appendText(bytes, v.y, ' ');
    appendText(bytes, v.z, '\n');
}

/// The name's ending in small letters.
std::string endingOf(const std::filesystem::path& file);

}  // namespace haustra::mesh
