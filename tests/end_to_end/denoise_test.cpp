// haustra denoise as scripts meet it.
#include "end_to_end/run_program.h"
#include "handle_meshes.h"
#include "mesh/mesh_file.h"

#include <algorithm>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace haustra {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using tests::lineCount;

tests::Outcome denoise(Arguments arguments) {
    arguments.insert(arguments.begin(), "denoise");
    return tests::runProgram("haustra", arguments);
}

TriMesh twoHandles() {
    tests::HandledSphere sphere(50.0, 40);
    sphere.addTube(0, 8, 12, 12, 4, 2.0, true);
    sphere.addTube(3, 8, 12, 12, 4, 2.5, false);
    return sphere.mesh();
}

/// A single line that names the file.
void expectOneError(const tests::Outcome& outcome, const std::string& file) {
    EXPECT_EQ(outcome.exitCode, 1) << outcome.err;
    EXPECT_TRUE(outcome.out.empty()) << outcome.out;
    const std::size_t last = outcome.err.rfind("haustra: ");
    ASSERT_NE(last, std::string::npos) << outcome.err;
    EXPECT_EQ(lineCount(outcome.err.substr(last)), 1u) << outcome.err;
    EXPECT_NE(outcome.err.find(file, last), std::string::npos) << outcome.err;
}

TEST(Denoise, ReadsAndWritesEveryFormatAndTellsWhatItCut) {
    const tests::TemporaryFolder folder;
    const fs::path report = folder.path() / "report.json";
    for (const char* ending : {".ply", ".obj", ".off", ".STL"}) {
        const fs::path in = folder.path() / (std::string("in") + ending),
                       out = folder.path() / (std::string("out") + ending);
        ASSERT_TRUE(mesh::writeMesh(in, twoHandles()));
        const auto outcome = denoise({in, out, "--report", report, "--threads", "2"});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        EXPECT_EQ(lineCount(outcome.out), 3u) << outcome.out;
        EXPECT_NE(outcome.out.find("handle 1: loop 12.48 mm at "), std::string::npos)
            << outcome.out;
        EXPECT_NE(outcome.out.find("genus 2 before, 0 after; area changed by +"), std::string::npos)
            << outcome.out;
        const auto clean = mesh::readMesh(out);
        ASSERT_TRUE(clean) << describe(clean.error());
        const MeshTopology topology = meshTopology(*clean);
        EXPECT_EQ(topology.eulerCharacteristic, 2) << ending;
        EXPECT_TRUE(topology.closed()) << ending;

        const auto told = nlohmann::json::parse(tests::fileContent(report));
        EXPECT_EQ(told["genus_before"], 2);
        EXPECT_EQ(told["genus_after"], 0);
        ASSERT_EQ(told["handles"].size(), 2u);
        for (const auto& handle : told["handles"]) {
            EXPECT_EQ(handle["loop_mm"].size(), 16u);
            EXPECT_GT(handle["filled_area_mm2"].get<double>(), 20.0);
        }
        EXPECT_EQ(told["triangles_after"], clean->triangles.size());
        EXPECT_EQ(told["crossings"], 0);
        EXPECT_EQ(outcome.out.find("cross"), std::string::npos) << outcome.out;
    }
}

TEST(Denoise, MayReplaceItsInputAndThenHasNothingToDo) {
    const tests::TemporaryFolder folder;
    const fs::path file = folder.path() / "mesh.ply";
    ASSERT_TRUE(mesh::writeMesh(file, twoHandles()));
    ASSERT_EQ(denoise({file, file}).exitCode, 0);
    const std::string once = tests::fileContent(file);
    const auto again = denoise({file, file});
    EXPECT_EQ(again.exitCode, 0);
    EXPECT_EQ(again.out, "genus 0 before, 0 after; area changed by +0.00 mm²\n");
    EXPECT_EQ(tests::fileContent(file), once);
}

