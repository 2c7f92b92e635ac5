#include "segmentation/colon_labels.h"

#include "core/connected_labels.h"
#include "core/ct_scan.h"
#include "core/flood_fill.h"
#include "core/voxel_sweep.h"
#include "segmentation/hu_range_lumen.h"
#include "segmentation/tagged_stool.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <unordered_map>

namespace haustra::segmentation {
namespace {

constexpr std::uint8_t outside = std::uint8_t(LumenLabel::outside),
                       air = std::uint8_t(LumenLabel::air),
                       tagged = std::uint8_t(LumenLabel::tagged),
                       bridge = std::uint8_t(LumenLabel::bridge),
                       untagged = std::uint8_t(LumenLabel::untagged);

class Labelling {
public:
    Labelling(const Volume<std::int16_t>& hu, const TissueModel& tissue,
              const BowelContents& contents, const TubePieces& cut, const PieceGraph& graph,
              const ColonChain& chain, const LabelOptions& options)
        : hu_(hu),
          grid_(hu.grid()),
          tissue_(tissue),
          contents_(contents),
          cut_(cut),
          graph_(graph),
          chain_(chain),
          softHu_(tissue.meanHu[int(Tissue::soft)]),
          options_(options),
          kept_(cut.pieces.size(), 0),
          barred_(hu.voxels().size(), false) {
        result_.labels = Volume<std::uint8_t>(grid_, outside);
        labels_ = result_.labels.writable();
    }

    ColonLabels run() {
        keepPieces();
        // Opening doors takes one thread.
        parallelFor(2, 1, options_.threads, [&](std::size_t first, std::size_t last) {
            for (std::size_t task = first; task < last; ++task)
                task == 0 ? openDoors() : smooth();
        });
        label();
        closeDoors();
        if (!options_.asGiven) {
            fillInterfaces();
            fitToHalfHeight();
        }
        takeCrumbs();
        if (!options_.asGiven) {
            takeInTheBalloons();
            result_.enclosed =
                takeInEnclosedGas(contents_.content, cut_, result_.labels, options_.threads);
            labels_ = result_.labels.writable();
        }
        layBridges(options_.bridgeRadiusMm);
        joinUp();
        return std::move(result_);
    }

private:
    std::int32_t pieceOf(int node) const { return graph_.pieceOf[std::size_t(node)]; }

    void keepPieces() {
        for (const int n : chain_.nodes)
            kept_[std::size_t(pieceOf(n))] = 1;
        for (const int n : chain_.sacs)
            kept_[std::size_t(pieceOf(n))] = 1;
    }
    /// The chain's first piece and the rectum's end beneath it.
    std::vector<std::int32_t> rectum() const {
        std::vector<std::int32_t> pieces{pieceOf(chain_.nodes.front())};
        for (const int n : chain_.rectalEnd)
            pieces.push_back(pieceOf(n));
        return pieces;
    }
    void takeInTheBalloons() {
        if (chain_.balloons.empty()) return;
        std::vector<std::int32_t> balloons;
        for (const int n : chain_.balloons)
            balloons.push_back(pieceOf(n));
        takeInBalloons(balloons, rectum(), contents_.content, cut_, result_.labels,
                       options_.threads);
        labels_ = result_.labels.writable();
    }
    bool isKept(std::int32_t piece) const { return piece >= 0 && kept_[std::size_t(piece)]; }

    void smooth() {
        constexpr double smoothMm = 0.8;
        if (!options_.asGiven) smooth_ = segmentation::smoothHu(hu_, smoothMm, 1);
    }

