// Laws of flat maps in the case store: what is published is what is read, and what would lead a
// reader astray is refused.
#include "store/case_store.h"
#include "store/product_file.h"
#include "temporary_folder.h"

#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::store {
namespace {

namespace fs = std::filesystem;

class FlatMapStore : public testing::Test {
protected:
    Case writer() { return CaseStore::open(folder_, true).value().createCase("patient").value(); }

    const tests::TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path() / "store";
};

ProductKey keyOf(int n) {
    return makeKey("test", n, "", {});
}

FlatMap randomMap(int vertices, int triangles, int cameras, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-400.0, 400.0), share(0.0, 1.0);
    FlatMap map;
    map.height = 12.75;
    for (int v = 0; v < vertices; ++v) {
        map.surface.vertices.push_back({place(random), place(random), place(random)});
        map.flat.push_back({share(random), map.height * share(random)});
        map.camera.push_back(int(random() % unsigned(cameras)));
    }
    map.flat[0] = {0.0, 0.0};
    map.flat[1] = {1.0, map.height};
    for (int t = 0; t < triangles; ++t) {
        const auto corner = [&] { return int(random() % unsigned(vertices)); };
        map.surface.triangles.push_back({corner(), corner(), corner()});
        map.sourceTriangle.push_back(int(random() % 1000u));
    }
    for (int c = 0; c < cameras; ++c)
        map.cameras.push_back({{place(random), place(random), place(random)}, 1.01 * c});
    return map;
}

