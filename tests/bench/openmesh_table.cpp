// OpenMesh beside what this project keeps of its own: the readers of mesh files, the half-edges
// that solvers walk on, and the arrays that cut handles open. What METHODS §7.1 "Half-edges and
// mesh files" says of them is printed here. Arguments: readers FILE… | hostile | halfedges | cuts
// FILE…
#include "handles/covering_space.h"
#include "handles/hole_fill.h"
#include "handles/loop_coarsening.h"
#include "handles/loop_cut.h"
#include "handles/loop_homology.h"
#include "handles/loop_search.h"
#include "mesh/halfedge_mesh.h"
#include "mesh/mesh_file.h"
#include "process_cost.h"
#include "stopwatch.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <numbers>
#include <random>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include <OpenMesh/Core/IO/importer/BaseImporter.hh>
#include <OpenMesh/Core/IO/reader/OBJReader.hh>
#include <OpenMesh/Core/IO/reader/OFFReader.hh>
#include <OpenMesh/Core/IO/reader/PLYReader.hh>
#include <OpenMesh/Core/IO/reader/STLReader.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>
#include <fcntl.h>
#include <sys/resource.h>
#include <sys/time.h>
#include <sys/wait.h>
#include <unistd.h>

namespace haustra {
namespace {

namespace fs = std::filesystem;

// ------------------------------------------------------------------------------- OpenMesh's
// readers

/// Takes vertices and faces as OpenMesh's readers give them, and builds no mesh of them.
class RawImporter : public OpenMesh::IO::BaseImporter {
public:
    std::vector<glm::dvec3> points;
    std::vector<int> corners;
    std::vector<std::size_t> firstCorner{0};

private:
    using Vertex = OpenMesh::VertexHandle;
    using Edge = OpenMesh::EdgeHandle;
    using Halfedge = OpenMesh::HalfedgeHandle;
    using Face = OpenMesh::FaceHandle;
    using Status = OpenMesh::Attributes::StatusInfo;

    Vertex add_vertex(const OpenMesh::Vec3f& p) override {
        points.emplace_back(p[0], p[1], p[2]);
        return Vertex(int(points.size()) - 1);
    }
    Vertex add_vertex(const OpenMesh::Vec3d& p) override {
        points.emplace_back(p[0], p[1], p[2]);
        return Vertex(int(points.size()) - 1);
    }
    Vertex add_vertex() override { return add_vertex(OpenMesh::Vec3d(0.0)); }
    void set_point(Vertex v, const OpenMesh::Vec3f& p) override {
        if (v.idx() >= 0 && std::size_t(v.idx()) < points.size())
            points[std::size_t(v.idx())] = {p[0], p[1], p[2]};
    }
    Face add_face(const VHandles& face) override {
        for (const Vertex v : face)
            corners.push_back(v.idx());
        firstCorner.push_back(corners.size());
        return Face(int(firstCorner.size()) - 2);
    }
    std::size_t n_vertices() const override { return points.size(); }
    std::size_t n_faces() const override { return firstCorner.size() - 1; }
    std::size_t n_edges() const override { return 0; }