    // Doors between kept pieces: those of the chain and of its sacs are open; of the others the
    // ways that lead to their two sides tell.
    void openDoors() {
        std::set<std::int32_t> sacs;
        for (const int n : chain_.sacs)
            sacs.insert(pieceOf(n));
        // The rectum's end opens to the rectum alone.
        std::set<std::int32_t> ofRectum;
        for (const std::int32_t piece : rectum())
            ofRectum.insert(piece);
        for (const int n : chain_.rectalEnd)
            sacs.erase(pieceOf(n));
        std::set<int> passed;
        for (const int j : chain_.junctions) {
            const ChainJunction& junction = graph_.graph.junctions[std::size_t(j)];
            if (junction.kind != JunctionKind::collapse) passed.insert(junction.path);
        }
        for (const int j : chain_.cuts)
            cuts_.insert(graph_.graph.junctions[std::size_t(j)].path);
        open_.assign(cut_.orifices.size(), 0);
        for (std::size_t o = 0; o < cut_.orifices.size(); ++o) {
            const Orifice& orifice = cut_.orifices[o];
            if (!isKept(orifice.a) || !isKept(orifice.b)) continue;
            inner_.push_back(int(o));
            const bool ofSac = sacs.count(orifice.a) || sacs.count(orifice.b) ||
                               (ofRectum.count(orifice.a) && ofRectum.count(orifice.b));
            open_[o] =
                passed.count(int(o)) || (ofSac && orifice.openMm2 > 0.0 && !cuts_.count(int(o)));
            for (const std::uint32_t n : orifice.voxels)
                faces_.emplace_back(n, int(o));
        }
        std::sort(faces_.begin(), faces_.end());
        const Volume<float> way = waysFromRectum();
        for (const int o : inner_) {
            if (open_[std::size_t(o)] || cuts_.count(o)) continue;
            open_[std::size_t(o)] = leadsAroundANeck(o, way);
        }
        for (const int o : inner_) {
            const Orifice& orifice = cut_.orifices[std::size_t(o)];
            if (open_[std::size_t(o)]) joined_.insert(std::pair(orifice.a, orifice.b));
        }
    }

    // The orifice of the face between voxels n and m of pieces a and b; −1: none that is known.
    int orificeAt(std::size_t n, std::size_t m) const {
        const std::uint32_t first = std::uint32_t(std::min(n, m));
        const std::int32_t a = std::min(cut_.pieceAt[n], cut_.pieceAt[m]),
                           b = std::max(cut_.pieceAt[n], cut_.pieceAt[m]);
        for (auto at = std::lower_bound(faces_.begin(), faces_.end(), std::pair(first, -1));
             at != faces_.end() && at->first == first; ++at) {
            if (cut_.orifices[std::size_t(at->second)].a == a &&
                cut_.orifices[std::size_t(at->second)].b == b)
                return at->second;
        }
        return -1;
    }

    // Shortest ways (face to face, mm) from the chain's beginning within its pieces and through
    // open doors; what no such way reaches goes on from a collapse. Only voxels of kept pieces have
    // a value; unreached ones have −1.
    Volume<float> waysFromRectum() const {
        constexpr float tickMm = 0.25f;
        Volume<float> ways(grid_);
        const auto way = ways.writable();
        forVoxels(grid_, options_.threads, [&](std::size_t n, glm::ivec3) {
            if (isKept(cut_.pieceAt[n])) way[n] = -1.0f;
        });
        const glm::dvec3 spacing = grid_.spacingMm();
        const std::size_t buckets =
            std::size_t(std::max({spacing.x, spacing.y, spacing.z}) / tickMm) + 2;
        std::vector<std::vector<std::pair<float, std::uint32_t>>> front(buckets);
        float from = 0.0f;
        const auto leadsOn = [&](std::size_t n, std::size_t m) {
            if (cut_.pieceAt[m] == cut_.pieceAt[n]) return true;
            const int o = orificeAt(n, m);
            return o >= 0 && open_[std::size_t(o)];
        };
        const auto spreadFrom = [&](std::uint32_t seed) {
            float most = from;
            std::size_t waiting = 1;
            front[std::size_t(from / tickMm) % buckets].emplace_back(from, seed);
            for (std::size_t tick = std::size_t(from / tickMm); waiting > 0; ++tick) {
                auto& now = front[tick % buckets];
                for (std::size_t head = 0; head < now.size(); ++head) {
                    const auto [mm, n] = now[head];
                    --waiting;
                    if (way[n] >= 0.0f && way[n] <= mm) continue;
                    way[n] = mm;
                    most = std::max(most, mm);
                    visitFaces(grid_, n, [&](std::size_t m, int axis) {
                        const float there = mm + float(spacing[axis]);
                        if (!isKept(cut_.pieceAt[m]) || (way[m] >= 0.0f && way[m] <= there) ||
                            !leadsOn(n, m))
                            return;
                        front[std::size_t(there / tickMm) % buckets].emplace_back(there,
                                                                                  std::uint32_t(m));
                        ++waiting;
                    });
                }
                now.clear();
            }
            from = most + 1.0f;
        };
        for (std::size_t step = 0; step < chain_.nodes.size(); ++step) {
            const TubePiece& piece = cut_.pieces[std::size_t(pieceOf(chain_.nodes[step]))];
            const std::uint32_t seed = std::uint32_t(
                grid_.index(step == 0 ? lowestVoxel(pieceOf(chain_.nodes[0])) : piece.center));
            if (way[seed] < 0.0f) spreadFrom(seed);
        }
        return ways;
    }
    glm::ivec3 lowestVoxel(std::int32_t piece) const {
        glm::ivec3 lowest = cut_.pieces[std::size_t(piece)].center;
        double lowestMm = 1e9;
        for (std::size_t n = 0; n < cut_.pieceAt.voxels().size(); ++n) {
            if (cut_.pieceAt[n] != piece) continue;
            const double z = grid_.patientFromVoxelPoint(grid_.voxelAt(n)).z;
            if (z < lowestMm) lowestMm = z, lowest = grid_.voxelAt(n);
        }
        return lowest;
    }

