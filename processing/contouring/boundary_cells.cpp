#include "contouring/boundary_cells.h"

#include "core/ct_scan.h"

#include <algorithm>
#include <cstring>

namespace haustra::contouring {
namespace {

/// The four rows of voxels that bound a row of cells, each with an outside voxel before and after.
class CellRow {
public:
    explicit CellRow(int width) : width_(width), nothing_(std::size_t(width), 0), rows_{} {}

    void moveTo(const Volume<std::uint8_t>& lumen, int j, int k) {
        const glm::ivec3 size = lumen.grid().size;
        for (int n = 0; n < 4; ++n) {
            const int y = j + (n & 1), z = k + (n >> 1);
            const bool within = y >= 0 && z >= 0 && y < size.y && z < size.z;
            rows_[n] =
                within ? lumen.voxels().data() + lumen.grid().index(0, y, z) : nothing_.data();
        }
    }

    /// Inside corners of column i, −1 ≤ i ≤ width: bits 0, 2, 4 and 6.
    unsigned column(int i) const {
        if (i < 0 || i >= width_) return 0;
        return unsigned(rows_[0][i] != 0) | unsigned(rows_[1][i] != 0) << 2 |
               unsigned(rows_[2][i] != 0) << 4 | unsigned(rows_[3][i] != 0) << 6;
    }

    /// Whether columns [i, i + 8) are alike, all inside or all outside.
    bool allAlike(int i) const {
        std::uint64_t words[4];
        for (int n = 0; n < 4; ++n)
            std::memcpy(&words[n], rows_[n] + i, 8);
        if ((words[0] | words[1] | words[2] | words[3]) == 0) return true;
        constexpr std::uint64_t ones = 0x0101010101010101u;
        // A byte is not 0 where one of its bits 0 to 2 is set.
        static_assert(int(LumenLabel::untagged) < 8);
        for (std::uint64_t word : words) {
            if (((word | word >> 1 | word >> 2) & ones) != ones) return false;
        }
        return true;
    }

private:
    int width_;
    std::vector<std::uint8_t> nothing_;
    const std::uint8_t* rows_[4];
};

void findRow(const CellRow& row, int j, int width, std::vector<BoundaryCell>& found) {
    unsigned low = 0;
    for (int i = -1; i < width; ++i) {
        if (i >= 0 && i + 9 <= width && (low == 0 || low == 0x55) && row.allAlike(i + 1) &&
            row.column(i + 1) == low) {
            i += 7;  // columns i … i + 8 are alike: their eight cells are not crossed
            continue;
        }
        const unsigned high = row.column(i + 1);
        const unsigned inside = low | high << 1;
        if (inside != 0 && inside != 0xff) found.push_back({i, j, 0, CellCase(inside)});
        low = high;
    }
}

}  // namespace

BoundaryCells::BoundaryCells(const Volume<std::uint8_t>& lumen, int threads)
    : size_(lumen.grid().size) {
    std::vector<std::vector<BoundaryCell>> found(std::size_t(size_.z) + 1);
    parallelFor(found.size(), 1, threads, [&](std::size_t begin, std::size_t end) {
        CellRow row(size_.x);
        for (std::size_t n = begin; n < end; ++n) {
            for (int j = -1; j < size_.y; ++j) {
                row.moveTo(lumen, j, ofLayer(int(n)));
                findRow(row, j, size_.x, found[n]);
            }
        }
    });
    begin_.assign(1, 0);
    for (const auto& layer : found)
        begin_.push_back(begin_.back() + layer.size());
    cells_.reserve(begin_.back());
    for (auto& layer : found) {
        for (BoundaryCell cell : layer) {
            cell.firstVertex = std::int32_t(vertexCount_);
            vertexCount_ += std::size_t(cellLoops(cell.inside).count);
            cells_.push_back(cell);
        }
        layer = {};
    }
}

LayerPair::LayerPair(const BoundaryCells& cells) : cells_(cells), width_(cells.gridSize().x + 1) {
    const std::size_t places = std::size_t(width_) * std::size_t(cells.gridSize().y + 1);
    for (auto& map : maps_)
        map.assign(places, -1);
}

glm::ivec3 BoundaryCells::low() const {
    glm::ivec3 least(size_);
    for (int n = 0; n < layers(); ++n)
        for (const BoundaryCell& cell : layer(n))
            least = glm::min(least, glm::ivec3(cell.i, cell.j, ofLayer(n)));
    return least;
}

void LayerPair::fill(int map, int layer) {
    if (layerOf_[map] == layer) return;
    if (layerOf_[map] >= 0) {
        for (const BoundaryCell& cell : cells_.layer(layerOf_[map]))
            maps_[map][place(cell.i, cell.j)] = -1;
    }
    layerOf_[map] = layer;
    if (layer < 0) return;
    std::int32_t index = std::int32_t(cells_.layerBegin(layer));
    for (const BoundaryCell& cell : cells_.layer(layer))
        maps_[map][place(cell.i, cell.j)] = index++;
}

void LayerPair::moveTo(int n) {
    if (layerOf_[1 - current_] == n || layerOf_[current_] == n - 1) current_ = 1 - current_;
    fill(current_, n);
    fill(1 - current_, n - 1);
}

}  // namespace haustra::contouring
