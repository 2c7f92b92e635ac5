// Mesh files: what is written reads back; what others write is read; what is broken is refused.
#include "mesh/mesh_file.h"

#include "data_folder.h"
#include "temporary_folder.h"

#include <cmath>
#include <cstring>
#include <fstream>
#include <random>

#include <gtest/gtest.h>

using haustra::ErrorKind;
using haustra::TriMesh;
using haustra::mesh::readMesh;
using haustra::mesh::writeMesh;

namespace {

class MeshFile : public testing::Test {
protected:
    std::filesystem::path write(const std::string& name, const std::string& bytes) const {
        std::ofstream(folder_ / name, std::ios::binary) << bytes;
        return folder_ / name;
    }

    static std::string bytesOf(const std::filesystem::path& file) {
        std::ifstream stream(file, std::ios::binary);
        return {std::istreambuf_iterator<char>(stream), {}};
    }

    const haustra::tests::TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path();
};

/// A torus whose coordinates use all digits of a double.
TriMesh torus(int around = 24, int along = 36) {
    TriMesh mesh;
    for (int i = 0; i < along; ++i) {
        for (int j = 0; j < around; ++j) {
            const double u = 2.0 * M_PI * i / along, v = 2.0 * M_PI * j / around;
            mesh.vertices.push_back({(30.0 + 10.0 * std::cos(v)) * std::cos(u) - 200.0 / 3.0,
                                     (30.0 + 10.0 * std::cos(v)) * std::sin(u),
                                     10.0 * std::sin(v) + 1e-7});
            const int a = i * around + j, b = i * around + (j + 1) % around;
            const int c = (i + 1) % along * around + j;
            const int d = (i + 1) % along * around + (j + 1) % around;
            mesh.triangles.push_back({a, c, b});
            mesh.triangles.push_back({b, c, d});
        }
    }
    return mesh;
}

double area(const TriMesh& mesh) {
    double sum = 0.0;
    for (const glm::ivec3& t : mesh.triangles) {
        const glm::dvec3 a = mesh.vertices[t[0]];
        sum += 0.5 * glm::length(glm::cross(mesh.vertices[t[1]] - a, mesh.vertices[t[2]] - a));
    }
    return sum;
}

const char* const textPly =
    "ply\nformat ascii 1.0\ncomment made by hand\nelement vertex 4\nproperty float x\n"
    "property float y\nproperty float z\nproperty uchar red\nelement face 2\n"
    "property list uchar int vertex_index\nend_header\n"
    "0 0 0 255\n1 0 0 255\n1 1 0 0\n0 1 0 7\n3 0 1 2\n3 0 2 3\n";

}  // namespace

TEST_F(MeshFile, ExactFormatsGiveBackTheSameMesh) {
    const TriMesh mesh = torus();
    for (const char* name : {"torus.ply", "torus.obj", "torus.off", "TORUS.PLY"}) {
        ASSERT_TRUE(writeMesh(folder_ / name, mesh)) << name;
        const auto read = readMesh(folder_ / name);
        ASSERT_TRUE(read) << describe(read.error());
        EXPECT_EQ(read->vertices, mesh.vertices) << name;
        EXPECT_EQ(read->triangles, mesh.triangles) << name;
    }
}

TEST_F(MeshFile, StlGivesBackTheSameSurfaceWeldedAndInFloat) {
    const TriMesh mesh = torus();
    ASSERT_TRUE(writeMesh(folder_ / "torus.stl", mesh));
    EXPECT_EQ(std::filesystem::file_size(folder_ / "torus.stl"), 84 + 50 * mesh.triangles.size());
    const auto read = readMesh(folder_ / "torus.stl");
    ASSERT_TRUE(read) << describe(read.error());
    ASSERT_EQ(read->vertices.size(), mesh.vertices.size());
    ASSERT_EQ(read->triangles.size(), mesh.triangles.size());
    EXPECT_TRUE(meshTopology(*read).closed());
    EXPECT_EQ(meshTopology(*read).genus(), 1);
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        for (int corner = 0; corner < 3; ++corner) {
            const glm::dvec3 written = mesh.vertices[mesh.triangles[t][corner]];
            const glm::dvec3 back = read->vertices[read->triangles[t][corner]];
            for (int axis = 0; axis < 3; ++axis)
                EXPECT_EQ(float(written[axis]), back[axis]);
        }
    }
}

TEST_F(MeshFile, WritingIsDeterministicReplacesAndLeavesNothingBeside) {
    const TriMesh mesh = torus();
    ASSERT_TRUE(writeMesh(folder_ / "a.ply", torus(5, 7)));
    ASSERT_TRUE(writeMesh(folder_ / "a.ply", mesh));
    ASSERT_TRUE(writeMesh(folder_ / "b.ply", mesh));
    EXPECT_EQ(bytesOf(folder_ / "a.ply"), bytesOf(folder_ / "b.ply"));
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder_)) {
        EXPECT_EQ(entry.path().extension(), ".ply");
        ++files;
    }
    EXPECT_EQ(files, 2);
}

