// haustra flatten as scripts meet it.
#include "end_to_end/run_program.h"
#include "flat_meshes.h"
#include "handle_meshes.h"
#include "mesh/mesh_file.h"

#include <algorithm>
#include <sstream>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace haustra {
namespace {

namespace fs = std::filesystem;
using Arguments = std::vector<std::string>;
using tests::lineCount;

tests::Outcome flatten(Arguments arguments) {
    arguments.insert(arguments.begin(), "flatten");
    return tests::runProgram("haustra", arguments);
}

TriMesh cylinder() {
    return tests::openTube([](double) { return 10.0; }, 50.0, 48, 39);
}

TEST(Flatten, WritesTheStripAndTellsAllFigures) {
    const tests::TemporaryFolder folder;
    const fs::path report = folder.path() / "report.json";
    ASSERT_TRUE(mesh::writeMesh(folder.path() / "tube.ply", cylinder()));
    for (const char* out : {"flat.obj", "flat.ply"}) {
        const auto outcome = flatten({folder.path() / "tube.ply", folder.path() / out, "--report",
                                      report, "--threads", "2"});
        ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
        for (const char* words :
             {"genus 0, 2 boundary loops, 3648 triangles\n", "modulus 0.796",
              "seam mismatch 0.0e+00", "angles off by ", "0 triangles flipped"}) {
            EXPECT_NE(outcome.out.find(words), std::string::npos) << words << outcome.out;
        }
        const auto cut = mesh::readMesh(folder.path() / out);
        ASSERT_TRUE(cut) << describe(cut.error());
        const auto told = nlohmann::json::parse(tests::fileContent(report));
        EXPECT_EQ(told["genus"], 0);
        EXPECT_EQ(told["boundary_loops"], 2);
        EXPECT_EQ(told["triangles"], 3648);
        EXPECT_EQ(told["flat_triangles"], cut->triangles.size());
        EXPECT_NEAR(told["modulus"].get<double>(), 0.7964, 1e-3);
        EXPECT_LT(told["certificate"].get<double>(), 1e-3);
        EXPECT_EQ(told["seam_mismatch"], 0.0);
        EXPECT_EQ(told["flips"], 0);
        for (const char* figure : {"mean", "p95", "p99_9", "max"}) {
            EXPECT_GE(told["angle_error_degrees"][figure].get<double>(), 0.0);
            EXPECT_GE(told["dilatation"][figure].get<double>(), 1.0);
        }
        for (const char* figure : {"angle_floor_degrees", "log_area_deviation", "area_range"})
            EXPECT_TRUE(told[figure].is_number()) << figure;
    }
    std::istringstream obj(tests::fileContent(folder.path() / "flat.obj"));
    std::size_t places = 0;
    for (std::string line; std::getline(obj, line);) {
        double x = 0.0, y = 0.0;
        if (std::sscanf(line.c_str(), "vt %lf %lf", &x, &y) != 2) continue;
        ++places;
        EXPECT_TRUE(x >= 0.0 && x <= 1.0 && y >= 0.0 && y <= 0.798) << line;
    }
    EXPECT_EQ(places, mesh::readMesh(folder.path() / "flat.obj")->vertices.size());
}

TEST(Flatten, TakesTheEndsOfAClosedSurfaceFromTheUser) {
    const tests::TemporaryFolder folder;
    const fs::path in = folder.path() / "capsule.stl", out = folder.path() / "flat.obj",
                   report = folder.path() / "report.json";
    ASSERT_TRUE(mesh::writeMesh(in, tests::capsule(10.0, 60.0, 40)));
    const auto own = flatten({in, out, "--report", report});
    ASSERT_EQ(own.exitCode, 0) << own.err;
    EXPECT_NE(own.out.find("ends opened: "), std::string::npos) << own.out;
    const double modulus = nlohmann::json::parse(tests::fileContent(report))["modulus"];
    // The first point is negative, as an option's name could be.
    const auto told =
        flatten({in, out, "--ends", "-10,0,30", "0,0,70", "--rim-mm", "8", "--report", report});
    ASSERT_EQ(told.exitCode, 0) << told.err;
    const auto figures = nlohmann::json::parse(tests::fileContent(report));
    EXPECT_NEAR(figures["rim_length_mm"][0].get<double>(), 8.0, 0.8);
    EXPECT_GT(figures["cap_area_mm2"][1].get<double>(), 3.0);
    EXPECT_LT(figures["modulus"].get<double>(), modulus);
}

TEST(Flatten, TakesSurfacesWithHandles) {
    const tests::TemporaryFolder folder;
    const fs::path in = folder.path() / "torus.off", out = folder.path() / "flat.obj",
                   report = folder.path() / "report.json";
    ASSERT_TRUE(mesh::writeMesh(in, tests::torusMesh(30.0, 10.0, 60, 30)));
    const auto outcome = flatten({in, out, "--report", report});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("genus 1, 0 boundary loops"), std::string::npos) << outcome.out;
    EXPECT_NEAR(nlohmann::json::parse(tests::fileContent(report))["tau"][1].get<double>(),
                std::sqrt(8.0), 0.05);
}

