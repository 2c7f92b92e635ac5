#include "core/simple_point.h"

namespace haustra {
namespace {

constexpr Neighbourhood center = 1u << 13;
constexpr Neighbourhood all = (1u << 27) - 1u;

/// The voxels of the 3 × 3 × 3 for which `holds(dx, dy, dz)`.
template <class Holds>
constexpr Neighbourhood voxelsWhere(const Holds& holds) {
    Neighbourhood found = 0;
    for (int n = 0; n < 27; ++n) {
        if (holds(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1)) found |= 1u << n;
    }
    return found;
}
constexpr int square(int value) {
    return value * value;
}

constexpr Neighbourhood six =
    voxelsWhere([](int x, int y, int z) { return square(x) + square(y) + square(z) == 1; });
constexpr Neighbourhood eighteen =
    voxelsWhere([](int x, int y, int z) { return square(x) + square(y) + square(z) <= 2; }) &
    ~center;
constexpr Neighbourhood twentySix = all & ~center;

// What a step along x or y may leave from; a step along z leaves by the ends of the word.
constexpr Neighbourhood notLastX = voxelsWhere([](int x, int, int) { return x < 1; });
constexpr Neighbourhood notFirstX = voxelsWhere([](int x, int, int) { return x > -1; });
constexpr Neighbourhood notLastY = voxelsWhere([](int, int y, int) { return y < 1; });
constexpr Neighbourhood notFirstY = voxelsWhere([](int, int y, int) { return y > -1; });

constexpr Neighbourhood wideX(Neighbourhood m) {
    return m | (m & notLastX) << 1 | (m & notFirstX) >> 1;
}
constexpr Neighbourhood wideY(Neighbourhood m) {
    return m | (m & notLastY) << 3 | (m & notFirstY) >> 3;
}
constexpr Neighbourhood wideZ(Neighbourhood m) {
    return m | m << 9 | m >> 9;
}

/// The set with its 6-neighbours, with its 18-neighbours, and with its 26-neighbours.
constexpr Neighbourhood dilated6(Neighbourhood m) {
    return wideX(m) | wideY(m) | wideZ(m);
}
constexpr Neighbourhood dilated18(Neighbourhood m) {
    const Neighbourhood y = wideY(m), z = wideZ(m);
    return wideX(y | z) | wideZ(y);
}
constexpr Neighbourhood dilated26(Neighbourhood m) {
    return wideX(wideY(wideZ(m)));
}

/// The component of `within` that holds `seed`.
template <auto dilated>
constexpr Neighbourhood flooded(Neighbourhood seed, Neighbourhood within) {
    for (Neighbourhood before = 0; before != seed;) {
        before = seed;
        seed = dilated(seed) & within;
    }
    return seed;
}

constexpr Neighbourhood lowestBit(Neighbourhood m) {
    return m & (~m + 1u);
}

/// Components of `within` that hold one of `entrances`.
template <auto dilated>
constexpr int countComponents(Neighbourhood within, Neighbourhood entrances) {
    int count = 0;
    for (Neighbourhood left = within & entrances; left; ++count)
        left &= ~flooded<dilated>(lowestBit(left), within);
    return count;
}

template <auto dilated>
constexpr bool isOneComponent(Neighbourhood within, Neighbourhood entrances) {
    const Neighbourhood from = within & entrances;
    return from && !(from & ~flooded<dilated>(lowestBit(from), within));
}

/// N₆³(x, X): the faces in X, the edges in X next to one of those, and the corners next to those.
Neighbourhood geodesic6(Neighbourhood object) {
    object &= twentySix;
    return dilated6(dilated6(object & six) & object) & object;
}

/// N₆²(x, X): the faces in X, and the edges in X next to one of those.
Neighbourhood geodesic6Of26(Neighbourhood object) {
    object &= eighteen;
    return dilated6(object & six) & object;
}

// What 18-adjacent steps from the 18-neighbours reach in two is N₁₈², and in more no more.
Neighbourhood background(Neighbourhood object) {
    return ~object & twentySix;
}

}  // namespace

int topologicalNumber6(Neighbourhood object) {
    return countComponents<dilated6>(geodesic6(object), six);
}

int topologicalNumber18(Neighbourhood object) {
    return countComponents<dilated18>(background(object), eighteen);
}

bool isSimple(Neighbourhood object) {
    return isOneComponent<dilated6>(geodesic6(object), six) &&
           isOneComponent<dilated18>(background(object), eighteen);
}

int topologicalNumber6Of26(Neighbourhood object) {
    return countComponents<dilated6>(geodesic6Of26(object), six);
}

int topologicalNumber26(Neighbourhood object) {
    return countComponents<dilated26>(background(object), twentySix);
}

bool isSimpleEitherWay(Neighbourhood object) {
    return isSimple(object) && isOneComponent<dilated6>(geodesic6Of26(object), six) &&
           isOneComponent<dilated26>(background(object), twentySix);
}

}  // namespace haustra
