#include "contouring/cell_cases.h"

namespace haustra::contouring {
namespace {

constexpr bool isInside(unsigned inside, int corner) {
    return inside >> corner & 1;
}
constexpr bool isCrossed(unsigned inside, int edge) {
    return isInside(inside, lowerCorner(edge)) != isInside(inside, upperCorner(edge));
}
constexpr int insideCorner(unsigned inside, int edge) {
    return isInside(inside, lowerCorner(edge)) ? lowerCorner(edge) : upperCorner(edge);
}
constexpr bool isOnFace(int edge, int axis, int side) {
    return edge / 4 != axis && (lowerCorner(edge) >> axis & 1) == side;
}

constexpr void joinLoops(CellLoops& loops, int edge, int other) {
    const std::int8_t from = loops.loopOfEdge[other], to = loops.loopOfEdge[edge];
    for (std::int8_t& loop : loops.loopOfEdge) {
        if (loop == from) loop = to;
    }
}

constexpr CellLoops findLoops(unsigned inside) {
    CellLoops loops;
    for (int e = 0; e < cellEdges; ++e)
        loops.loopOfEdge[e] = isCrossed(inside, e) ? std::int8_t(e) : std::int8_t(-1);
    for (int face = 0; face < 6; ++face) {
        int crossed = 0;
        for (int e = 0; e < cellEdges; ++e)
            crossed += isOnFace(e, face / 2, face % 2) && isCrossed(inside, e);
        for (int e = 0; e < cellEdges; ++e) {
            for (int f = e + 1; f < cellEdges; ++f) {
                if (!isOnFace(e, face / 2, face % 2) || !isOnFace(f, face / 2, face % 2)) continue;
                if (!isCrossed(inside, e) || !isCrossed(inside, f)) continue;
                if (crossed == 2 || insideCorner(inside, e) == insideCorner(inside, f))
                    joinLoops(loops, e, f);
            }
        }
    }
    // Number the loops from 0 in the order of their first edges.
    std::array<std::int8_t, cellEdges> number{};
    for (int e = 0; e < cellEdges; ++e) {
        const std::int8_t loop = loops.loopOfEdge[e];
        if (loop < 0) continue;
        bool seen = false;
        for (int f = 0; f < e; ++f)
            seen = seen || loops.loopOfEdge[f] == loop;
        if (!seen) number[loop] = loops.count++;
    }
    for (std::int8_t& loop : loops.loopOfEdge) {
        if (loop >= 0) loop = number[loop];
    }
    return loops;
}

constexpr std::array<CellLoops, 256> table = [] {
    std::array<CellLoops, 256> cases;
    for (unsigned inside = 0; inside < cases.size(); ++inside)
        cases[inside] = findLoops(inside);
    return cases;
}();

}  // namespace

const CellLoops& cellLoops(CellCase inside) {
    return table[inside];
}

}  // namespace haustra::contouring
