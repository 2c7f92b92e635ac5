// Laws of the case store: what is published is what is read, keys tell everything apart, and
// damage is always seen.
#include "store/case_store.h"
#include "store/product_file.h"
#include "temporary_folder.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::store {
namespace {

namespace fs = std::filesystem;

class Store : public testing::Test {
protected:
    CaseStore store() { return CaseStore::open(folder_, true).value(); }
    Case writer(const std::string& name = "patient-1") { return store().createCase(name).value(); }

    const tests::TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path() / "store";
};

ProductKey keyOf(int n) {
    return makeKey("test", n, "", {});
}

std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void overwrite(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

Grid obliqueGrid(glm::ivec3 size) {
    Grid grid = axisAlignedGrid(size, {0.7, 0.8, 1.25}, {-120.5, 33.0, -900.125});
    const double c = std::cos(0.2), s = std::sin(0.2);
    const glm::dmat4 turn(c, s, 0, 0, -s, c, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    grid.patientFromVoxel = turn * grid.patientFromVoxel;
    return grid;
}

template <class T>
Volume<T> randomVolume(glm::ivec3 size, unsigned seed) {
    Volume<T> volume(obliqueGrid(size));
    std::mt19937 random(seed);
    for (T& voxel : volume.writable()) {
        if constexpr (std::is_same_v<T, TissueFractions>) {
            voxel.air = std::uint8_t(random() % 256);
            voxel.tagged = std::uint8_t(random() % (256 - voxel.air));
        } else {
            voxel = T(int(random() % 60000) - 30000);
        }
    }
    return volume;
}

template <class T>
bool sameBytes(const Volume<T>& a, const Volume<T>& b) {
    return a.grid().size == b.grid().size &&
           a.grid().patientFromVoxel == b.grid().patientFromVoxel &&
           std::memcmp(a.voxels().data(), b.voxels().data(), a.sizeBytes()) == 0;
}

Centerline someCenterline(int samples) {
    Centerline line;
    for (int n = 0; n < samples; ++n) {
        line.points.push_back(
            {{0.1 * n, std::sqrt(double(n)), -1e-3 * n}, n / 3.0, 0.5 * n, n % 7 == 3});
    }
    return line;
}

TriMesh randomMesh(int vertices, int triangles, unsigned seed) {
    TriMesh mesh;
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> place(-400.0, 400.0);
    for (int n = 0; n < vertices; ++n)
        mesh.vertices.push_back({place(random), place(random), place(random)});
    for (int n = 0; n < triangles; ++n) {
        const auto corner = [&] { return int(random() % unsigned(vertices)); };
        mesh.triangles.push_back({corner(), corner(), corner()});
    }
    return mesh;
}

template <class T>
class StoreRoundTrip : public Store {};
using VoxelTypes = testing::Types<std::int16_t, std::uint8_t, float, TissueFractions>;
TYPED_TEST_SUITE(StoreRoundTrip, VoxelTypes);

TYPED_TEST(StoreRoundTrip, AVolumeComesBackBitForBitWithItsGridAndAttributes) {
    Case writing = this->writer();
    for (const glm::ivec3 size :
         {glm::ivec3(1, 1, 1), glm::ivec3(13, 7, 5), glm::ivec3(160, 150, 101)}) {
        const auto volume = randomVolume<TypeParam>(size, unsigned(size.x));
        const Attributes attributes{{"position", "prone"}, {"note", "a \"quoted\" line\nand µ"}};
        ASSERT_TRUE(writing.publishVolume("thing", keyOf(size.x), volume, attributes));
        const Case reading = this->store().openCase("patient-1").value();
        const auto back = reading.readVolume<TypeParam>("thing");
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_TRUE(sameBytes(volume, *back));
        EXPECT_EQ(reading.attributes("thing").value(), attributes);
        EXPECT_TRUE(reading.has("thing", keyOf(size.x)));
        EXPECT_FALSE(reading.has("thing", keyOf(size.x + 1)));
        EXPECT_TRUE(reading.verify("thing"));
    }
}

TYPED_TEST(StoreRoundTrip, AVolumeHeldInABoxIsTheFileOfTheWholeOne) {
    Case writing = this->writer();
    const auto whole = randomVolume<TypeParam>({260, 150, 101}, 7);
    const VoxelBox box{{31, 0, 20}, {200, 140, 60}};
    // Beyond the box there is the volume itself; or nothing.
    for (const bool zeros : {false, true}) {
        BoxedVolume<TypeParam> boxed{whole.grid(), box, cropped(whole, box, 2), {}};
        if (!zeros) {
            boxed.beyond = [&](glm::ivec3 first, std::span<TypeParam> row) {
                std::copy_n(&whole.voxels()[whole.grid().index(first)], row.size(), row.begin());
            };
        }
        Volume<TypeParam> expected = whole.clone();
        if (zeros) {
            expected = Volume<TypeParam>(whole.grid(), TypeParam{});
            paste(boxed.part, box, expected, 2);
        }
        for (const int threads : {1, 3}) {
            ASSERT_TRUE(writing.publishVolume("thing", keyOf(threads), boxed, {}, {}, threads));
            const auto back = writing.readVolume<TypeParam>("thing");
            ASSERT_TRUE(back) << describe(back.error());
            EXPECT_TRUE(sameBytes(expected, *back));
            EXPECT_TRUE(writing.verify("thing"));
        }
        EXPECT_TRUE(sameBytes(expected, std::move(boxed).whole(2)));
    }
}

TEST_F(Store, ACenterlineComesBackBitForBit) {
    Case writing = writer();
    for (const int samples : {0, 1, 1700}) {
        const Centerline line = someCenterline(samples);
        ASSERT_TRUE(writing.publishCenterline("centerline", keyOf(samples), line));
        const auto back = writing.readCenterline();
        ASSERT_TRUE(back) << describe(back.error());
        ASSERT_EQ(back->points.size(), line.points.size());
        for (std::size_t n = 0; n < line.points.size(); ++n) {
            EXPECT_EQ(back->points[n].positionMm, line.points[n].positionMm);
            EXPECT_EQ(back->points[n].arcMm, line.points[n].arcMm);
            EXPECT_EQ(back->points[n].radiusMm, line.points[n].radiusMm);
            EXPECT_EQ(back->points[n].gap, line.points[n].gap);
        }
    }
}

TEST_F(Store, ATextComesBackBitForBit) {
    Case writing = writer();
    for (const std::string& text : {std::string(), std::string("{\"µ\": 1}\n"),
                                    std::string("a\0b", 3), std::string(100000, 'x')}) {
        ASSERT_TRUE(writing.publishText("quality", keyOf(int(text.size())), text));
        const auto back = writing.readText("quality");
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_EQ(*back, text);
        EXPECT_TRUE(writing.verify("quality"));
        EXPECT_FALSE(writing.readMesh("quality")) << "it is no mesh";
    }
}

// Whoever reads refuses them: the case would have lost what it had.
TEST_F(Store, WhatIsTooLargeToBeReadAgainIsNotWritten) {
    Case writing = writer();
    ASSERT_TRUE(writing.publishText("quality", keyOf(1), "sound"));
    const auto refused = writing.publishText("quality", keyOf(2), std::string((1 << 24) + 1, 'x'));
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, ErrorKind::unsupported);
    EXPECT_TRUE(writing.publishText("findings", keyOf(2), std::string(1 << 24, 'x')));
    EXPECT_TRUE(writing.readText("findings"));
    EXPECT_EQ(writing.readText("quality").value_or(""), "sound");
}

TEST_F(Store, AMeshComesBackBitForBit) {
    Case writing = writer();
    for (const glm::ivec2 size :
         {glm::ivec2(0, 0), glm::ivec2(3, 0), glm::ivec2(4, 4), glm::ivec2(30001, 60007)}) {
        const TriMesh mesh = randomMesh(size.x, size.y, 11);
        ASSERT_TRUE(writing.publishMesh("surface", keyOf(size.x), mesh, {{"genus", "0"}}));
        const Case reading = store().openCase("patient-1").value();
        const auto back = reading.readMesh();
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_EQ(back->vertices, mesh.vertices);
        EXPECT_EQ(back->triangles, mesh.triangles);
        EXPECT_EQ(reading.attributes("surface").value().at("genus"), "0");
        EXPECT_TRUE(reading.verify("surface"));
    }
    EXPECT_FALSE(writing.readVolume<float>("surface"));
    EXPECT_FALSE(writing.readCenterline("surface"));
}

// A file whose checksums are right can still be hostile: it is the content that counts.
TEST_F(Store, AMeshThatWouldBeReadOutsideItselfIsRefused) {
    Case writing = writer();
    const TriMesh sound = randomMesh(40, 70, 3);
    ASSERT_TRUE(writing.publishMesh("surface", keyOf(1), sound));
    const std::string name = writing.find("surface")->file;
    const auto readForged = [&](const TriMesh& mesh, glm::ivec3 size) {
        ProductHeader header{Content::mesh, {}, digestFromHex(keyOf(1).hex), {}, {}};
        header.grid.size = size;
        std::vector<std::byte> bytes(mesh.vertices.size() * 24 + mesh.triangles.size() * 12);
        std::memcpy(bytes.data(), mesh.vertices.data(), mesh.vertices.size() * 24);
        std::memcpy(bytes.data() + mesh.vertices.size() * 24, mesh.triangles.data(),
                    mesh.triangles.size() * 12);
        EXPECT_TRUE(writeProduct(writing.folder(), name, header, {bytes}));
        return writing.readMesh();
    };
    ASSERT_TRUE(readForged(sound, {40, 70, 1}));
    EXPECT_FALSE(readForged(sound, {41, 70, 1}));
    EXPECT_FALSE(readForged(sound, {40, 71, 1}));
    EXPECT_FALSE(readForged(sound, {40, 70, 2}));
    const TriMesh whole = readForged(sound, {38, 74, 1}).value_or(TriMesh{});  // as many bytes
    for (const glm::ivec3& t : whole.triangles)
        EXPECT_LT(std::max({t.x, t.y, t.z}), 38);
    EXPECT_FALSE(readForged(sound, {-1, 70, 1}));
    EXPECT_FALSE(readForged(sound, {1 << 30, 1 << 30, 1}));
    for (const int bad : {-1, 40, std::numeric_limits<int>::min(), 1 << 30}) {
        TriMesh forged = sound;
        forged.triangles[69][2] = bad;
        EXPECT_FALSE(readForged(forged, {40, 70, 1})) << bad;
    }
    for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
        TriMesh forged = sound;
        forged.vertices[39].y = bad;
        EXPECT_FALSE(readForged(forged, {40, 70, 1})) << bad;
    }
}

TEST_F(Store, ACutMeshIsRefused) {
    Case writing = writer();
    ASSERT_TRUE(writing.publishMesh("surface", keyOf(1), randomMesh(40, 70, 3)));
    const fs::path file = writing.folder() / writing.find("surface")->file;
    const std::string whole = content(file);
    for (std::size_t length = 0; length < whole.size(); length += 53) {
        overwrite(file, whole.substr(0, length));
        ASSERT_FALSE(writing.readMesh()) << length;
    }
}

TEST_F(Store, EqualInputsMakeEqualFiles) {
    std::string first;
    for (const char* name : {"a", "b"}) {
        Case writing = writer(name);
        const auto volume = randomVolume<float>({64, 64, 300}, 3);
        ASSERT_TRUE(writing.publishVolume("distance", keyOf(1), volume, {{"x", "1"}, {"y", "2"}}));
        const std::string bytes = content(writing.folder() / writing.find("distance")->file);
        if (first.empty()) first = bytes;
        EXPECT_EQ(first, bytes);
    }
}

TEST_F(Store, ReadingAsAnotherTypeIsRefused) {
    Case writing = writer();
    ASSERT_TRUE(writing.publishVolume("ct", keyOf(1), randomVolume<std::int16_t>({4, 4, 4}, 1)));
    EXPECT_FALSE(writing.readVolume<std::uint8_t>("ct"));
    EXPECT_FALSE(writing.readVolume<float>("ct"));
    EXPECT_FALSE(writing.readCenterline("ct"));
}

TEST(ProductKeys, AnyChangeOfAnyPartChangesTheKey) {
    const ProductKey a = keyOf(1), b = keyOf(2);
    const ProductKey base = makeKey("lumen", 3, "seeds=1", {a, b});
    EXPECT_EQ(base, makeKey("lumen", 3, "seeds=1", {a, b}));
    std::set<std::string> keys{base.hex};
    for (const ProductKey& other :
         {makeKey("lumeN", 3, "seeds=1", {a, b}), makeKey("lumen", 4, "seeds=1", {a, b}),
          makeKey("lumen", 3, "seeds=2", {a, b}), makeKey("lumen", 3, "seeds=1", {b, a}),
          makeKey("lumen", 3, "seeds=1", {a}), makeKey("lumen", 3, "seeds=1", {})}) {
        EXPECT_EQ(other.hex.size(), 64u);
        EXPECT_TRUE(keys.insert(other.hex).second);
    }
}

TEST(ProductKeys, PartsDoNotRunIntoEachOther) {
    EXPECT_NE(makeKey("ab", 1, "c", {}), makeKey("a", 1, "bc", {}));
    EXPECT_NE(makeKey("a", 1, "1b", {}), makeKey("a", 11, "b", {}));
    const ProductKey key = keyOf(1);
    EXPECT_NE(makeKey("a", 1, key.hex, {}), makeKey("a", 1, "", {key}));
}

TEST_F(Store, APublishedProductReplacesTheOldAndWhatCameFromIt) {
    Case writing = writer();
    const auto first = randomVolume<std::uint8_t>({40, 40, 40}, 1);
    const auto second = randomVolume<std::uint8_t>({40, 40, 40}, 2);
    ASSERT_TRUE(writing.publishVolume("lumen", keyOf(1), first));
    ASSERT_TRUE(writing.publishCenterline("centerline", keyOf(2), someCenterline(10)));
    const fs::path oldFile = writing.folder() / writing.find("lumen")->file;
    const auto mapped = writing.readVolume<std::uint8_t>("lumen");

    ASSERT_TRUE(writing.publishVolume("lumen", keyOf(3), second, {}, {"centerline"}));
    EXPECT_FALSE(fs::exists(oldFile));
    EXPECT_TRUE(sameBytes(*mapped, first));  // who has it mapped keeps it
    EXPECT_TRUE(sameBytes(*writing.readVolume<std::uint8_t>("lumen"), second));
    EXPECT_FALSE(writing.find("centerline"));
    std::size_t products = 0;
    for (const auto& file : fs::directory_iterator(writing.folder())) {
        products += file.path().extension() == ".hvol" || file.path().extension() == ".hline";
    }
    EXPECT_EQ(products, 1u);
}

// Cut at any length, or changed at any byte, a product is refused or told from what it was; it
// never crashes a reader and never passes for sound.
TEST_F(Store, EveryTruncationAndEveryFlippedBitIsSeen) {
    Case writing = writer();
    const auto volume = randomVolume<std::int16_t>({9, 8, 7}, 5);
    ASSERT_TRUE(writing.publishVolume("ct", keyOf(1), volume, {{"position", "supine"}}));
    const fs::path file = writing.folder() / writing.find("ct")->file;
    const std::string whole = content(file);
    ASSERT_EQ(whole.size(), 4096 + volume.sizeBytes());

    for (std::size_t length = 0; length < whole.size(); length += length < 300 ? 1 : 37) {
        overwrite(file, whole.substr(0, length));
        const auto read = writing.readVolume<std::int16_t>("ct");
        ASSERT_FALSE(read) << length;
        EXPECT_NE(describe(read.error()).find(file.filename().string()), std::string::npos);
    }
    overwrite(file, whole + "x");
    EXPECT_FALSE(writing.readVolume<std::int16_t>("ct"));

    std::mt19937 random(7);
    for (std::size_t at = 0; at < whole.size(); at += at < 300 ? 1 : 41) {
        // Between the attributes and the values lies padding, which means nothing.
        if (at >= 300 && at < 4096) at = 4096;
        std::string changed = whole;
        changed[at] = char(changed[at] ^ (1 << random() % 8));
        overwrite(file, changed);
        if (at < 240) {
            EXPECT_FALSE(writing.readVolume<std::int16_t>("ct")) << at;
        } else if (at >= 4096) {
            const auto verified = writing.verify("ct");
            ASSERT_FALSE(verified) << at;
            EXPECT_NE(verified.error().place.find(file.filename().string()), std::string::npos);
        }
    }
    overwrite(file, whole);
    EXPECT_TRUE(writing.verify("ct"));
}

TEST_F(Store, AFileOfAnotherProductUnderTheNameIsSeen) {
    Case writing = writer();
    ASSERT_TRUE(writing.publishVolume("a", keyOf(1), randomVolume<float>({3, 3, 3}, 1)));
    ASSERT_TRUE(writing.publishVolume("b", keyOf(2), randomVolume<float>({3, 3, 3}, 2)));
    overwrite(writing.folder() / writing.find("a")->file,
              content(writing.folder() / writing.find("b")->file));
    EXPECT_FALSE(writing.readVolume<float>("a"));
}

TEST_F(Store, AnIndexThatLeavesTheFolderIsRefused) {
    Case writing = writer();
    ASSERT_TRUE(writing.publishVolume("ct", keyOf(1), randomVolume<float>({3, 3, 3}, 1)));
    const std::string index = content(writing.folder() / "case.json");
    const std::string name = writing.find("ct")->file;
    for (const std::string& bad :
         {std::string("../x"), std::string("/etc/passwd"), std::string(".."), std::string()}) {
        std::string changed = index;
        changed.replace(changed.find(name), name.size(), bad);
        overwrite(writing.folder() / "case.json", changed);
        EXPECT_FALSE(writing.products()) << bad;
    }
    for (const char* bad :
         {"", "[]", "{}", "{\"format\":2,\"products\":{}}", "{\"format\":1,\"products\":{\"a\":3}}",
          "{\"format\":1,\"products\":{\"a\":{\"key\":\"00\",\"file\":\"a\"}}}"}) {
        overwrite(writing.folder() / "case.json", bad);
        EXPECT_FALSE(writing.products()) << bad;
    }
}

TEST_F(Store, OneWriterACase) {
    const CaseStore cases = store();
    auto first = cases.createCase("a");
    ASSERT_TRUE(first);
    const auto second = cases.createCase("a");
    ASSERT_FALSE(second);
    EXPECT_NE(second.error().message.find("being written"), std::string::npos);
    EXPECT_TRUE(cases.createCase("b"));
    ASSERT_TRUE(first->publishVolume("ct", keyOf(1), randomVolume<float>({2, 2, 2}, 1)));
    Case reader = cases.openCase("a").value();
    EXPECT_FALSE(reader.publishVolume("ct", keyOf(2), randomVolume<float>({2, 2, 2}, 1)));
    first = cases.openCase("a");  // lets go of the lock
    EXPECT_TRUE(cases.createCase("a"));
}

TEST_F(Store, TheNextWriterSweepsWhatAKilledOneLeft) {
    fs::path folder;
    {
        Case writing = writer();
        folder = writing.folder();
        ASSERT_TRUE(writing.publishVolume("ct", keyOf(1), randomVolume<float>({2, 2, 2}, 1)));
    }
    overwrite(folder / ".tmp-ct-0123456789abcdef.hvol-77", "half");
    overwrite(folder / "lumen-0123456789abcdef.hvol", "never named by the index");
    EXPECT_EQ(store().openCase("patient-1")->products()->size(), 1u);
    Case writing = writer();
    EXPECT_FALSE(fs::exists(folder / ".tmp-ct-0123456789abcdef.hvol-77"));
    EXPECT_FALSE(fs::exists(folder / "lumen-0123456789abcdef.hvol"));
    EXPECT_TRUE(writing.verify("ct"));
}

TEST_F(Store, CaseNamesCannotLeaveTheStore) {
    const CaseStore cases = store();
    const std::string tooLong(65, 'a');
    for (const std::string& bad :
         {std::string(), std::string(".."), std::string(".hidden"), std::string("a/b"),
          std::string("a b"), std::string("a\0b", 3), std::string("Mü"), tooLong}) {
        EXPECT_FALSE(cases.createCase(bad)) << bad;
        EXPECT_FALSE(cases.openCase(bad)) << bad;
    }
    EXPECT_TRUE(cases.createCase("A-1_b.2"));
    EXPECT_TRUE(cases.createCase(tooLong.substr(1)));
    EXPECT_TRUE(cases.cases()->empty());  // nothing published in them
}

TEST_F(Store, CasesAreListedSortedAndOnlyWithAnIndex) {
    const CaseStore cases = store();
    for (const char* name : {"b", "a", "c"}) {
        Case writing = cases.createCase(name).value();
        if (*name == 'c') continue;
        ASSERT_TRUE(writing.publishVolume("ct", keyOf(1), randomVolume<float>({2, 2, 2}, 1)));
    }
    EXPECT_EQ(cases.cases().value(), (std::vector<std::string>{"a", "b"}));
    EXPECT_EQ(cases.openCase("c").error().kind, ErrorKind::notFound);
    EXPECT_FALSE(CaseStore::open(folder_ / "none", false));
}

// ---- whose case it is

const ScanIdentity scanA{keyOf(100), "1.2.3", "1.2.3.4"}, scanB{keyOf(200), "1.2.9", ""};

TEST_F(Store, ACaseIsOfTheScanThatItWasBoundTo) {
    {
        Case bound = writer();
        EXPECT_EQ(bound.scan().value(), std::nullopt);
        ASSERT_TRUE(bound.bind(scanA));
        EXPECT_EQ(store().cases()->size(), 0u) << "a case of nothing is none";
        ASSERT_TRUE(bound.publishCenterline("centerline", keyOf(1), {}));
        ASSERT_TRUE(bound.publishCenterline("branches", keyOf(2), {}));
    }
    EXPECT_EQ(store().openCase("patient-1")->scan().value(), scanA);
    // Whoever writes on need not know of it.
    ASSERT_TRUE(writer().publishCenterline("branches", keyOf(3), {}));
    EXPECT_EQ(store().openCase("patient-1")->scan().value(), scanA);
    EXPECT_FALSE(store().openCase("patient-1")->bind(scanA)) << "open for reading only";
}

TEST_F(Store, AnotherScansFirstProductTakesThePlaceOfAll) {
    Case bound = writer();
    ASSERT_TRUE(bound.bind(scanA));
    ASSERT_TRUE(bound.publishCenterline("centerline", keyOf(1), {}));
    ASSERT_TRUE(bound.publishCenterline("branches", keyOf(2), {}));
    ASSERT_TRUE(bound.bind(scanB));
    EXPECT_EQ(bound.products()->size(), 2u);
    EXPECT_EQ(bound.scan().value(), scanA) << "until there is something of the other";
    ASSERT_TRUE(bound.publishCenterline("centerline", keyOf(3), {}));
    EXPECT_EQ(bound.products()->size(), 1u);
    EXPECT_EQ(bound.scan().value(), scanB);
    ASSERT_TRUE(bound.publishCenterline("branches", keyOf(4), {}));
    EXPECT_EQ(bound.products()->size(), 2u);
}

TEST_F(Store, AnUnboundCaseIsOfItsCtAndMayBeBoundUnderThatKey) {
    Case unbound = writer();
    ASSERT_TRUE(
        unbound.publishVolume("ct", keyOf(7), Volume<std::int16_t>(obliqueGrid({2, 2, 2}))));
    ASSERT_EQ(unbound.scan().value(), (ScanIdentity{keyOf(7), "", ""}));
    ASSERT_TRUE(unbound.bind({keyOf(7), "1.2.3", "1.2.3.4"}));
    EXPECT_EQ(unbound.scan().value(), (ScanIdentity{keyOf(7), "1.2.3", "1.2.3.4"}));
    EXPECT_TRUE(unbound.find("ct"));
}

TEST_F(Store, AnIndexThatNamesNoSoundScanIsDamaged) {
    ASSERT_TRUE(writer().publishCenterline("centerline", keyOf(1), {}));
    const fs::path index = store().openCase("patient-1")->folder() / "case.json";
    for (const char* scan : {"7", "{}", R"({"key":"abc","study_uid":"","series_uid":""})",
                             R"({"key":null,"study_uid":"","series_uid":""})"}) {
        overwrite(index, R"({"format":1,"products":{},"scan":)" + std::string(scan) + "}");
        EXPECT_FALSE(store().openCase("patient-1")->scan()) << scan;
    }
}

}  // namespace
}  // namespace haustra::store