    template <class Visit>
    void visitFacesOf(int o, const Visit& visit) const {
        const Orifice& orifice = cut_.orifices[std::size_t(o)];
        const std::size_t strides[3] = {1, std::size_t(grid_.size.x),
                                        std::size_t(grid_.size.x) * std::size_t(grid_.size.y)};
        for (const std::uint32_t n : orifice.voxels) {
            const glm::ivec3 v = grid_.voxelAt(n);
            for (int axis = 0; axis < 3; ++axis) {
                if (v[axis] + 1 >= grid_.size[axis]) continue;
                const std::size_t m = n + strides[axis];
                if (std::min(cut_.pieceAt[n], cut_.pieceAt[m]) == orifice.a &&
                    std::max(cut_.pieceAt[n], cut_.pieceAt[m]) == orifice.b)
                    visit(std::size_t(n), m, axis);
            }
        }
    }

    // Around a neck, ways along faces differ by no more than the lumen's width and some; between
    // two loops that touch, by the loop.
    bool leadsAroundANeck(int o, const Volume<float>& way) const {
        const Orifice& orifice = cut_.orifices[std::size_t(o)];
        double sum = 0.0;
        std::size_t count = 0;
        visitFacesOf(o, [&](std::size_t n, std::size_t m, int) {
            if (way[n] < 0.0f || way[m] < 0.0f) return;
            sum += std::abs(double(way[n]) - double(way[m])), ++count;
        });
        if (count == 0) return false;
        const double widest = std::max(cut_.pieces[std::size_t(orifice.a)].radiusMm,
                                       cut_.pieces[std::size_t(orifice.b)].radiusMm);
        return sum / double(count) < 2.5 * widest + 5.0;
    }

    void label() {
        forVoxels(grid_, options_.threads, [&](std::size_t n, glm::ivec3) {
            if (isKept(cut_.pieceAt[n])) labels_[n] = labelOf(n);
        });
    }

    std::uint8_t labelOf(std::size_t n) const {
        const auto content = Content(contents_.content[n]);
        if (content == Content::untagged) return untagged;
        if (content == Content::gas) return air;
        if (content == Content::tagged) return tagged;
        return hu_[n] < tissue_.airBelowHu ? air : tagged;
    }

    double unlikeSoft(std::size_t n) const { return std::abs(hu_[n] - softHu_); }

    void closeDoors() {
        for (std::size_t o = 0; o < cut_.orifices.size(); ++o) {
            const Orifice& orifice = cut_.orifices[o];
            const bool a = isKept(orifice.a), b = isKept(orifice.b);
            if ((!a && !b) || open_[o]) continue;
            // What is small and no bowel of its own may yet be a crumb of the lumen.
            if (a != b && graph_.nodeOf[std::size_t(a ? orifice.b : orifice.a)] < 0) continue;
            double areaMm2 = 0.0;
            std::vector<std::size_t> voxels;
            visitFacesOf(int(o), [&](std::size_t n, std::size_t m, int axis) {
                if (orificeAt(n, m) >= 0 && orificeAt(n, m) != int(o)) return;
                const std::size_t wall = unlikeSoft(n) <= unlikeSoft(m) ? n : m;
                labels_[wall] = outside, barred_[wall] = true;
                areaMm2 += grid_.voxelVolumeMm3() / grid_.spacingMm()[axis];
                voxels.push_back(wall);
            });
            std::sort(voxels.begin(), voxels.end());
            voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
            for (const std::size_t n : voxels)
                ++closings_[n];
            if (orifice.openMm2 <= 0.0) continue;
            if (a && b) loopWalls_.push_back({result_.walls.size(), std::move(voxels)});
            result_.walls.push_back({orifice.placeMm, areaMm2, orifice.radiusMm, a && b});
        }
    }

