#include "flatten/periodic_map.h"

#include <cmath>

namespace haustra::flatten {

void rotate(PeriodicMap& map, const TriMesh& tube, double shift) {
    std::vector<std::int8_t> wraps(map.flat.size());
    for (std::size_t v = 0; v < map.flat.size(); ++v) {
        const double moved = map.flat[v].x - shift;
        double turns = std::floor(moved);
        // Just below a whole number the difference can round up to 1.
        if (moved - turns >= 1.0) turns += 1.0;
        map.flat[v].x = moved - turns;
        wraps[v] = std::int8_t(turns);
    }
    for (std::size_t t = 0; t < map.turns.size(); ++t) {
        for (int c = 0; c < 3; ++c)
            map.turns[t][std::size_t(c)] += wraps[std::size_t(tube.triangles[t][c])];
        // Only differences within a triangle matter: the first corner's turn is made 0.
        const std::int8_t first = map.turns[t][0];
        for (std::int8_t& turn : map.turns[t])
            turn -= first;
    }
}

}  // namespace haustra::flatten
