#include "segmentation/tube_pieces.h"

#include "core/disjoint_sets.h"
#include "core/flood_fill.h"
#include "core/voxel_sweep.h"
#include "segmentation/bowel_contents.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>
#include <utility>

namespace haustra::segmentation {
namespace {

constexpr double ticksPerMm = 32.0;
constexpr std::int32_t none = -1;

bool isContent(std::uint8_t content) {
    return Content(content) == Content::gas || Content(content) == Content::tagged ||
           Content(content) == Content::interface || Content(content) == Content::untagged;
}

/// A tally of each piece: tell(tally, index, voxel) of all its voxels. Each slab of the grid has
/// tallies of its own, which are added in order: sums must not depend on how slabs are cut.
template <class Tally, class Tell>
std::vector<Tally> tallyPieces(std::span<const std::int32_t> label, std::size_t pieces,
                               const Grid& grid, int threads, const Tell& tell) {
    const std::size_t depth = std::size_t(grid.size.z),
                      count = 2 * std::size_t(threadCount(threads)),
                      slabDepth = (depth + count - 1) / count;
    std::vector<std::vector<Tally>> slabs((depth + slabDepth - 1) / slabDepth);
    parallelFor(slabs.size(), 1, threads, [&](std::size_t first, std::size_t last) {
        for (std::size_t s = first; s < last; ++s) {
            slabs[s].resize(pieces);
            const std::int32_t* const pieceOf = label.data();
            Tally* const tallies = slabs[s].data();
            visitSlices(grid, s * slabDepth, std::min(depth, (s + 1) * slabDepth),
                        [&](std::size_t n, glm::ivec3 v) {
                            if (pieceOf[n] >= 0) tell(tallies[pieceOf[n]], n, v);
                        });
        }
    });
    for (std::size_t s = 1; s < slabs.size(); ++s) {
        for (std::size_t p = 0; p < pieces; ++p)
            slabs[0][p].add(slabs[s][p]);
    }
    return std::move(slabs[0]);
}

void renumber(std::span<std::int32_t> label, const std::vector<std::int32_t>& number, int threads) {
    constexpr std::size_t grain = std::size_t(1) << 20;
    parallelFor(label.size(), grain, threads, [&](std::size_t begin, std::size_t end) {
        for (std::int32_t& of : label.subspan(begin, end - begin))
            if (of >= 0) of = number.data()[of];
    });
}

/// Watershed basins of the distance: from each voxel uphill to a peak, and the basins merged where
/// they meet, by falling distance.
class Basins {
public:
    Basins(const Volume<float>& distanceMm, std::span<std::int32_t> label, int threads)
        : distanceMm_(distanceMm),
          grid_(distanceMm.grid()),
          label_(label.data()),
          uphill_(grid_, notInside),
          threads_(threads) {}

    /// Labels each voxel with its basin; returns how many there are.
    std::size_t flood(double neck) {
        findUphill();
        findPeaks();
        goUphill();
        merge(neck);
        return numberRoots();
    }

private:
    // Of `uphill_`; else 1 + the face (2 · axis, + 1 upwards) towards the deepest neighbour before.
    static constexpr std::uint8_t notInside = 0, peak = 7;

    static std::size_t ticks(float mm) {
        return std::size_t(std::min(mm, 1000.0f) * float(ticksPerMm));
    }
    /// The farthest from the boundary come first, of equals the first in memory.
    bool isBefore(std::size_t m, std::size_t n) const {
        const std::size_t a = ticks(distanceMm_[m]), b = ticks(distanceMm_[n]);
        return a > b || (a == b && m < n);
    }
    std::size_t stepUphill(std::size_t n) const {
        const std::ptrdiff_t strides[3] = {1, grid_.size.x,
                                           std::ptrdiff_t(grid_.size.x) * grid_.size.y};
        const int face = uphill_[n] - 1;
        return n + std::size_t(face % 2 ? strides[face / 2] : -strides[face / 2]);
    }

    void findUphill() {
        const auto uphill = uphill_.writable();
        forVoxels(grid_, threads_, [&](std::size_t n, glm::ivec3 v) {
            label_[n] = none;
            if (!(distanceMm_[n] > 0.0f)) return;
            float deepest = 0.0f;
            uphill[n] = peak;
            visitFaces(grid_, n, v, [&](std::size_t m, int axis) {
                if (distanceMm_[m] > deepest && isBefore(m, n))
                    deepest = distanceMm_[m], uphill[n] = std::uint8_t(2 * axis + (m > n) + 1);
            });
        });
    }

    void findPeaks() {
        auto peaks = voxelsWhere(grid_, threads_,
                                 [&](std::size_t n, glm::ivec3) { return uphill_[n] == peak; });
        std::sort(peaks.begin(), peaks.end(),
                  [&](std::uint32_t m, std::uint32_t n) { return isBefore(m, n); });
        for (const std::uint32_t n : peaks) {
            label_[n] = std::int32_t(peakMm_.size());
            peakMm_.push_back(distanceMm_[n]);
        }
    }

