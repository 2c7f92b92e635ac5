#include "segmentation/colon_chain.h"

#include "core/flood_fill.h"

#include <algorithm>
#include <bitset>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <queue>
#include <set>

namespace haustra::segmentation {
namespace {

constexpr std::size_t mostNodes = 512;
using Visited = std::bitset<mostNodes>;

// Of bowel that counts as one observation: neighbours lie near each other, and a part of the colon
// is distended or not as a whole.
constexpr double placeUnitMm = 100.0, calibreUnitMm = 300.0, foldUnitMm = 100.0;

double gaussian(double x, double mean, double sd) {
    const double z = (x - mean) / sd;
    return std::exp(-0.5 * z * z) / (sd * std::sqrt(2.0 * M_PI));
}

/// Inscribed diameter of a distended colon, by part: mean and standard deviation, mm. Folds take
/// some 5 mm off what is measured from wall to wall.
struct Calibre {
    double mean, sd;
};
constexpr std::array<Calibre, colonParts> calibres{
    {{34, 10}, {26, 7}, {29, 8}, {32, 9}, {35, 9}, {37, 9}, {42, 10}, {46, 11}}};

double calibreLogOdds(double diameterMm, int part) {
    const Calibre c = calibres[std::size_t(part)];
    const double colon = 0.9 * gaussian(diameterMm, c.mean, c.sd) + 0.1 / 80.0;
    const double smallBowel = 0.95 * gaussian(diameterMm, 16.0, 5.0) + 0.05 / 80.0;
    return std::clamp(std::log(colon / smallBowel), -2.0, 2.5);
}

double nodeScore(const ChainNode& node, int part) {
    const double lengthMm = std::clamp(node.lengthMm, 2.0, 600.0);
    return lengthMm / calibreUnitMm * calibreLogOdds(2.0 * node.radiusMm, part) +
           lengthMm / placeUnitMm * node.placeLogOdds[std::size_t(part)] +
           lengthMm / foldUnitMm * node.foldLogOdds[std::size_t(part)] + node.given;
}

double lnOnePlusExp(double x) {
    return x > 30.0 ? x : std::log1p(std::exp(x));
}
double costOpen(const ChainJunction& j) {
    return lnOnePlusExp(-j.logOdds);
}
double costCut(const ChainJunction& j) {
    return lnOnePlusExp(j.logOdds);
}

double mostSacMl(const ChainNode& base) {
    return 0.5 * base.volumeMl + 5.0;
}

/// A ball whose middle is no higher lies below a chain's first piece.
double highestEndMm(const ChainNode& first) {
    return first.lowestMm.z + 5.0;
}

/// Beside or beneath a chain's first piece that comes down to the anus, no farther off than beyond
/// a balloon: wider than a rectal catheter, where the rectum's end lies, and its ball's middle at
/// most so high.
bool isRectalEnd(const ChainNode& node, const ChainNode& first, double mostHighMm) {
    constexpr double catheterMm = 4.0, beyondBalloonMm = 55.0;
    constexpr double leastPlace = 1.0;  // of 1.2 at most
    constexpr double nearAnus = -3.0;   // 2.4 standard deviations
    return first.rectumLogOdds > nearAnus && node.rectumLogOdds > nearAnus &&
           node.radiusMm > catheterMm && node.centerMm.z <= mostHighMm &&
           glm::distance(node.centerMm, first.lowestMm) < beyondBalloonMm &&
           node.placeLogOdds[std::size_t(ColonPart::rectum)] > leastPlace;
}

/// Pieces that sure lumen joins one after the other: a chain goes through all of them or none.
struct Tube {
    std::vector<int> nodes;
    std::vector<int> links;  ///< junctions between one node and the next
};

constexpr int notReached = -1000000;
using PartScores = std::array<double, colonParts>;

struct Label {
    int tube, exit;  ///< leaves by the tube's first (0) or last (1) node
    int part;        ///< of the last node
    int parent, junction;
    double score;
    double pending;   ///< what closing the doors that were passed by would cost
    Visited visited;  ///< nodes
    double worth() const { return score - pending; }
};

class ChainSearch {
public:
    ChainSearch(const ChainGraph& graph, const ChainOptions& options)
        : graph_(graph), options_(options) {
        around_.resize(graph.nodes.size());
        for (std::size_t n = 0; n < graph.junctions.size(); ++n) {
            around_[std::size_t(graph.junctions[n].a)].push_back(int(n));
            around_[std::size_t(graph.junctions[n].b)].push_back(int(n));
        }
        // Holes of one wall are no evidence of their own: only the widest counts.
        std::map<std::pair<int, int>, std::size_t> widest;
        closing_.assign(graph.junctions.size(), 0.0);
        for (std::size_t n = 0; n < graph.junctions.size(); ++n) {
            const ChainJunction& door = graph.junctions[n];
            if (door.kind == JunctionKind::collapse) continue;
            const auto [first, added] = widest.try_emplace(std::minmax(door.a, door.b), n);
            if (!added && graph.junctions[first->second].logOdds < door.logOdds) first->second = n;
        }
        for (const auto& [pair, n] : widest)
            closing_[n] = costCut(graph.junctions[n]);
        makeTubes();
    }