    // Whether two pieces are one or open into each other.
    bool areJoined(std::int32_t a, std::int32_t b) const {
        return a >= 0 && b >= 0 && (a == b || joined_.count(std::minmax(a, b)) > 0);
    }

    // Between gas and the tagged material of one lumen straight beneath: partial volume, and the
    // menisci at a level's rim. Elsewhere, and between two loops, a thin wall looks the same. What
    // is filled faces no lumen that these two do not open into.
    void fillInterfaces() {
        constexpr double rimMm = 1.5, nearMm = 3.0;
        const glm::dvec3 spacing = grid_.spacingMm();
        const GravityAxis down = contents_.down;
        const int side = 1 - down.axis;
        const auto voxels = [&](double mm, int axis) {
            return std::max(1, int(std::lround(mm / spacing[axis])));
        };
        const int rimAside = voxels(rimMm, side), rimAlong = voxels(rimMm, 2),
                  near = voxels(nearMm, down.axis) + 1;
        std::unordered_map<std::size_t, std::int32_t> gasOver;  // of each voxel filled
        const auto fillAround = [&](const LevelColumn& column) {
            for (int dz = -rimAlong; dz <= rimAlong; ++dz) {
                for (int dn = -rimAside; dn <= rimAside; ++dn) {
                    glm::ivec3 v = column.below;
                    v[side] += dn, v.z += dz, v[down.axis] -= near * down.sign;
                    fillGap(gapBelow(v, near), gasOver);
                }
            }
        };
        for (const Level& level : contents_.levels) {
            for (const LevelColumn& column : level.columns) {
                if (labels_[grid_.index(column.below)] != outside ||
                    labels_[grid_.index(column.above)] != outside)
                    fillAround(column);
            }
        }
    }
    // What lies between the gas of one piece and the fluid of another below it.
    struct Gap {
        std::int32_t gas = -1, fluid = -1;  // pieces
        std::vector<std::size_t> voxels;
    };
    // The last gap in the `2 near` voxels from `v` down, of fewer than `near`; empty: none.
    Gap gapBelow(glm::ivec3 v, int near) const {
        const GravityAxis down = contents_.down;
        Gap gap;
        bool underAir = false;
        for (int step = 0; step < 2 * near && grid_.contains(v);
             ++step, v[down.axis] += down.sign) {
            const std::size_t n = grid_.index(v);
            const std::int32_t piece = cut_.pieceAt[n];
            if (labels_[n] == air) {
                underAir = true, gap.voxels.clear();
                gap.gas = piece;
            } else if (labels_[n] == tagged) {
                gap.fluid = piece;
                const bool oneLumen = underAir && areJoined(gap.gas, piece);
                return oneLumen && int(gap.voxels.size()) < near ? gap : Gap{};
            } else if (barred_[n] || (piece >= 0 && graph_.nodeOf[std::size_t(piece)] >= 0)) {
                break;
            } else if (underAir) {
                gap.voxels.push_back(n);
            }
        }
        return {};
    }
    void fillGap(const Gap& gap, std::unordered_map<std::size_t, std::int32_t>& gasOver) {
        const auto facesOther = [&](std::size_t n) {
            bool other = false;
            visitFaces(grid_, n, [&](std::size_t m, int) {
                if (labels_[m] == outside) return;
                const auto over = gasOver.find(m);
                const std::int32_t piece = over != gasOver.end() ? over->second : cut_.pieceAt[m];
                other = other || !(areJoined(gap.gas, piece) || areJoined(gap.fluid, piece));
            });
            return other;
        };
        for (const std::size_t n : gap.voxels) {
            if (facesOther(n)) continue;
            labels_[n] = tagged, gasOver.emplace(n, gap.gas);
        }
    }