    // Ways end at a peak, or at a voxel of the same slab that is labelled already.
    void goUphill() {
        constexpr std::size_t slabDepth = 16;
        const std::size_t depth = std::size_t(grid_.size.z), slice = grid_.index(0, 0, 1);
        parallelFor((depth + slabDepth - 1) / slabDepth, 1, threads_,
                    [&](std::size_t first, std::size_t last) {
                        const std::size_t begin = first * slabDepth * slice,
                                          end = std::min(depth, last * slabDepth) * slice;
                        const auto isOwn = [&](std::size_t n) { return n >= begin && n < end; };
                        const auto isEnd = [&](std::size_t n) {
                            return uphill_[n] == peak || (isOwn(n) && label_[n] >= 0);
                        };
                        for (std::size_t n = begin; n < end; ++n) {
                            if (uphill_[n] == notInside || isEnd(n)) continue;
                            std::size_t top = n;
                            while (!isEnd(top))
                                top = stepUphill(top);
                            const std::int32_t basin = label_[top];
                            for (std::size_t at = n; at != top; at = stepUphill(at)) {
                                if (isOwn(at)) label_[at] = basin;
                            }
                        }
                    });
    }

    /// Ascending voxels, the farthest from the boundary first.
    std::vector<std::uint32_t> byFallingDistance(const std::vector<std::uint32_t>& voxels) const {
        std::vector<std::size_t> begin;
        for (const std::uint32_t n : voxels) {
            const std::size_t at = ticks(distanceMm_[n]);
            if (at + 1 > begin.size()) begin.resize(at + 1, 0);
            ++begin[at];
        }
        std::size_t sum = 0;
        for (std::size_t n = begin.size(); n-- > 0;)
            sum += std::exchange(begin[n], sum);
        std::vector<std::uint32_t> order(sum);
        for (const std::uint32_t n : voxels)
            order[begin[ticks(distanceMm_[n])]++] = n;
        return order;
    }

    /// Where basins meet at a voxel: another one than its own among its neighbours that come before
    /// it (its own where there is none), and whether there is but one other.
    struct Meeting {
        std::int32_t other;
        bool ofTwo;
    };
    Meeting meetingAt(std::size_t n, glm::ivec3 v) const {
        Meeting meeting{label_[n], true};
        visitFaces(grid_, n, v, [&](std::size_t m, int) {
            if (label_[m] < 0 || label_[m] == label_[n] || label_[m] == meeting.other ||
                !isBefore(m, n))
                return;
            meeting.ofTwo = meeting.ofTwo && meeting.other == label_[n];
            meeting.other = label_[m];
        });
        return meeting;
    }

    /// saddles() of a slab of slices.
    std::vector<std::uint32_t> saddlesOf(std::size_t firstSlice, std::size_t endSlice) const {
        std::vector<std::uint32_t> found;
        std::unordered_map<std::uint64_t, float> highestMm;  // by both basins
        visitSlices(grid_, firstSlice, endSlice, [&](std::size_t n, glm::ivec3 v) {
            if (label_[n] < 0 || uphill_[n] == peak) return;
            const auto [other, ofTwo] = meetingAt(n, v);
            if (other == label_[n]) return;
            if (ofTwo) {
                const auto [low, high] = std::minmax(label_[n], other);
                float& most = highestMm[(std::uint64_t(low) << 32) | std::uint64_t(high)];
                if (distanceMm_[n] <= most) return;
                most = distanceMm_[n];
            }
            found.push_back(std::uint32_t(n));
        });
        return found;
    }

    /// Voxels where basins meet, ascending. Of those between the same two only the ones that are
    /// higher than any before them in their slab: what two basins do not merge at they do not
    /// merge at further down either, as peaks only become higher.
    std::vector<std::uint32_t> saddles() const {
        constexpr std::size_t slabDepth = 16;
        const std::size_t depth = std::size_t(grid_.size.z);
        std::vector<std::vector<std::uint32_t>> slabs((depth + slabDepth - 1) / slabDepth);
        parallelFor(slabs.size(), 1, threads_, [&](std::size_t first, std::size_t last) {
            for (std::size_t s = first; s < last; ++s)
                slabs[s] = saddlesOf(s * slabDepth, std::min(depth, (s + 1) * slabDepth));
        });
        std::vector<std::uint32_t> all;
        for (const auto& slab : slabs)
            all.insert(all.end(), slab.begin(), slab.end());
        return all;
    }