    // What a file may say besides is not wanted.
    Halfedge add_edge(Vertex, Vertex) override { return Halfedge(); }
    Face add_face(Halfedge) override { return Face(); }
    void add_face_texcoords(Face, Vertex, const std::vector<OpenMesh::Vec2f>&) override {}
    void add_face_texcoords(Face, Vertex, const std::vector<OpenMesh::Vec3f>&) override {}
    void set_face_texindex(Face, int) override {}
    void set_halfedge(Vertex, Halfedge) override {}
    void set_normal(Vertex, const OpenMesh::Vec3f&) override {}
    void set_normal(Vertex, const OpenMesh::Vec3d&) override {}
    void set_normal(Face, const OpenMesh::Vec3f&) override {}
    void set_normal(Face, const OpenMesh::Vec3d&) override {}
    void set_color(Vertex, const OpenMesh::Vec3uc&) override {}
    void set_color(Vertex, const OpenMesh::Vec4uc&) override {}
    void set_color(Vertex, const OpenMesh::Vec3f&) override {}
    void set_color(Vertex, const OpenMesh::Vec4f&) override {}
    void set_color(Edge, const OpenMesh::Vec3uc&) override {}
    void set_color(Edge, const OpenMesh::Vec4uc&) override {}
    void set_color(Edge, const OpenMesh::Vec3f&) override {}
    void set_color(Edge, const OpenMesh::Vec4f&) override {}
    void set_color(Face, const OpenMesh::Vec3uc&) override {}
    void set_color(Face, const OpenMesh::Vec4uc&) override {}
    void set_color(Face, const OpenMesh::Vec3f&) override {}
    void set_color(Face, const OpenMesh::Vec4f&) override {}
    void set_texcoord(Vertex, const OpenMesh::Vec2f&) override {}
    void set_texcoord(Vertex, const OpenMesh::Vec3f&) override {}
    void set_texcoord(Halfedge, const OpenMesh::Vec2f&) override {}
    void set_texcoord(Halfedge, const OpenMesh::Vec3f&) override {}
    void set_status(Vertex, const Status&) override {}
    void set_status(Edge, const Status&) override {}
    void set_status(Halfedge, const Status&) override {}
    void set_status(Face, const Status&) override {}
    void set_next(Halfedge, Halfedge) override {}
    void set_face(Halfedge, Face) override {}
    void request_face_texcoords2D() override {}
    void add_texture_information(int, std::string) override {}
};

OpenMesh::IO::BaseReader& readerOf(const fs::path& file) {
    const std::string ending = file.extension().string();
    if (ending == ".ply") return OpenMesh::IO::PLYReader();
    if (ending == ".obj") return OpenMesh::IO::OBJReader();
    if (ending == ".off") return OpenMesh::IO::OFFReader();
    return OpenMesh::IO::STLReader();
}

/// A triangle mesh without a triangle where the reader refuses.
TriMesh readByOpenMesh(const fs::path& file) {
    RawImporter importer;
    OpenMesh::IO::Options options;
    if (!readerOf(file).read(file.string(), importer, options)) return {};
    TriMesh mesh{std::move(importer.points), {}};
    for (std::size_t f = 0; f + 1 < importer.firstCorner.size(); ++f) {
        const std::size_t first = importer.firstCorner[f];
        for (std::size_t c = first + 2; c < importer.firstCorner[f + 1]; ++c)
            mesh.triangles.push_back(
                {importer.corners[first], importer.corners[c - 1], importer.corners[c]});
    }
    return mesh;
}

TriMesh readByOurs(const fs::path& file) {
    auto mesh = mesh::readMesh(file);
    return mesh ? std::move(*mesh) : TriMesh{};
}

struct Reading {
    bench::Cost cost;
    std::size_t vertices = 0, triangles = 0;
};

/// Between the vertices that the two readers give; not a number where they give other triangles.
double largestDifferenceMm(const fs::path& file) {
    const TriMesh ours = readByOurs(file), theirs = readByOpenMesh(file);
    if (ours.vertices.size() != theirs.vertices.size() || ours.triangles != theirs.triangles)
        return std::nan("");
    double difference = 0.0;
    for (std::size_t v = 0; v < ours.vertices.size(); ++v)
        difference = std::max(difference, glm::distance(ours.vertices[v], theirs.vertices[v]));
    return difference;
}

void tellReaders(std::span<char*> files) {
    std::printf("%-28s %-9s %10s %10s %8s %8s %22s\n", "file", "reader", "vertices", "triangles",
                "cpu s", "MiB", "largest difference mm");
    for (const char* file : files) {
        const double differenceMm = largestDifferenceMm(file);
        for (const auto& [name, read] :
             {std::pair("OpenMesh", &readByOpenMesh), {"ours", &readByOurs}}) {
            const auto reading = bench::inFreshProcess<Reading>([&, read = read] {
                const bench::Stopwatch watch;
                const TriMesh mesh = read(file);
                return Reading{watch.read(), mesh.vertices.size(), mesh.triangles.size()};
            });
            std::printf("%-28s %-9s %10zu %10zu %8.2f %8.0f %22.3g\n",
                        fs::path(file).filename().c_str(), name, reading.vertices,
                        reading.triangles, reading.cost.cpuS(), reading.cost.peakMiB, differenceMm);
        }
    }
}

// ------------------------------------------------------------------------------------ hostile
// files

TriMesh torus(int around, int along) {
    TriMesh mesh;
    const double turn = 2.0 * std::numbers::pi;
    for (int i = 0; i < along; ++i) {
        for (int j = 0; j < around; ++j) {
            const double u = turn * i / along, v = turn * j / around;
            mesh.vertices.push_back({(30.0 + 10.0 * std::cos(v)) * std::cos(u) - 200.0 / 3.0,
                                     (30.0 + 10.0 * std::cos(v)) * std::sin(u),
                                     10.0 * std::sin(v) + 1e-7});
            const int a = i * around + j, b = i * around + (j + 1) % around;
            const int c = (i + 1) % along * around + j,
                      d = (i + 1) % along * around + (j + 1) % around;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({b, c, d});
        }
    }
    return mesh;
}

enum class Outcome { refused, whole, fewer, unsound, crashed, endless };
constexpr int outcomes = 6;

/// What a reader does with a file, in a process of its own that has 0.3 s of processor time, 1 GiB,
/// and writes no more than 1 MiB to stderr.
Outcome outcomeOf(TriMesh (*read)(const fs::path&), const fs::path& file, std::size_t triangles,
                  const fs::path& errors) {
    std::fflush(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        const rlimit memory{1ul << 30, 1ul << 30}, written{1ul << 20, 1ul << 20}, core{0, 0};
        setrlimit(RLIMIT_AS, &memory);
        setrlimit(RLIMIT_FSIZE, &written);
        std::signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_CORE, &core);
        const itimerval limit{{0, 0}, {0, 300000}};
        setitimer(ITIMER_PROF, &limit, nullptr);
        dup2(open(errors.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0600), 2);
        const TriMesh mesh = read(file);
        Outcome outcome = mesh.triangles.empty()               ? Outcome::refused
                          : mesh.triangles.size() >= triangles ? Outcome::whole
                                                               : Outcome::fewer;
        for (const glm::ivec3& t : mesh.triangles) {
            for (int c = 0; c < 3; ++c)
                if (t[c] < 0 || std::size_t(t[c]) >= mesh.vertices.size())
                    outcome = Outcome::unsound;
        }
        for (const glm::dvec3& v : mesh.vertices)
            if (!std::isfinite(v.x + v.y + v.z)) outcome = Outcome::unsound;
        _exit(int(outcome));
    }
    int status = 0;
    waitpid(child, &status, 0);
    if (WIFEXITED(status)) return Outcome(WEXITSTATUS(status));
    return WTERMSIG(status) == SIGPROF ? Outcome::endless : Outcome::crashed;
}

void tellHostile() {
    const fs::path folder =
        fs::temp_directory_path() / ("openmesh-table-" + std::to_string(getpid()));
    fs::create_directories(folder);
    std::printf("%-6s %-10s %-9s %6s %8s %6s %6s %8s %8s %8s %12s\n", "format", "files", "reader",
                "of", "refused", "whole", "fewer", "unsound", "crashed", "endless", "stderr bytes");
    const TriMesh mesh = torus(4, 5);
    for (const char* ending : {"ply", "obj", "off", "stl"}) {
        const fs::path good = folder / (std::string("good.") + ending);
        if (!mesh::writeMesh(good, mesh)) std::abort();
        std::stringstream stream;
        stream << std::ifstream(good, std::ios::binary).rdbuf();
        std::string whole = stream.str();
        // OpenMesh reads no comment before an OFF file's counts.
        if (const auto comment = whole.find("# LPS mm\n"); comment != whole.npos)
            whole.erase(comment, 9);
        std::vector<std::string> cut, changed;
        for (std::size_t size = 0; size < whole.size(); size += 7)
            cut.push_back(whole.substr(0, size));
        std::mt19937 random(7);
        for (int round = 0; round < 200; ++round) {
            changed.push_back(whole);
            for (int change = 0; change < 3; ++change)
                changed.back()[random() % whole.size()] = char(random());
        }
        for (const auto& [files, inputs] : {std::pair("cut short", &cut), {"changed", &changed}}) {
            for (const auto& [name, read] :
                 {std::pair("OpenMesh", &readByOpenMesh), {"ours", &readByOurs}}) {
                std::array<int, outcomes> count{};
                const fs::path errors = folder / "stderr",
                               file = folder / (std::string("bad.") + ending);
                fs::remove(errors);
                for (const std::string& bytes : *inputs) {
                    std::ofstream(file, std::ios::binary) << bytes;
                    ++count[std::size_t(outcomeOf(read, file, mesh.triangles.size(), errors))];
                }
                std::printf("%-6s %-10s %-9s %6zu %8d %6d %6d %8d %8d %8d %12ju\n", ending, files,
                            name, inputs->size(), count[0], count[1], count[2], count[3], count[4],
                            count[5], fs::exists(errors) ? fs::file_size(errors) : 0);
            }
        }
    }
    fs::remove_all(folder);
}

// ---------------------------------------------------------------------------------------
// half-edges

struct DoubleTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::None);
    HalfedgeAttributes(OpenMesh::Attributes::None);
    FaceAttributes(OpenMesh::Attributes::None);
    EdgeAttributes(OpenMesh::Attributes::None);
};
using OpenTriMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;

