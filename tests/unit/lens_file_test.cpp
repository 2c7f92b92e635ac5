// Lens files, Haustra's and OpenCV's, there and back; damaged ones are refused in one sentence.
#include "coverage/lens_file.h"

#include "data_folder.h"
#include "temporary_folder.h"

#include <fstream>
#include <random>

#include <gtest/gtest.h>

namespace haustra::coverage {
namespace {

namespace fs = std::filesystem;

Colonoscope fisheye() {
    Colonoscope scope = olympusCfQ160l();
    scope.name = "cap \"sule\"";
    scope.lens = {{1.0, -0.1 / 3.0, 0.41, -0.3, 0.02}, 137.1, 136.7, 161.3, 160.9};
    return scope;
}

Colonoscope pinhole() {
    Colonoscope scope = olympusCfQ160l();
    scope.lens = {{1.0, -0.488, 0.347, -0.145, 0.0},
                  649.5,
                  649.7,
                  420.1,
                  361.5,
                  Projection::perspective,
                  {0.001, -1.0 / 7.0}};
    return scope;
}

TEST(LensFile, NumbersComeBackAsTheyWere) {
    for (const Colonoscope& scope : {olympusCfQ160l(), fisheye(), pinhole()}) {
        const auto back = colonoscopeOfText(lensText(scope), "lens.json");
        ASSERT_TRUE(back) << describe(back.error());
        EXPECT_EQ(*back, scope);
    }
    EXPECT_EQ(readColonoscope("olympus-cf-q160l").value(), olympusCfQ160l());
}

TEST(LensFile, EveryMissingOrWrongFieldIsNamed) {
    const std::string sound = lensText(fisheye());
    const auto refused = [](const std::string& text, const std::string& field) {
        const auto read = colonoscopeOfText(text, "lens.json");
        ASSERT_FALSE(read) << field;
        EXPECT_EQ(read.error().kind, ErrorKind::badInput);
        EXPECT_EQ(read.error().place, "lens.json");
        EXPECT_NE(read.error().message.find(field), std::string::npos) << read.error().message;
    };
    for (const std::string field :
         {"name", "projection", "k", "m_u", "m_v", "u0", "v0", "picture_size", "open_centre",
          "open_radii", "field_degrees", "depth_of_field_mm", "tip_radius_mm"}) {
        std::string text = sound;
        text.replace(text.find("\"" + field + "\""), field.size() + 2, "\"other\"");
        refused(text, field);
        text = sound;
        const std::size_t colon = text.find(':', text.find("\"" + field + "\""));
        text.replace(colon, 1, ": {}, \"rest\":");
        refused(text, field);
    }
    const auto with = [&](const std::string& was, const std::string& is) {
        std::string text = sound;
        EXPECT_NE(text.find(was), std::string::npos) << was;
        return text.replace(text.find(was), was.size(), is);
    };
    refused(with("\"equidistance\"", "\"mercator\""), "projection");
    refused(with("137.1", "1e999"), "JSON");
    refused(with("137.1", "-1"), "over 0");
    refused(with("525", "525.5"), "picture_size");
    refused(with("525", "1e9"), "picture_size");
    refused(with("140.0", "400"), "field_degrees");
    refused("[]", "JSON");
    refused("", "JSON");
}

TEST(LensFile, OpenCvsFormsComeBack) {
    for (const Colonoscope& scope : {fisheye(), pinhole()}) {
        for (const char* ending : {".xml", ".yml", ".yaml", ".json"}) {
            const auto text = openCvText(scope, ending);
            ASSERT_TRUE(text) << describe(text.error());
            const auto back = lensOfOpenCvText(*text, "camera");
            ASSERT_TRUE(back) << ending << ": " << describe(back.error());
            EXPECT_EQ(back->lens, scope.lens) << ending;
            EXPECT_EQ(back->pictureSize, scope.pictureSize);
        }
        EXPECT_FALSE(openCvText(scope, ".txt"));
    }
    // Another scale of the same lens is the same camera; shown in OpenCV's scale it shows the same.
    const auto back =
        lensOfOpenCvText(openCvText(olympusCfQ160l(), ".yml").value(), "camera").value();
    EXPECT_EQ(back.lens.k[0], 1.0);
    for (const glm::dvec3 direction : {glm::dvec3(0.3, -0.2, 1.0), glm::dvec3(-1.5, 1.0, 1.0)})
        EXPECT_LT(glm::distance(pixelOf(back.lens, direction).value(),
                                pixelOf(olympusCfQ160l().lens, direction).value()),
                  1e-9);
    // What OpenCV has no lens for is not written as another.
    Colonoscope other = fisheye();
    other.lens.projection = Projection::equisolid;
    EXPECT_EQ(openCvText(other, ".yml").error().kind, ErrorKind::unsupported);
}

TEST(LensFile, OpenCvsOlderSpellingIsRead) {
    HAUSTRA_REAL_DATA(file, "calibration/endocal_001/calibration_001-010.xml");
    const auto scope = readColonoscope(file);
    ASSERT_TRUE(scope) << describe(scope.error());
    EXPECT_EQ(scope->lens.projection, Projection::perspective);
    EXPECT_EQ(scope->lens.mu, 6.4950472053791145e+02);
    EXPECT_EQ(scope->lens.k[3], -1.4479023206940939e-01);
    EXPECT_EQ(scope->pictureSize, glm::ivec2(768, 710));
}

TEST(LensFile, WhatNoLensHereIsIsRefused) {
    const std::string sound = openCvText(fisheye(), ".yml").value();
    const auto refused = [](const std::string& text, const std::string& why) {
        const auto read = lensOfOpenCvText(text, "camera.yml");
        ASSERT_FALSE(read) << why;
        EXPECT_EQ(read.error().kind, ErrorKind::badInput);
        EXPECT_EQ(read.error().place, "camera.yml");
        EXPECT_NE(read.error().message.find(why), std::string::npos) << read.error().message;
    };
    const auto with = [&](const std::string& was, const std::string& is) {
        std::string text = sound;
        EXPECT_NE(text.find(was), std::string::npos) << was;
        return text.replace(text.find(was), was.size(), is);
    };
    refused(with("fisheye_model: 1", "other: 1"), "fisheye_model");
    refused(with("image_width", "width"), "image_width");
    refused(with("image_width: 525", "image_width: -3"), "image_width");
    refused(with("data: [ ", "data: [ -"), "over 0");
    refused(with("data: [ ", "data: [ .Nan, "), "camera_matrix");
    refused(with("0., 0., 1. ]", "0., 0.1, 1. ]"), "skew");
    refused(with("distortion_coefficients", "others"), "distortion_coefficients");
    refused(with("camera_matrix", "camera_matrices"), "camera_matrix");
    refused("", "no lens file");
    refused("camera_matrix", "");
    refused("%YAML:1.0\n---\ncamera_matrix: {\n", "");
    refused("%YAML:1.0\n---\ncamera_matrix: " + std::string(100000, '['), "deep");
    refused("{\"camera_matrix\": " + std::string(100000, '['), "deep");
    std::string tags = "<?xml version=\"1.0\"?><opencv_storage><camera_matrix>";
    for (int n = 0; n < 50000; ++n)
        tags += "<a>";
    refused(tags, "deep");
    std::string blocks = "%YAML:1.0\n---\ncamera_matrix:\n";
    for (int n = 1; n < 2000; ++n)
        blocks += std::string(std::size_t(n), ' ') + "a:\n";
    refused(blocks, "deep");
    std::string dashes = "%YAML:1.0\n---\ncamera_matrix:\n  ";
    for (int n = 0; n < 20000; ++n)
        dashes += "- ";
    refused(dashes + "1\n", "deep");
}

TEST(LensFile, DamagedFilesAreRefusedOrReadButNothingWorse) {
    std::mt19937 random(13);
    std::vector<std::string> sound{lensText(pinhole())};
    for (const char* ending : {".xml", ".yml", ".json"})
        sound.push_back(openCvText(pinhole(), ending).value());
    const tests::TemporaryFolder folder;
    const fs::path file = fs::path(folder.path()) / "lens";
    for (const std::string& text : sound) {
        for (int n = 0; n < 200; ++n) {
            std::string odd = text;
            if (n % 4 == 0) odd.resize(random() % odd.size());
            for (int change = 0; change < 3 && !odd.empty(); ++change)
                odd[random() % odd.size()] =
                    n % 2 ? char(random()) : "0123456789-.[]{}<>/:,\" \n"[random() % 23];
            std::ofstream(file, std::ios::binary) << odd;
            const auto read = readColonoscope(file);
            if (read) {
                EXPECT_TRUE(checkLens(read->lens));
                continue;
            }
            EXPECT_EQ(read.error().place, file.string());
            EXPECT_FALSE(read.error().message.empty());
            EXPECT_EQ(read.error().message.find('\n'), std::string::npos);
        }
    }
    EXPECT_EQ(readColonoscope(folder.path()).error().kind, ErrorKind::badInput);
    EXPECT_EQ(readColonoscope((fs::path(folder.path()) / "none").string()).error().kind,
              ErrorKind::notFound);
}

}  // namespace
}  // namespace haustra::coverage