    // Where basins meet, the one of the highest peak takes what hardly stands apart from it here.
    void merge(double neck) {
        parent_.resize(peakMm_.size());
        std::iota(parent_.begin(), parent_.end(), 0);
        for (const std::uint32_t n : byFallingDistance(saddles())) {
            std::array<std::int32_t, 6> around{};
            std::size_t count = 0;
            visitFaces(grid_, n, [&](std::size_t m, int) {
                if (label_[m] < 0 || !isBefore(m, n)) return;
                const std::int32_t root = rootOf(parent_, label_[m]);
                if (std::find(around.begin(), around.begin() + std::ptrdiff_t(count), root) ==
                    around.begin() + std::ptrdiff_t(count))
                    around[count++] = root;
            });
            std::int32_t first = around[0];
            for (std::size_t k = 1; k < count; ++k) {
                const float mm = peakMm_[std::size_t(around[k])],
                            highest = peakMm_[std::size_t(first)];
                if (mm > highest || (mm == highest && around[k] < first)) first = around[k];
            }
            for (std::size_t k = 0; k < count; ++k) {
                if (around[k] != first &&
                    double(distanceMm_[n]) >= neck * double(peakMm_[std::size_t(around[k])]))
                    parent_[std::size_t(around[k])] = first;
            }
        }
    }

    std::size_t numberRoots() {
        std::vector<std::int32_t> number(parent_.size(), none);
        std::int32_t count = 0;
        for (std::size_t n = 0; n < parent_.size(); ++n) {
            if (parent_[n] == std::int32_t(n)) number[n] = count++;
        }
        for (std::size_t n = 0; n < parent_.size(); ++n)
            number[n] = number[std::size_t(rootOf(parent_, std::int32_t(n)))];
        renumber({label_, grid_.voxelCount()}, number, threads_);
        return std::size_t(count);
    }

    const Volume<float>& distanceMm_;
    const Grid grid_;
    std::int32_t* const label_;  // by pointer: of the innermost loops
    Volume<std::uint8_t> uphill_;
    const int threads_;
    std::vector<float> peakMm_;
    std::vector<std::int32_t> parent_;
};

struct Extent {
    std::size_t voxels = 0;
    std::uint32_t first = std::numeric_limits<std::uint32_t>::max();
    void add(const Extent& other) { voxels += other.voxels, first = std::min(first, other.first); }
};

std::vector<Extent> extentsOf(std::span<const std::int32_t> label, std::size_t pieces,
                              const Grid& grid, int threads) {
    return tallyPieces<Extent>(label, pieces, grid, threads,
                               [](Extent& extent, std::size_t n, glm::ivec3) {
                                   extent.add({1, std::uint32_t(n)});
                               });
}

/// Cuts pieces that reach farther than a part of the colon does into lengths of about `bandMm`, by
/// the way from their far end, face to face.
class LongPieces {
public:
    LongPieces(std::span<std::int32_t> label, std::size_t pieces, double bandMm, const Grid& grid,
               int threads)
        : label_(label.data()),
          grid_(grid),
          bandMm_(bandMm),
          leastVoxels_(std::size_t(bandMm * 30.0 / grid.voxelVolumeMm3())),
          threads_(threads),
          extents_(extentsOf(label, pieces, grid, threads)) {}

    /// Returns how many pieces there are then; what was cut has no voxels left.
    std::size_t split() {
        std::size_t pieces = extents_.size();
        const std::vector<std::int32_t> large = largeOnes();
        if (large.empty()) return pieces;
        ways_ = Volume<float>(grid_);  // of large pieces alone
        way_ = ways_.writable().data();
        forVoxels(grid_, threads_, [&](std::size_t n, glm::ivec3) {
            if (label_[n] >= 0 && isLarge(label_[n])) way_[n] = -1.0f;
        });
        // Labels stay as they are until all pieces are cut.
        std::vector<Parts> cuts(large.size());
        parallelFor(large.size(), 1, threads_, [&](std::size_t first, std::size_t last) {
            for (std::size_t n = first; n < last; ++n)
                cuts[n] = cut(large[n]);
        });
        std::vector<std::size_t> byPiece(large.size());
        std::iota(byPiece.begin(), byPiece.end(), 0);
        std::sort(byPiece.begin(), byPiece.end(),
                  [&](std::size_t a, std::size_t b) { return large[a] < large[b]; });
        for (const std::size_t c : byPiece) {
            const Parts& parts = cuts[c];
            for (std::size_t part = 0; part + 1 < parts.begin.size(); ++part, ++pieces) {
                for (std::size_t n = parts.begin[part]; n < parts.begin[part + 1]; ++n)
                    label_[parts.voxels[n]] = std::int32_t(pieces);
            }
        }
        return pieces;
    }

private:
    struct Parts {
        std::vector<std::uint32_t> voxels;
        std::vector<std::size_t> begin;  ///< of each part among the voxels, and the end
    };

    bool isLarge(std::int32_t piece) const { return extents_.data()[piece].voxels > leastVoxels_; }

