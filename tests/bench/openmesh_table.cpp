// OpenMesh beside what this project keeps of its own: the readers of mesh files and the half-edges
// that solvers walk on. What METHODS §7.1 "Half-edges and mesh files" says of either is printed
// here. Arguments: readers FILE… | hostile | halfedges
#include "mesh/halfedge_mesh.h"
#include "mesh/mesh_file.h"
#include "process_cost.h"
#include "stopwatch.h"

#include <array>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <filesystem>
#include <fstream>
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
    OpenTriMesh open;
    open.reserve(mesh.vertices.size(), 3 * mesh.vertices.size(), mesh.triangles.size());
    for (const glm::dvec3& p : mesh.vertices)
        open.add_vertex({p.x, p.y, p.z});
    for (const glm::ivec3& t : mesh.triangles)
        open.add_face(OpenMesh::VertexHandle(t.x), OpenMesh::VertexHandle(t.y),
                      OpenMesh::VertexHandle(t.z));
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
    else
        return std::fprintf(stderr, "usage: openmesh_table readers FILE… | hostile | halfedges\n"),
               2;
}