    // Tagged material ends where the HU are half-way between it and soft tissue: its own, as it is
    // not equally bright everywhere. One layer of voxels at a time, off or on.
    void fitToHalfHeight() {
        constexpr double layersMm = 1.6;
        auto front = voxelsWhere(grid_, options_.threads, [&](std::size_t n, glm::ivec3 v) {
            if (labels_[n] != tagged || Content(contents_.content[n]) == Content::interface)
                return false;
            bool edge = false;
            visitFaces(grid_, n, v,
                       [&](std::size_t m, int) { edge = edge || labels_[m] == outside; });
            return edge;
        });
        const int layers = std::max(1, int(std::lround(layersMm / grid_.spacingMm().x)));
        const std::vector<std::uint32_t> rim = front;
        for (int layer = 0; layer < layers && !front.empty(); ++layer) {
            std::vector<std::uint32_t> off;
            for (const std::uint32_t n : front) {
                bool byAir = false;
                visitFaces(grid_, n,
                           [&](std::size_t m, int) { byAir = byAir || labels_[m] == air; });
                if (!byAir && smooth_[n] < halfHeightAt(n)) off.push_back(n);
            }
            front.clear();
            for (const std::uint32_t n : off)
                labels_[n] = outside;
            for (const std::uint32_t n : off) {
                visitFaces(grid_, n, [&](std::size_t m, int) {
                    if (labels_[m] == tagged && Content(contents_.content[m]) != Content::interface)
                        front.push_back(std::uint32_t(m));
                });
            }
            std::sort(front.begin(), front.end());
            front.erase(std::unique(front.begin(), front.end()), front.end());
        }
        front = rim;
        for (int layer = 0; layer < layers && !front.empty(); ++layer) {
            std::vector<std::uint32_t> on;
            for (const std::uint32_t n : front) {
                if (labels_[n] != tagged) continue;
                visitFaces(grid_, n, [&](std::size_t m, int) {
                    if (labels_[m] == outside && !barred_[m] &&
                        Content(contents_.content[m]) == Content::tissue &&
                        smooth_[m] > halfHeightAt(n) && !besideOthers(m))
                        on.push_back(std::uint32_t(m));
                });
            }
            std::sort(on.begin(), on.end());
            on.erase(std::unique(on.begin(), on.end()), on.end());
            for (const std::uint32_t n : on) {  // the wall between two loops parts them still
                if (joinsNothing(result_.labels, n)) labels_[n] = tagged;
            }
            front = std::move(on);
        }
    }
    // By the brightest tagged voxel within 3 mm.
    double halfHeightAt(std::size_t n) const {
        constexpr double reachMm = 3.0;
        const glm::ivec3 v = grid_.voxelAt(n);
        const glm::ivec3 reach(reachMm / grid_.spacingMm());
        const glm::ivec3 lo = glm::max(v - reach, glm::ivec3(0)),
                         hi = glm::min(v + reach, grid_.size - 1);
        int most = -1024;
        for (int k = lo.z; k <= hi.z; ++k) {
            for (int j = lo.y; j <= hi.y; ++j) {
                for (std::size_t m = grid_.index(lo.x, j, k), end = grid_.index(hi.x, j, k);
                     m <= end; ++m) {
                    if (labels_[m] == tagged) most = std::max<int>(most, smooth_[m]);
                }
            }
        }
        return 0.5 * (softHu_ + most);
    }
    bool besideOthers(std::size_t n) const {
        bool beside = false;
        visitFaces(grid_, n, [&](std::size_t m, int) {
            const std::int32_t p = cut_.pieceAt[m];
            beside = beside || barred_[m] ||
                     (p >= 0 && !isKept(p) && graph_.nodeOf[std::size_t(p)] >= 0);
        });
        return beside;
    }