    /// By falling volume, so that threads end at about the same time.
    std::vector<std::int32_t> largeOnes() const {
        std::vector<std::int32_t> large;
        for (std::size_t p = 0; p < extents_.size(); ++p) {
            if (isLarge(std::int32_t(p))) large.push_back(std::int32_t(p));
        }
        std::stable_sort(large.begin(), large.end(), [&](std::int32_t a, std::int32_t b) {
            return extents_[std::size_t(a)].voxels > extents_[std::size_t(b)].voxels;
        });
        return large;
    }

    /// Sets the ways of a piece's voxels from one of them, and returns the voxels as they are met.
    /// Ways by steps of equal count are long enough here: rounds of breadth-first search, in mm.
    std::vector<std::uint32_t> waysFrom(std::uint32_t seed, std::int32_t piece) {
        std::vector<std::uint32_t> reached{seed};
        way_[seed] = 0.0f;
        const glm::vec3 stepMm(grid_.spacingMm());
        const auto steps = [&](std::uint32_t n, const auto& visit) {
            visitFaces(grid_, n,
                       [&](std::size_t m, int axis) { visit(m, way_[n] + stepMm[axis]); });
        };
        floodFill(reached, steps, [&](std::size_t m, float wayMm) {
            if (label_[m] != piece || way_[m] >= 0.0f) return false;
            way_[m] = wayMm;
            return true;
        });
        return reached;
    }

    /// The connected parts of a piece's bands; none where it is short.
    Parts cut(std::int32_t piece) {
        std::vector<std::uint32_t> reached = waysFrom(extents_[std::size_t(piece)].first, piece);
        const std::uint32_t farEnd = reached.back();
        for (const std::uint32_t n : reached)
            way_[n] = -1.0f;
        reached = waysFrom(farEnd, piece);
        const double reachMm = way_[reached.back()];
        Parts parts;
        if (reachMm < 1.6 * bandMm_) return parts;
        const int bands = int(std::lround(reachMm / bandMm_));
        const auto bandOf = [&](std::size_t n) {
            return std::min(bands - 1, int(double(way_[n]) / reachMm * bands));
        };
        parts.voxels.reserve(reached.size());
        std::vector<std::uint32_t> part;
        for (const std::uint32_t seed : reached) {
            if (way_[seed] < 0.0f) continue;  // in a part already
            const int band = bandOf(seed);
            part.assign(1, seed);
            way_[seed] = -1.0f;
            floodFill(part, faceNeighbours(grid_), [&](std::size_t m) {
                if (label_[m] != piece || way_[m] < 0.0f || bandOf(m) != band) return false;
                way_[m] = -1.0f;
                return true;
            });
            parts.begin.push_back(parts.voxels.size());
            parts.voxels.insert(parts.voxels.end(), part.begin(), part.end());
        }
        parts.begin.push_back(parts.voxels.size());
        return parts;
    }

