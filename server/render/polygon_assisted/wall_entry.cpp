#include "render/polygon_assisted/wall_entry.h"

#include "core/parallel.h"
#include "core/voxel_sweep.h"
#include "render/scene/wall_normals.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace haustra::render {

namespace {

constexpr std::array<glm::ivec3, 6> neighbours = {
    {{-1, 0, 0}, {1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, -1}, {0, 0, 1}}};

}  // namespace

WallEntry::WallEntry(const Scene& scene, double marginMm)
    : blocks_(scene.ranges.size),
      voxelFromPatient_(scene.grid().voxelFromPatient()),
      patientFromVoxel_(scene.grid().patientFromVoxel),
      originMm_(scene.grid().patientFromVoxelPoint(0.5 * glm::dvec3(scene.grid().size) - 0.5)),
      side_(scene.ranges.lowHu.size(), lumen) {
    const TriMesh& mesh = *scene.wall;
    const std::vector<glm::dvec3> inwards = inwardNormals(mesh);
    std::vector<glm::dvec3> moved(mesh.vertices.size());
    wall_.places.resize(moved.size());
    for (std::size_t i = 0; i < moved.size(); ++i) {
        const glm::dvec3 place = mesh.vertices[i] + marginMm * inwards[i];
        wall_.places[i] = glm::vec4(place - originMm_, 0.0);
        moved[i] = blockCoordinate(place);
    }
    wall_.triangles = mesh.triangles;
    for (const glm::ivec3& t : mesh.triangles)
        touch(moved[std::size_t(t.x)], moved[std::size_t(t.y)], moved[std::size_t(t.z)]);
    floodOutside();
}

glm::dvec3 WallEntry::blockCoordinate(glm::dvec3 positionMm) const {
    return glm::dvec3(voxelFromPatient_ * glm::dvec4(positionMm, 1.0)) / double(blockSide);
}

std::size_t WallEntry::index(glm::ivec3 block) const {
    return std::size_t(block.x) +
           std::size_t(blocks_.x) *
               (std::size_t(block.y) + std::size_t(blocks_.y) * std::size_t(block.z));
}

bool WallEntry::contains(glm::ivec3 block) const {
    return glm::all(glm::greaterThanEqual(block, glm::ivec3(0))) &&
           glm::all(glm::lessThan(block, blocks_));
}

void WallEntry::touch(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    // The rasteriser rounds by less than this.
    constexpr double hair = 1e-3;
    const glm::ivec3 last = blocks_ - 1;
    // Blocks at the volume's faces also hold the half voxel beyond the last centres.
    const auto blockOf = [&](glm::dvec3 place) {
        return glm::clamp(glm::ivec3(glm::floor(glm::clamp(place, -1.0, 1e6))), glm::ivec3(0),
                          last);
    };
    const glm::ivec3 low = blockOf(glm::min(a, glm::min(b, c)) - hair),
                     high = blockOf(glm::max(a, glm::max(b, c)) + hair);
    const glm::dvec3 normal = glm::cross(b - a, c - a);
    const double reach = 0.5 * (std::abs(normal.x) + std::abs(normal.y) + std::abs(normal.z)) +
                         hair * glm::length(normal);
    visitBox(low, high, [&](glm::ivec3 block) {
        // Of the box and the plane; a box beside the triangle that its plane meets counts.
        const double away = std::abs(glm::dot(normal, glm::dvec3(block) + 0.5 - a));
        const bool atFace =
            glm::any(glm::equal(block, glm::ivec3(0))) || glm::any(glm::equal(block, last));
        if (away <= reach || atFace) side_[index(block)] = touched;
    });
}

