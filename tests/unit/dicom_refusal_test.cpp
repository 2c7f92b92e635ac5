// What the import must choose, leave out or refuse, and how it says so.
#include "data_folder.h"
#include "dicom/import_series.h"
#include "dicom_test_files.h"

#include <fstream>

namespace haustra {
namespace {

using dicom::importSeries;
using tests::filesIn;
using tests::patternScan;
using tests::smallGrid;
using tests::TemporaryFolder;
namespace fs = std::filesystem;

void expectRefused(const fs::path& path, const std::string& name, const std::string& reason) {
    const auto imported = importSeries(path);
    ASSERT_FALSE(imported);
    const std::string message = describe(imported.error());
    EXPECT_NE(message.find(name), std::string::npos) << message;
    EXPECT_NE(message.find(reason), std::string::npos) << message;
    EXPECT_EQ(message.find('\n'), std::string::npos) << "one line: " << message;
    EXPECT_EQ(message.find("PHANTOM"), std::string::npos) << "names the patient: " << message;
}

std::string seriesUidOf(const fs::path& path) {
    const auto series = dicom::listSeries(path);
    return series && !series->empty() ? series->front().seriesUid : "none";
}

// ------------------------------------------------------------------------------------- choosing

TEST(DicomChoice, SeveralSeriesAreListed) {
    const TemporaryFolder folder;
    const CtScan supine = patternScan(smallGrid()),
                 prone = patternScan(smallGrid(), PatientPosition::prone);
    tests::write(folder / "a", supine, "first");
    tests::write(folder / "b", prone, "second");
    const std::string first = seriesUidOf(folder / "a"), second = seriesUidOf(folder / "b");
    for (const std::string& said : {first, second, std::string("\"first\""),
                                    std::string("24 images of 17x12, prone, \"second\"")})
        expectRefused(folder.path(), said, "there are 2 CT series here");

    dicom::ImportOptions options;
    options.seriesUid = second;
    const auto chosen = importSeries(folder.path(), options);
    ASSERT_TRUE(chosen) << describe(chosen.error());
    EXPECT_EQ(chosen->scan.position, PatientPosition::prone);
    EXPECT_EQ(chosen->summary.description, "second");
    options.seriesUid = "1.2.3";
    EXPECT_EQ(importSeries(folder.path(), options).error().kind, ErrorKind::notFound);

    const auto listed = dicom::listSeries(folder.path());
    ASSERT_TRUE(listed);
    ASSERT_EQ(listed->size(), 2u);
    EXPECT_EQ((*listed)[0].images, 24);
}

TEST(DicomChoice, ScoutViewsReportsAndOtherModalitiesForceNoChoice) {
    const TemporaryFolder folder;
    const CtScan scan = patternScan(smallGrid());
    tests::write(folder / "scan", scan, "scan");
    tests::write(folder / "two", patternScan(axisAlignedGrid({9, 9, 2}, {1, 1, 1})), "two images");
    tests::write(folder / "scout", patternScan(axisAlignedGrid({9, 9, 1}, {1, 1, 1})), "scout");
    tests::set(folder / "scout/0001.dcm", DCM_ImageType, "ORIGINAL\\PRIMARY\\LOCALIZER");
    tests::write(folder / "mr", scan, "another modality");
    for (const fs::path& file : filesIn(folder / "mr"))
        tests::set(file, DCM_SOPClassUID, UID_MRImageStorage);
    // And a scout within the series itself.
    fs::copy(folder / "scout/0001.dcm", folder / "scan/scout");
    tests::set(folder / "scan/scout", DCM_SeriesInstanceUID, seriesUidOf(folder / "scan"));
    const auto imported = importSeries(folder.path());
    ASSERT_TRUE(imported) << describe(imported.error());
    EXPECT_TRUE(std::ranges::equal(imported->scan.hu.voxels(), scan.hu.voxels()));
    ASSERT_EQ(imported->notes.size(), 1u);
    EXPECT_NE(imported->notes[0].find("scout"), std::string::npos);

    expectRefused(folder / "scout/0001.dcm", "scout", "only scout views");
    expectRefused(folder / "mr/0001.dcm", "0001.dcm", "not a CT image, but MRImageStorage");
    expectRefused(folder / "mr", "0001.dcm", "no CT image");
}

TEST(DicomChoice, NothingToRead) {
    const TemporaryFolder folder;
    expectRefused(folder / "absent", "absent", "no such file");
    expectRefused(folder.path(), folder.path().filename(), "no DICOM file");
    std::ofstream(folder / "note.txt") << "a text of more than eight bytes";
    expectRefused(folder / "note.txt", "note.txt", "not a DICOM file");
}

// ------------------------------------------------------------------------------------- geometry

TEST(DicomRefusal, MissingSliceIsNamedByPositionAndNeighbours) {
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(smallGrid()));
    fs::remove(folder / "0010.dcm");
    expectRefused(folder.path(), "0009.dcm", "missing at z = -59.75 mm");
    expectRefused(folder.path(), "0011.dcm", "1.25 mm apart");
}

TEST(DicomRefusal, TwoSlicesAtOnePlace) {
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(smallGrid()));
    fs::copy(folder / "0010.dcm", folder / "again.dcm");
    const auto copied = importSeries(folder.path());
    ASSERT_TRUE(copied) << "a copy of a file is no conflict: " << describe(copied.error());
    EXPECT_EQ(copied->notes.size(), 1u);
    EXPECT_EQ(copied->scan.hu.grid().size.z, 24);
    tests::set(folder / "again.dcm", DCM_SOPInstanceUID, "2.25.1");
    expectRefused(folder.path(), "again.dcm", "same position");
    expectRefused(folder.path(), "0010.dcm", "z = -59.75 mm");
}

