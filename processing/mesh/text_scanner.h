// Words and numbers of a text file, one by one.
#pragma once

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace haustra::mesh {

/// Walks over bytes that outlive it; never past their end.
class TextScanner {
public:
    explicit TextScanner(std::span<const char> bytes) : rest_(bytes.data(), bytes.size()) {}
    explicit TextScanner(std::string_view text) : rest_(text) {}

    bool atEnd() const { return rest_.empty(); }
    std::string_view rest() const { return rest_; }

    /// The next line without its end; empty at the end.
    std::string_view line() {
        const std::size_t end = rest_.find('\n');
        std::string_view found = rest_.substr(0, end);
        rest_.remove_prefix(end == rest_.npos ? rest_.size() : end + 1);
        if (!found.empty() && found.back() == '\r') found.remove_suffix(1);
        return found;
    }

    /// The next word between white space; empty at the end.
    std::string_view word() {
        rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n\v\f"), rest_.size()));
        std::string_view found = rest_.substr(0, rest_.find_first_of(" \t\r\n\v\f"));
        rest_.remove_prefix(found.size());
        return found;
    }

    std::optional<double> number() { return parse<double>(word()); }
    std::optional<std::int64_t> integer() { return parse<std::int64_t>(word()); }

    /// The whole of `text` as a number (a leading + is allowed), or nothing.
    template <class Number>
    static std::optional<Number> parse(std::string_view text) {
        if (text.starts_with('+')) text.remove_prefix(1);
        Number value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size() || text.empty()) return {};
        return value;
    }

private:
    std::string_view rest_;
};

}  // namespace haustra::mesh
