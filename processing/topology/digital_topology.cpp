#include "topology/digital_topology.h"

#include "core/disjoint_sets.h"
#include "core/parallel.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace haustra::topology {
namespace {

using Word = std::uint64_t;

/// Bit n is bit n + 1 of the row, across words.
Word next(const Word* row, std::size_t word, std::size_t words) {
    return row[word] >> 1 | (word + 1 < words ? row[word + 1] << 63 : Word(0));
}

long count(Word bits) {
    return long(std::popcount(bits));
}

/// The eight voxels around each of 64 corners: bits of rows (j, k), (j + 1, k), (j, k + 1) and
/// (j + 1, k + 1), and the same one voxel on.
struct EightVoxels {
    Word p, q, r, s, P, Q, R, S;
};

long openCornersOf(const EightVoxels& v) {
    const auto [p, q, r, s, P, Q, R, S] = v;
    return count(~p & ~S & q & r & s & P & Q & R) + count(~P & ~s & p & q & r & Q & R & S) +
           count(~q & ~R & p & r & s & P & Q & S) + count(~Q & ~r & p & q & s & P & R & S);
}

/// χ of the cells with these corners lowest.
long eulerOf(const EightVoxels& v) {
    const auto [p, q, r, s, P, Q, R, S] = v;
    const Word pq = p & q, pr = p & r, PQ = P & Q, PR = P & R;
    return count(p) - count(p & P) - count(pq) - count(pr) + count(pq & PQ) + count(pr & PR) +
           count(pq & r & s) - count(pq & r & s & PQ & R & S) + openCornersOf(v);
}

/// The sum of `of` over all corners of the grid with an object voxel around them.
template <class Of>
long sumOverCorners(const BitMask& object, int threads, const Of& of) {
    const glm::ivec3 size = object.size();
    const std::size_t words = object.rowWords();
    std::vector<long> ofSlice(std::size_t(size.z), 0);
    parallelFor(ofSlice.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t slice = begin; slice < end; ++slice) {
            const int k = int(slice);
            for (int j = 0; j < size.y; ++j) {
                const Word *a = object.row(j, k), *b = object.row(j + 1, k),
                           *c = object.row(j, k + 1), *d = object.row(j + 1, k + 1);
                for (std::size_t w = 0; w < words; ++w) {
                    const EightVoxels v{a[w],
                                        b[w],
                                        c[w],
                                        d[w],
                                        next(a, w, words),
                                        next(b, w, words),
                                        next(c, w, words),
                                        next(d, w, words)};
                    if (v.p | v.q | v.r | v.s | v.P | v.Q | v.R | v.S) ofSlice[slice] += of(v);
                }
            }
        }
    });
    return std::accumulate(ofSlice.begin(), ofSlice.end(), 0L);
}

/// The runs of a row's bits, inverted where `flip` is all ones, from bit 0 of the row (i = −1).
void appendRuns(const Word* row, std::size_t words, Word flip, int j, int k, int size,
                std::vector<MaskRun>& runs) {
    bool inside = false;
    for (std::size_t w = 0; w < words; ++w) {
        // Ones where the row changes against the bit before.
        const Word bits = row[w] ^ flip;
        const Word before = bits << 1 | Word(inside);
        for (Word changes = bits ^ before; changes; changes &= changes - 1) {
            const int i = int(w * 64) + std::countr_zero(changes) - 1;
            if (!inside && i > size) return;
            if (inside)
                runs.back().end = i;
            else
                runs.push_back({i, size + 1, j, k, -1});
            inside = !inside;
        }
    }
    if (inside) runs.back().end = size + 1;
}

std::int32_t firstRunOf(std::vector<MaskRun>& runs, std::int32_t run) {
    return haustra::rootOf(
        [&](std::int32_t n) -> std::int32_t& { return runs[std::size_t(n)].component; }, run);
}

/// Finds a mask's runs and joins them; until they are numbered, a run's component is a run of the
/// same one.
class RunJoiner {
public:
    /// The object by 6-connectivity, or the background by 18-connectivity with the border around.
    RunJoiner(const BitMask& mask, bool background) : width_(mask.size().y + 2) {
        const glm::ivec3 size = mask.size();
        for (int k = -1; k <= size.z; ++k) {
            for (int j = -1; j <= size.y; ++j) {
                rowBegin_.push_back(runs_.size());
                appendRuns(mask.row(j, k), mask.rowWords(), background ? ~Word(0) : Word(0), j, k,
                           size.x, runs_);
            }
        }
        rowBegin_.push_back(runs_.size());
        for (std::size_t n = 0; n < runs_.size(); ++n)
            runs_[n].component = std::int32_t(n);
        const int edges = background ? 1 : 0;
        for (int k = -1; k <= size.z; ++k) {
            for (int j = -1; j <= size.y; ++j) {
                if (j > -1) join(place(j, k), place(j - 1, k), edges);
                if (k > -1) join(place(j, k), place(j, k - 1), edges);
                if (!background || k == -1) continue;
                if (j > -1) join(place(j, k), place(j - 1, k - 1), 0);
                if (j < size.y) join(place(j, k), place(j + 1, k - 1), 0);
            }
        }
    }