    std::vector<ColonChain> run() {
        for (std::size_t t = 0; t < tubes_.size(); ++t) {
            for (const int exit : {0, 1})
                start(int(t), exit);
        }
        for (std::size_t head = 0; head < labels_.size(); ++head) {
            if (dropped_[head]) continue;
            for (const int j : around_[std::size_t(exitNode(labels_[head]))])
                extend(int(head), j);
        }
        return best();
    }

private:
    const ChainJunction& junction(int j) const { return graph_.junctions[std::size_t(j)]; }
    const ChainNode& node(int n) const { return graph_.nodes[std::size_t(n)]; }
    int otherEnd(int j, int n) const { return junction(j).a == n ? junction(j).b : junction(j).a; }
    bool isSure(int j) const {
        constexpr double surely = 8.0;
        return junction(j).kind == JunctionKind::openLumen && junction(j).logOdds > surely;
    }
    int exitNode(const Label& label) const {
        const Tube& tube = tubes_[std::size_t(label.tube)];
        return label.exit == 0 ? tube.nodes.front() : tube.nodes.back();
    }

    /// How far a haustrum, or the colon's blind end, may reach beyond a door.
    double sacReachMm(int base) const { return 1.5 * node(base).radiusMm + 12.0; }
    double reachBehindMm(int j, int side) const {
        return glm::distance(node(side).centerMm, junction(j).placeMm) + node(side).radiusMm;
    }
    /// Not fluids that one lumen would have mixed: opacified ileum beside the colon's fluid.
    bool holdsTheSame(int j) const { return junction(j).mismatch < 0.5; }
    /// Whether the piece at the other end of junction `j` is a side sac of `base`: small, and
    /// reaching little farther out than the wall of that.
    bool isSac(int j, int base) const {
        const int side = otherEnd(j, base);
        return holdsTheSame(j) && reachBehindMm(j, side) < sacReachMm(base) &&
               node(side).volumeMl < mostSacMl(node(base));
    }

    void makeTubes() {
        const std::size_t count = graph_.nodes.size();
        std::vector<std::map<int, int>> sure(count);  // neighbour, junction
        for (std::size_t j = 0; j < graph_.junctions.size(); ++j) {
            if (!isSure(int(j))) continue;
            const ChainJunction& door = graph_.junctions[j];
            sure[std::size_t(door.a)][door.b] = int(j), sure[std::size_t(door.b)][door.a] = int(j);
        }
        // Side sacs do not part a tube.
        std::vector<bool> sac(count, false);
        for (std::size_t n = 0; n < count; ++n) {
            if (sure[n].size() != 1) continue;
            const auto [base, door] = *sure[n].begin();
            if (sure[std::size_t(base)].size() < 3 || !isSac(door, base)) continue;
            sac[n] = true;
            sure[std::size_t(base)].erase(int(n));
            sure[n].clear();
        }
        tubeOf_.assign(count, -1);
        for (std::size_t n = 0; n < count; ++n) {
            if (tubeOf_[n] >= 0) continue;
            Tube tube{{int(n)}, {}};
            tubeOf_[n] = int(tubes_.size());
            if (sure[n].size() <= 2 && !sac[n]) {
                lengthen(tube, sure, true);
                lengthen(tube, sure, false);
            }
            tubes_.push_back(std::move(tube));
        }
    }