    // Pieces that are no bowel of their own, open to the lumen more than to anything else; and
    // tagged stool in its gas.
    void takeCrumbs() {
        struct Contact {
            double openToLumen = 0.0, openToBowel = 0.0;  ///< mm²
            double lumen = 0.0, others = 0.0;             ///< with walls, and any other piece
        };
        std::map<std::int32_t, Contact> contacts;
        for (const Orifice& orifice : cut_.orifices) {
            for (const auto& [crumb, other] :
                 {std::pair(orifice.a, orifice.b), std::pair(orifice.b, orifice.a)}) {
                if (isKept(crumb) || graph_.nodeOf[std::size_t(crumb)] >= 0) continue;
                Contact& contact = contacts[crumb];
                (isKept(other) ? contact.lumen : contact.others) +=
                    orifice.openMm2 + orifice.wallMm2;
                if (isKept(other))
                    contact.openToLumen += orifice.openMm2;
                else if (graph_.nodeOf[std::size_t(other)] >= 0)
                    contact.openToBowel += orifice.openMm2;
            }
        }
        std::vector<char> taken(cut_.pieces.size(), 0);
        // Other bowel; crumbs of tagged material that touch other pieces more than the lumen; and
        // what is tagged and as wide as bowel.
        std::vector<char> elsewhere(cut_.pieces.size(), 0), aside = elsewhere, wide = elsewhere;
        for (std::size_t p = 0; p < elsewhere.size(); ++p) {
            const int node = graph_.nodeOf[p];
            if (kept_[p] || node < 0) continue;
            const TubePiece& piece = cut_.pieces[p];
            const bool mayBeStool = piece.taggedVoxels > piece.gasVoxels + piece.untaggedVoxels &&
                                    graph_.graph.nodes[std::size_t(node)].given >= 0.0;
            (mayBeStool ? wide : elsewhere)[p] = 1;
        }
        for (const auto& [crumb, contact] : contacts) {
            constexpr double largestMl = 1.0;
            const TubePiece& piece = cut_.pieces[std::size_t(crumb)];
            if (!piece.mostlyGas()) {
                if (contact.others > contact.lumen) aside[std::size_t(crumb)] = 1;
            } else if (contact.openToLumen > 3.0 * contact.openToBowel &&
                       contact.openToLumen > 0.05 * piece.surfaceMm2 &&
                       piece.volumeMl < largestMl && piece.excludedAirMm2 == 0.0) {
                taken[std::size_t(crumb)] = 1;
            }
        }
        forVoxels(grid_, options_.threads, [&](std::size_t n, glm::ivec3) {
            const std::int32_t p = cut_.pieceAt[n];
            if (p >= 0 && taken[std::size_t(p)] && labels_[n] == outside && !barred_[n])
                labels_[n] = labelOf(n);
        });
        if (options_.asGiven) return;
        const auto voxelsOf = [&](const auto& isOne) {
            return voxelsWhere(grid_, options_.threads,
                               [&](std::size_t n, glm::ivec3) { return isOne(n); });
        };
        const auto isOf = [&](const std::vector<char>& pieces, std::size_t n) {
            const std::int32_t p = cut_.pieceAt[n];
            return p >= 0 && pieces[std::size_t(p)];
        };
        OtherMaterial other;
        other.surely = voxelsOf([&](std::size_t n) { return barred_[n] || isOf(elsewhere, n); });
        other.aside = voxelsOf([&](std::size_t n) { return !barred_[n] && isOf(aside, n); });
        other.bowel = voxelsOf([&](std::size_t n) { return !barred_[n] && isOf(wide, n); });
        addTaggedStool(result_.labels, hu_, contents_, tissue_, other);
        labels_ = result_.labels.writable();
    }

    // The voxel of a labelled piece nearest to a point, of its body where that is near, else of a
    // crumb: a bridge to a crumb joins nothing.
    std::optional<glm::ivec3> nearestOf(std::int32_t piece, glm::dvec3 pointMm) const {
        constexpr double reachMm = 12.0;
        const glm::ivec3 center(glm::round(grid_.voxelFromPatientPoint(pointMm)));
        const glm::ivec3 reach = glm::ivec3(reachMm / grid_.spacingMm()) + 1;
        const glm::ivec3 lo = glm::max(center - reach, glm::ivec3(0)),
                         hi = glm::min(center + reach, grid_.size - 1);
        const auto ofBody = [&](glm::ivec3 v) {
            constexpr int leastFaces = 3;
            int faces = 0;
            for (int n = 0; n < 6; ++n) {
                glm::ivec3 w = v;
                w[n / 2] += n % 2 ? 1 : -1;
                if (grid_.contains(w) && cut_.pieceAt.at(w) == piece)
                    faces += labels_[grid_.index(w)] != outside;
            }
            return faces >= leastFaces;
        };
        std::optional<glm::ivec3> nearest, crumb;
        double nearestMm = 1e9, crumbMm = 1e9;
        visitBox(lo, hi, [&](glm::ivec3 w) {
            const std::size_t n = grid_.index(w);
            if (cut_.pieceAt[n] != piece || labels_[n] == outside || labels_[n] == bridge) return;
            const double mm = glm::distance(grid_.patientFromVoxelPoint(glm::dvec3(w)), pointMm);
            if (mm < crumbMm) crumbMm = mm, crumb = w;
            if (mm < nearestMm && ofBody(w)) nearestMm = mm, nearest = w;
        });
        return nearest ? nearest : crumb;
    }