TEST(DicomRefusal, ACopyOfOtherPixels) {
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(smallGrid()));
    fs::copy(folder / "0010.dcm", folder / "again.dcm");
    ASSERT_TRUE(importSeries(folder.path()));
    tests::set(folder / "again.dcm", DCM_RescaleIntercept, "3");
    expectRefused(folder.path(), "again.dcm", "but other pixels");
}

TEST(DicomRefusal, SlicesOfSeveralStudiesOrPositions) {
    const struct {
        DcmTagKey tag;
        const char* value;
        const char* reason;
    } cases[] = {{DCM_StudyInstanceUID, "1.2.3", "another study"},
                 {DCM_PatientPosition, "HFP", "another patient position"}};
    for (const auto& test : cases) {
        const TemporaryFolder folder;
        tests::write(folder.path(), patternScan(smallGrid()));
        tests::set(folder / "0007.dcm", test.tag, test.value);
        expectRefused(folder.path(), "0007.dcm", test.reason);
    }
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(smallGrid()));
    tests::set(folder / "0001.dcm", DCM_PatientPosition, "");  // not said is not another
    tests::set(folder / "0007.dcm", DCM_FrameOfReferenceUID, "1.2.3");
    tests::set(folder / "0008.dcm", DCM_LossyImageCompression, "01");
    const auto imported = importSeries(folder.path());
    ASSERT_TRUE(imported) << describe(imported.error());
    ASSERT_EQ(imported->notes.size(), 2u) << "read, and told";
    EXPECT_EQ(imported->scan.position, PatientPosition::supine);
    EXPECT_NE(imported->notes[0].find("2 frames of reference"), std::string::npos);
    EXPECT_NE(imported->notes[1].find("1 images were compressed with loss"), std::string::npos);
}

// At the end of a series nothing else tells that it is missing.
TEST(DicomRefusal, FilesThatHaveLostTheirContent) {
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(smallGrid()));
    std::ofstream(folder / "notes.txt") << "not an image";
    std::ofstream(folder / "._0024.dcm") << "another program's";
    ASSERT_TRUE(importSeries(folder.path()));
    std::ofstream(folder / "0024.dcm", std::ios::trunc) << std::string(4000, '\0');
    expectRefused(folder.path(), "0024.dcm", "not a DICOM file");
    // Without an ending, or with a number for one, a file is known by having nothing in it.
    tests::write(folder / "new", patternScan(smallGrid()));
    for (const std::string name : {"", "CT.1.2.3."}) {
        const TemporaryFolder plain;
        for (const fs::path& file : filesIn(folder / "new"))
            fs::copy(file, plain / (name + file.stem().string()));
        std::ofstream(plain / "README") << "not an image";
        ASSERT_TRUE(importSeries(plain.path()));
        for (const std::size_t zeros : {0u, 4000u}) {
            std::ofstream(plain / (name + "0024"), std::ios::trunc) << std::string(zeros, '\0');
            expectRefused(plain.path(), name + "0024", "not a DICOM file");
        }
    }
}