    /// Adds, at its end or at its beginning, what a new tube goes on to without a branch.
    void lengthen(Tube& tube, const std::vector<std::map<int, int>>& sure, bool atEnd) {
        const auto goesOn = [&](const std::pair<const int, int>& door) {
            const std::size_t other = std::size_t(door.first);
            return tubeOf_[other] < 0 && sure[other].size() <= 2;
        };
        for (;;) {
            const auto& doors = sure[std::size_t(atEnd ? tube.nodes.back() : tube.nodes.front())];
            const auto found = std::find_if(doors.begin(), doors.end(), goesOn);
            if (found == doors.end()) return;
            const auto& [next, link] = *found;
            tubeOf_[std::size_t(next)] = int(tubes_.size());
            tube.nodes.insert(atEnd ? tube.nodes.end() : tube.nodes.begin(), next);
            tube.links.insert(atEnd ? tube.links.end() : tube.links.begin(), link);
        }
    }

    std::vector<int> nodesTowards(int tube, int exit) const {
        std::vector<int> nodes = tubes_[std::size_t(tube)].nodes;
        if (exit == 0) std::reverse(nodes.begin(), nodes.end());
        return nodes;
    }

    /// Calibre changes along the colon, but not at once.
    double calibreStep(int a, int b) const {
        const double change = std::log(node(b).radiusMm / node(a).radiusMm) / 0.5;
        return 0.5 * std::min(9.0, change * change);
    }

    /// What it costs that the colon has nothing of the parts between two others.
    static double skipCost(int from, int part) {
        constexpr std::array<double, colonParts> cost{1.0, 3.0, 3.0, 1.0, 3.0, 1.0, 3.0, 1.0};
        double sum = 0.0;
        for (int skipped = from + 1; skipped < part; ++skipped)
            sum += cost[std::size_t(skipped)];
        return sum;
    }
    static PartScores unreached() {
        PartScores scores;
        scores.fill(notReached);
        return scores;
    }
    /// Scores by the part of a node after one with these: parts follow each other, some are short.
    PartScores onwards(const PartScores& before, int next) const {
        constexpr int mostSkipped = 3;
        PartScores after = unreached();
        for (int from = 0; from < colonParts; ++from) {
            if (before[std::size_t(from)] <= notReached) continue;
            for (int part = from; part < std::min(colonParts, from + 2 + mostSkipped); ++part) {
                const double score =
                    before[std::size_t(from)] - skipCost(from, part) + nodeScore(node(next), part);
                after[std::size_t(part)] = std::max(after[std::size_t(part)], score);
            }
        }
        return after;
    }
    /// Through a tube from the node that has these scores.
    PartScores through(PartScores scores, const std::vector<int>& nodes) const {
        for (std::size_t n = 1; n < nodes.size(); ++n) {
            scores = onwards(scores, nodes[n]);
            const double step = calibreStep(nodes[n - 1], nodes[n]);
            for (double& score : scores)
                score -= step;
        }
        return scores;
    }

    void start(int tube, int exit) {
        const std::vector<int> nodes = nodesTowards(tube, exit);
        if (node(nodes.front()).rectumLogOdds < -14.0 && node(nodes.front()).given <= 0.0) return;
        if (nodes.size() == 1 && exit == 1) return;
        PartScores scores = unreached();
        for (int part = 0; part < 3; ++part)
            scores[std::size_t(part)] = nodeScore(node(nodes.front()), part) - skipCost(-1, part) +
                                        node(nodes.front()).rectumLogOdds;
        scores = through(scores, nodes);
        Label label{tube, exit, 0, -1, -1, 0.0, 0.0, {}};
        for (const int n : nodes)
            label.visited.set(std::size_t(n));
        addEach(label, scores);
    }