    void layBridges(double radiusMm) {
        result_.bridgeMm.assign(chain_.junctions.size(), 0.0);
        for (std::size_t step = 0; step < chain_.junctions.size(); ++step) {
            const ChainJunction& junction =
                graph_.graph.junctions[std::size_t(chain_.junctions[step])];
            if (junction.kind != JunctionKind::collapse) continue;
            const CollapsePath& path = graph_.collapses[std::size_t(junction.path)];
            const auto from = nearestOf(path.from, path.pointsMm.front()),
                       to = nearestOf(path.to, path.pointsMm.back());
            if (!from || !to) continue;  // joinUp tells
            std::vector<glm::ivec3> corners{*from};
            for (const glm::dvec3 p : path.pointsMm)
                corners.push_back(glm::ivec3(glm::round(grid_.voxelFromPatientPoint(p))));
            corners.push_back(*to);
            laid_.clear();
            sides_ = {path.from, path.to};
            for (std::size_t n = 1; n < corners.size(); ++n)
                result_.bridgeMm[step] += layStraight(corners[n - 1], corners[n], radiusMm);
            wallOff();
        }
    }
    // A collapsed colon that runs along the wall of another loop does not open into it: where the
    // bridge just laid faces lumen of other pieces than the two that it joins, that becomes wall.
    void wallOff() {
        for (const glm::ivec3 v : laid_) {
            for (int n = 0; n < 6; ++n) {
                glm::ivec3 w = v;
                w[n / 2] += n % 2 ? 1 : -1;
                if (!grid_.contains(w)) continue;
                const std::size_t at = grid_.index(w);
                if (labels_[at] == outside || labels_[at] == bridge || isSide(w)) continue;
                labels_[at] = outside, barred_[at] = true;
            }
        }
    }
    // Whether a labelled voxel is of a piece that the bridge joins.
    bool isSide(glm::ivec3 v) const {
        const auto joins = [&](std::int32_t piece) {
            return piece >= 0 && (piece == sides_[0] || piece == sides_[1]);
        };
        if (cut_.pieceAt.at(v) >= 0) return joins(cut_.pieceAt.at(v));
        for (int n = 0; n < 27; ++n) {  // a voxel that labelling added
            const glm::ivec3 w = v + cornerStep(n);
            if (grid_.contains(w) && joins(cut_.pieceAt.at(w))) return true;
        }
        return false;
    }
    // Returns the length outside the lumen.
    double layStraight(glm::ivec3 from, glm::ivec3 to, double radiusMm) {
        const glm::dvec3 spacing = grid_.spacingMm(), line = spacing * glm::dvec3(to - from);
        const int steps = std::max(1, int(std::ceil(glm::length(line) / 0.2)));
        glm::ivec3 at = from;
        double crossedMm = 0.0;
        for (int s = 0; s <= steps; ++s) {
            const glm::ivec3 next(
                glm::round(glm::mix(glm::dvec3(from), glm::dvec3(to), double(s) / steps)));
            while (at != next) {  // face to face
                for (int axis = 0; axis < 3; ++axis) {
                    if (at[axis] == next[axis]) continue;
                    at[axis] += next[axis] > at[axis] ? 1 : -1;
                    setBridge(at, true);
                }
            }
            setBridge(at, true);
            if (labels_[grid_.index(at)] == bridge) crossedMm += glm::length(line) / steps;
            const glm::ivec3 reach(radiusMm / spacing);
            for (int k = -reach.z; k <= reach.z; ++k) {
                for (int j = -reach.y; j <= reach.y; ++j) {
                    for (int i = -reach.x; i <= reach.x; ++i) {
                        if (glm::length(spacing * glm::dvec3(i, j, k)) <= radiusMm)
                            setBridge(at + glm::ivec3(i, j, k), false);
                    }
                }
            }
        }
        return crossedMm;
    }
    void setBridge(glm::ivec3 v, bool middle) {
        if (!grid_.contains(v)) return;
        constexpr double rimMm = 3.0;
        const std::size_t n = grid_.index(v);
        // Its middle is laid through another loop's rim, too, which would become wall there.
        if (labels_[n] != outside &&
            (!middle || labels_[n] == bridge || cut_.distanceMm[n] > rimMm || isSide(v)))
            return;
        if (!middle && (barred_[n] || Content(contents_.content[n]) != Content::tissue)) return;
        labels_[n] = bridge;
        laid_.push_back(v);
    }

    // What the labels' fitting has parted is joined again through the pieces as they were cut.
    void joinUp() {
        while (joinBodies(false) >= leastPartedMl && openAWallAgain()) {
        }
        result_.strandedMl = joinBodies(true);
    }
    double joinBodies(bool dropOthers) {
        const double ml = haustra::joinBodies(
            result_.labels, [&](std::size_t n) { return isKept(cut_.pieceAt[n]) && !barred_[n]; },
            [&](std::size_t n) { return labelOf(n); }, {.dropOthers = dropOthers});
        labels_ = result_.labels.writable();
        return ml;
    }

