// A candidate as a body: where it ends on the wall, how large it is, which voxels are its tissue.
#pragma once

#include "cad/candidates.h"
#include "core/findings.h"
#include "core/zeroed_array.h"

#include <cstdint>
#include <optional>
#include <set>
#include <span>
#include <vector>

namespace haustra::cad {

/// A patch of the wall as a body that stands on a base. The base is a membrane, spanned from the
/// patch's rim as a soap film: the wall as it would be without the body.
struct Lesion {
    Patch patch;
    /// Of its volume; of the patch, by area, where parts above and beneath the base cancel so far
    /// that its volume's would lie beyond the box around the body.
    glm::dvec3 centerMm{0.0};
    glm::dvec3 topMm{0.0};     ///< the sample farthest above the base
    glm::dvec3 axis{0, 0, 1};  ///< unit, from the base into the lumen
    /// Of the patch and of what rises around it up to the foot; of a head on a stalk, the patch.
    Diameter diameter;
    /// The patch's greatest extent square to diameter and axis. The diameter is taken down to the
    /// foot, so that of a round body this is less, by what its foot stands out.
    double widthMm = 0.0;
    double heightMm = 0.0;   ///< of the top above the base, along the axis
    double volumeMm3 = 0.0;  ///< between patch and base
    double areaMm2 = 0.0;    ///< of the patch
    double baseMm2 = 0.0;    ///< of the base
    /// Voxels of the scan's grid whose centres lie between patch and base; where it holds none,
    /// those right beneath the patch.
    std::vector<VoxelRun> voxels;
};

/// Whether it is a head on a stalk: its base is narrower than 0.7 of it, both as discs of the same
/// area, so that what is long and low has none.
bool standsOnStalk(const Lesion& lesion);

/// Some samples, numbered from 0 in the order in which they were added. Emptied at no cost, so that
/// one serves for patch after patch. Belongs to one thread.
class SampleNumbers {
public:
    /// Of `samples` < 2³¹; their marks are made anew once so many, at least, have been added.
    explicit SampleNumbers(std::size_t samples, std::uint32_t mostMarks = 1u << 31)
        : size_(samples), mostMarks_(mostMarks), numberOf_(samples) {}
    void clear() {
        first_ += count();
        samples_.clear();
        if (first_ < mostMarks_) return;
        numberOf_ = ZeroedArray<std::uint32_t>(size_);
        first_ = 1;
    }
    void add(std::uint32_t sample) {
        if (has(sample)) return;
        const std::uint32_t mark = first_ + count();
        samples_.push_back(sample);
        numberOf_[sample] = mark;
    }
    bool has(std::uint32_t sample) const { return numberOf_[sample] >= first_; }
    /// Of a sample that has been added.
    std::uint32_t number(std::uint32_t sample) const { return numberOf_[sample] - first_; }
    std::uint32_t sample(std::uint32_t number) const { return samples_[number]; }
    std::uint32_t count() const { return std::uint32_t(samples_.size()); }

private:
    std::size_t size_;
    std::uint32_t mostMarks_;
    std::uint32_t first_ = 1;              // the mark of number 0: lower ones are of patches before
    ZeroedArray<std::uint32_t> numberOf_;  // of each sample, and first_ more
    std::vector<std::uint32_t> samples_;
};

/// Numbers the samples within a distance of the patch along the wall: the patch's first, in their
/// order, then the others, ring after ring. Each one's distance, along the edges of a breadth-first
/// search: a tenth too long in the mean, of one in seven a fifth and more, so that some at the rim
/// are left out. O(numbered samples).
std::vector<double> widen(const WallSamples& wall, std::span<const std::uint32_t> patch,
                          double byMm, SampleNumbers& numbers);

/// Of a patch that has triangles of its own; else nothing. `numbers`: of all samples, for its own
/// use. O(samples of the patch · their width).
std::optional<Lesion> standUp(const WallEvidence& evidence, Patch patch, const Grid& grid,
                              SampleNumbers& numbers);

/// One voxel of the scan beneath each of the samples, so that a picture of the wall shows them: of
/// the eight voxels around the point half a voxel beneath, it is the one of the greatest weight
/// there whose centre lies behind the wall. By their indices.
std::set<std::size_t> voxelsBehind(const WallEvidence& evidence,
                                   std::span<const std::uint32_t> samples, const Grid& grid);

/// What a finding tells as its tissue, in memory order: the lesion's voxels that are no gas (a wide
/// one's film lies in the lumen), and voxelsBehind() its patch, since a body thinner than voxels
/// holds few of their centres.
std::vector<VoxelRun> segmentationOf(const PreparedColon& colon, const WallEvidence& evidence,
                                     const Lesion& lesion);

/// Voxels of a grid, by their indices.
std::vector<VoxelRun> runsOf(const std::set<std::size_t>& voxels, const Grid& grid);
/// Runs of the voxels whose centres, moved by some millionths of a voxel, lie within a closed mesh
/// (even–odd along i).
std::vector<VoxelRun> voxelsWithin(const TriMesh& body, const Grid& grid);

}  // namespace haustra::cad