    std::int32_t* const label_;  // by pointer, as way_: of the innermost loops
    const Grid& grid_;
    const double bandMm_;
    const std::size_t leastVoxels_;  ///< what is thinner is no colon
    const int threads_;
    const std::vector<Extent> extents_;
    Volume<float> ways_;
    float* way_ = nullptr;  ///< mm; −1 where none is known
};

/// Numbers the pieces that stand for themselves in `pieceOf` by falling volume, each with all that
/// is its own; returns how many there are.
std::size_t numberByVolume(std::span<std::int32_t> label, const std::vector<std::int32_t>& pieceOf,
                           const Grid& grid, int threads) {
    const std::vector<Extent> extents = extentsOf(label, pieceOf.size(), grid, threads);
    std::vector<std::size_t> voxels(pieceOf.size(), 0);
    std::vector<std::int32_t> kept;
    for (std::size_t n = 0; n < pieceOf.size(); ++n) {
        voxels[std::size_t(pieceOf[n])] += extents[n].voxels;
        if (pieceOf[n] == std::int32_t(n)) kept.push_back(std::int32_t(n));
    }
    std::stable_sort(kept.begin(), kept.end(), [&](std::int32_t a, std::int32_t b) {
        return voxels[std::size_t(a)] > voxels[std::size_t(b)];
    });
    std::vector<std::int32_t> place(pieceOf.size(), none), number;
    for (std::size_t n = 0; n < kept.size(); ++n)
        place[std::size_t(kept[n])] = std::int32_t(n);
    for (const std::int32_t p : pieceOf)
        number.push_back(place[std::size_t(p)]);
    renumber(label, number, threads);
    return kept.size();
}

/// Tagged voxels more than 2.5 mm deep in a piece.
struct Core {
    std::int64_t voxels = 0, sumHu = 0, sumHu2 = 0;
    std::int64_t sumDepth = 0, sumDepth2 = 0, sumHuDepth = 0;  ///< depth: downwards, in voxels
    void add(const Core& other) {
        voxels += other.voxels, sumHu += other.sumHu, sumHu2 += other.sumHu2;
        sumDepth += other.sumDepth, sumDepth2 += other.sumDepth2, sumHuDepth += other.sumHuDepth;
    }
    void add(std::int64_t hu, std::int64_t depth = 0) {
        add({1, hu, hu * hu, depth, depth * depth, hu * depth});
    }
    double meanHu() const { return double(sumHu) / double(voxels); }
    /// About the line that best tells HU from the depth, where it rises downwards: tagging that has
    /// settled lies in layers, and bone does not.
    double sdHu() const {
        const double count = double(voxels), depth = double(sumDepth) / count;
        const double ofHu = double(sumHu2) / count - meanHu() * meanHu(),
                     ofDepth = double(sumDepth2) / count - depth * depth,
                     ofBoth = double(sumHuDepth) / count - meanHu() * depth;
        const double layered = ofDepth > 0.0 && ofBoth > 0.0 ? ofBoth * ofBoth / ofDepth : 0.0;
        return std::sqrt(std::max(0.0, ofHu - layered));
    }
};
bool isCore(std::uint8_t content, float distanceMm) {
    return Content(content) == Content::tagged && distanceMm > 2.5f;
}

/// Mean HU of each piece's core; −∞ where it has none.
std::vector<double> coreHuOf(std::span<const std::int32_t> label, std::size_t pieces,
                             const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                             const Volume<float>& distanceMm, int threads) {
    std::vector<double> mean;
    for (const Core& core : tallyPieces<Core>(label, pieces, hu.grid(), threads,
                                              [&](Core&tally, std::size_t n, glm::ivec3) {
                                                  if (isCore(content[n], distanceMm[n]))
                                                      tally.add(hu[n]);
                                              }))
        mean.push_back(core.voxels > 0 ? core.meanHu() : -std::numeric_limits<double>::infinity());
    return mean;
}

/// Gives what no basin has, layer by layer and `layers` far, to the piece beside it for which
/// `takes(voxel, piece)` holds; the rest stays without one.
template <class Takes>
void spread(std::span<std::int32_t> label, const Volume<std::uint8_t>& content, const Grid& grid,
            int layers, int threads, const Takes& takes) {
    auto front = voxelsWhere(grid, threads, [&](std::size_t n, glm::ivec3 v) {
        if (label[n] >= 0 || !isContent(content[n])) return false;
        bool near = false;
        visitFaces(grid, n, v, [&](std::size_t m, int) { near = near || label[m] >= 0; });
        return near;
    });
    for (int layer = 0; layer < layers && !front.empty(); ++layer) {
        std::vector<std::pair<std::uint32_t, std::int32_t>> given;
        for (const std::uint32_t n : front) {
            std::int32_t nearest = none;
            visitFaces(grid, n, [&](std::size_t m, int) {
                if (label[m] >= 0 && (nearest < 0 || label[m] < nearest) && takes(n, label[m]))
                    nearest = label[m];
            });
            if (nearest >= 0) given.emplace_back(n, nearest);
        }
        for (const auto& [n, to] : given)
            label[n] = to;
        std::vector<std::uint32_t> next;
        for (const auto& [n, to] : given) {
            visitFaces(grid, n, [&](std::size_t m, int) {
                if (label[m] < 0 && isContent(content[m])) next.push_back(std::uint32_t(m));
            });
        }
        std::sort(next.begin(), next.end());
        next.erase(std::unique(next.begin(), next.end()), next.end());
        front = std::move(next);
    }
}

/// A face between voxel `n` and the next along `axis`, of two pieces.
struct Face {
    std::int32_t a, b;
    std::uint32_t n;
    std::uint8_t axis;
};

/// The faces of one pair of pieces, by their first voxels.
using FacesOfPair = std::span<const Face>;

/// Unites the faces whose first voxels are the same or touch; the first of a patch stands for it.
std::vector<std::int32_t> unitePatches(FacesOfPair faces, const Grid& grid) {
    std::vector<std::int32_t> parent(faces.size());
    std::iota(parent.begin(), parent.end(), 0);
    // Three voxels in each of the four rows before a voxel's own, which the faces pass in order.
    constexpr std::array<glm::ivec2, 4> rows{{{-1, -1}, {0, -1}, {1, -1}, {-1, 0}}};
    std::array<std::size_t, 4> from{};
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const glm::ivec3 v = grid.voxelAt(faces[f].n);
        if (f > 0 &&
            (faces[f - 1].n == faces[f].n || (v.x > 0 && faces[f - 1].n + 1 == faces[f].n)))
            unite(parent, std::int32_t(f), std::int32_t(f - 1));
        if (f > 0 && faces[f - 1].n == faces[f].n) continue;
        for (std::size_t row = 0; row < rows.size(); ++row) {
            const int j = v.y + rows[row].x, k = v.z + rows[row].y;
            if (j < 0 || j >= grid.size.y || k < 0) continue;
            const std::size_t lo = grid.index(std::max(0, v.x - 1), j, k),
                              hi = grid.index(std::min(grid.size.x - 1, v.x + 1), j, k);
            std::size_t& at = from[row];
            while (faces[at].n < lo)
                ++at;
            for (std::size_t g = at; faces[g].n <= hi; ++g)
                unite(parent, std::int32_t(f), std::int32_t(g));
        }
    }
    for (std::size_t f = 0; f < parent.size(); ++f)
        parent[f] = rootOf(parent, std::int32_t(f));
    return parent;
}

/// What the orifices are measured by.
struct Around {
    const Volume<std::int16_t>& hu;
    const Volume<std::uint8_t>& content;
    const Volume<std::uint8_t>& thinWalls;
    const Volume<float>& distanceMm;
};

Orifice measureOrifice(const std::vector<Face>& patch, const Around& around) {
    const auto& [hu, content, thinWalls, distanceMm] = around;
    const Grid& grid = hu.grid();
    const glm::dvec3 faceMm2 = grid.voxelVolumeMm3() / grid.spacingMm();
    const std::size_t strides[3] = {1, std::size_t(grid.size.x),
                                    std::size_t(grid.size.x) * std::size_t(grid.size.y)};
    Orifice orifice;
    orifice.a = patch.front().a, orifice.b = patch.front().b;
    glm::dvec3 middle(0.0);
    double area = 0.0, huSum = 0.0;
    for (const Face& face : patch) {
        const std::size_t n = face.n, m = n + strides[face.axis];
        const double mm2 = faceMm2[face.axis];
        const glm::ivec3 v = grid.voxelAt(n);
        glm::ivec3 next = v;
        ++next[face.axis];
        middle += mm2 * 0.5 * (glm::dvec3(v) + glm::dvec3(next));
        area += mm2;
        if (orifice.voxels.empty() || orifice.voxels.back() != face.n)
            orifice.voxels.push_back(face.n);
        if (thinWalls[n] || thinWalls[m]) {
            orifice.wallMm2 += mm2;
            huSum += mm2 * double(std::max(hu[n], hu[m]));
            continue;
        }
        orifice.openMm2 += mm2;
        if (Content(content[n]) == Content::tagged && Content(content[m]) == Content::tagged)
            orifice.openTaggedMm2 += mm2;
        const double through = std::min(distanceMm[n], distanceMm[m]);
        if (through > orifice.radiusMm) orifice.radiusMm = through, orifice.place = v;
    }
    if (orifice.openMm2 == 0.0) orifice.place = glm::ivec3(glm::round(middle / area));
    orifice.placeMm = grid.patientFromVoxelPoint(orifice.place);
    if (orifice.wallMm2 > 0.0) orifice.barrierHu = huSum / orifice.wallMm2;
    return orifice;
}

/// The connected patches of the faces of each two pieces, by the pair and then by first face.
std::vector<Orifice> patchesOf(const std::vector<std::vector<Face>>& slices, std::size_t pieces,
                               const Around& around, int threads) {
    // In order of their first piece, and then of their voxels.
    std::vector<std::size_t> begin(pieces + 1, 0);
    for (const auto& slice : slices) {
        for (const Face& face : slice)
            ++begin[std::size_t(face.a) + 1];
    }
    std::partial_sum(begin.begin(), begin.end(), begin.begin());
    std::vector<Face> faces(begin.back());
    std::vector<std::size_t> next(begin.begin(), begin.end() - 1);
    for (const auto& slice : slices) {
        for (const Face& face : slice)
            faces[next[std::size_t(face.a)]++] = face;
    }
    std::vector<std::vector<Orifice>> ofPiece(pieces);
    parallelFor(pieces, 4, threads, [&](std::size_t first, std::size_t last) {
        std::vector<std::vector<Face>> patches;
        for (std::size_t a = first; a < last; ++a) {
            const auto end = faces.begin() + std::ptrdiff_t(begin[a + 1]);
            auto at = faces.begin() + std::ptrdiff_t(begin[a]);
            std::stable_sort(at, end, [](const Face& x, const Face& y) { return x.b < y.b; });
            while (at != end) {
                const auto pairEnd =
                    std::find_if(at, end, [&](const Face& face) { return face.b != at->b; });
                std::vector<std::int32_t> root =
                    unitePatches(FacesOfPair(at, pairEnd), around.hu.grid());
                patches.clear();
                for (std::size_t f = 0; f < root.size(); ++f) {
                    // A patch's first face comes first: from then on it holds the patch's place.
                    const std::int32_t of = root[f];
                    if (of == std::int32_t(f)) {
                        root[f] = std::int32_t(patches.size());
                        patches.emplace_back();
                    } else {
                        root[f] = root[std::size_t(of)];
                    }
                    patches[std::size_t(root[f])].push_back(at[std::ptrdiff_t(f)]);
                }
                for (const auto& patch : patches)
                    ofPiece[a].push_back(measureOrifice(patch, around));
                at = pairEnd;
            }
        }
    });
    std::vector<Orifice> orifices;
    for (auto& own : ofPiece)
        std::move(own.begin(), own.end(), std::back_inserter(orifices));
    return orifices;
}

/// What is measured of a piece voxel by voxel; whole numbers, whose sums have no order.
struct PieceTally {
    std::size_t voxels = 0, gasVoxels = 0, taggedVoxels = 0, untaggedVoxels = 0;
    std::int64_t gasHu = 0, taggedHu = 0;
    Core core;
    std::array<std::size_t, 3> faces{}, excludedAirFaces{};  ///< across each axis
    float radiusMm = 0.0f;
    glm::ivec3 center{0};