    void addEach(Label label, const PartScores& scores) {
        for (int part = 0; part < colonParts; ++part) {
            if (scores[std::size_t(part)] <= notReached / 2) continue;
            label.part = part, label.score = scores[std::size_t(part)];
            add(label);
        }
    }

    void extend(int head, int j) {
        const Label from = labels_[std::size_t(head)];
        const int last = exitNode(from), first = otherEnd(j, last);
        if (from.visited.test(std::size_t(first))) return;
        const int tube = tubeOf_[std::size_t(first)];
        const Tube& entered = tubes_[std::size_t(tube)];
        // A tube is entered by an end and left by the other.
        if (first != entered.nodes.front() && first != entered.nodes.back()) return;
        const int exit = first == entered.nodes.front() ? 1 : 0;
        const std::vector<int> nodes = nodesTowards(tube, exit);
        double cost =
            costOpen(junction(j)) +
            calibreStep(last, first) * (junction(j).kind == JunctionKind::collapse ? 0.3 : 1.0);
        Label label{tube, exit, 0, head, j, 0.0, from.pending, from.visited};
        cost += contradictions(head, nodes, last);
        for (const int n : nodes)
            label.visited.set(std::size_t(n));
        label.pending += doorsPassed(from, label.visited) - doorsTaken(nodes, from);
        PartScores before = unreached();
        before[std::size_t(from.part)] = from.score - cost;
        addEach(label, through(onwards(before, first), nodes));
    }

    /// What closing the doors of the label's tube would cost that lead to what `visited` has not.
    double doorsPassed(const Label& label, const Visited& visited) const {
        double cost = 0.0;
        for (const int n : tubes_[std::size_t(label.tube)].nodes) {
            for (const int j : around_[std::size_t(n)]) {
                if (!visited.test(std::size_t(otherEnd(j, n)))) cost += passing(j, n);
            }
        }
        return cost;
    }
    /// … and what of that had been counted for doors into `nodes` already.
    double doorsTaken(const std::vector<int>& nodes, const Label& from) const {
        double cost = 0.0;
        for (const int n : nodes) {
            for (const int j : around_[std::size_t(n)]) {
                const int base = otherEnd(j, n);
                if (from.visited.test(std::size_t(base)) && tubeOf_[std::size_t(base)] != from.tube)
                    cost += passing(j, base);
            }
        }
        return cost;
    }
    double passing(int j, int base) const {
        const ChainJunction& door = junction(j);
        if (door.kind == JunctionKind::collapse || door.logOdds < 0.0 || isSac(j, base)) return 0.0;
        return closing_[std::size_t(j)];
    }

    /// From the end of a label's chain to each of its nodes, and that node's own length; −1 for
    /// others. Kept for the label that was last asked for, which is extended many times.
    const std::vector<double>& waysBack(int head) {
        if (head == waysBackOf_) return waysBack_;
        waysBackOf_ = head;
        waysBack_.assign(graph_.nodes.size(), -1.0);
        double way = 0.0;
        for (int at = head; at >= 0; at = labels_[std::size_t(at)].parent) {
            const std::vector<int> passed =
                nodesTowards(labels_[std::size_t(at)].tube, labels_[std::size_t(at)].exit);
            for (auto n = passed.rbegin(); n != passed.rend(); ++n)
                waysBack_[std::size_t(*n)] = way, way += node(*n).lengthMm;
        }
        return waysBack_;
    }

    /// What it costs that lumen seems to lead from new nodes to places of the chain far back.
    double contradictions(int head, const std::vector<int>& nodes, int before) {
        double cost = 0.0;
        const std::vector<double>& wayBack = waysBack(head);
        double ahead = 0.0;
        for (const int n : nodes) {
            for (const int j : around_[std::size_t(n)]) {
                const int other = otherEnd(j, n);
                const double back = wayBack[std::size_t(other)];
                if (back < 0.0 || junction(j).kind == JunctionKind::collapse) continue;
                if (n == nodes.front() && other == before) continue;
                if (ahead + back > 2.0 * (node(n).radiusMm + node(other).radiusMm))
                    cost += closing_[std::size_t(j)];
            }
            ahead += node(n).lengthMm;
        }
        return cost;
    }

