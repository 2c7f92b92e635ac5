#include "cad/lesion.h"

#include "cad/membrane.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>
#include <set>

namespace haustra::cad {
namespace {

// How far beyond the patch the base is anchored: there the wall is the wall again.
constexpr double anchorMm = 2.0;
// Where a body's foot is: it has this share of the body's height there. Tuned on eight training
// phantoms: least error of the diameter of sessile and flat polyps alike.
constexpr double footShare = 0.15;

double halfVoxelMm(const Grid& grid) {
    const glm::dvec3 spacing = grid.spacingMm();
    return 0.5 * std::min({spacing.x, spacing.y, spacing.z});
}

// The voxels that hold what is half a voxel beneath a patch: of a body that holds no voxel's
// centre. Features are measured in them, of the phantoms that the built-in model has learnt from
// too, so that a change here asks for another model.
std::vector<VoxelRun> voxelsBeneath(const WallEvidence& evidence, const Patch& patch,
                                    const Grid& grid) {
    const double depth = halfVoxelMm(grid);
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    std::set<std::size_t> voxels;
    for (const std::uint32_t v : patch.samples) {
        const glm::dvec3 p =
            evidence.samples.mesh.vertices[v] + depth * glm::dvec3(evidence.shapes[v].intoWall);
        const glm::ivec3 voxel(glm::floor(glm::dvec3(voxelFromPatient * glm::dvec4(p, 1.0)) + 0.5));
        if (grid.contains(voxel)) voxels.insert(grid.index(voxel));
    }
    return runsOf(voxels, grid);
}

// Whether a place lies in the box around some others.
bool isAmong(std::span<const glm::dvec3> others, glm::dvec3 place) {
    glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const glm::dvec3& each : others)
        low = glm::min(low, each), high = glm::max(high, each);
    return glm::all(glm::lessThanEqual(low, place)) && glm::all(glm::lessThanEqual(place, high));
}

// The mean of a patch's places, by area.
glm::dvec3 middleOf(const WallSamples& wall, std::span<const std::uint32_t> samples) {
    const glm::dvec3 origin = wall.mesh.vertices[samples.front()];
    glm::dvec3 sum(0.0);
    double area = 0.0;
    for (const std::uint32_t v : samples) {
        sum += double(wall.areaMm2[v]) * (wall.mesh.vertices[v] - origin);
        area += wall.areaMm2[v];
    }
    return area > 0.0 ? origin + sum / area : origin;
}

// A widened patch and the film across it: what the parts of a body are measured by. The patch's
// samples have the first numbers, then come the others up to `inside`, which the film spans, and
// then, once the body is closed, all others around them.
struct SpannedPatch {
    const WallSamples& wall;
    const Membrane& film;
    SampleNumbers& numbers;
    std::uint32_t inside;