    void add(const PieceTally& other) {
        voxels += other.voxels, gasVoxels += other.gasVoxels;
        taggedVoxels += other.taggedVoxels, untaggedVoxels += other.untaggedVoxels;
        gasHu += other.gasHu, taggedHu += other.taggedHu;
        core.add(other.core);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            faces[axis] += other.faces[axis];
            excludedAirFaces[axis] += other.excludedAirFaces[axis];
        }
        if (other.radiusMm > radiusMm) radiusMm = other.radiusMm, center = other.center;
    }
};

/// Pieces and orifices of cut.pieceAt, whose numbers are below `count`.
void measure(TubePieces& cut, std::size_t count, const Volume<std::int16_t>& hu,
             const Volume<std::uint8_t>& content, const Volume<std::uint8_t>& thinWalls,
             GravityAxis down, int threads) {
    const Grid& grid = hu.grid();
    const std::int32_t* const label = cut.pieceAt.voxels().data();
    const double voxelMm3 = grid.voxelVolumeMm3();
    const glm::dvec3 faceMm2 = voxelMm3 / grid.spacingMm();
    std::vector<std::vector<Face>> faces(std::size_t(grid.size.z));
    const auto tallies = tallyPieces<PieceTally>(
        cut.pieceAt.voxels(), count, grid, threads,
        [&](PieceTally& tally, std::size_t n, glm::ivec3 v) {
            const std::int32_t l = label[n];
            const Content own = Content(content[n]);
            ++tally.voxels;
            if (own == Content::gas) ++tally.gasVoxels, tally.gasHu += hu[n];
            if (own == Content::tagged) ++tally.taggedVoxels, tally.taggedHu += hu[n];
            tally.untaggedVoxels += own == Content::untagged;
            const float mm = cut.distanceMm[n];
            if (isCore(content[n], mm))
                tally.core.add(hu[n], down.sign * std::lround(down.heightOf(v)));
            if (mm > tally.radiusMm) tally.radiusMm = mm, tally.center = v;
            visitFaces(grid, n, v, [&](std::size_t m, int axis) {
                if (label[m] == l) return;
                ++tally.faces[std::size_t(axis)];
                const Content other = Content(content[m]);
                tally.excludedAirFaces[std::size_t(axis)] +=
                    other == Content::outside || other == Content::lung;
                if (label[m] < 0 || m < n) return;
                faces[std::size_t(v.z)].push_back({std::min(l, label[m]), std::max(l, label[m]),
                                                   std::uint32_t(n), std::uint8_t(axis)});
            });
        });
    const auto areaMm2 = [&](const std::array<std::size_t, 3>& faceCount) {
        return double(faceCount[0]) * faceMm2[0] + double(faceCount[1]) * faceMm2[1] +
               double(faceCount[2]) * faceMm2[2];
    };
    cut.pieces.assign(count, {});
    for (std::size_t p = 0; p < count; ++p) {
        const PieceTally& tally = tallies[p];
        TubePiece& piece = cut.pieces[p];
        piece.voxels = tally.voxels, piece.gasVoxels = tally.gasVoxels;
        piece.taggedVoxels = tally.taggedVoxels, piece.untaggedVoxels = tally.untaggedVoxels;
        piece.radiusMm = tally.radiusMm, piece.center = tally.center;
        piece.surfaceMm2 = areaMm2(tally.faces);
        piece.excludedAirMm2 = areaMm2(tally.excludedAirFaces);
        if (tally.core.voxels > 0)
            piece.coreHu = tally.core.meanHu(), piece.coreSdHu = tally.core.sdHu();
        piece.volumeMl = double(piece.voxels) * voxelMm3 / 1000.0;
        piece.centerMm = grid.patientFromVoxelPoint(piece.center);
        piece.meanHu =
            piece.mostlyGas()
                ? double(tally.gasHu) / double(std::max<std::size_t>(1, piece.gasVoxels))
                : double(tally.taggedHu) / double(std::max<std::size_t>(1, piece.taggedVoxels));
    }
    cut.orifices = patchesOf(faces, count, {hu, content, thinWalls, cut.distanceMm}, threads);
}

