// Flat maps as files: what is written is read back, by readers that know nothing of flat maps too.
#include "mesh/flat_map_file.h"

#include "mesh/mesh_file.h"
#include "temporary_folder.h"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>

#include <gtest/gtest.h>

namespace haustra::mesh {
namespace {

namespace fs = std::filesystem;

class FlatMapFile : public testing::Test {
protected:
    std::string content(const fs::path& file) const {
        std::ifstream in(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(in), {}};
    }

    const tests::TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

FlatMap twoTriangles() {
    FlatMap map;
    map.surface.vertices = {
        {0.1, -2.0, 1e-7}, {1.0 / 3.0, 5.0, -400.25}, {7.0, 8.0, 9.0}, {1e3, 0, 0}};
    map.surface.triangles = {{0, 1, 2}, {2, 1, 3}};
    map.flat = {{0.0, 0.0}, {1.0, 1.0 / 7.0}, {0.25, 12.75}, {0.5, 0.1}};
    map.camera = {0, 1, 1, 2};
    map.cameras = {{{1, 2, 3}, 0.0}, {{4, 5, 6}, 1.01}, {{7, 8, 9}, 2.02}};
    map.sourceTriangle = {17, 4};
    map.height = 12.75;
    return map;
}

TEST_F(FlatMapFile, BothFormatsAreReadBackAsTheCutSurface) {
    const FlatMap map = twoTriangles();
    FlatMap unseen = map;
    unseen.camera.clear();
    unseen.cameras.clear();
    for (const char* name : {"map.obj", "map.ply", "map.PLY"}) {
        for (const FlatMap& written : {map, unseen}) {
            ASSERT_TRUE(writeFlatMap(folder_ / name, written));
            const auto read = readMesh(folder_ / name);
            ASSERT_TRUE(read) << describe(read.error());
            EXPECT_EQ(read->vertices, map.surface.vertices);
            EXPECT_EQ(read->triangles, map.surface.triangles);
        }
    }
}

TEST_F(FlatMapFile, AnObjHasATexturePlaceForEachVertex) {
    const FlatMap map = twoTriangles();
    ASSERT_TRUE(writeFlatMap(folder_ / "map.obj", map));
    std::istringstream lines(content(folder_ / "map.obj"));
    std::vector<glm::dvec2> places;
    std::vector<std::string> faces;
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string keyword;
        words >> keyword;
        if (keyword == "vt") {
            glm::dvec2& at = places.emplace_back();
            words >> at.x >> at.y;
        }
        if (keyword == "f") faces.push_back(line);
    }
    EXPECT_EQ(places, map.flat);
    EXPECT_EQ(faces, (std::vector<std::string>{"f 1/1 2/2 3/3", "f 3/3 2/2 4/4"}));
}

TEST_F(FlatMapFile, APlyHasTheFlatPlacesCamerasAndSources) {
    const FlatMap map = twoTriangles();
    ASSERT_TRUE(writeFlatMap(folder_ / "map.ply", map));
    const std::string bytes = content(folder_ / "map.ply");
    const std::string end = "end_header\n";
    std::size_t at = bytes.find(end) + end.size();
    const auto take = [&](auto value) {
        EXPECT_LE(at + sizeof value, bytes.size());
        std::memcpy(&value, bytes.data() + at, sizeof value);
        at += sizeof value;
        return value;
    };
    for (std::size_t v = 0; v < 4; ++v) {
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_EQ(take(double()), map.surface.vertices[v][axis]);
        EXPECT_EQ(take(double()), map.flat[v].x);
        EXPECT_EQ(take(double()), map.flat[v].y);
        EXPECT_EQ(take(std::int32_t()), map.camera[v]);
        EXPECT_EQ(take(double()), map.cameras[std::size_t(map.camera[v])].arcMm);
    }
    for (std::size_t t = 0; t < 2; ++t) {
        EXPECT_EQ(take(std::uint8_t()), 3);
        for (int c = 0; c < 3; ++c)
            EXPECT_EQ(take(std::int32_t()), map.surface.triangles[t][c]);
        EXPECT_EQ(take(std::int32_t()), map.sourceTriangle[t]);
    }
    for (const FlatCamera& camera : map.cameras) {
        for (int axis = 0; axis < 3; ++axis)
            EXPECT_EQ(take(double()), camera.positionMm[axis]);
        EXPECT_EQ(take(double()), camera.arcMm);
    }
    EXPECT_EQ(at, bytes.size());
    const std::string header = bytes.substr(0, bytes.find(end));
    for (const char* line :
         {"element vertex 4\n", "property double s\nproperty double t\n", "property int camera\n",
          "property double arc_mm\n", "element face 2\n", "property int source_triangle\n",
          "element camera 3\n"}) {
        EXPECT_NE(header.find(line), std::string::npos) << line;
    }
}

TEST_F(FlatMapFile, WhatCannotBeWrittenIsNamedAndLeavesNothing) {
    for (const char* name : {"map.off", "map.stl", "map", "none/map.obj"}) {
        const auto written = writeFlatMap(folder_ / name, twoTriangles());
        ASSERT_FALSE(written) << name;
        EXPECT_NE(describe(written.error()).find(name), std::string::npos);
    }
    EXPECT_TRUE(fs::is_empty(folder_));
}

}  // namespace
}  // namespace haustra::mesh
