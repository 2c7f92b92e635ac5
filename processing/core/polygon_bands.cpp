#include "core/polygon_bands.h"

#include <algorithm>

namespace haustra {
namespace {

/// An edge from its lower end to its upper one.
struct Rising {
    glm::dvec2 low, high;
    double xAt(double y) const {
        const double t = std::clamp((y - low.y) / (high.y - low.y), 0.0, 1.0);
        return low.x + t * (high.x - low.x);
    }
};

void addCrossing(const Rising& a, const Rising& b, std::vector<double>& heights) {
    if (a.high.y <= b.low.y || b.high.y <= a.low.y) return;
    const glm::dvec2 along = a.high - a.low, other = b.high - b.low;
    const double turn = cross(along, other);
    if (turn == 0.0) return;
    const double t = cross(b.low - a.low, other) / turn;
    const double s = cross(b.low - a.low, along) / turn;
    if (t > 0.0 && t < 1.0 && s > 0.0 && s < 1.0) heights.push_back(a.low.y + t * along.y);
}

}  // namespace

std::vector<Trapezoid> evenOddTrapezoids(const std::vector<glm::dvec2>& polygon) {
    std::vector<Rising> edges;
    std::vector<double> heights;
    for (std::size_t n = 0; n < polygon.size(); ++n) {
        const glm::dvec2 a = polygon[n], b = polygon[(n + 1) % polygon.size()];
        heights.push_back(a.y);
        if (a.y < b.y) edges.push_back({a, b});
        if (b.y < a.y) edges.push_back({b, a});
    }
    std::sort(edges.begin(), edges.end(),
              [](const Rising& a, const Rising& b) { return a.low.y < b.low.y; });
    for (std::size_t n = 0; n < edges.size(); ++n) {
        for (std::size_t m = n + 1; m < edges.size() && edges[m].low.y < edges[n].high.y; ++m)
            addCrossing(edges[n], edges[m], heights);
    }
    std::sort(heights.begin(), heights.end());
    heights.erase(std::unique(heights.begin(), heights.end()), heights.end());

    // Within a band edges do not cross: ordered at half height, every other gap is inside.
    std::vector<Trapezoid> pieces;
    struct Side {
        double middle, bottom, top;
    };
    std::vector<Side> sides;
    for (std::size_t n = 1; n < heights.size(); ++n) {
        const double bottom = heights[n - 1], top = heights[n];
        sides.clear();
        for (const Rising& edge : edges) {
            if (edge.low.y > bottom) break;
            if (edge.high.y >= top)
                sides.push_back({edge.xAt(0.5 * (bottom + top)), edge.xAt(bottom), edge.xAt(top)});
        }
        std::sort(sides.begin(), sides.end(),
                  [](const Side& a, const Side& b) { return a.middle < b.middle; });
        for (std::size_t s = 0; s + 1 < sides.size(); s += 2) {
            const Side &left = sides[s], &right = sides[s + 1];
            pieces.push_back({glm::dvec2(left.bottom, bottom), glm::dvec2(right.bottom, bottom),
                              glm::dvec2(right.top, top), glm::dvec2(left.top, top)});
        }
    }
    return pieces;
}

}  // namespace haustra