template <class Open>
Open openMeshOf(const TriMesh& mesh) {
    Open open;
    open.reserve(mesh.vertices.size(), 3 * mesh.vertices.size(), mesh.triangles.size());
    for (const glm::dvec3& p : mesh.vertices)
        open.add_vertex({p.x, p.y, p.z});
    for (const glm::ivec3& t : mesh.triangles)
        open.add_face(OpenMesh::VertexHandle(t.x), OpenMesh::VertexHandle(t.y),
                      OpenMesh::VertexHandle(t.z));
    return open;
}

struct Walk {
    bench::Cost build;
    double aroundMs = 0.0, sumMm = 0.0, grewMiB = 0.0;
};

/// Ten times the sum of all edges' lengths, by the half-edges that leave each vertex.
constexpr int rounds = 10;

Walk walkOurs(const TriMesh& mesh) {
    Walk walk;
    const bench::Stopwatch watch;
    const auto halves = mesh::HalfedgeMesh::ofClosed(mesh);
    walk.build = watch.read();
    const double before = bench::cpuMilliseconds();
    for (int round = 0; round < rounds; ++round) {
        for (int v = 0; v < halves->vertexCount(); ++v) {
            int h = halves->outgoing(v);
            do {
                walk.sumMm += glm::distance(mesh.vertices[std::size_t(v)],
                                            mesh.vertices[std::size_t(halves->target(h))]);
                h = halves->turnLeft(h);
            } while (h != halves->outgoing(v));
        }
    }
    walk.aroundMs = (bench::cpuMilliseconds() - before) / rounds;
    return walk;
}