TEST(Flatten, TellsBothDistortionsWhereAreasAreWeighted) {
    const tests::TemporaryFolder folder;
    const fs::path in = folder.path() / "tube.ply", out = folder.path() / "flat.ply",
                   report = folder.path() / "report.json";
    ASSERT_TRUE(mesh::writeMesh(
        in,
        tests::openTube([](double z) { return 10.0 + 3.0 * std::sin(z * 0.3); }, 50.0, 48, 39)));
    const auto outcome = flatten({in, out, "--area-weight", "0.6", "--report", report});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("conformal: angles off by "), std::string::npos) << outcome.out;
    const auto figures = nlohmann::json::parse(tests::fileContent(report));
    EXPECT_EQ(figures["area_weight"], 0.6);
    EXPECT_LT(figures["log_area_deviation"].get<double>(),
              figures["conformal"]["log_area_deviation"].get<double>());
}

TEST(Flatten, FailuresAreOneLineThatNamesTheFileAndLeaveNothing) {
    const tests::TemporaryFolder folder;
    TriMesh disc = tests::capsule(10.0, 20.0, 24);
    disc.triangles.pop_back();
    ASSERT_TRUE(mesh::writeMesh(folder.path() / "disc.ply", disc));
    std::ofstream(folder.path() / "junk.ply") << "ply\nformat ascii 1.0\nelement vertex 9";
    for (const char* name : {"disc.ply", "junk.ply", "none.ply"}) {
        const auto outcome = flatten({folder.path() / name, folder.path() / "flat.obj"});
        EXPECT_EQ(outcome.exitCode, 1) << name;
        EXPECT_TRUE(outcome.out.empty()) << outcome.out;
        const std::size_t last = outcome.err.rfind("haustra: ");
        ASSERT_NE(last, std::string::npos) << outcome.err;
        EXPECT_EQ(lineCount(outcome.err.substr(last)), 1u) << outcome.err;
        EXPECT_NE(outcome.err.find(name, last), std::string::npos) << outcome.err;
        EXPECT_FALSE(fs::exists(folder.path() / "flat.obj"));
    }
}

TEST(Flatten, RefusesWrongUsage) {
    for (const Arguments& wrong :
         std::vector<Arguments>{{},
                                {"a.ply"},
                                {"a.ply", "b.off"},
                                {"a.txt", "b.obj"},
                                {"a.ply", "b.obj", "--ends", "1,2,3"},
                                {"a.ply", "b.obj", "--ends", "1,2,3", "x"},
                                {"a.ply", "b.obj", "--rim-mm", "0"},
                                {"a.ply", "b.obj", "--rim-mm", "nan"},
                                {"a.ply", "b.obj", "--area-weight", "2"}}) {
        const auto outcome = flatten(wrong);
        EXPECT_EQ(outcome.exitCode, 2) << outcome.err;
        EXPECT_EQ(lineCount(outcome.err), 1u) << outcome.err;
    }
    const tests::TemporaryFolder folder;
    ASSERT_TRUE(mesh::writeMesh(folder.path() / "tube.ply", cylinder()));
    EXPECT_EQ(flatten({folder.path() / "tube.ply", folder.path() / "tube.ply"}).exitCode, 2);
    for (const char* taken : {"tube.ply", "flat.obj"}) {
        EXPECT_EQ(flatten({folder.path() / "tube.ply", folder.path() / "flat.obj", "--report",
                           folder.path() / taken})
                      .exitCode,
                  2)
            << taken;
    }
    EXPECT_TRUE(mesh::readMesh(folder.path() / "tube.ply"));
}

TEST(Flatten, RefusesOptionsThatSayNothingAboutTheSurface) {
    const tests::TemporaryFolder folder;
    const fs::path out = folder.path() / "flat.obj";
    ASSERT_TRUE(mesh::writeMesh(folder.path() / "tube.ply", cylinder()));
    ASSERT_TRUE(mesh::writeMesh(folder.path() / "torus.ply", tests::torusMesh(30.0, 10.0, 24, 12)));
    const Arguments ends{"--ends", "0,0,1", "0,0,2"}, rim{"--rim-mm", "9"},
        weight{"--area-weight", "0.5"};
    const auto run = [&](const char* name, const Arguments& more) {
        Arguments arguments{folder.path() / name, out};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return flatten(arguments);
    };
    for (const auto& [name, more] : std::vector<std::pair<const char*, Arguments>>{
             {"tube.ply", ends}, {"tube.ply", rim}, {"torus.ply", ends}, {"torus.ply", weight}}) {
        const auto outcome = run(name, more);
        EXPECT_EQ(outcome.exitCode, 2) << name << outcome.err;
        EXPECT_EQ(lineCount(outcome.err), 1u) << outcome.err;
        EXPECT_NE(outcome.err.find(more.front() + ": is for "), std::string::npos) << outcome.err;
        EXPECT_FALSE(fs::exists(out));
    }
    EXPECT_EQ(run("tube.ply", {"--area-weight", "0"}).exitCode, 0);
}

TEST(Flatten, CountsOneThingAsOne) {
    const tests::TemporaryFolder folder;
    const fs::path in = folder.path() / "open.ply";
    TriMesh open = tests::torusMesh(30.0, 10.0, 24, 12);  // less a triangle
    open.triangles.pop_back();
    ASSERT_TRUE(mesh::writeMesh(in, open));
    const auto outcome = flatten({in, folder.path() / "flat.obj"});
    ASSERT_EQ(outcome.exitCode, 0) << outcome.err;
    EXPECT_NE(outcome.out.find("genus 1, 1 boundary loop, 575 triangles\n"), std::string::npos)
        << outcome.out;
}

}  // namespace
}  // namespace haustra