    MaskComponents components() && {
        MaskComponents result;
        // A root is its component's first run, so its number is set before the others need it.
        std::vector<std::int32_t> number(runs_.size());
        for (std::size_t n = 0; n < runs_.size(); ++n) {
            const auto root = std::size_t(firstRunOf(runs_, std::int32_t(n)));
            if (root == n) {
                number[n] = std::int32_t(result.voxels.size());
                result.voxels.push_back(0);
            }
            number[n] = number[root];
            result.voxels[std::size_t(number[n])] += std::size_t(runs_[n].end - runs_[n].begin);
        }
        for (std::size_t n = 0; n < runs_.size(); ++n)
            runs_[n].component = number[n];
        result.runs = std::move(runs_);
        return result;
    }

private:
    std::size_t place(int j, int k) const {
        return std::size_t(j + 1) + std::size_t(width_) * std::size_t(k + 1);
    }
    /// Joins the runs of two rows that overlap, or would if they were `edges` longer.
    void join(std::size_t rowA, std::size_t rowB, int edges) {
        std::size_t a = rowBegin_[rowA], b = rowBegin_[rowB];
        while (a < rowBegin_[rowA + 1] && b < rowBegin_[rowB + 1]) {
            const MaskRun &inA = runs_[a], &inB = runs_[b];
            if (inA.begin < inB.end + edges && inB.begin < inA.end + edges)
                unite(std::int32_t(a), std::int32_t(b));
            inA.end < inB.end ? ++a : ++b;
        }
    }
    // The lower number wins, so that a component is named by its first run.
    void unite(std::int32_t a, std::int32_t b) {
        a = firstRunOf(runs_, a), b = firstRunOf(runs_, b);
        if (a != b) runs_[std::size_t(std::max(a, b))].component = std::min(a, b);
    }

    int width_;
    std::vector<MaskRun> runs_;
    std::vector<std::size_t> rowBegin_;
};

}  // namespace

BitMask maskOf(const Volume<std::uint8_t>& labels, int threads) {
    const glm::ivec3 size = labels.grid().size;
    BitMask mask(size);
    parallelFor(std::size_t(size.z), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (int k = int(begin); k < int(end); ++k) {
            for (int j = 0; j < size.y; ++j) {
                const std::uint8_t* label = labels.voxels().data() + labels.grid().index(0, j, k);
                Word* row = mask.row(j, k);
                for (int i = 0; i < size.x; ++i)
                    row[std::size_t(i + 1) / 64] |= Word(label[i] != 0) << ((i + 1) % 64);
            }
        }
    });
    return mask;
}

long eulerCharacteristic(const BitMask& object, int threads) {
    return sumOverCorners(object, threads, eulerOf);
}

long openCorners(const BitMask& object, int threads) {
    return sumOverCorners(object, threads, openCornersOf);
}

MaskComponents objectComponents(const BitMask& object) {
    return RunJoiner(object, false).components();
}

MaskComponents cavitiesOf(const BitMask& object) {
    MaskComponents background = RunJoiner(object, true).components();
    // The first run is the border's corner; what it reaches is no cavity.
    std::erase_if(background.runs, [](const MaskRun& run) { return run.component == 0; });
    for (MaskRun& run : background.runs)
        --run.component;
    background.voxels.erase(background.voxels.begin());
    return background;
}

DigitalTopology digitalTopology(const BitMask& object, int threads) {
    return {long(objectComponents(object).voxels.size()), long(cavitiesOf(object).voxels.size()),
            eulerCharacteristic(object, threads)};
}

DigitalTopology digitalTopology(const Volume<std::uint8_t>& labels, int threads) {
    return digitalTopology(maskOf(labels, threads), threads);
}

bool isBallEitherWay(const Volume<std::uint8_t>& labels, int threads) {
    const BitMask object = maskOf(labels, threads);
    return digitalTopology(object, threads).isBall() && openCorners(object, threads) == 0;
}

}  // namespace haustra::topology