TEST(DicomChoice, LinksAreFollowedOnce) {
    const TemporaryFolder folder, elsewhere;
    const CtScan scan = patternScan(smallGrid());
    tests::write(folder.path(), scan);
    for (const fs::path& file : filesIn(folder.path()))
        if (file.stem() > "0012") fs::rename(file, elsewhere / file.filename());
    fs::create_directory_symlink(elsewhere.path(), folder / "rest");
    fs::create_directory_symlink(elsewhere.path(), folder / "rest again");
    fs::create_directory_symlink(folder.path(), folder / "round");
    const auto imported = importSeries(folder.path());
    ASSERT_TRUE(imported) << describe(imported.error());
    EXPECT_TRUE(std::ranges::equal(imported->scan.hu.voxels(), scan.hu.voxels()));
    EXPECT_TRUE(imported->notes.empty()) << imported->notes.front();
}

TEST(DicomRefusal, NamesTheSliceThatDiffers) {
    const struct {
        DcmTagKey tag;
        const char* value;
        const char* reason;
    } cases[] = {
        {DCM_PixelSpacing, "0.8\\0.71", "pixel spacing"},
        {DCM_PixelSpacing, "0.8", "no valid Pixel Spacing"},
        {DCM_PixelSpacing, "0\\0", "no valid Pixel Spacing"},
        {DCM_PixelSpacing, "0,7\\0,7", "no valid Pixel Spacing"},
        {DCM_ImagePositionPatient, "-30,0\\12,5\\-64,75", "no valid Image Position"},
        {DCM_ImagePositionPatient, "1e30\\0\\0", "no valid Image Position"},
        {DCM_RescaleSlope, "1.0HU", "no valid Rescale Slope"},
        {DCM_RescaleSlope, "+-1", "no valid Rescale Slope"},
        {DCM_ImageOrientationPatient, "0\\1\\0\\1\\0\\0", "orientation"},
        {DCM_ImageOrientationPatient, "1\\0\\0\\1\\0\\0", "not orthogonal"},
        {DCM_ImageOrientationPatient, "2\\0\\0\\0\\1\\0", "not orthogonal"},
        {DCM_ImagePositionPatient, "", "no valid Image Position"},
        {DCM_ImagePositionPatient, "1\\2", "no valid Image Position"},
        {DCM_RescaleSlope, "", "no valid Rescale Slope"},
        {DCM_RescaleSlope, "0", "no valid Rescale Slope"},
        {DCM_PhotometricInterpretation, "MONOCHROME1", "MONOCHROME1"},
        {DCM_PhotometricInterpretation, "RGB", "RGB"},
    };
    for (const auto& test : cases) {
        SCOPED_TRACE(test.reason);
        const TemporaryFolder folder;
        tests::write(folder.path(), patternScan(smallGrid()));
        tests::set(folder / "0007.dcm", test.tag, test.value);
        expectRefused(folder.path(), "0007.dcm", test.reason);
    }
}

TEST(DicomRefusal, PixelsThatAreNotWhatTheHeaderSays) {
    auto change = [](const std::function<void(DcmDataset&)>& edit, const std::string& reason) {
        SCOPED_TRACE(reason);
        const TemporaryFolder folder;
        tests::write(folder.path(), patternScan(smallGrid()));
        tests::edit(folder / "0005.dcm", edit);
        expectRefused(folder.path(), "0005.dcm", reason);
    };
    auto number = [](const DcmTagKey& tag, Uint16 value) {
        return [=](DcmDataset& d) { ASSERT_TRUE(d.putAndInsertUint16(tag, value).good()); };
    };
    change(number(DCM_Rows, 0), "no picture");
    change(number(DCM_Rows, 60000), "60000 rows");
    change(number(DCM_Rows, 13), "matrix");
    change(number(DCM_BitsAllocated, 32), "32 bits allocated");
    change(number(DCM_BitsStored, 17), "17 stored");
    change(number(DCM_BitsStored, 0), "0 stored");
    change(number(DCM_HighBit, 16), "high bit 16");
    change(number(DCM_SamplesPerPixel, 3), "colour");
    change(number(DCM_PixelRepresentation, 2), "no valid Pixel Representation");
    change([](DcmDataset& d) { delete d.remove(DCM_PixelRepresentation); },
           "no valid Pixel Representation");
    change([](DcmDataset& d) { delete d.remove(DCM_PixelData); }, "no pixel data");
    change(
        [](DcmDataset& d) {
            const Uint16 few[4] = {};
            d.putAndInsertUint16Array(DCM_PixelData, few, 4);
        },
        "8 of 408 bytes");
    change(
        [](DcmDataset& d) {
            const std::vector<Uint16> many(2 * 17 * 12);
            d.putAndInsertUint16Array(DCM_PixelData, many.data(), many.size());
        },
        "holds 816 bytes");
    // Zeros that fill it up are no picture.
    const TemporaryFolder folder;
    const CtScan scan = patternScan(smallGrid());
    tests::write(folder.path(), scan);
    tests::edit(folder / "0005.dcm", [](DcmDataset& d) {
        const Uint16* pixels = nullptr;
        unsigned long count = 0;
        ASSERT_TRUE(d.findAndGetUint16Array(DCM_PixelData, pixels, &count).good());
        std::vector<Uint16> longer(pixels, pixels + count);
        longer.resize(count + 100, 0);
        d.putAndInsertUint16Array(DCM_PixelData, longer.data(), longer.size());
    });
    const auto imported = importSeries(folder.path());
    ASSERT_TRUE(imported) << describe(imported.error());
    EXPECT_TRUE(std::ranges::equal(imported->scan.hu.voxels(), scan.hu.voxels()));
}