Walk walkOpenMesh(const TriMesh& mesh) {
    Walk walk;
    const bench::Stopwatch watch;
    const auto open = openMeshOf<OpenTriMesh>(mesh);
    walk.build = watch.read();
    const double before = bench::cpuMilliseconds();
    for (int round = 0; round < rounds; ++round) {
        for (const auto v : open.vertices()) {
            for (auto w = open.cvv_iter(v); w.is_valid(); ++w)
                walk.sumMm += (open.point(v) - open.point(*w)).norm();
        }
    }
    walk.aroundMs = (bench::cpuMilliseconds() - before) / rounds;
    return walk;
}

void tellHalfedges() {
    const TriMesh mesh = torus(500, 1000);
    std::printf("%-9s %12s %12s %14s %14s\n", "mesh", "build s", "MiB more", "one-rings ms",
                "sum mm");
    for (const auto& [name, of] : {std::pair("OpenMesh", &walkOpenMesh), {"ours", &walkOurs}}) {
        const double baseMiB = bench::inFreshProcess<double>([] {
            const bench::Stopwatch watch;
            return watch.read().peakMiB;
        });
        const auto walk = bench::inFreshProcess<Walk>([&, of = of] { return of(mesh); });
        std::printf("%-9s %12.3f %12.0f %14.1f %14.3f\n", name, walk.build.cpuS(),
                    walk.build.peakMiB - baseMiB, walk.aroundMs, walk.sumMm);
    }
}