    // From one of two loops that touch, the colon leads to the other: a wall that parts it is not
    // between loops, but where a head or a fold leaves little room. Of the walls that face both the
    // largest body and another as large as parts of the colon are, the one through which the
    // largest ball passes is opened; false: none.
    bool openAWallAgain() {
        const Bodies bodies = bodiesOfLabels();
        const LoopWall* widest = nullptr;
        for (const LoopWall& wall : loopWalls_) {
            bool facesLargest = false, facesPart = false;
            for (const std::size_t n : wall.voxels)
                visitFaces(grid_, n, [&](std::size_t m, int) {
                    const std::int32_t body = bodies.at[m];
                    facesLargest |= body == bodies.largest;
                    facesPart |= body >= 0 && body != bodies.largest &&
                                 bodies.ml[std::size_t(body)] >= leastPartedMl;
                });
            if (facesLargest && facesPart &&
                (!widest ||
                 result_.walls[wall.wall].radiusMm > result_.walls[widest->wall].radiusMm))
                widest = &wall;
        }
        if (!widest) return false;
        for (const std::size_t n : widest->voxels)
            if (labels_[n] == outside && isKept(cut_.pieceAt[n]) && --closings_[n] == 0)
                labels_[n] = labelOf(n), barred_[n] = false;
        const std::size_t opened = widest->wall;
        result_.walls[opened].openedAgain = true;
        std::erase_if(loopWalls_, [&](const LoopWall& wall) { return wall.wall == opened; });
        return true;
    }
    struct Bodies {
        std::vector<std::int32_t> at;  // of each voxel; −1: outside
        std::vector<double> ml;
        std::int32_t largest = -1;
    };
    Bodies bodiesOfLabels() const {
        Bodies bodies;
        bodies.at.assign(labels_.size(), -1);
        for (std::size_t n = 0; n < labels_.size(); ++n) {
            if (labels_[n] == outside || bodies.at[n] >= 0) continue;
            const auto body = std::int32_t(bodies.ml.size());
            std::vector<std::size_t> voxels{n};
            bodies.at[n] = body;
            floodFill(voxels, faceNeighbours(grid_), [&](std::size_t m) {
                if (labels_[m] == outside || bodies.at[m] >= 0) return false;
                bodies.at[m] = body;
                return true;
            });
            bodies.ml.push_back(double(voxels.size()) * grid_.voxelVolumeMm3() / 1000.0);
            if (bodies.largest < 0 || bodies.ml.back() > bodies.ml[std::size_t(bodies.largest)])
                bodies.largest = body;
        }
        return bodies;
    }

    const Volume<std::int16_t>& hu_;
    const Grid grid_;
    const TissueModel& tissue_;
    const BowelContents& contents_;
    const TubePieces& cut_;
    const PieceGraph& graph_;
    const ColonChain& chain_;
    const double softHu_;
    const LabelOptions options_;
    std::vector<char> kept_;                                  ///< pieces
    std::vector<bool> barred_;                                ///< voxels of rebuilt walls
    Volume<std::int16_t> smooth_;                             ///< HU, against noise
    std::vector<char> open_;                                  ///< orifices
    std::vector<int> inner_;                                  ///< orifices between kept pieces
    std::set<std::pair<std::int32_t, std::int32_t>> joined_;  ///< pieces a < b, by open orifices
    std::array<std::int32_t, 2> sides_{-1, -1};               ///< pieces that the last bridge joins
    std::vector<glm::ivec3> laid_;                            ///< voxels of the last bridge
    std::set<int> cuts_;                                      ///< orifices that the chain closes
    struct LoopWall {
        std::size_t wall = 0;             // of result_.walls
        std::vector<std::size_t> voxels;  // that became wall
    };
    std::unordered_map<std::size_t, int> closings_;  // of a voxel that became wall: of how many
    std::vector<LoopWall> loopWalls_;
    std::vector<std::pair<std::uint32_t, int>> faces_;  ///< first voxel, inner orifice; sorted
    ColonLabels result_;
    std::span<std::uint8_t> labels_;
};

}  // namespace

ColonLabels layLabels(const Volume<std::int16_t>& hu, const TissueModel& tissue,
                      const BowelContents& contents, const TubePieces& cut, const PieceGraph& graph,
                      const ColonChain& chain, const LabelOptions& options) {
    return Labelling(hu, tissue, contents, cut, graph, chain, options).run();
}

}  // namespace haustra::segmentation