    void add(const Label& label) {
        std::vector<int>& here = places_[{2 * label.tube + label.exit, label.part}];
        for (int& n : here) {
            if (labels_[std::size_t(n)].visited != label.visited) continue;
            if (labels_[std::size_t(n)].worth() >= label.worth()) return;
            dropped_[std::size_t(n)] = true;
            n = int(labels_.size());
            push(label);
            return;
        }
        if (here.size() < options_.labelsPerPlace) {
            here.push_back(int(labels_.size()));
        } else {
            const Label* const labels = labels_.data();
            const auto worst = std::min_element(here.begin(), here.end(), [&](int a, int b) {
                return labels[a].worth() < labels[b].worth();
            });
            if (labels_[std::size_t(*worst)].worth() >= label.worth()) return;
            dropped_[std::size_t(*worst)] = true;
            *worst = int(labels_.size());
        }
        push(label);
    }
    void push(const Label& label) {
        labels_.push_back(label);
        dropped_.push_back(false);
    }

    static double endCost(int part) { return skipCost(part, colonParts); }

    /// A colon is 1200 mm long or more, 1895 ± 263 mm in the mean (Khashab et al., Endoscopy 2009;
    /// 41: 674): what a chain costs that is shorter, else the one that explains nothing is the best
    /// where the true one has many collapses and contacts.
    double shortCost(const Visited& visited) const {
        constexpr double shortestMm = 1200.0, sdMm = 263.0;
        double lengthMm = 0.0;
        for (std::size_t n = 0; n < graph_.nodes.size(); ++n)
            lengthMm += visited.test(n) ? node(int(n)).lengthMm : 0.0;
        const double z = std::max(0.0, shortestMm - lengthMm) / sdMm;
        return 0.5 * z * z;
    }

    ColonChain chainOf(int label) const {
        ColonChain chain;
        chain.score = labels_[std::size_t(label)].score -
                      endCost(labels_[std::size_t(label)].part) -
                      shortCost(labels_[std::size_t(label)].visited);
        std::vector<int> steps;
        for (int at = label; at >= 0; at = labels_[std::size_t(at)].parent)
            steps.push_back(at);
        std::reverse(steps.begin(), steps.end());
        for (const int at : steps) {
            const Label& step = labels_[std::size_t(at)];
            if (step.junction >= 0) chain.junctions.push_back(step.junction);
            const std::vector<int> nodes = nodesTowards(step.tube, step.exit);
            chain.nodes.insert(chain.nodes.end(), nodes.begin(), nodes.end());
            std::vector<int> links = tubes_[std::size_t(step.tube)].links;
            if (step.exit == 0) std::reverse(links.begin(), links.end());
            chain.junctions.insert(chain.junctions.end(), links.begin(), links.end());
        }
        return chain;
    }

    /// The most likely part of each node of a chain (Viterbi).
    void nameParts(ColonChain& chain) const {
        const std::size_t count = chain.nodes.size();
        std::vector<PartScores> scores(count, unreached());
        for (int part = 0; part < 3; ++part)
            scores[0][std::size_t(part)] =
                nodeScore(node(chain.nodes[0]), part) - skipCost(-1, part);
        for (std::size_t n = 1; n < count; ++n)
            scores[n] = onwards(scores[n - 1], chain.nodes[n]);
        chain.states.assign(count, 0);
        double best = -1e300;
        for (int part = 0; part < colonParts; ++part) {
            if (scores[count - 1][std::size_t(part)] - endCost(part) > best)
                best = scores[count - 1][std::size_t(part)] - endCost(part),
                chain.states[count - 1] = part;
        }
        for (std::size_t n = count - 1; n > 0; --n) {
            best = -1e300;
            for (int part = 0; part <= chain.states[n]; ++part) {
                const double score =
                    scores[n - 1][std::size_t(part)] - skipCost(part, chain.states[n]);
                if (score > best) best = score, chain.states[n - 1] = part;
            }
        }
    }