// -------------------------------------------------------------------------------------------
// cuts

struct DeletableTraits : OpenMesh::DefaultTraits {
    using Point = OpenMesh::Vec3d;
    using Normal = OpenMesh::Vec3d;
    VertexAttributes(OpenMesh::Attributes::Status);
    HalfedgeAttributes(OpenMesh::Attributes::Status);
    EdgeAttributes(OpenMesh::Attributes::Status);
    FaceAttributes(OpenMesh::Attributes::Status);
};
using DeletableMesh = OpenMesh::TriMesh_ArrayKernelT<DeletableTraits>;
using Point = OpenMesh::Vec3d;
using Vertex = OpenMesh::VertexHandle;
using Halfedge = OpenMesh::HalfedgeHandle;
using Face = OpenMesh::FaceHandle;

Point pointOf(const glm::dvec3& p) {
    return {p.x, p.y, p.z};
}

glm::dvec3 placeOf(const Point& p) {
    return {p[0], p[1], p[2]};
}

/// What handles::cutAlong does, in place: the faces on the loop's right are taken out and put in
/// again on vertices of their own, and both holes are spanned. How many faces OpenMesh did not
/// take: 0 where all is well.
int cutAlong(DeletableMesh& open, const mesh::HalfedgeMesh& halves, const mesh::Loop& loop) {
    const std::size_t n = loop.halfedges.size();
    constexpr double lipShare = 0.2;

    // The half-edges round each vertex of the loop on one of its sides, counter-clockwise.
    std::vector<Halfedge> along;
    for (const int h : loop.halfedges)
        along.push_back(open.find_halfedge(Vertex(halves.origin(h)), Vertex(halves.target(h))));
    const auto fan = [&](std::size_t i, bool left) {
        const Halfedge out = along[i], in = open.opposite_halfedge_handle(along[(i + n - 1) % n]);
        std::vector<Halfedge> halfedges;
        for (Halfedge h = left ? out : in; h != (left ? in : out);
             h = open.ccw_rotated_halfedge_handle(h))
            halfedges.push_back(h);
        return halfedges;
    };
    const auto drawBack = [&](bool left) {
        std::vector<Point> direction(n, Point(0.0)), moves(n);
        std::vector<double> reach(n);
        for (std::size_t i = 0; i < n; ++i) {
            const auto halfedges = fan(i, left);
            const Point here = open.point(open.from_vertex_handle(halfedges[0]));
            Point towards(0.0);
            double height = open.calc_edge_length(halfedges[0]);
            for (const Halfedge h : halfedges) {
                const Point b = open.point(open.to_vertex_handle(h)),
                            c = open.point(open.to_vertex_handle(open.next_halfedge_handle(h)));
                const Point normal = (b - here) % (c - here);
                const double opposite = (b - c).norm();
                towards += (0.5 * (b + c) - here).normalized() *
                           std::atan2(normal.norm(), (b - here) | (c - here));
                if (opposite > 0.0) height = std::min(height, normal.norm() / opposite);
            }
            if (towards.norm() > 0.0) direction[i] = towards.normalized();
            reach[i] = lipShare * height;
        }
        for (std::size_t i = 0; i < n; ++i)
            moves[i] =
                direction[i] * std::min({reach[(i + n - 1) % n], reach[i], reach[(i + 1) % n]});
        return moves;
    };
    const auto leftMoves = drawBack(true), rightMoves = drawBack(false);

    std::vector<glm::dvec3> polygon;
    std::vector<Vertex> leftRim, rightRim;
    for (std::size_t i = 0; i < n; ++i) {
        leftRim.push_back(open.from_vertex_handle(along[i]));
        polygon.push_back(placeOf(open.point(leftRim[i])));
    }
    // Faces on the right, with their corners on vertices of their own.
    std::map<Face, std::array<Vertex, 3>> rightFaces;
    for (std::size_t i = 0; i < n; ++i) {
        const auto halfedges = fan(i, false);
        rightRim.push_back(open.add_vertex(pointOf(polygon[i]) + rightMoves[i]));
        for (const Halfedge h : halfedges) {
            const Face face = open.face_handle(h);
            auto [held, isNew] = rightFaces.try_emplace(face);
            if (isNew) {
                const Halfedge first = open.halfedge_handle(face);
                held->second = {open.from_vertex_handle(first), open.to_vertex_handle(first),
                                open.to_vertex_handle(open.next_halfedge_handle(first))};
            }
            std::ranges::replace(held->second, leftRim[i], rightRim[i]);
        }
        open.set_point(leftRim[i], pointOf(polygon[i]) + leftMoves[i]);
    }
    int refused = 0;
    const auto add = [&](Vertex a, Vertex b, Vertex c) {
        refused += !open.add_face(a, b, c).is_valid();
    };
    for (const auto& [face, corners] : rightFaces)
        open.delete_face(face, false);
    for (const auto& [face, corners] : rightFaces)
        add(corners[0], corners[1], corners[2]);

    const handles::LoopDisc disc = handles::spanLoop(polygon);
    const auto addDisc = [&](const std::vector<Vertex>& rim, const std::vector<Point>& moves,
                             bool reversed) {
        std::vector<glm::dvec3> corners;
        for (const Point& move : moves)
            corners.push_back(placeOf(move));
        const auto inside = handles::extendInside(disc, corners);
        std::vector<Vertex> vertices = rim;
        for (std::size_t i = 0; i < inside.size(); ++i)
            vertices.push_back(open.add_vertex(pointOf(disc.interior[i] + inside[i])));
        for (glm::ivec3 t : disc.triangles) {
            if (reversed) std::swap(t.y, t.z);
            add(vertices[std::size_t(t.x)], vertices[std::size_t(t.y)], vertices[std::size_t(t.z)]);
        }
    };
    addDisc(leftRim, leftMoves, true);
    addDisc(rightRim, rightMoves, false);
    return refused;
}