TEST(DicomRefusal, CompressedPixelsThatAreNotWhatTheHeaderSays) {
    auto change = [](E_TransferSyntax syntax, const DcmTagKey& tag, Uint16 value,
                     const std::string& reason) {
        SCOPED_TRACE(reason);
        const TemporaryFolder folder;
        tests::write(folder.path(), patternScan(axisAlignedGrid({40, 30, 1}, {1, 1, 1})));
        const fs::path file = folder / "0001.dcm";
        tests::rewrite(file, syntax);
        ASSERT_TRUE(importSeries(file));
        tests::edit(file, [&](DcmDataset& d) {
            ASSERT_TRUE(d.putAndInsertUint16(tag, value).good());
            if (tag == DCM_BitsAllocated) {
                d.putAndInsertUint16(DCM_BitsStored, value);
                d.putAndInsertUint16(DCM_HighBit, Uint16(value - 1));
            }
        });
        expectRefused(file, "0001.dcm", reason);
    };
    for (const E_TransferSyntax syntax : {EXS_JPEGProcess14SV1, EXS_JPEGProcess14}) {
        change(syntax, DCM_Rows, 60, "40 columns, 30 rows and 16 bits");
        change(syntax, DCM_Columns, 20, "40 columns, 30 rows and 16 bits");
        change(syntax, DCM_BitsAllocated, 8, "the file of 40, 30 and 8");
    }
    change(EXS_RLELossless, DCM_Rows, 15, "run-length");
    change(EXS_RLELossless, DCM_Rows, 60, "run-length");
}

// Decoders go on behind what they cannot read.
TEST(DicomRefusal, DamageWithinCompressedPixels) {
    const TemporaryFolder folder;
    const CtScan scan = patternScan(axisAlignedGrid({64, 64, 1}, {1, 1, 1}));
    // Pixels that are there too early leave bytes before the end.
    tests::write(folder / "early", scan);
    const fs::path early = folder / "early/0001.dcm";
    tests::rewrite(early, EXS_JPEGProcess14SV1);
    std::vector<Uint8> stream = tests::joined(tests::fragmentsOf(early));
    while (stream.back() == 0)
        stream.pop_back();
    const std::vector<Uint8> more(50, 0x55);
    stream.insert(stream.end() - 2, more.begin(), more.end());
    stream.resize(stream.size() + stream.size() % 2, 0);
    tests::wrap(early, {{stream}}, EXS_JPEGProcess14SV1);
    expectRefused(early, "0001.dcm", "compressed data is damaged");
    for (const E_TransferSyntax syntax :
         {EXS_JPEGProcess14SV1, EXS_JPEGLSLossless, EXS_RLELossless}) {
        SCOPED_TRACE(DcmXfer(syntax).getXferName());
        fs::remove_all(folder / "series");
        tests::write(folder / "series", scan);
        const fs::path file = folder / "series/0001.dcm";
        tests::rewrite(file, syntax);
        std::ifstream in(file, std::ios::binary);
        std::string whole{std::istreambuf_iterator<char>(in), {}};
        // An end of image in its midst; of run lengths, two bytes that become ten.
        const std::string damage = syntax == EXS_RLELossless ? "\xf7\xf7" : "\xff\xd9";
        for (std::size_t n = 0; n < 100; ++n)
            whole.replace(whole.size() - 900 + 2 * n, 2, damage);
        std::ofstream(file, std::ios::binary | std::ios::trunc) << whole;
        expectRefused(file, "0001.dcm", "the pixels cannot be read");
    }
}

