// The same pixels come out whatever they were wrapped in.
#include "data_folder.h"
#include "dicom/import_series.h"
#include "dicom_test_files.h"

namespace haustra {
namespace {

using dicom::importSeries;
using tests::TemporaryFolder;
namespace fs = std::filesystem;

/// Values between −1000 and 3000, all of them after the shifts of writeEnhanced in 16 bits.
CtScan bodyScan() {
    CtScan scan = tests::patternScan(tests::smallGrid(), PatientPosition::prone);
    for (std::int16_t& hu : scan.hu.writable())
        hu = std::int16_t(1000 + hu / 16);
    return scan;
}

void expectVoxels(const CtScan& expected, const fs::path& path) {
    const auto imported = importSeries(path);
    ASSERT_TRUE(imported) << describe(imported.error());
    EXPECT_TRUE(sameGrid(imported->scan.hu.grid(), expected.hu.grid()));
    EXPECT_TRUE(std::ranges::equal(imported->scan.hu.voxels(), expected.hu.voxels()));
    EXPECT_EQ(imported->scan.position, expected.position);
}

constexpr E_TransferSyntax losslessSyntaxes[] = {
    EXS_LittleEndianExplicit, EXS_LittleEndianImplicit,
    EXS_BigEndianExplicit,    EXS_DeflatedLittleEndianExplicit,
    EXS_RLELossless,          EXS_JPEGProcess14SV1,
    EXS_JPEGProcess14,        EXS_JPEGLSLossless,
};

TEST(DicomTransferSyntax, LosslessOnesAgree) {
    const CtScan scan = bodyScan();
    for (E_TransferSyntax syntax : losslessSyntaxes) {
        SCOPED_TRACE(DcmXfer(syntax).getXferName());
        const TemporaryFolder folder;
        tests::write(folder.path(), scan);
        for (const fs::path& file : tests::filesIn(folder.path()))
            tests::rewrite(file, syntax);
        expectVoxels(scan, folder.path());
    }
}

TEST(DicomTransferSyntax, NoPreambleNoMetaInformation) {
    const CtScan scan = bodyScan();
    for (E_TransferSyntax syntax :
         {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit}) {
        SCOPED_TRACE(DcmXfer(syntax).getXferName());
        const TemporaryFolder folder;
        tests::write(folder.path(), scan);
        for (const fs::path& file : tests::filesIn(folder.path()))
            tests::rewrite(file, syntax, EWM_dataset);
        expectVoxels(scan, folder.path());
    }
}

TEST(DicomTransferSyntax, EnhancedMultiFrame) {
    const CtScan scan = bodyScan();
    for (E_TransferSyntax syntax : losslessSyntaxes) {
        SCOPED_TRACE(DcmXfer(syntax).getXferName());
        const TemporaryFolder folder;
        tests::writeEnhanced(folder / "enhanced.dcm", scan);
        tests::rewrite(folder / "enhanced.dcm", syntax);
        expectVoxels(scan, folder / "enhanced.dcm");
    }
}

// What else stands in a stream, or beside it, than the pixels.
TEST(DicomTransferSyntax, JpegIsReadHoweverItIsWrapped) {
    const CtScan scan = bodyScan();
    const std::vector<Uint8> end{0xff, 0xd9}, zeros(8, 0);
    const auto padded = [&](std::vector<Uint8> stream) {
        while (stream.back() == 0)  // makes its length even
            stream.pop_back();
        stream.insert(stream.end() - 2, zeros.begin(), zeros.end());
        if (stream.size() % 2) stream.push_back(0);
        return stream;
    };
    const TemporaryFolder folder;
    tests::write(folder / "classic", scan);
    for (const fs::path& file : tests::filesIn(folder / "classic")) {
        tests::rewrite(file, EXS_JPEGProcess14SV1);
        tests::wrap(file, {{padded(tests::joined(tests::fragmentsOf(file))), {}}},
                    EXS_JPEGProcess14SV1);
    }
    expectVoxels(scan, folder / "classic");
    // Of several frames, each of two fragments.
    const fs::path enhanced = folder / "enhanced.dcm";
    tests::writeEnhanced(enhanced, scan);
    tests::rewrite(enhanced, EXS_JPEGProcess14SV1);
    std::vector<tests::Fragments> frames;
    for (const std::vector<Uint8>& stream : tests::fragmentsOf(enhanced)) {
        const auto half = stream.begin() + std::ptrdiff_t(stream.size() / 4 * 2);
        frames.push_back({{stream.begin(), half}, {half, stream.end()}});
    }
    for (const bool hasTable : {true, false}) {
        tests::wrap(enhanced, frames, EXS_JPEGProcess14SV1, hasTable);
        expectVoxels(scan, enhanced);
    }
    frames.pop_back();
    tests::wrap(enhanced, frames, EXS_JPEGProcess14SV1, false);
    EXPECT_FALSE(importSeries(enhanced)) << "a frame is missing";
}

TEST(DicomTransferSyntax, EnhancedRefusesOtherGroupsThanFrames) {
    const TemporaryFolder folder;
    tests::writeEnhanced(folder / "enhanced.dcm", bodyScan());
    for (const char* count : {"25", "23", "4097", "0", "-3", "999999999999", "x"}) {
        tests::set(folder / "enhanced.dcm", DCM_NumberOfFrames, count);
        const auto imported = importSeries(folder / "enhanced.dcm");
        ASSERT_FALSE(imported) << count;
        EXPECT_EQ(imported.error().place, (folder / "enhanced.dcm").string());
    }
}

// ------------------------------------------------------------------------- the WG 04 pictures

struct Loss {
    int most = 0;
    double rms = 0.0;
};

Loss lossOf(const fs::path& file, const fs::path& reference) {
    const auto a = importSeries(file), b = importSeries(reference);
    EXPECT_TRUE(a) << describe(a.error());
    EXPECT_TRUE(b) << describe(b.error());
    if (!a || !b) return {99999, 99999};
    EXPECT_TRUE(sameGrid(a->scan.hu.grid(), b->scan.hu.grid()));
    Loss loss;
    double sum = 0.0;
    for (std::size_t n = 0; n < a->scan.hu.voxels().size(); ++n) {
        const int off = a->scan.hu[n] - b->scan.hu[n];
        loss.most = std::max(loss.most, std::abs(off));
        sum += double(off) * off;
    }
    loss.rms = std::sqrt(sum / double(a->scan.hu.voxels().size()));
    return loss;
}

TEST(DicomTransferSyntax, Wg04EqualsTheReference) {
    HAUSTRA_REAL_DATA(wg04, "dicom/wg04");
    for (const std::string picture : {"CT1_", "CT2_"}) {
        const fs::path reference = wg04 / "REF" / (picture + "UNC");
        for (const std::string syntax : {"RLE", "J2KR", "JPLL", "JLSL"}) {
            const Loss loss = lossOf(wg04 / syntax / (picture + syntax), reference);
            EXPECT_EQ(loss.most, 0) << picture << syntax;
        }
        // Near-lossless JPEG-LS with NEAR = 4: no pixel is off by more, and some are by that.
        const Loss near = lossOf(wg04 / "JLSN" / (picture + "JLSN"), reference);
        EXPECT_EQ(near.most, 4) << picture;
        // Lossy JPEG 2000 at 69:1 and 106:1: 26 and 31 HU measured, of a range of 4,000.
        const Loss lossy = lossOf(wg04 / "J2KI" / (picture + "J2KI"), reference);
        EXPECT_GT(lossy.rms, 1.0) << picture;
        EXPECT_LT(lossy.rms, 40.0) << picture;
    }
}

TEST(DicomTransferSyntax, EnhancedMultiFrameInJpeg2000) {
    HAUSTRA_REAL_DATA(wg04, "dicom/wg04");
    const auto first = importSeries(wg04 / "REF/CT1_UNC"),
               second = importSeries(wg04 / "REF/CT2_UNC");
    ASSERT_TRUE(first && second);
    const TemporaryFolder folder;
    const fs::path file = folder / "enhanced.dcm";
    CtScan scan{Volume<std::int16_t>(axisAlignedGrid({512, 512, 20}, {1, 1, 1}), 0),
                PatientPosition::supine};
    tests::writeEnhanced(file, scan);
    // One frame of three fragments, one of one; the others of two.
    const tests::Fragments a = tests::fragmentsOf(wg04 / "J2KR/CT1_J2KR"),
                           b = tests::fragmentsOf(wg04 / "J2KR/CT2_J2KR");
    ASSERT_EQ(a.size(), 3u);
    ASSERT_EQ(b.size(), 2u);
    std::vector<tests::Fragments> frames(20, b);
    frames[0] = a;
    frames[17] = {tests::joined(a)};
    tests::wrapJpeg2000(file, frames);
    const auto imported = importSeries(file);
    ASSERT_TRUE(imported) << describe(imported.error());
    // Frames are told apart by their place: the shuffled frames 0 and 17 lie at two known slices.
    const std::size_t plane = 512 * 512;
    int firsts = 0;
    for (std::size_t k = 0; k < 20; ++k) {
        const auto slice = imported->scan.hu.voxels().subspan(k * plane, plane);
        // writeEnhanced gives slice k the intercept −10 k; CT1's own is −1024, CT2's is 0.
        const int shift = int(10 * k);
        const int center = int(256 * 512 + 256);
        const int stored = slice[std::size_t(center)] + shift;
        if (stored == first->scan.hu[std::size_t(center)] + 1024) {
            ++firsts;
            continue;
        }
        for (std::size_t n = 0; n < plane; ++n)
            ASSERT_EQ(slice[n] + shift, second->scan.hu[n]) << k << ' ' << n;
    }
    EXPECT_EQ(firsts, 2);
    frames.pop_back();
    tests::wrapJpeg2000(file, frames);
    EXPECT_FALSE(importSeries(file)) << "a frame is missing";
}

TEST(DicomTransferSyntax, DamagedJpeg2000IsRefused) {
    HAUSTRA_REAL_DATA(wg04, "dicom/wg04");
    const TemporaryFolder folder;
    const fs::path file = folder / "damaged.dcm";
    const std::vector<Uint8> whole = tests::joined(tests::fragmentsOf(wg04 / "J2KR/CT2_J2KR"));
    auto expectRefused = [&](const std::vector<Uint8>& codestream, const std::string& reason) {
        fs::remove(file);
        fs::copy_file(wg04 / "REF/CT2_UNC", file);
        fs::permissions(file, fs::perms::owner_write, fs::perm_options::add);
        tests::wrapJpeg2000(file, {{codestream}});
        const auto imported = importSeries(file);
        ASSERT_FALSE(imported);
        EXPECT_EQ(imported.error().place, file.string());
        EXPECT_NE(imported.error().message.find(reason), std::string::npos)
            << imported.error().message;
    };
    expectRefused({whole.begin(), whole.begin() + std::ptrdiff_t(whole.size() / 3)}, "damaged");
    expectRefused({whole.begin(), whole.begin() + 40}, "damaged");
    expectRefused(std::vector<Uint8>(400, 0), "damaged");
    std::vector<Uint8> larger = whole;
    larger[8] = 0x7f;  // the width, from 512 to two thousand million
    expectRefused(larger, "JPEG 2000");
}

}  // namespace
}  // namespace haustra
