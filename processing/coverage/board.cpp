#include "coverage/board.h"

#include <array>
#include <charconv>

namespace haustra::coverage {
namespace {

constexpr std::array<std::pair<std::string_view, BoardPattern>, 3> patterns{
    {{"checkerboard", BoardPattern::checkerboard},
     {"dots", BoardPattern::dots},
     {"asymmetric-dots", BoardPattern::asymmetricDots}}};
constexpr int mostASide = 200;

std::optional<int> countOf(std::string_view text) {
    int count = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), count);
    if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
    return count;
}

}  // namespace

std::optional<Board> boardOfText(std::string_view text) {
    const std::size_t colon = text.find(':');
    const std::size_t cross = text.find('x', colon == text.npos ? 0 : colon);
    if (colon == text.npos || cross == text.npos) return std::nullopt;
    for (const auto& [name, pattern] : patterns) {
        if (text.substr(0, colon) != name) continue;
        const auto columns = countOf(text.substr(colon + 1, cross - colon - 1)),
                   rows = countOf(text.substr(cross + 1));
        const int fewest = pattern == BoardPattern::checkerboard ? 4 : 3;
        if (!columns || !rows || std::min(*columns, *rows) < fewest ||
            std::max(*columns, *rows) > mostASide)
            return std::nullopt;
        return Board{pattern, {*columns, *rows}};
    }
    return std::nullopt;
}

std::string textOf(const Board& board) {
    std::string text;
    for (const auto& [name, pattern] : patterns)
        if (pattern == board.pattern) text = name;
    return text + ":" + std::to_string(board.count.x) + "x" + std::to_string(board.count.y);
}

int pointCount(const Board& board) {
    const int less = board.pattern == BoardPattern::checkerboard ? 1 : 0;
    return (board.count.x - less) * (board.count.y - less);
}

}  // namespace haustra::coverage