TEST(DicomRefusal, RunLengthSegmentsOutsideTheFrame) {
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(axisAlignedGrid({8, 8, 1}, {1, 1, 1})));
    const fs::path file = folder / "0001.dcm";
    tests::rewrite(file, EXS_RLELossless);
    ASSERT_TRUE(importSeries(file));
    std::ifstream in(file, std::ios::binary);
    const std::string whole{std::istreambuf_iterator<char>(in), {}};
    // Two segments, the first at byte 64.
    const std::size_t header = whole.find(std::string("\2\0\0\0\x40\0\0\0", 8));
    ASSERT_NE(header, std::string::npos);
    for (const std::string& second :
         {std::string("\x88\0\xfb\0", 4), std::string("\xff\xff\xff\xff", 4),
          std::string("\0\0\0\0", 4)}) {
        std::ofstream(file, std::ios::binary | std::ios::trunc)
            << std::string(whole).replace(header + 8, 4, second);
        expectRefused(file, "0001.dcm", "run-length segments");
    }
}

TEST(DicomRefusal, TruncatedAnywhere) {
    const TemporaryFolder folder;
    tests::write(folder / "series", patternScan(smallGrid()));
    for (E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_JPEGLSLossless, EXS_RLELossless,
                                    EXS_DeflatedLittleEndianExplicit}) {
        const fs::path victim = folder / "series/0012.dcm";
        tests::rewrite(victim, syntax);
        std::ifstream in(victim, std::ios::binary);
        const std::string whole{std::istreambuf_iterator<char>(in), {}};
        for (std::size_t length = 0; length + 8 < whole.size(); length += 53) {
            std::ofstream(victim, std::ios::binary | std::ios::trunc)
                .write(whole.data(), std::ptrdiff_t(length));
            const auto imported = importSeries(folder / "series");
            ASSERT_FALSE(imported) << length << " of " << whole.size();
            EXPECT_NE(describe(imported.error()).find("0012.dcm"), std::string::npos)
                << DcmXfer(syntax).getXferName() << " " << length << " of " << whole.size() << ": "
                << describe(imported.error());
        }
        std::ofstream(victim, std::ios::binary | std::ios::trunc) << whole;
        ASSERT_TRUE(importSeries(folder / "series"));
    }
}

// --------------------------------------------------------------------------------------- values

/// HU of a one-slice series whose stored cells are `cells`, after `edit`.
std::vector<int> huOf(const std::vector<Uint16>& cells,
                      const std::function<void(DcmDataset&)>& edit) {
    const TemporaryFolder folder;
    tests::write(folder.path(), patternScan(axisAlignedGrid({int(cells.size()), 1, 1}, {1, 1, 1})));
    tests::edit(folder / "0001.dcm", [&](DcmDataset& dataset) {
        dataset.putAndInsertUint16Array(DCM_PixelData, cells.data(),
                                        static_cast<unsigned long>(cells.size()));
        edit(dataset);
    });
    const auto imported = importSeries(folder.path());
    EXPECT_TRUE(imported) << describe(imported.error());
    if (!imported) return {};
    const auto voxels = imported->scan.hu.voxels();
    return {voxels.begin(), voxels.end()};
}

TEST(DicomValues, BitsStoredSignAndRescale) {
    const auto twelveBits = [](Uint16 representation) {
        return [=](DcmDataset& d) {
            d.putAndInsertUint16(DCM_BitsStored, 12);
            d.putAndInsertUint16(DCM_HighBit, 11);
            d.putAndInsertUint16(DCM_PixelRepresentation, representation);
            d.putAndInsertString(DCM_RescaleIntercept, "-1024");
        };
    };
    // The top four bits are an overlay's, as in old scanners.
    EXPECT_EQ(huOf({0, 4095, 0xf001, 0x0800}, twelveBits(0)),
              (std::vector{-1024, 3071, -1023, 1024}));
    EXPECT_EQ(huOf({0, 4095, 0xf001, 0x0800}, twelveBits(1)),
              (std::vector{-1024, -1025, -1023, -3072}));
    EXPECT_EQ(huOf({0, 1, 0xffff, 20000},
                   [](DcmDataset& d) {
                       d.putAndInsertString(DCM_RescaleSlope, "2.5");
                       d.putAndInsertString(DCM_RescaleIntercept, "-0.25");
                   }),
              (std::vector{0, 2, -3, 32767}));  // clamped, not wrapped
}