    /// The rectum's end, and what stands between as a balloon's gas, beyond openings too narrow for
    /// one lumen elsewhere; no more than a sac's volume, and nothing that a door had been closed
    /// to.
    void takeRectalEnd(ColonChain& chain, Visited& seen) const {
        constexpr double leastOpenMm2 = 10.0;
        const ChainNode& first = node(chain.nodes.front());
        const double underItMm = std::max(first.centerMm.z - first.radiusMm, highestEndMm(first));
        const auto doors = [&](int from, const auto& visit) {
            for (const int j : around_[std::size_t(from)]) {
                if (junction(j).openMm2 >= leastOpenMm2 && holdsTheSame(j))
                    visit(otherEnd(j, from));
            }
        };
        const auto takeUnder = [&](int next) {
            if (seen.test(std::size_t(next)) || node(next).given < 0.0 ||
                !isRectalEnd(node(next), first, underItMm))
                return false;
            seen.set(std::size_t(next));
            return true;
        };
        doors(chain.nodes.front(), [&](int next) {
            const Visited before = seen;
            if (!takeUnder(next)) return;
            std::vector<int> body{next};
            floodFill(body, doors, takeUnder);
            double volumeMl = 0.0;
            for (const int n : body)
                volumeMl += node(n).volumeMl;
            if (volumeMl > mostSacMl(first) ||
                std::ranges::none_of(body, [&](int n) { return isBelowRectum(node(n), first); })) {
                seen = before;
                return;
            }
            if (body.size() > 1) chain.balloons.push_back(next);
            chain.rectalEnd.insert(chain.rectalEnd.end(), body.begin(), body.end());
        });
        chain.sacs.insert(chain.sacs.end(), chain.rectalEnd.begin(), chain.rectalEnd.end());
    }

    /// What hangs on the chain: sacs of it, or what has to be cut off.
    void finish(ColonChain& chain, const Visited& visited) const {
        Visited seen = visited;
        double arc = 0.0, total = 0.0;
        std::map<int, double> arcOf;
        for (const int n : chain.nodes)
            total += graph_.nodes[std::size_t(n)].lengthMm;
        for (const int n : chain.nodes)
            arcOf[n] = arc + 0.5 * graph_.nodes[std::size_t(n)].lengthMm,
            arc += graph_.nodes[std::size_t(n)].lengthMm;
        for (const int base : chain.nodes) {
            for (const int j : around_[std::size_t(base)]) {
                const int side = otherEnd(j, base);
                const ChainJunction& door = graph_.junctions[std::size_t(j)];
                if (seen.test(std::size_t(side)) || door.kind == JunctionKind::collapse ||
                    door.logOdds < 0.0)
                    continue;
                // All that this door opens to, and what of it leads back to the chain.
                std::vector<int> body{side};
                seen.set(std::size_t(side));
                std::vector<int> doors{j};
                const auto openDoors = [&](int from, const auto& visit) {
                    for (const int k : around_[std::size_t(from)]) {
                        if (junction(k).kind != JunctionKind::collapse &&
                            junction(k).logOdds >= 0.0)
                            visit(otherEnd(k, from), k);
                    }
                };
                floodFill(body, openDoors, [&](int next, int k) {
                    if (visited.test(std::size_t(next))) {
                        if (k != j) doors.push_back(k);
                        return false;
                    }
                    if (seen.test(std::size_t(next))) return false;
                    seen.set(std::size_t(next));
                    return true;
                });
                double farthestMm = 0.0, volumeMl = 0.0;
                for (const int n : body) {
                    farthestMm = std::max(farthestMm, reachBehindMm(j, n));
                    volumeMl += node(n).volumeMl;
                }
                const bool named = std::any_of(body.begin(), body.end(),
                                               [&](int n) { return node(n).given > 0.0; });
                const bool sac = named || (holdsTheSame(j) && farthestMm < sacReachMm(base) &&
                                           volumeMl < mostSacMl(node(base)) &&
                                           opensToOnePlace(chain, doors, visited));
                if (sac) {
                    chain.sacs.insert(chain.sacs.end(), body.begin(), body.end());
                    continue;
                }
                // The ileum: one narrow door near the chain's end.
                const bool valve = doors.size() == 1 && total - arcOf[base] < 250.0 &&
                                   door.radiusMm < 8.0 && !valveUsed(chain);
                for (const int d : doors) {
                    chain.cuts.push_back(d);
                    chain.score -=
                        valve ? std::min(1.5, closing_[std::size_t(d)]) : closing_[std::size_t(d)];
                }
            }
        }
        takeRectalEnd(chain, seen);
    }
    /// Whether doors lead to one piece of the chain, or to neighbours with open lumen between them:
    /// else there is a way through what was left out.
    bool opensToOnePlace(const ColonChain& chain, const std::vector<int>& doors,
                         const Visited& visited) const {
        std::set<int> bases;
        for (const int d : doors) {
            const ChainJunction& door = graph_.junctions[std::size_t(d)];
            bases.insert(visited.test(std::size_t(door.a)) ? door.a : door.b);
        }
        for (std::size_t n = 0; n + 1 < chain.nodes.size(); ++n) {
            if (!bases.count(chain.nodes[n])) continue;
            // All bases from here on must follow at once.
            std::size_t found = 1;
            while (n + found < chain.nodes.size() && bases.count(chain.nodes[n + found]) &&
                   graph_.junctions[std::size_t(chain.junctions[n + found - 1])].kind ==
                       JunctionKind::openLumen)
                ++found;
            return found == bases.size();
        }
        return bases.size() == 1;
    }
    static bool valveUsed(const ColonChain& chain) { return !chain.cuts.empty(); }