/// Closes the gaps that deletions left in the arrays, and reads the mesh out.
TriMesh collected(DeletableMesh& open) {
    open.garbage_collection();
    TriMesh mesh;
    mesh.vertices.reserve(open.n_vertices());
    mesh.triangles.reserve(open.n_faces());
    for (const auto v : open.vertices())
        mesh.vertices.push_back(placeOf(open.point(v)));
    for (const auto face : open.faces()) {
        glm::ivec3 corners(0);
        int c = 0;
        for (const auto v : face.vertices())
            corners[c++] = v.idx();
        mesh.triangles.push_back(corners);
    }
    return mesh;
}

double millisecondsOf(const auto& work) {
    const double before = bench::cpuMilliseconds();
    work();
    return bench::cpuMilliseconds() - before;
}

/// The places of its corners, the least first.
using Placed = std::array<std::array<double, 3>, 3>;

Placed placed(glm::dvec3 a, glm::dvec3 b, glm::dvec3 c) {
    Placed corners{{{a.x, a.y, a.z}, {b.x, b.y, b.z}, {c.x, c.y, c.z}}};
    std::ranges::rotate(corners, std::ranges::min_element(corners));
    return corners;
}

std::vector<Placed> placedTriangles(const TriMesh& mesh) {
    std::vector<Placed> triangles;
    for (const glm::ivec3& t : mesh.triangles)
        triangles.push_back(placed(mesh.vertices[std::size_t(t.x)], mesh.vertices[std::size_t(t.y)],
                                   mesh.vertices[std::size_t(t.z)]));
    return triangles;
}