TEST(DicomValues, PaddingIsMinus1024) {
    const auto padded = [](DcmDataset& d) {
        d.putAndInsertSint16(DCM_PixelPaddingValue, -2000);
        d.putAndInsertString(DCM_RescaleIntercept, "-24");
    };
    EXPECT_EQ(huOf({Uint16(-2000), Uint16(-1990), 0, 1000}, padded),
              (std::vector{-1024, -1024, -24, 976}));
    const auto range = [](DcmDataset& d) {
        d.putAndInsertSint16(DCM_PixelPaddingValue, 3000);
        d.putAndInsertSint16(DCM_PixelPaddingRangeLimit, 3010);
    };
    EXPECT_EQ(huOf({2999, 3000, 3005, 3010, 3011}, range),
              (std::vector{2999, -1024, -1024, -1024, 3011}));
    const auto above = [](DcmDataset& d) {  // padding that uses bits above the twelve stored
        d.putAndInsertUint16(DCM_BitsStored, 12);
        d.putAndInsertUint16(DCM_HighBit, 11);
        d.putAndInsertUint16(DCM_PixelRepresentation, 0);
        d.putAndInsertUint16(DCM_PixelPaddingValue, 63536);
        d.putAndInsertString(DCM_RescaleIntercept, "-1024");
    };
    EXPECT_EQ(huOf({63536, 0, 2048}, above), (std::vector{-1024, -1024, 1024}));
}

TEST(DicomValues, EveryPatientPosition) {
    const std::pair<const char*, PatientPosition> codes[] = {
        {"HFS", PatientPosition::supine},
        {"FFS", PatientPosition::supine},
        {"HFP", PatientPosition::prone},
        {"FFP", PatientPosition::prone},
        {"HFDL", PatientPosition::leftDecubitus},
        {"FFDL", PatientPosition::leftDecubitus},
        {"HFDR", PatientPosition::rightDecubitus},
        {"FFDR", PatientPosition::rightDecubitus},
        {"", PatientPosition::unknown},
        {"SITTING", PatientPosition::unknown},
    };
    for (const auto& [code, position] : codes) {
        const TemporaryFolder folder;
        tests::write(folder.path(), patternScan(axisAlignedGrid({3, 3, 1}, {1, 1, 1})));
        tests::set(folder / "0001.dcm", DCM_PatientPosition, code);
        const auto imported = importSeries(folder.path());
        ASSERT_TRUE(imported);
        EXPECT_EQ(imported->scan.position, position) << code;
    }
}

// ------------------------------------------------------------------------------------ real data

TEST(DicomReal, OddFilesAreReadOrRefusedByName) {
    HAUSTRA_REAL_DATA(odd, "dicom/odd");
    int read = 0, refused = 0;
    for (const fs::path& file : filesIn(odd)) {
        const auto imported = importSeries(file);
        if (imported) {
            ++read;
            EXPECT_TRUE(checkGrid(imported->scan.hu.grid(), file)) << file;
            continue;
        }
        ++refused;
        const std::string message = describe(imported.error());
        EXPECT_NE(message.find(file.filename().string()), std::string::npos) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_GT(imported.error().message.size(), 10u) << message;
    }
    EXPECT_GE(read, 3);  // CT_small, J2K_pixelrep_mismatch, 693_J2KI
    EXPECT_GT(refused, 100);
    EXPECT_FALSE(importSeries(odd));
    EXPECT_TRUE(dicom::listSeries(odd));
}

TEST(DicomReal, WholeColonographyScan) {
    HAUSTRA_REAL_DATA(folder, "ctc430");
    const auto imported = importSeries(folder);
    ASSERT_TRUE(imported) << describe(imported.error());
    const Grid& grid = imported->scan.hu.grid();
    EXPECT_EQ(grid.size, glm::ivec3(512, 512, 430));
    EXPECT_LT(glm::distance(grid.spacingMm(), glm::dvec3(0.675781, 0.675781, 1.0)), 1e-6);
    EXPECT_EQ(imported->scan.position, PatientPosition::prone);
    EXPECT_TRUE(imported->notes.empty());
    // The feet come first: the lungs are at the far end, the thighs at the near one.
    auto airIn = [&](int first, int last) {
        long air = 0;
        for (int k = first; k < last; ++k) {
            for (int j = 128; j < 384; ++j) {
                for (int i = 64; i < 448; ++i)
                    air += imported->scan.hu.at(i, j, k) < -700;
            }
        }
        return air;
    };
    EXPECT_GT(airIn(420, 430), 4 * airIn(0, 10));
}

}  // namespace
}  // namespace haustra