    std::vector<ColonChain> best() {
        std::vector<std::pair<double, int>> order;
        for (std::size_t n = 0; n < labels_.size(); ++n) {
            if (!dropped_[n])
                order.emplace_back(
                    labels_[n].worth() - endCost(labels_[n].part) - shortCost(labels_[n].visited),
                    int(n));
        }
        std::sort(order.begin(), order.end(), std::greater<>());
        order.resize(std::min<std::size_t>(order.size(), 4000));
        std::vector<ColonChain> chains;
        for (const auto& [worth, label] : order) {
            chains.push_back(chainOf(label));
            finish(chains.back(), labels_[std::size_t(label)].visited);
        }
        std::stable_sort(
            chains.begin(), chains.end(),
            [](const ColonChain& a, const ColonChain& b) { return a.score > b.score; });
        std::vector<ColonChain> distinct;
        std::set<std::set<int>> seen;
        for (ColonChain& chain : chains) {
            std::set<int> all(chain.nodes.begin(), chain.nodes.end());
            all.insert(chain.sacs.begin(), chain.sacs.end());
            if (!seen.insert(all).second) continue;
            nameParts(chain);
            distinct.push_back(std::move(chain));
            if (distinct.size() >= options_.chains) break;
        }
        return distinct;
    }

    const ChainGraph& graph_;
    const ChainOptions& options_;
    std::vector<std::vector<int>> around_;  ///< junctions of each node
    std::vector<double> closing_;           ///< of each junction: what taking it for a wall costs
    std::vector<Tube> tubes_;
    std::vector<int> tubeOf_;
    std::vector<Label> labels_;
    std::vector<bool> dropped_;
    std::map<std::pair<int, int>, std::vector<int>> places_;
    int waysBackOf_ = -1;  // label
    std::vector<double> waysBack_;
};

}  // namespace

bool isBelowRectum(const ChainNode& node, const ChainNode& first) {
    return isRectalEnd(node, first, highestEndMm(first));
}

std::vector<ColonChain> findChains(const ChainGraph& graph, const ChainOptions& options) {
    if (graph.nodes.empty() || graph.nodes.size() > mostNodes) return {};
    return ChainSearch(graph, options).run();
}

}  // namespace haustra::segmentation
