#include "topology/run_components.h"

#include "core/disjoint_sets.h"
#include "core/parallel.h"

#include <algorithm>
#include <numeric>

namespace haustra::topology {

RunComponents::RunComponents(const Volume<std::int16_t>& volume, double below, int threads)
    : size_(volume.grid().size) {
    const std::size_t rows = std::size_t(size_.y) * std::size_t(size_.z);
    const std::int16_t* voxels = volume.voxels().data();
    std::vector<std::vector<Run>> slices(static_cast<std::size_t>(size_.z));
    rowBegin_.assign(rows + 1, 0);
    parallelFor(slices.size(), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t k = first; k < last; ++k) {
            for (int j = 0; j < size_.y; ++j) {
                const std::int16_t* row = voxels + volume.grid().index(0, j, int(k));
                const std::size_t before = slices[k].size();
                for (int i = 0; i < size_.x;) {
                    while (i < size_.x && !(row[i] < below))
                        ++i;
                    const int begin = i;
                    while (i < size_.x && row[i] < below)
                        ++i;
                    if (i > begin) slices[k].push_back({begin, i, 0});
                }
                rowBegin_[std::size_t(j) + std::size_t(size_.y) * k + 1] =
                    slices[k].size() - before;
            }
        }
    });
    std::partial_sum(rowBegin_.begin(), rowBegin_.end(), rowBegin_.begin());
    runs_.reserve(rowBegin_.back());
    for (auto& slice : slices) {
        runs_.insert(runs_.end(), slice.begin(), slice.end());
        std::vector<Run>().swap(slice);
    }

    std::vector<std::int32_t> parent(runs_.size());
    std::iota(parent.begin(), parent.end(), 0);
    auto uniteRows = [&](std::size_t rowA, std::size_t rowB) {
        std::size_t a = rowBegin_[rowA], b = rowBegin_[rowB];
        while (a < rowBegin_[rowA + 1] && b < rowBegin_[rowB + 1]) {
            if (runs_[a].begin < runs_[b].end && runs_[b].begin < runs_[a].end) {
                // A component is named by its first run.
                unite(parent, std::int32_t(a), std::int32_t(b));
            }
            runs_[a].end < runs_[b].end ? ++a : ++b;
        }
    };
    for (int k = 0; k < size_.z; ++k) {
        for (int j = 0; j < size_.y; ++j) {
            const std::size_t r = std::size_t(j) + std::size_t(size_.y) * std::size_t(k);
            if (j > 0) uniteRows(r - 1, r);
            if (k > 0) uniteRows(r - std::size_t(size_.y), r);
        }
    }

    std::vector<std::int32_t> number(runs_.size(), -1);
    for (std::size_t r = 0; r < rows; ++r) {
        const int j = int(r % std::size_t(size_.y)), k = int(r / std::size_t(size_.y));
        for (std::size_t n = rowBegin_[r]; n < rowBegin_[r + 1]; ++n) {
            std::int32_t& name = number[rootOf(parent, std::int32_t(n))];
            if (name < 0) {
                name = std::int32_t(components_.size());
                components_.push_back({0, glm::ivec3(size_), glm::ivec3(-1), glm::dvec3(0.0)});
            }
            Run& run = runs_[n];
            run.component = name;
            RunComponent& c = components_[name];
            const int length = run.end - run.begin;
            c.voxels += std::uint64_t(length);
            c.lowest = glm::min(c.lowest, glm::ivec3(run.begin, j, k));
            c.highest = glm::max(c.highest, glm::ivec3(run.end - 1, j, k));
            c.centroid += double(length) * glm::dvec3(0.5 * (run.begin + run.end - 1), j, k);
        }
    }
    for (RunComponent& c : components_)
        c.centroid /= double(c.voxels);
}

int RunComponents::at(glm::ivec3 voxel) const {
    const auto runs = row(voxel.y, voxel.z);
    const auto after = std::upper_bound(runs.begin(), runs.end(), voxel.x,
                                        [](int i, const Run& run) { return i < run.begin; });
    if (after == runs.begin() || (after - 1)->end <= voxel.x) return -1;
    return (after - 1)->component;
}

}  // namespace haustra::topology
