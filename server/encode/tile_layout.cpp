#include "encode/tile_layout.h"

#include <algorithm>

namespace haustra::encode {
namespace {

constexpr int blockSide = 16;  // of JPEG with 4:2:0 chroma

int partLength(int side) {
    const int parts = (side + maxTileSide - 1) / maxTileSide;
    const int length = (side + parts - 1) / parts;
    return (length + blockSide - 1) / blockSide * blockSide;
}

}  // namespace

std::vector<TileRectangle> layOutTiles(int width, int height) {
    std::vector<TileRectangle> tiles;
    const int tileWidth = partLength(width), tileHeight = partLength(height);
    for (int y = 0; y < height; y += tileHeight)
        for (int x = 0; x < width; x += tileWidth)
            tiles.push_back(
                {x, y, std::min(tileWidth, width - x), std::min(tileHeight, height - y)});
    return tiles;
}

}  // namespace haustra::encode