/// For each piece the least of those that lie side by side with it in one lumen, as fluid, gas and
/// haustra of a wide cecum do; empty where none do. In a tube pieces follow each other. Three of a
/// hairpin may still all open to each other; a fourth that opens to two of them lies in no tube.
/// Loops that touch show most of their wall.
std::vector<std::int32_t> sideBySide(const TubePieces& cut) {
    constexpr double crossSections = 1.5, mostWall = 0.15;
    std::map<std::pair<std::int32_t, std::int32_t>, std::array<double, 2>> contacts;
    for (const Orifice& orifice : cut.orifices) {
        auto& [open, wall] = contacts[{orifice.a, orifice.b}];
        open += orifice.openMm2, wall += orifice.wallMm2;
    }
    std::map<std::int32_t, std::vector<std::int32_t>> wide;  // later pieces that a piece opens to
    for (const auto& [pair, mm2] : contacts) {
        const double radiusMm = std::min(cut.pieces[std::size_t(pair.first)].radiusMm,
                                         cut.pieces[std::size_t(pair.second)].radiusMm);
        if (mm2[0] > crossSections * M_PI * radiusMm * radiusMm &&
            mm2[1] < mostWall * (mm2[0] + mm2[1]))
            wide[pair.first].push_back(pair.second);
    }
    using Triangle = std::array<std::int32_t, 3>;
    std::vector<Triangle> triangles;
    std::map<std::pair<std::int32_t, std::int32_t>, int> trianglesAt;
    for (const auto& [a, others] : wide) {
        for (const std::int32_t b : others) {
            const auto next = wide.find(b);
            if (next == wide.end()) continue;
            for (const std::int32_t c : next->second) {
                if (std::find(others.begin(), others.end(), c) == others.end()) continue;
                triangles.push_back({a, b, c});
                ++trianglesAt[{a, b}], ++trianglesAt[{b, c}], ++trianglesAt[{a, c}];
            }
        }
    }
    std::vector<std::int32_t> parent(cut.pieces.size());
    std::iota(parent.begin(), parent.end(), 0);
    bool any = false;
    for (const auto& [a, b, c] : triangles) {
        if (trianglesAt[{a, b}] < 2 && trianglesAt[{b, c}] < 2 && trianglesAt[{a, c}] < 2) continue;
        unite(parent, a, b), unite(parent, b, c);
        any = true;
    }
    if (!any) return {};
    for (std::size_t p = 0; p < parent.size(); ++p)
        parent[p] = rootOf(parent, std::int32_t(p));
    return parent;
}

}  // namespace

