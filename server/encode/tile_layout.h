// How a picture is cut into tiles.
#pragma once

#include <vector>

namespace haustra::encode {

struct TileRectangle {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Longest side of a tile. Small tiles waste bytes (METHODS §21 "Pictures on the wire"); one of
/// this size is coded in a few milliseconds.
inline constexpr int maxTileSide = 512;

/// Rows of tiles from the top, each from the left, that cover the picture once. Every side of the
/// picture is cut into the fewest near-equal parts of at most maxTileSide, so that a tile is under
/// 128 pixels only where the picture is. Cuts lie on multiples of 16, where JPEG's blocks end.
std::vector<TileRectangle> layOutTiles(int width, int height);

}  // namespace haustra::encode