TEST_F(MeshFile, ReadsTextPlyWithOtherProperties) {
    const auto mesh = readMesh(write("a.ply", textPly));
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->vertices.size(), 4u);
    EXPECT_EQ(mesh->triangles, (std::vector<glm::ivec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(MeshFile, ReadsPlyWhoseListsAreCountedByAnyInteger) {
    for (const char* type : {"char", "uchar", "short", "ushort", "int", "uint", "uint32"}) {
        std::string bytes = textPly;
        bytes.replace(bytes.find("uchar int"), 5, type);
        const auto mesh = readMesh(write("a.ply", bytes));
        ASSERT_TRUE(mesh) << type << ": " << describe(mesh.error());
        EXPECT_EQ(mesh->triangles, (std::vector<glm::ivec3>{{0, 1, 2}, {0, 2, 3}}));
    }
}

TEST_F(MeshFile, ReadsBigEndianPly) {
    std::string bytes =
        "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
        "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    const auto append = [&](auto value) {
        char raw[sizeof value];
        std::memcpy(raw, &value, sizeof value);
        bytes.append(std::reverse_iterator(raw + sizeof value), std::reverse_iterator(raw));
    };
    for (const float value : {0.f, 0.f, 0.f, 2.5f, 0.f, 0.f, 0.f, -3.25f, 1.f})
        append(value);
    bytes.push_back(3);
    for (const std::int32_t corner : {2, 0, 1})
        append(corner);
    const auto mesh = readMesh(write("a.ply", bytes));
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->vertices[2], glm::dvec3(0.0, -3.25, 1.0));
    EXPECT_EQ(mesh->triangles, (std::vector<glm::ivec3>{{2, 0, 1}}));
}