    // Of a sample above the film, along the axis.
    double heightMm(std::uint32_t number, glm::dvec3 axis) const {
        return glm::dot(wall.mesh.vertices[numbers.sample(number)] - film.at(number), axis);
    }
};

// Triangles at the widened patch, each once, ascending.
std::vector<std::uint32_t> facesOf(const SpannedPatch& spanned) {
    std::vector<std::uint32_t> faces;
    for (std::uint32_t n = 0; n < spanned.inside; ++n) {
        // Each is told by the first of its corners that the film spans.
        const auto isToldBefore = [&](int corner) {
            const auto sample = std::uint32_t(corner);
            return spanned.numbers.has(sample) && spanned.numbers.number(sample) < n;
        };
        for (const std::uint32_t t : spanned.wall.trianglesAround(spanned.numbers.sample(n))) {
            const glm::ivec3 corners = spanned.wall.mesh.triangles[t];
            if (isToldBefore(corners.x) || isToldBefore(corners.y) || isToldBefore(corners.z))
                continue;
            faces.push_back(t);
        }
    }
    std::sort(faces.begin(), faces.end());
    return faces;
}

// The body between wall and film, closed, counter-clockwise seen from outside, and its volume,
// centre, base and axis; none where it has no base.
std::optional<TriMesh> closeBody(const SpannedPatch& spanned, Lesion& lesion) {
    const TriMesh& wall = spanned.wall.mesh;
    SampleNumbers& numbers = spanned.numbers;
    const std::vector<std::uint32_t> faces = facesOf(spanned);
    if (faces.empty()) return {};
    // Wall and base have the same triangles; where both have the same place they cancel. Samples
    // beyond the inside anchor the base and are one place of both.
    for (const std::uint32_t t : faces)
        for (int n = 0; n < 3; ++n)
            numbers.add(std::uint32_t(wall.triangles[t][n]));
    TriMesh body;
    body.vertices.reserve(numbers.count() + spanned.inside);
    for (std::uint32_t n = 0; n < numbers.count(); ++n)
        body.vertices.push_back(wall.vertices[numbers.sample(n)]);
    for (std::uint32_t n = 0; n < spanned.inside; ++n)
        body.vertices.push_back(spanned.film.at(n));
    glm::dvec3 normal(0.0), moment(0.0);
    const glm::dvec3 origin = wall.vertices[numbers.sample(0)];
    const auto add = [&](glm::ivec3 corners) {
        const glm::dvec3 a = body.vertices[std::size_t(corners.x)] - origin,
                         b = body.vertices[std::size_t(corners.y)] - origin,
                         c = body.vertices[std::size_t(corners.z)] - origin;
        const double volume = glm::dot(a, glm::cross(b, c)) / 6.0;
        lesion.volumeMm3 += volume;
        moment += volume * 0.25 * (a + b + c);
        body.triangles.push_back(corners);
    };
    for (const std::uint32_t t : faces) {
        const glm::ivec3 corners = wall.triangles[t];
        glm::ivec3 top, base;
        for (int n = 0; n < 3; ++n) {
            const std::uint32_t number = numbers.number(std::uint32_t(corners[n]));
            top[n] = int(number);
            base[n] = int(number < spanned.inside ? numbers.count() + number : number);
        }
        // The wall's outside is the tissue: seen from the lumen the patch turns the other way.
        add({top.x, top.z, top.y});
        add(base);
        const glm::dvec3 a = body.vertices[std::size_t(base.x)],
                         side = glm::cross(body.vertices[std::size_t(base.y)] - a,
                                           body.vertices[std::size_t(base.z)] - a);
        normal -= side;
        lesion.baseMm2 += 0.5 * glm::length(side);
    }
    const double length = glm::length(normal);
    if (!(length > 0.0)) return {};
    lesion.axis = normal / length;
    lesion.centerMm = origin + moment / lesion.volumeMm3;
    return body;
}

// The patch's area, and its top above the film.
void measureAbove(const SpannedPatch& spanned, std::span<const std::uint32_t> patch,
                  Lesion& lesion) {
    lesion.heightMm = -std::numeric_limits<double>::infinity();
    for (std::uint32_t n = 0; n < patch.size(); ++n) {
        lesion.areaMm2 += spanned.wall.areaMm2[patch[n]];
        const double height = spanned.heightMm(n, lesion.axis);
        if (height <= lesion.heightMm) continue;
        lesion.heightMm = height, lesion.topMm = spanned.wall.mesh.vertices[patch[n]];
    }
}

// A patch ends where the body's side turns from convex to concave; its foot is farther out.
std::vector<std::uint32_t> downToFoot(const SpannedPatch& spanned,
                                      std::span<const std::uint32_t> patch, const Lesion& lesion) {
    std::vector<std::uint32_t> samples(patch.begin(), patch.end());
    std::vector<std::uint8_t> taken(spanned.inside, 0);
    for (std::size_t head = 0; head < samples.size(); ++head) {
        for (const std::uint32_t next : spanned.wall.around(samples[head])) {
            const std::uint32_t number = spanned.numbers.number(next);
            if (number < patch.size() || number >= spanned.inside || taken[number]) continue;
            if (spanned.heightMm(number, lesion.axis) < footShare * lesion.heightMm) continue;
            taken[number] = 1;
            samples.push_back(next);
        }
    }
    return samples;
}

// The greatest extent square to diameter and axis.
double widthAcross(const WallSamples& wall, std::span<const std::uint32_t> patch,
                   const Lesion& lesion) {
    const glm::dvec3 along =
        wall.mesh.vertices[lesion.diameter.to] - wall.mesh.vertices[lesion.diameter.from];
    const glm::dvec3 across = glm::cross(along, lesion.axis);
    if (!(glm::length(across) > 1e-9)) return 0.0;
    const glm::dvec3 unit = glm::normalize(across);
    double least = std::numeric_limits<double>::infinity(), most = -least;
    for (const std::uint32_t v : patch) {
        const double at = glm::dot(unit, wall.mesh.vertices[v]);
        least = std::min(least, at), most = std::max(most, at);
    }
    return most - least;
}

}  // namespace

