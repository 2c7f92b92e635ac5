#include "flatten/tube/unified_flattening.h"

#include "flatten/tube/strip_energy.h"
#include "flatten/tube/strip_newton.h"
#include "flatten/tube/tube_topology.h"
#include "mesh/halfedge_mesh.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace haustra::flatten {
namespace {

/// Without any weight on angles, area-preserving maps may shear without bound.
constexpr double leastAngleWeight = 0.01;
/// The area weight to begin with.
constexpr double gentleWeight = 0.1;

std::vector<glm::dvec2> moved(const std::vector<glm::dvec2>& flat,
                              const std::vector<glm::dvec2>& move, double share) {
    std::vector<glm::dvec2> to(flat.size());
    for (std::size_t v = 0; v < flat.size(); ++v)
        to[v] = flat[v] + share * move[v];
    return to;
}

/// Lowers the energy from `flat` on until a step promises less than `tolerance` of what is left.
/// Returns the steps made, at most `most`.
Result<int> descend(StripEnergy& energy, StripNewton& newton, double tolerance, int most,
                    std::vector<glm::dvec2>& flat, const std::function<void()>& stepped) {
    double value = energy.value(flat);
    for (int n = 0; n < most; ++n) {
        const auto step = TRY(newton.step(energy.derivatives(flat), energy.scaleCurvature()));
        // Half the slope is what a full step takes off a quadratic; rounding leaves 1e-12 or so.
        if (-0.5 * step.slope <= tolerance * value + 1e-12) return n;

        const double flip = energy.firstFlip(flat, step.move);
        double share = std::min(1.0, 0.9 * flip);
        double reached = value;
        std::vector<glm::dvec2> next;
        for (int halved = 0; halved < 30; ++halved, share *= 0.5) {
            next = moved(flat, step.move, share);
            reached = energy.value(next);
            if (reached <= value + 1e-4 * share * step.slope) break;
        }
        if (!(reached < value)) {
            energy.value(flat);
            return n;
        }
        // Newton's step only doubles what is far too small: it may go on while that pays.
        for (share *= 2.0; share < 0.9 * flip; share *= 2.0) {
            auto further = moved(flat, step.move, share);
            const double there = energy.value(further);
            if (!(there < reached)) break;
            reached = there;
            next = std::move(further);
        }
        value = energy.value(next);
        flat = std::move(next);
        stepped();
    }
    return most;
}

StripEnergy::Weights weightsOf(double areaWeight) {
    return {std::max(1.0 - areaWeight, leastAngleWeight), areaWeight};
}

}  // namespace

Result<PeriodicMap> unifiedFlattening(const TriMesh& tube, const PeriodicMap& conformal,
                                      const UnifiedOptions& options) {
    if (!(options.areaWeight >= 0.0 && options.areaWeight <= 1.0))
        return fail(ErrorKind::badInput, "the weight of areas must be from 0 to 1");
    if (conformal.flat.size() != tube.vertices.size() ||
        conformal.turns.size() != tube.triangles.size() || !(conformal.height > 0.0))
        return fail(ErrorKind::badInput, "the flat map is not one of this surface");
    std::vector<int> rims[2];
    {
        const auto halfedges = TRY(mesh::HalfedgeMesh::of(tube));
        auto topology = TRY(tubeTopology(halfedges, -1));
        const auto heightAt = [&](int v) { return conformal.flat[std::size_t(v)].y; };
        const bool upsideDown =
            heightAt(topology.rims[0].front()) > heightAt(topology.rims[1].front());
        rims[0] = std::move(topology.rims[upsideDown ? 1 : 0]);
        rims[1] = std::move(topology.rims[upsideDown ? 0 : 1]);
    }
    StripEnergy energy(tube, conformal, weightsOf(options.areaWeight), options.threads);
    std::vector<glm::dvec2> flat = conformal.flat;
    if (!std::isfinite(energy.value(flat)))
        return fail(ErrorKind::badInput, "the conformal map to start from has flipped triangles");
    if (options.areaWeight == 0.0) return conformal;

    StripNewton newton(tube, rims[0], rims[1], energy.stretch());
    // Blind pouches and folded places open more readily while angles weigh much.
    int steps = 0, shown = 0;
    const auto stepped = [&] {
        if (options.progress) options.progress(double(++shown) / options.maxIterations);
    };
    for (double weight = std::min(gentleWeight, options.areaWeight);;
         weight = std::min(3.0 * weight, options.areaWeight)) {
        const bool last = weight == options.areaWeight;
        energy.weigh(weightsOf(weight));
        const auto made = TRY(descend(energy, newton, last ? options.tolerance : 0.03,
                                      options.maxIterations - steps, flat, stepped));
        steps += made;
        if (last) break;
    }

    PeriodicMap map = conformal;
    map.flat = std::move(flat);
    map.height = map.flat[std::size_t(rims[1].front())].y;
    rotate(map, tube, 0.0);
    if (options.progress) options.progress(1.0);
    return map;
}

}  // namespace haustra::flatten