void WallEntry::floodOutside() {
    // Row by row: nearly all blocks are outside, and lie in long rows of them.
    std::vector<glm::ivec3> open;  // the first blocks of rows that are not yet entered
    const auto openRow = [&](int first, int last, int y, int z) {
        if (y < 0 || z < 0 || y >= blocks_.y || z >= blocks_.z) return;
        const Side* row = &side_[index({0, y, z})];
        bool before = false;
        for (int x = first; x <= last; ++x) {
            const bool here = row[x] == lumen;
            if (here && !before) open.push_back({x, y, z});
            before = here;
        }
    };
    const auto enter = [&](glm::ivec3 block) {
        Side* row = &side_[index({0, block.y, block.z})];
        if (row[block.x] != lumen) return;
        int first = block.x, last = block.x;
        while (first > 0 && row[first - 1] == lumen)
            --first;
        while (last + 1 < blocks_.x && row[last + 1] == lumen)
            ++last;
        std::fill(row + first, row + last + 1, outside);
        openRow(first, last, block.y - 1, block.z);
        openRow(first, last, block.y + 1, block.z);
        openRow(first, last, block.y, block.z - 1);
        openRow(first, last, block.y, block.z + 1);
    };
    for (int z = 0; z < blocks_.z; ++z) {
        for (int y = 0; y < blocks_.y; ++y) {
            const bool rim = z == 0 || y == 0 || z == blocks_.z - 1 || y == blocks_.y - 1;
            for (int x = 0; x < blocks_.x; x += rim ? 1 : std::max(blocks_.x - 1, 1)) {
                enter({x, y, z});
                while (!open.empty()) {
                    const glm::ivec3 next = open.back();
                    open.pop_back();
                    enter(next);
                }
            }
        }
    }
}

std::vector<std::uint8_t> WallEntry::visibleBefore(const BlockRanges& ranges,
                                                   const TransferTable& table, int threads) const {
    std::vector<std::uint8_t> visible(side_.size());
    parallelFor(side_.size(), 1 << 16, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t i = begin; i < end; ++i)
            visible[i] = side_[i] != outside && table.anyVisible(ranges.lowHu[i], ranges.highHu[i]);
    });
    return visible;
}

EntryTriangles WallEntry::faces(const std::vector<std::uint8_t>& visible) const {
    EntryTriangles faces;
    const auto placeOf = [&](glm::dvec3 block) {
        const glm::dvec3 voxel = double(blockSide) * block;
        return glm::vec4(glm::dvec3(patientFromVoxel_ * glm::dvec4(voxel, 1.0)) - originMm_, 0.0);
    };
    for (std::size_t i = 0; i < visible.size(); ++i) {
        if (!visible[i]) continue;
        const std::size_t row = i / std::size_t(blocks_.x);
        const glm::ivec3 block(int(i % std::size_t(blocks_.x)), int(row % std::size_t(blocks_.y)),
                               int(row / std::size_t(blocks_.y)));
        for (int n = 0; n < 6; ++n) {
            const glm::ivec3 beside = block + neighbours[std::size_t(n)];
            const bool shown =
                contains(beside) && side_[index(beside)] != outside && !visible[index(beside)];
            if (!shown) continue;
            const int axis = n / 2;
            glm::dvec3 corner(block), u(0.0), v(0.0);
            corner[axis] += n % 2;
            u[(axis + 1) % 3] = 1.0;
            v[(axis + 2) % 3] = 1.0;
            const int first = int(faces.places.size());
            for (const glm::dvec3& place : {corner, corner + u, corner + u + v, corner + v})
                faces.places.push_back(placeOf(place));
            faces.triangles.push_back({first, first + 1, first + 2});
            faces.triangles.push_back({first, first + 2, first + 3});
        }
    }
    return faces;
}

bool WallEntry::isClear(glm::dvec3 positionMm, const std::vector<std::uint8_t>& visible) const {
    const glm::dvec3 place = glm::floor(blockCoordinate(positionMm));
    if (!glm::all(glm::greaterThanEqual(place, glm::dvec3(0.0))) ||
        !glm::all(glm::lessThan(place, glm::dvec3(blocks_))))
        return false;
    const std::size_t at = index(glm::ivec3(place));
    return side_[at] == lumen && !visible[at];
}

}  // namespace haustra::render