TEST_F(MeshFile, ReadsTheWaysObjNamesCorners) {
    const auto mesh =
        readMesh(write("a.obj",
                       "# hand\nmtllib x.mtl\nv 0 0 0\nv +1 0 0\r\nv 1 1 0\nv 0 1 0\n"
                       "vt 0 0\nvn 0 0 1\ng part\nf 1/1/1 2//1 3\nf -4 -2 -1 # end\n"));
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->triangles, (std::vector<glm::ivec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(MeshFile, ReadsOffWithCommentsAndColours) {
    const auto mesh = readMesh(write("a.off",
                                     "OFF # header\n# more\n4 2 0\n0 0 0\n1 0 0\n1 1 0 # corner\n"
                                     "0 1 0\n\n3 0 1 2 255 0 0\n3 0 2 3\n"));
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->triangles, (std::vector<glm::ivec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(MeshFile, ReadsTextStlOfTwoSolids) {
    const std::string facet =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 1 1 -0\nendloop\n"
        "endfacet\n";
    const std::string other =
        "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 1 0\nvertex 0 1e0 0\nendloop\n"
        "endfacet\n";
    const auto mesh = readMesh(write("a.stl", "solid the facet\n" + facet + "endsolid the facet\n" +
                                                  "solid\n" + other + "endsolid\n"));
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->vertices.size(), 4u);
    EXPECT_EQ(mesh->triangles, (std::vector<glm::ivec3>{{0, 1, 2}, {0, 2, 3}}));
}

TEST_F(MeshFile, TriangulatesPolygonsOfAnyShape) {
    // A star of ten corners, every second one deep inside: a fan from any corner would fold over.
    std::string obj;
    double expected = 0.0;
    for (int i = 0; i < 10; ++i) {
        const double radius = i % 2 ? 2.0 : 10.0, angle = M_PI * i / 5.0;
        obj += "v " + std::to_string(radius * std::cos(angle)) + " " +
               std::to_string(radius * std::sin(angle)) + " 4\n";
        expected += 0.5 * 2.0 * 10.0 * std::sin(M_PI / 5.0);
    }
    obj += "f 1 2 3 4 5 6 7 8 9 10\n";
    const auto mesh = readMesh(write("star.obj", obj));
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->triangles.size(), 8u);
    EXPECT_NEAR(area(*mesh), expected, 1e-4);
    EXPECT_EQ(haustra::meshTopology(*mesh).eulerCharacteristic, 1);
    EXPECT_EQ(haustra::meshTopology(*mesh).nonManifoldEdges, 0);
}

TEST_F(MeshFile, LeavesWhatIsNotManifoldAsItIs) {
    // Three triangles at one edge, and one twice.
    const auto mesh = readMesh(write("fin.off",
                                     "OFF\n5 4 0\n0 0 0\n0 0 1\n1 0 0\n0 1 0\n-1 0 0\n"
                                     "3 0 1 2\n3 0 1 3\n3 0 1 4\n3 0 1 4\n"));
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->triangles.size(), 4u);
    EXPECT_EQ(haustra::meshTopology(*mesh).nonManifoldEdges, 3);
}

TEST_F(MeshFile, RefusesWhatIsBrokenNamingTheFile) {
    const std::string plyStart = "ply\nformat binary_little_endian 1.0\n";
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    const std::pair<const char*, std::string> broken[] = {
        {"empty.ply", ""},
        {"empty.obj", ""},
        {"empty.off", ""},
        {"empty.stl", ""},
        {"noise.ply",
         "\x7f"
         "ELF nothing of the kind"},
        {"noise.off", "COFF\n1 1 0\n"},
        {"huge.ply", plyStart + "element vertex 999999999999\n" + xyz + "end_header\n1234"},
        {"billions.ply", plyStart + "element vertex 4000000000\n" + xyz +
                             "element face 4000000000\n"
                             "property list uchar int vertex_indices\nend_header\n1234"},
        {"billions.off", "OFF\n4000000000 4000000000 0\n0 0 0\n"},
        {"billions.stl", std::string(80, ' ') + std::string("\x00\x28\x6b\xee", 4)},
        {"huge.off", "OFF\n9999999999 9999999999 0\n0 0 0\n"},
        {"list.ply", plyStart + "element face 1\nproperty list uint int vertex_indices\n"
                                "end_header\n\xff\xff\xff\xff"},
        {"negative.off", "OFF\n-1 -1 0\n"},
        {"nothing.ply", plyStart + "element vertex 99999999999999\nend_header\n"},
        {"index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n"},
        {"index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 -9223372036854775808\n"},
        {"zero.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n"},
        {"word.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 three\n"},
        {"nan.obj", "v 0 0 0\nv nan 0 0\nv 0 1 0\nf 1 2 3\n"},
        {"infinite.off", "OFF\n3 1 0\n0 0 0\n1e999 0 0\n0 1 0\n3 0 1 2\n"},
        {"points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"},
        {"two.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 1\n"},
        {"noformat.ply", "ply\nelement vertex 1\nend_header\n"},
        {"quad.stl",
         "solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\n"
         "vertex 1 1 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid\n"},
        {"mesh.vtk", "anything"},
    };
    for (const auto& [name, bytes] : broken) {
        const auto mesh = readMesh(write(name, bytes));
        ASSERT_FALSE(mesh) << name;
        EXPECT_NE(describe(mesh.error()).find(name), std::string::npos) << describe(mesh.error());
    }
    EXPECT_EQ(readMesh(folder_ / "missing.ply").error().kind, ErrorKind::notFound);
    std::filesystem::create_directory(folder_ / "folder.ply");
    EXPECT_FALSE(readMesh(folder_ / "folder.ply"));
    EXPECT_FALSE(writeMesh(folder_ / "no such folder" / "a.ply", torus(5, 7)));
    EXPECT_FALSE(writeMesh(folder_ / "a.vtk", torus(5, 7)));
}

TEST_F(MeshFile, EveryTruncationIsRefusedOrSound) {
    const TriMesh mesh = torus(4, 5);
    for (const char* name : {"a.ply", "a.off", "a.obj", "a.stl"}) {
        ASSERT_TRUE(writeMesh(folder_ / name, mesh));
        const std::string whole = bytesOf(folder_ / name);
        const bool isText = std::strcmp(name, "a.obj") == 0 || std::strcmp(name, "a.off") == 0;
        for (std::size_t size = 0; size < whole.size(); ++size) {
            const auto read = readMesh(write(std::string("cut-") + name, whole.substr(0, size)));
            // A text cut inside its last line may still be a mesh; a binary one never is.
            if (!isText) {
                EXPECT_FALSE(read) << name << " at " << size;
            }
            if (read) {
                EXPECT_LE(read->triangles.size(), mesh.triangles.size());
            }
        }
    }
}

TEST_F(MeshFile, NoChangedByteCrashes) {
    std::mt19937 random(7);
    const TriMesh mesh = torus(4, 5);
    for (const char* name : {"a.ply", "a.off", "a.obj", "a.stl"}) {
        ASSERT_TRUE(writeMesh(folder_ / name, mesh));
        const std::string whole = bytesOf(folder_ / name);
        for (int round = 0; round < 500; ++round) {
            std::string bytes = whole;
            for (int change = 0; change < 3; ++change)
                bytes[random() % bytes.size()] = char(random());
            const auto read = readMesh(write(std::string("bad-") + name, bytes));
            if (!read) continue;
            for (const glm::ivec3& t : read->triangles) {
                for (int corner = 0; corner < 3; ++corner) {
                    ASSERT_GE(t[corner], 0);
                    ASSERT_LT(t[corner], int(read->vertices.size()));
                }
            }
        }
    }
}

TEST_F(MeshFile, ReadsARealColon) {
    HAUSTRA_REAL_DATA(file, "meshes/colon00090_genus1_100k.ply");
    const auto mesh = readMesh(file);
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(mesh->triangles.size(), 97154u);
    EXPECT_TRUE(meshTopology(*mesh).closed());
    EXPECT_EQ(meshTopology(*mesh).genus(), 1);
}

TEST_F(MeshFile, ReadsAnOpenTube) {
    HAUSTRA_REAL_DATA(file, "meshes/tube_open.stl");
    const auto mesh = readMesh(file);
    ASSERT_TRUE(mesh) << describe(mesh.error());
    EXPECT_EQ(meshTopology(*mesh).nonManifoldEdges, 0);
    EXPECT_GT(meshTopology(*mesh).boundaryEdges, 0);
    EXPECT_EQ(meshTopology(*mesh).components, 1);
}