/// Of two lists of triangles, how many stand at the same place in both, and how far the corners of
/// the sorted lists are apart at most: not a number where they are not equally long.
std::pair<std::size_t, double> difference(std::vector<Placed> a, std::vector<Placed> b) {
    std::size_t same = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        same += a[i] == b[i];
    if (a.size() != b.size()) return {same, std::nan("")};
    std::ranges::sort(a);
    std::ranges::sort(b);
    double most = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t c = 0; c < 3; ++c)
            for (std::size_t k = 0; k < 3; ++k)
                most = std::max(most, std::abs(a[i][c][k] - b[i][c][k]));
    return {same, most};
}

/// The shortest loop round a handle; without half-edges on a sphere.
mesh::Loop handleLoop(const TriMesh& mesh, const mesh::HalfedgeMesh& halves) {
    const auto coarse = handles::coarsen(mesh, 3000);
    const auto coarseHalves = mesh::HalfedgeMesh::ofClosed(coarse.mesh);
    if (!coarseHalves) return {};
    std::vector<int> near;
    for (const mesh::Loop& loop :
         handles::coveringLoops(*coarseHalves, handles::homologyMarks(*coarseHalves), 1.5))
        near.push_back(
            coarse.fineVertex[std::size_t(coarseHalves->origin(loop.halfedges.front()))]);
    return handles::shortestLoop(halves, handles::homologyMarks(halves), near);
}

void tellLoopCut(const char* name, const TriMesh& mesh, const mesh::HalfedgeMesh& halves) {
    const mesh::Loop loop = handleLoop(mesh, halves);
    if (loop.halfedges.empty()) return;
    constexpr int times = 9;
    std::vector<double> ours, build, cut, collect;
    TriMesh open;
    int refused = 0;
    for (int i = 0; i < times; ++i) {
        ours.push_back(millisecondsOf([&] { handles::cutAlong(mesh, halves, loop); }));
        DeletableMesh deletable;
        build.push_back(millisecondsOf([&] { deletable = openMeshOf<DeletableMesh>(mesh); }));
        cut.push_back(millisecondsOf([&] { refused = cutAlong(deletable, halves, loop); }));
        collect.push_back(millisecondsOf([&] { open = collected(deletable); }));
    }
    const TriMesh array = handles::cutAlong(mesh, halves, loop).mesh;
    const auto [same, mostMm] = difference(placedTriangles(array), placedTriangles(open));
    std::printf(
        "%-28s loop of %zu edges, %zu triangles: arrays %.2f ms; OpenMesh build %.2f, cut "
        "%.2f, read out %.2f ms; %d faces refused, %zu of %zu at the same place in the "
        "list, sorted off by %.3g mm; characteristic %ld and %ld\n",
        name, loop.halfedges.size(), mesh.triangles.size(), bench::median(ours),
        bench::median(build), bench::median(cut), bench::median(collect), refused, same,
        array.triangles.size(), mostMm, meshTopology(array).eulerCharacteristic,
        meshTopology(open).eulerCharacteristic);
}

void tellCuts(std::span<char*> files) {
    const auto tell = [](const char* name, const TriMesh& mesh) {
        const auto halves = mesh::HalfedgeMesh::ofClosed(mesh);
        if (!halves) return void(std::printf("%-28s is not closed\n", name));
        tellLoopCut(name, mesh, *halves);
    };
    tell("torus", torus(500, 1000));
    for (const char* file : files)
        tell(fs::path(file).filename().c_str(), readByOurs(file));
}

}  // namespace
}  // namespace haustra

int main(int count, char** arguments) {
    const std::string task = count > 1 ? arguments[1] : "";
    if (task == "readers" && count > 2)
        haustra::tellReaders({arguments + 2, arguments + count});
    else if (task == "hostile")
        haustra::tellHostile();
    else if (task == "halfedges")
        haustra::tellHalfedges();
    else if (task == "cuts")
        haustra::tellCuts({arguments + 2, arguments + count});
    else
        return std::fprintf(stderr,
                            "usage: openmesh_table readers FILE… | hostile | halfedges | "
                            "cuts FILE…\n"),
               2;
}