// The values as product_file.h lays them out, written by the test itself.
std::vector<std::byte> layOut(const FlatMap& map) {
    std::string bytes;
    const auto add = [&](const auto& value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(map.height);
    for (const glm::dvec3& v : map.surface.vertices)
        add(v.x), add(v.y), add(v.z);
    for (const glm::dvec2& v : map.flat)
        add(v.x), add(v.y);
    for (const FlatCamera& c : map.cameras)
        add(c.positionMm.x), add(c.positionMm.y), add(c.positionMm.z), add(c.arcMm);
    for (const glm::ivec3& t : map.surface.triangles)
        add(t.x), add(t.y), add(t.z);
    for (const std::int32_t source : map.sourceTriangle)
        add(source);
    for (const std::int32_t camera : map.camera)
        add(camera);
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    return {first, first + bytes.size()};
}

TEST_F(FlatMapStore, AFlatMapComesBackBitForBit) {
    Case writing = writer();
    for (const glm::ivec3 size :
         {glm::ivec3(2, 1, 1), glm::ivec3(5, 4, 3), glm::ivec3(30001, 60007, 1700)}) {
        const FlatMap map = randomMap(size.x, size.y, size.z, 11);
        ASSERT_TRUE(writing.publishFlatMap("flatmap", keyOf(size.x), map, {{"modulus", "12.75"}}));
        const auto back = writing.readFlatMap();
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_EQ(layOut(*back), layOut(map));
        EXPECT_EQ(writing.attributes("flatmap").value().at("modulus"), "12.75");
        EXPECT_TRUE(writing.verify("flatmap"));
        EXPECT_EQ(writing.find("flatmap")->file.substr(0, 8), "flatmap-");
    }
    EXPECT_FALSE(writing.readMesh("flatmap"));
    EXPECT_FALSE(writing.readVolume<float>("flatmap"));
    EXPECT_FALSE(writing.readCenterline("flatmap"));
    ASSERT_TRUE(writing.publishMesh("surface", keyOf(1), {}));
    EXPECT_FALSE(writing.readFlatMap("surface"));
}

TEST_F(FlatMapStore, TheLayoutIsTheDocumentedOne) {
    Case writing = writer();
    const FlatMap map = randomMap(50, 70, 9, 3);
    ASSERT_TRUE(writing.publishFlatMap("flatmap", keyOf(1), map));
    const auto mapped = mapProduct(writing.folder() / writing.find("flatmap")->file);
    ASSERT_TRUE(mapped);
    const auto expected = layOut(map);
    ASSERT_EQ(mapped->values.size(), expected.size());
    EXPECT_EQ(std::memcmp(mapped->values.data(), expected.data(), expected.size()), 0);
    EXPECT_EQ(mapped->header.grid.size, glm::ivec3(50, 70, 9));
}

TEST_F(FlatMapStore, AReplacedFlatMapLeavesNoFile) {
    Case writing = writer();
    ASSERT_TRUE(writing.publishFlatMap("flatmap", keyOf(1), randomMap(50, 70, 9, 3)));
    const fs::path old = writing.folder() / writing.find("flatmap")->file;
    ASSERT_TRUE(writing.publishFlatMap("flatmap", keyOf(2), randomMap(50, 70, 9, 4)));
    EXPECT_FALSE(fs::exists(old));
    EXPECT_TRUE(fs::exists(writing.folder() / writing.find("flatmap")->file));
}

// A file whose checksums are right can still be hostile: neither reading nor publishing takes it.
TEST_F(FlatMapStore, AMapThatWouldBeReadOutsideItselfIsRefused) {
    const FlatMap sound = randomMap(40, 70, 9, 5);
    Case writing = writer();
    ASSERT_TRUE(writing.publishFlatMap("flatmap", keyOf(1), sound));
    const std::string name = writing.find("flatmap")->file;
    const auto readForged = [&](const FlatMap& map, glm::ivec3 size) {
        ProductHeader header{Content::flatMap, {}, digestFromHex(keyOf(1).hex), {}, {}};
        header.grid.size = size;
        EXPECT_TRUE(writeProduct(writing.folder(), name, header, {layOut(map)}));
        return writing.readFlatMap();
    };
    ASSERT_TRUE(readForged(sound, {40, 70, 9}));
    for (const glm::ivec3 size :
         {glm::ivec3(41, 70, 9), glm::ivec3(40, 71, 9), glm::ivec3(40, 70, 8),
          glm::ivec3(-1, 70, 9), glm::ivec3(40, 70, -1), glm::ivec3(1 << 30),
          glm::ivec3(0, 0, 0)}) {
        EXPECT_FALSE(readForged(sound, size)) << size.x << " " << size.y << " " << size.z;
    }
    const double nan = std::nan(""), infinite = std::numeric_limits<double>::infinity();
    const std::vector<std::function<void(FlatMap&)>> forgeries{
        [&](FlatMap& m) { m.height = nan; },
        [&](FlatMap& m) { m.height = 1.01 * maxFlatHeight; },
        [&](FlatMap& m) { m.surface.vertices[39].x = -1e160; },
        [&](FlatMap& m) { m.cameras[8].positionMm.y = 2e6; },
        [&](FlatMap& m) { m.height = infinite; },
        [&](FlatMap& m) { m.height = 0.0; },
        [&](FlatMap& m) { m.height = -12.75; },
        [&](FlatMap& m) { m.height = 12.0; },  // below a vertex
        [&](FlatMap& m) { m.surface.vertices[39].y = nan; },
        [&](FlatMap& m) { m.surface.vertices[0].x = infinite; },
        [&](FlatMap& m) { m.flat[39].x = -1e-300; },
        [&](FlatMap& m) { m.flat[39].x = std::nextafter(1.0, 2.0); },
        [&](FlatMap& m) { m.flat[39].y = nan; },
        [&](FlatMap& m) { m.surface.triangles[69].z = 40; },
        [&](FlatMap& m) { m.surface.triangles[0].x = -1; },
        [&](FlatMap& m) { m.surface.triangles[7].y = std::numeric_limits<int>::min(); },
        [&](FlatMap& m) { m.sourceTriangle[69] = -1; },
        [&](FlatMap& m) { m.camera[39] = 9; },
        [&](FlatMap& m) { m.camera[0] = -1; },
        [&](FlatMap& m) { m.cameras[8].positionMm.z = nan; },
        [&](FlatMap& m) { m.cameras[8].arcMm = infinite; },
        [&](FlatMap& m) { m.cameras[0].arcMm = -1.0; },
        [&](FlatMap& m) { std::swap(m.cameras[3].arcMm, m.cameras[4].arcMm); },
    };
    for (std::size_t n = 0; n < forgeries.size(); ++n) {
        FlatMap forged = sound;
        forgeries[n](forged);
        const auto read = readForged(forged, {40, 70, 9});
        ASSERT_FALSE(read) << n;
        EXPECT_NE(describe(read.error()).find("flatmap"), std::string::npos);
        EXPECT_FALSE(writing.publishFlatMap("other", keyOf(2), forged)) << n;
    }
    FlatMap uneven = sound;
    uneven.camera.pop_back();
    EXPECT_FALSE(writing.publishFlatMap("other", keyOf(2), uneven));
    EXPECT_FALSE(writing.find("other"));
}

TEST_F(FlatMapStore, ACutMapIsRefused) {
    Case writing = writer();
    ASSERT_TRUE(writing.publishFlatMap("flatmap", keyOf(1), randomMap(40, 70, 9, 3)));
    const fs::path file = writing.folder() / writing.find("flatmap")->file;
    std::ifstream in(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    for (std::size_t length = 0; length < whole.size(); length += 53) {
        std::ofstream(file, std::ios::binary).write(whole.data(), std::streamsize(length));
        ASSERT_FALSE(writing.readFlatMap()) << length;
    }
}

}  // namespace
}  // namespace haustra::store