TubePieces cutIntoPieces(const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                         const Volume<std::uint8_t>& thinWalls, const TubePieceOptions& options) {
    const Grid& grid = hu.grid();
    const int threads = options.threads;
    TubePieces cut;
    {
        Volume<std::uint8_t> plain(grid, std::uint8_t(0));
        const auto out = plain.writable();
        forVoxels(grid, threads, [&](std::size_t n, glm::ivec3) {
            if (isContent(content[n]) && !thinWalls[n]) out[n] = 1;
        });
        cut.distanceMm = topology::distanceToBoundaryMm(plain, threads);
    }
    cut.pieceAt = Volume<std::int32_t>(grid);
    const auto label = cut.pieceAt.writable();
    std::size_t pieces = Basins(cut.distanceMm, label, threads).flood(options.neck);
    if (options.lengthMm > 0.0)
        pieces = LongPieces(label, pieces, options.lengthMm, grid, threads).split();
    std::vector<std::int32_t> own(pieces);
    std::iota(own.begin(), own.end(), 0);
    numberByVolume(label, own, grid, threads);
    {
        // Thin walls go to the piece beside them, but what is dimmer than half a fluid's height
        // over soft tissue lies beyond that fluid's wall: it is another's, or nobody's.
        const std::vector<double> coreHu =
            coreHuOf(label, pieces, hu, content, cut.distanceMm, threads);
        const auto layers = [&](double mm) {
            const glm::dvec3 step = grid.spacingMm();
            return std::max(1, int(std::lround(mm / std::min({step.x, step.y, step.z}))));
        };
        spread(label, content, grid, layers(6.0), threads, [&](std::size_t n, std::int32_t piece) {
            return Content(content[n]) != Content::tagged ||
                   hu[n] - options.softHu > 0.45 * (coreHu[std::size_t(piece)] - options.softHu);
        });
        spread(label, content, grid, layers(1.5), threads,
               [](std::size_t, std::int32_t) { return true; });
    }

    measure(cut, pieces, hu, content, thinWalls, options.down, threads);
    if (const std::vector<std::int32_t> sides = sideBySide(cut); !sides.empty()) {
        pieces = numberByVolume(label, sides, grid, threads);
        measure(cut, pieces, hu, content, thinWalls, options.down, threads);
    }
    return cut;
}

}  // namespace haustra::segmentation