std::vector<VoxelRun> runsOf(const std::set<std::size_t>& voxels, const Grid& grid) {
    std::vector<VoxelRun> runs;
    for (const std::size_t index : voxels) {
        const glm::ivec3 voxel = grid.voxelAt(index);
        if (!runs.empty() && runs.back().first + glm::ivec3(runs.back().count, 0, 0) == voxel)
            ++runs.back().count;
        else
            runs.push_back({voxel, 1});
    }
    return runs;
}

bool standsOnStalk(const Lesion& lesion) {
    constexpr double neckShare = 0.7;
    const double base = std::sqrt(4.0 * lesion.baseMm2 / std::numbers::pi);
    return base < neckShare * std::sqrt(lesion.diameter.mm * lesion.widthMm);
}

std::vector<double> widen(const WallSamples& wall, std::span<const std::uint32_t> patch,
                          double byMm, SampleNumbers& numbers) {
    numbers.clear();
    std::vector<double> distances;
    for (const std::uint32_t v : patch) {
        numbers.add(v);
        distances.push_back(0.0);
    }
    const glm::dvec3* const places = wall.mesh.vertices.data();  // looked at too often to check
    // Steps are short beside the width, so a breadth-first order is near enough.
    for (std::uint32_t head = 0; head < numbers.count(); ++head) {
        const std::uint32_t v = numbers.sample(head);
        const double sofar = distances[head];
        for (const std::uint32_t next : wall.around(v)) {
            if (numbers.has(next)) continue;
            const double mm = sofar + glm::distance(places[v], places[next]);
            if (mm > byMm) continue;
            numbers.add(next);
            distances.push_back(mm);
        }
    }
    return distances;
}

std::vector<VoxelRun> voxelsWithin(const TriMesh& body, const Grid& grid) {
    // Where rows of voxels along i cross the body, in voxels.
    std::map<std::pair<int, int>, std::vector<double>> crossings;
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    std::vector<glm::dvec3> places;
    places.reserve(body.vertices.size());
    for (const glm::dvec3& p : body.vertices)
        places.push_back(glm::dvec3(voxelFromPatient * glm::dvec4(p, 1.0)));
    for (const glm::ivec3& t : body.triangles) {
        const glm::dvec3 a = places[std::size_t(t.x)], b = places[std::size_t(t.y)],
                         c = places[std::size_t(t.z)];
        const glm::dvec3 lo = glm::min(a, glm::min(b, c)), hi = glm::max(a, glm::max(b, c));
        const auto edge = [](glm::dvec3 p, glm::dvec3 q, double y, double z) {
            return (q.y - p.y) * (z - p.z) - (q.z - p.z) * (y - p.y);
        };
        // Rows pass a hair beside whole numbers, so that none meets an edge.
        constexpr double besideY = 1.7e-6, besideZ = 2.3e-6;
        for (int k = int(std::ceil(lo.z - besideZ)); k <= int(std::floor(hi.z)); ++k) {
            for (int j = int(std::ceil(lo.y - besideY)); j <= int(std::floor(hi.y)); ++j) {
                const double y = j + besideY, z = k + besideZ;
                const double ea = edge(b, c, y, z), eb = edge(c, a, y, z), ec = edge(a, b, y, z);
                if (!((ea > 0 && eb > 0 && ec > 0) || (ea < 0 && eb < 0 && ec < 0))) continue;
                crossings[{k, j}].push_back((ea * a.x + eb * b.x + ec * c.x) / (ea + eb + ec));
            }
        }
    }
    std::vector<VoxelRun> runs;
    for (auto& [row, at] : crossings) {
        const auto [k, j] = row;
        if (k < 0 || j < 0 || k >= grid.size.z || j >= grid.size.y) continue;
        std::sort(at.begin(), at.end());
        for (std::size_t n = 0; n + 1 < at.size(); n += 2) {
            const int first = std::max(0, int(std::ceil(at[n]))),
                      last = std::min(grid.size.x - 1, int(std::floor(at[n + 1])));
            if (first > last) continue;
            if (!runs.empty() && runs.back().first == glm::ivec3(first - runs.back().count, j, k))
                runs.back().count += last - first + 1;
            else
                runs.push_back({{first, j, k}, last - first + 1});
        }
    }
    return runs;
}

