#include "segmentation/tube_pieces.h"

#include "segmentation/bowel_contents.h"
#include "topology/distance_field.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_map>

namespace haustra::segmentation {
namespace {

constexpr double ticksPerMm = 32.0;
constexpr std::int32_t none = -1;

bool isContent(std::uint8_t content) {
    return Content(content) == Content::gas || Content(content) == Content::tagged ||
           Content(content) == Content::interface || Content(content) == Content::untagged;
}

std::int32_t rootOf(std::vector<std::int32_t>& parent, std::int32_t n) {
    while (parent[std::size_t(n)] != n)
        n = parent[std::size_t(n)] = parent[std::size_t(parent[std::size_t(n)])];
    return n;
}

/// Voxels with a distance, the farthest from the boundary first, of equals the first.
std::vector<std::uint32_t> byFallingDistance(const Volume<float>& distanceMm) {
    std::vector<std::size_t> begin;
    const auto ticks = [](float mm) {
        return std::size_t(std::min(mm, 1000.0f) * float(ticksPerMm));
    };
    for (const float mm : distanceMm.voxels()) {
        if (!(mm > 0.0f)) continue;
        const std::size_t at = ticks(mm);
        if (at + 2 > begin.size()) begin.resize(at + 2, 0);
        ++begin[at];
    }
    std::size_t sum = 0;
    for (std::size_t n = begin.size(); n-- > 0;) {
        const std::size_t count = begin[n];
        begin[n] = sum;
        sum += count;
    }
    std::vector<std::uint32_t> order(sum);
    for (std::size_t n = 0; n < distanceMm.voxels().size(); ++n) {
        if (distanceMm[n] > 0.0f) order[begin[ticks(distanceMm[n])]++] = std::uint32_t(n);
    }
    return order;
}

/// Basins of the distance, merged as they meet; `label` gets their numbers.
std::vector<std::int32_t> floodBasins(const Volume<float>& distanceMm, double neck,
                                      std::span<std::int32_t> label, const Grid& grid) {
    std::vector<std::int32_t> parent;
    std::vector<float> peakMm;
    for (const std::uint32_t n : byFallingDistance(distanceMm)) {
        std::array<std::int32_t, 6> around{};
        std::size_t count = 0;
        float deepest = 0.0f;
        std::int32_t uphill = none;
        visitFaces(grid, n, [&](std::size_t m, int) {
            if (label[m] < 0) return;
            const std::int32_t root = rootOf(parent, label[m]);
            if (distanceMm[m] > deepest) deepest = distanceMm[m], uphill = root;
            if (std::find(around.begin(), around.begin() + std::ptrdiff_t(count), root) ==
                around.begin() + std::ptrdiff_t(count))
                around[count++] = root;
        });
        if (count == 0) {
            label[n] = std::int32_t(parent.size());
            parent.push_back(label[n]);
            peakMm.push_back(distanceMm[n]);
            continue;
        }
        // The voxel goes uphill; the highest peak takes what hardly stands apart from it here.
        std::int32_t first = around[0];
        for (std::size_t k = 1; k < count; ++k) {
            const float peak = peakMm[std::size_t(around[k])], highest = peakMm[std::size_t(first)];
            if (peak > highest || (peak == highest && around[k] < first)) first = around[k];
        }
        for (std::size_t k = 0; k < count; ++k) {
            if (around[k] != first &&
                double(distanceMm[n]) >= neck * double(peakMm[std::size_t(around[k])]))
                parent[std::size_t(around[k])] = first;
        }
        label[n] = uphill;
    }
    for (std::size_t n = 0; n < parent.size(); ++n)
        parent[n] = rootOf(parent, std::int32_t(n));
    return parent;
}

/// Cuts pieces that reach farther than a part of the colon does, into lengths of about `bandMm` by
/// the way, face to face, from their far end.
void splitLong(std::span<std::int32_t> label, std::vector<std::int32_t>& rootOfBasin, double bandMm,
               const Grid& grid) {
    if (!(bandMm > 0.0)) return;
    std::vector<std::size_t> voxels(rootOfBasin.size(), 0);
    std::vector<std::uint32_t> first(rootOfBasin.size(), 0);
    for (std::size_t n = label.size(); n-- > 0;) {
        if (label[n] < 0) continue;
        label[n] = rootOfBasin[std::size_t(label[n])];
        ++voxels[std::size_t(label[n])], first[std::size_t(label[n])] = std::uint32_t(n);
    }
    const glm::dvec3 spacing = grid.spacingMm();
    const std::size_t large =
        std::size_t(bandMm * 30.0 / grid.voxelVolumeMm3());  // thinner is no colon
    std::vector<float> way(
        label.size() * std::size_t(std::any_of(voxels.begin(), voxels.end(),
                                               [&](std::size_t v) { return v > large; })),
        -1.0f);
    const std::size_t basins = voxels.size();
    for (std::size_t basin = 0; basin < basins; ++basin) {
        if (voxels[basin] <= large) continue;
        // Ways by steps of equal count are long enough here: rounds of breadth-first search, in mm.
        const auto waysFrom = [&](std::uint32_t seed, std::vector<std::uint32_t>& reached) {
            for (const std::uint32_t n : reached)
                way[n] = -1.0f;
            reached.assign(1, seed);
            way[seed] = 0.0f;
            for (std::size_t head = 0; head < reached.size(); ++head) {
                visitFaces(grid, reached[head], [&](std::size_t m, int axis) {
                    if (label[m] != std::int32_t(basin) || way[m] >= 0.0f) return;
                    way[m] = way[reached[head]] + float(spacing[axis]);
                    reached.push_back(std::uint32_t(m));
                });
            }
        };
        std::vector<std::uint32_t> reached;
        waysFrom(first[basin], reached);
        waysFrom(reached.back(), reached);
        const double reachMm = way[reached.back()];
        if (reachMm < 1.6 * bandMm) continue;
        const int bands = int(std::lround(reachMm / bandMm));
        const auto bandOf = [&](std::uint32_t n) {
            return std::min(bands - 1, int(double(way[n]) / reachMm * bands));
        };
        // Each connected part of a band is a piece.
        std::vector<std::uint32_t> front;
        std::vector<std::pair<std::uint32_t, std::int32_t>> moved;
        for (const std::uint32_t seed : reached) {
            if (way[seed] < 0.0f) continue;  // in a part already
            const std::int32_t number = std::int32_t(rootOfBasin.size());
            rootOfBasin.push_back(number);
            const int band = bandOf(seed);
            front.assign(1, seed);
            way[seed] = -1.0f;
            for (std::size_t head = 0; head < front.size(); ++head) {
                moved.emplace_back(front[head], number);
                visitFaces(grid, front[head], [&](std::size_t m, int) {
                    if (label[m] != std::int32_t(basin) || way[m] < 0.0f ||
                        bandOf(std::uint32_t(m)) != band)
                        return;
                    way[m] = -1.0f;
                    front.push_back(std::uint32_t(m));
                });
            }
        }
        for (const auto& [n, number] : moved)
            label[n] = number;
    }
}

void numberByVolume(std::span<std::int32_t> label, std::vector<std::int32_t>& rootOfBasin) {
    std::vector<std::size_t> voxels(rootOfBasin.size(), 0);
    for (const std::int32_t l : label) {
        if (l >= 0) ++voxels[std::size_t(rootOfBasin[std::size_t(l)])];
    }
    std::vector<std::int32_t> roots;
    for (std::size_t n = 0; n < rootOfBasin.size(); ++n) {
        if (rootOfBasin[n] == std::int32_t(n)) roots.push_back(std::int32_t(n));
    }
    std::stable_sort(roots.begin(), roots.end(), [&](std::int32_t a, std::int32_t b) {
        return voxels[std::size_t(a)] > voxels[std::size_t(b)];
    });
    std::vector<std::int32_t> number(rootOfBasin.size(), none);
    for (std::size_t n = 0; n < roots.size(); ++n)
        number[std::size_t(roots[n])] = std::int32_t(n);
    for (std::int32_t& l : label) {
        if (l >= 0) l = number[std::size_t(rootOfBasin[std::size_t(l)])];
    }
    rootOfBasin = std::move(roots);
}

/// Mean HU of each piece's tagged voxels more than 2.5 mm deep; −∞ where it has none.
std::vector<double> coreHuOf(std::span<const std::int32_t> label, std::size_t pieces,
                             const Volume<std::int16_t>& hu, const Volume<std::uint8_t>& content,
                             const Volume<float>& distanceMm) {
    std::vector<double> sum(pieces, 0.0), count(pieces, 0.0);
    for (std::size_t n = 0; n < label.size(); ++n) {
        if (label[n] < 0 || Content(content[n]) != Content::tagged || !(distanceMm[n] > 2.5f))
            continue;
        sum[std::size_t(label[n])] += hu[n], count[std::size_t(label[n])] += 1.0;
    }
    for (std::size_t p = 0; p < pieces; ++p)
        sum[p] = count[p] > 0.0 ? sum[p] / count[p] : -std::numeric_limits<double>::infinity();
    return sum;
}

/// Gives what no basin has, layer by layer and `layers` far, to the piece beside it for which
/// `takes(voxel, piece)` holds; the rest stays without one.
template <class Takes>
void spread(std::span<std::int32_t> label, const Volume<std::uint8_t>& content, const Grid& grid,
            int layers, const Takes& takes) {
    std::vector<std::uint32_t> front;
    for (std::size_t n = 0; n < label.size(); ++n) {
        if (label[n] >= 0 || !isContent(content[n])) continue;
        bool near = false;
        visitFaces(grid, n, [&](std::size_t m, int) { near = near || label[m] >= 0; });
        if (near) front.push_back(std::uint32_t(n));
    }
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

/// The connected patches of the faces between each two pieces: faces are neighbours where their
/// first voxels are the same or touch.
std::vector<Orifice> patchesOf(std::vector<Face> faces, const Volume<std::int16_t>& hu,
                               const Volume<std::uint8_t>& content,
                               const Volume<std::uint8_t>& thinWalls,
                               const Volume<float>& distanceMm) {
    const Grid& grid = hu.grid();
    const glm::dvec3 faceMm2 = grid.voxelVolumeMm3() / grid.spacingMm();
    const std::size_t strides[3] = {1, std::size_t(grid.size.x),
                                    std::size_t(grid.size.x) * std::size_t(grid.size.y)};
    std::stable_sort(faces.begin(), faces.end(), [](const Face& x, const Face& y) {
        return std::pair(x.a, x.b) < std::pair(y.a, y.b);
    });
    std::vector<Orifice> patches;
    std::unordered_map<std::uint32_t, std::int32_t> at;  // first face of a voxel
    for (std::size_t first = 0, last = 0; first < faces.size(); first = last) {
        while (last < faces.size() && faces[last].a == faces[first].a &&
               faces[last].b == faces[first].b)
            ++last;
        std::vector<std::int32_t> parent(last - first);
        std::iota(parent.begin(), parent.end(), 0);
        const auto unite = [&](std::int32_t x, std::int32_t y) {
            x = rootOf(parent, x), y = rootOf(parent, y);
            parent[std::size_t(std::max(x, y))] = std::min(x, y);
        };
        at.clear();
        for (std::size_t f = first; f < last; ++f) {
            const auto [known, isNew] = at.try_emplace(faces[f].n, std::int32_t(f - first));
            if (!isNew) unite(std::int32_t(f - first), known->second);
        }
        for (std::size_t f = first; f < last; ++f) {
            const glm::ivec3 v = grid.voxelAt(faces[f].n);
            for (int s = 0; s < 27; ++s) {
                const glm::ivec3 w = v + glm::ivec3(s % 3 - 1, s / 3 % 3 - 1, s / 9 - 1);
                if (!grid.contains(w)) continue;
                const auto near = at.find(std::uint32_t(grid.index(w)));
                if (near != at.end()) unite(std::int32_t(f - first), near->second);
            }
        }
        std::map<std::int32_t, std::vector<std::size_t>> byRoot;
        for (std::size_t f = first; f < last; ++f)
            byRoot[rootOf(parent, std::int32_t(f - first))].push_back(f);
        for (const auto& [root, members] : byRoot) {
            Orifice orifice;
            orifice.a = faces[first].a, orifice.b = faces[first].b;
            glm::dvec3 middle(0.0);
            double area = 0.0, huSum = 0.0;
            for (const std::size_t f : members) {
                const std::size_t n = faces[f].n, m = n + strides[faces[f].axis];
                const double mm2 = faceMm2[faces[f].axis];
                middle += mm2 * 0.5 * (glm::dvec3(grid.voxelAt(n)) + glm::dvec3(grid.voxelAt(m)));
                area += mm2;
                orifice.voxels.push_back(std::uint32_t(n));
                if (thinWalls[n] || thinWalls[m]) {
                    orifice.wallMm2 += mm2;
                    huSum += mm2 * double(std::max(hu[n], hu[m]));
                    continue;
                }
                orifice.openMm2 += mm2;
                if (Content(content[n]) == Content::tagged &&
                    Content(content[m]) == Content::tagged)
                    orifice.openTaggedMm2 += mm2;
                const double through = std::min(distanceMm[n], distanceMm[m]);
                if (through > orifice.radiusMm)
                    orifice.radiusMm = through, orifice.place = grid.voxelAt(n);
            }
            if (orifice.openMm2 == 0.0) orifice.place = glm::ivec3(glm::round(middle / area));
            orifice.placeMm = grid.patientFromVoxelPoint(orifice.place);
            if (orifice.wallMm2 > 0.0) orifice.barrierHu = huSum / orifice.wallMm2;
            std::sort(orifice.voxels.begin(), orifice.voxels.end());
            orifice.voxels.erase(std::unique(orifice.voxels.begin(), orifice.voxels.end()),
                                 orifice.voxels.end());
            patches.push_back(std::move(orifice));
        }
    }
    return patches;
}

/// Pieces and orifices of cut.pieceAt, whose numbers are below `count`.
void measure(TubePieces& cut, std::size_t count, const Volume<std::int16_t>& hu,
             const Volume<std::uint8_t>& content, const Volume<std::uint8_t>& thinWalls) {
    const Grid& grid = hu.grid();
    const auto label = cut.pieceAt.voxels();
    const glm::dvec3 spacing = grid.spacingMm();
    const double voxelMm3 = grid.voxelVolumeMm3();
    const glm::dvec3 faceMm2 = voxelMm3 / spacing;
    cut.pieces.assign(count, {});
    std::vector<double> gasSum(count, 0.0), taggedSum(count, 0.0);
    std::vector<Face> faces;
    for (std::size_t n = 0; n < label.size(); ++n) {
        const std::int32_t l = label[n];
        if (l < 0) continue;
        TubePiece& piece = cut.pieces[std::size_t(l)];
        ++piece.voxels;
        if (Content(content[n]) == Content::gas) ++piece.gasVoxels, gasSum[std::size_t(l)] += hu[n];
        if (Content(content[n]) == Content::tagged)
            ++piece.taggedVoxels, taggedSum[std::size_t(l)] += hu[n];
        piece.untaggedVoxels += Content(content[n]) == Content::untagged;
        const double mm = cut.distanceMm[n];
        if (mm > piece.radiusMm) piece.radiusMm = mm, piece.centre = grid.voxelAt(n);
        visitFaces(grid, n, [&](std::size_t m, int axis) {
            if (label[m] == l) return;
            piece.surfaceMm2 += faceMm2[axis];
            const Content other = Content(content[m]);
            if (other == Content::outside || other == Content::lung)
                piece.excludedAirMm2 += faceMm2[axis];
            if (label[m] < 0 || m < n) return;
            faces.push_back({std::min(l, label[m]), std::max(l, label[m]), std::uint32_t(n),
                             std::uint8_t(axis)});
        });
    }
    std::vector<std::array<double, 3>> core(count, {0, 0, 0});
    for (std::size_t n = 0; n < label.size(); ++n) {
        if (label[n] < 0 || Content(content[n]) != Content::tagged || !(cut.distanceMm[n] > 2.5f))
            continue;
        std::array<double, 3>& sums = core[std::size_t(label[n])];
        sums[0] += 1.0, sums[1] += hu[n], sums[2] += double(hu[n]) * hu[n];
    }
    for (std::size_t p = 0; p < cut.pieces.size(); ++p) {
        if (core[p][0] > 0.0) {
            cut.pieces[p].coreHu = core[p][1] / core[p][0];
            cut.pieces[p].coreSdHu = std::sqrt(std::max(
                0.0, core[p][2] / core[p][0] - cut.pieces[p].coreHu * cut.pieces[p].coreHu));
        }
        TubePiece& piece = cut.pieces[p];
        piece.volumeMl = double(piece.voxels) * voxelMm3 / 1000.0;
        piece.centreMm = grid.patientFromVoxelPoint(piece.centre);
        piece.meanHu = piece.mostlyGas()
                           ? gasSum[p] / double(std::max<std::size_t>(1, piece.gasVoxels))
                           : taggedSum[p] / double(std::max<std::size_t>(1, piece.taggedVoxels));
    }
    cut.orifices = patchesOf(std::move(faces), hu, content, thinWalls, cut.distanceMm);
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
    const auto unite = [&](std::int32_t a, std::int32_t b) {
        a = rootOf(parent, a), b = rootOf(parent, b);
        parent[std::size_t(std::max(a, b))] = std::min(a, b);
        any = true;
    };
    for (const auto& [a, b, c] : triangles) {
        if (trianglesAt[{a, b}] > 1 || trianglesAt[{b, c}] > 1 || trianglesAt[{a, c}] > 1)
            unite(a, b), unite(b, c);
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
    TubePieces cut;
    {
        Volume<std::uint8_t> plain(grid);
        const auto out = plain.writable();
        for (std::size_t n = 0; n < out.size(); ++n)
            out[n] = isContent(content[n]) && !thinWalls[n];
        cut.distanceMm = topology::distanceToBoundaryMm(plain, options.threads);
    }
    cut.pieceAt = Volume<std::int32_t>(grid, none);
    const auto label = cut.pieceAt.writable();
    std::vector<std::int32_t> basins = floodBasins(cut.distanceMm, options.neck, label, grid);
    splitLong(label, basins, options.lengthMm, grid);
    numberByVolume(label, basins);
    {
        // Thin walls go to the piece beside them, but what is dimmer than half a fluid's height
        // over soft tissue lies beyond that fluid's wall: it is another's, or nobody's.
        const std::vector<double> coreHu =
            coreHuOf(label, basins.size(), hu, content, cut.distanceMm);
        const auto layers = [&](double mm) {
            const glm::dvec3 step = grid.spacingMm();
            return std::max(1, int(std::lround(mm / std::min({step.x, step.y, step.z}))));
        };
        spread(label, content, grid, layers(6.0), [&](std::size_t n, std::int32_t piece) {
            return Content(content[n]) != Content::tagged ||
                   hu[n] - options.softHu > 0.45 * (coreHu[std::size_t(piece)] - options.softHu);
        });
        spread(label, content, grid, layers(1.5), [](std::size_t, std::int32_t) { return true; });
    }

    measure(cut, basins.size(), hu, content, thinWalls);
    if (std::vector<std::int32_t> sides = sideBySide(cut); !sides.empty()) {
        for (std::int32_t& l : label) {
            if (l >= 0) l = sides[std::size_t(l)];
        }
        std::iota(basins.begin(), basins.end(), 0);
        for (std::size_t p = 0; p < basins.size(); ++p)
            basins[p] = sides[p];
        numberByVolume(label, basins);
        measure(cut, basins.size(), hu, content, thinWalls);
    }
    return cut;
}

}  // namespace haustra::segmentation