TEST(Denoise, TreatsEachPieceOfAMesh) {
    const tests::TemporaryFolder folder;
    const fs::path in = folder.path() / "in.off", out = folder.path() / "out.off";
    TriMesh mesh = tests::torusMesh(20.0, 5.0, 48, 24);
    const TriMesh other = twoHandles();
    const int first = int(mesh.vertices.size());
    for (const glm::dvec3& p : other.vertices)
        mesh.vertices.push_back(p + glm::dvec3(200.0, 0.0, 0.0));
    for (const glm::ivec3& t : other.triangles)
        mesh.triangles.push_back(t + first);
    ASSERT_TRUE(mesh::writeMesh(in, mesh));
    const auto outcome = denoise({in, out});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    const auto clean = mesh::readMesh(out);
    ASSERT_TRUE(clean);
    EXPECT_EQ(meshTopology(*clean).components, 2);
    EXPECT_EQ(meshTopology(*clean).genus(), 0);
}

TEST(Denoise, TellsWhereNoCutIsClean) {
    // A thread goes through the torus's hole, and a ring runs inside its tube.
    const tests::TemporaryFolder folder;
    const fs::path in = folder.path() / "in.off", out = folder.path() / "out.off",
                   report = folder.path() / "report.json";
    TriMesh mesh = tests::torusMesh(20.0, 14.0, 60, 44);
    const TriMesh ring = tests::torusMesh(20.0, 2.0, 60, 12);
    for (const bool isThread : {false, true}) {
        const int first = int(mesh.vertices.size());
        for (const glm::dvec3& p : ring.vertices)
            mesh.vertices.push_back(isThread ? glm::dvec3(p.x + 20.0, -p.z, p.y) : p);
        for (const glm::ivec3& t : ring.triangles)
            mesh.triangles.push_back(t + first);
    }
    ASSERT_TRUE(mesh::writeMesh(in, mesh));
    const auto outcome = denoise({in, out, "--report", report});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_EQ(lineCount(outcome.out), 4u) << outcome.out;
    const auto told = nlohmann::json::parse(tests::fileContent(report));
    EXPECT_GT(told["handles"][0]["crossings"], 0);
    long sum = 0;
    for (const auto& handle : told["handles"])
        sum += handle["crossings"].get<long>();
    EXPECT_EQ(told["crossings"], sum);
    const std::string first = outcome.out.substr(0, outcome.out.find('\n'));
    EXPECT_NE(first.find("pairs of triangles cross"), std::string::npos) << outcome.out;
    EXPECT_NE(
        outcome.out.find("mm²; in all " + std::to_string(sum) + " pairs of triangles cross\n"),
        std::string::npos)
        << outcome.out;
}

TEST(Denoise, RefusesWhatHasNoInsideAndLeavesNothing) {
    const tests::TemporaryFolder folder;
    const fs::path out = folder.path() / "out.ply";
    TriMesh open = twoHandles(), doubled = open;
    open.triangles.pop_back();
    doubled.triangles.push_back(doubled.triangles[0]);
    const fs::path openFile = folder.path() / "open.ply",
                   doubledFile = folder.path() / "doubled.ply";
    ASSERT_TRUE(mesh::writeMesh(openFile, open));
    ASSERT_TRUE(mesh::writeMesh(doubledFile, doubled));
    expectOneError(denoise({openFile, out}), openFile);
    expectOneError(denoise({doubledFile, out}), doubledFile);
    const auto missing = denoise({folder.path() / "missing.ply", out});
    expectOneError(missing, "missing.ply");
    EXPECT_NE(missing.err.find("there is no such file"), std::string::npos) << missing.err;
    expectOneError(denoise({openFile, folder.path() / "no" / "out.ply"}), "out.ply");
    EXPECT_FALSE(fs::exists(out));
    EXPECT_EQ(std::distance(fs::directory_iterator(folder.path()), {}), 2);
}

TEST(Denoise, ExplainsItselfAndRefusesWrongUsage) {
    const auto help = denoise({"--help"});
    EXPECT_EQ(help.exitCode, 0);
    for (const char* word :
         {"Usage: haustra denoise", "MESH", "OUT", "--report", "--threads", "STL, whose"})
        EXPECT_NE(help.out.find(word), std::string::npos) << help.out;
    for (const Arguments& wrong : std::vector<Arguments>{{},
                                                         {"a.ply"},
                                                         {"a.ply", "b.vtk"},
                                                         {"a.png", "b.ply"},
                                                         {"a.ply", "b.ply", "--threads", "x"}}) {
        const auto outcome = denoise(wrong);
        EXPECT_EQ(outcome.exitCode, 2) << outcome.err;
        EXPECT_EQ(lineCount(outcome.err), 1u) << outcome.err;
    }
}

}  // namespace
}  // namespace haustra