std::optional<Lesion> standUp(const WallEvidence& evidence, Patch patch, const Grid& grid,
                              SampleNumbers& numbers) {
    const WallSamples& wall = evidence.samples;
    widen(wall, patch.samples, anchorMm, numbers);
    const Membrane film(wall, numbers);
    const SpannedPatch spanned{wall, film, numbers, numbers.count()};
    Lesion lesion;
    const auto body = closeBody(spanned, lesion);
    if (!body) return {};
    if (!isAmong(body->vertices, lesion.centerMm)) lesion.centerMm = middleOf(wall, patch.samples);
    measureAbove(spanned, patch.samples, lesion);
    lesion.diameter = diameterOf(wall, patch.samples);
    lesion.widthMm = widthAcross(wall, patch.samples, lesion);
    if (!standsOnStalk(lesion)) {
        lesion.diameter = diameterOf(wall, downToFoot(spanned, patch.samples, lesion));
        lesion.widthMm = widthAcross(wall, patch.samples, lesion);
    }
    lesion.voxels = voxelsWithin(*body, grid);
    if (lesion.voxels.empty()) lesion.voxels = voxelsBeneath(evidence, patch, grid);
    lesion.patch = std::move(patch);
    return lesion;
}

std::set<std::size_t> voxelsBehind(const WallEvidence& evidence,
                                   std::span<const std::uint32_t> samples, const Grid& grid) {
    const double depth = halfVoxelMm(grid);
    const glm::dmat4 voxelFromPatient = grid.voxelFromPatient();
    std::set<std::size_t> voxels;
    for (const std::uint32_t v : samples) {
        const glm::dvec3 wall = evidence.samples.mesh.vertices[v],
                         intoWall(evidence.shapes[v].intoWall), beneath = wall + depth * intoWall;
        const glm::dvec3 at(voxelFromPatient * glm::dvec4(beneath, 1.0));
        const glm::ivec3 low(glm::floor(at));
        double greatest = 0.0;
        std::size_t most = 0;
        for (int corner = 0; corner < 8; ++corner) {
            const glm::ivec3 voxel = low + glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2);
            if (!grid.contains(voxel)) continue;
            const glm::dvec3 apart = 1.0 - glm::abs(at - glm::dvec3(voxel));
            const double share = apart.x * apart.y * apart.z;
            const glm::dvec3 center = grid.patientFromVoxelPoint(glm::dvec3(voxel));
            if (glm::dot(center - wall, intoWall) < 0.0 || share <= greatest) continue;
            greatest = share, most = grid.index(voxel);
        }
        if (greatest > 0.0) voxels.insert(most);
    }
    return voxels;
}

std::vector<VoxelRun> segmentationOf(const PreparedColon& colon, const WallEvidence& evidence,
                                     const Lesion& lesion) {
    const Grid& grid = colon.cleansed.grid();
    std::set<std::size_t> voxels = voxelsBehind(evidence, lesion.patch.samples, grid);
    for (const VoxelRun& run : lesion.voxels)
        for (int i = 0; i < run.count; ++i) {
            const glm::ivec3 voxel = run.first + glm::ivec3(i, 0, 0);
            if (colon.cleansed.at(voxel) >= colon.tissue.airBelowHu)
                voxels.insert(grid.index(voxel));
        }
    return runsOf(voxels, grid);
}

}  // namespace haustra::cad
