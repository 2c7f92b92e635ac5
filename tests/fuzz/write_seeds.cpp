// Small sound inputs of every fuzz target, for it to change: OUT/dicom_fuzz/… and so on.
#include "dicom/write_series.h"
#include "nifti/nifti_file.h"
#include "protocol/framing.h"
#include "protocol/haustra.pb.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <dcmtk/dcmjpls/djencode.h>

namespace {

namespace fs = std::filesystem;
using namespace haustra;

void require(bool holds, const char* what) {
    if (holds) return;
    std::fprintf(stderr, "write_seeds: cannot write %s\n", what);
    std::exit(1);
}

template <class T>
Volume<T> ramp(const glm::ivec3& size) {
    Volume<T> volume(axisAlignedGrid(size, {0.7, 0.8, 1.25}, {-3, 1.5, -7}));
    for (std::size_t n = 0; n < volume.grid().voxelCount(); ++n)
        volume.writable()[n] = T(n * 37 % 200);
    return volume;
}

void recompress(const fs::path& from, const fs::path& to, E_TransferSyntax syntax) {
    DcmFileFormat file;
    require(file.loadFile(from.c_str()).good() &&
                file.getDataset()->chooseRepresentation(syntax, nullptr).good() &&
                file.saveFile(to.c_str(), syntax).good(),
            to.c_str());
}

void writeDicom(const fs::path& folder) {
    dicom::WriteOptions options;
    options.threads = 1;
    const CtScan scan{ramp<std::int16_t>({16, 12, 1}), PatientPosition::prone};
    require(dicom::writeSeries(folder, scan, options).has_value(), "a DICOM file");
    DJEncoderRegistration::registerCodecs();
    DJLSEncoderRegistration::registerCodecs();
    const fs::path plain = folder / "0001.dcm";
    recompress(plain, folder / "big-endian.dcm", EXS_BigEndianExplicit);
    recompress(plain, folder / "jpeg.dcm", EXS_JPEGProcess14SV1);
    recompress(plain, folder / "jpeg-ls.dcm", EXS_JPEGLSLossless);
}

void writeNiftis(const fs::path& folder) {
    fs::create_directories(folder);
    const glm::ivec3 size(5, 4, 3);
    require(nifti::writeNifti(folder / "int16.nii", ramp<std::int16_t>(size)) &&
                nifti::writeNifti(folder / "float.nii", ramp<float>(size)) &&
                nifti::writeNifti(folder / "uint8.nii.gz", ramp<std::uint8_t>(size)) &&
                nifti::writeColorNifti(
                    folder / "color.nii",
                    Volume<Rgba>(axisAlignedGrid(size, {1, 1, 1}, {0, 0, 0}), Rgba{1, 2, 3, 4})),
            "a NIfTI file");
}

void writeFrame(const fs::path& file, protocol::FrameType type,
                const std::vector<std::uint8_t>& payload) {
    std::vector<std::uint8_t> frame;
    protocol::appendFrameHeader(frame, {std::uint32_t(payload.size()), type});
    frame.insert(frame.end(), payload.begin(), payload.end());
    std::ofstream out(file, std::ios::binary);
    out.write(reinterpret_cast<const char*>(frame.data()), std::streamsize(frame.size()));
    require(bool(out.flush()), "a frame");
}

void writeControl(const fs::path& file, const google::protobuf::MessageLite& message) {
    std::vector<std::uint8_t> payload(message.ByteSizeLong());
    require(message.SerializeToArray(payload.data(), int(payload.size())), "a message");
    writeFrame(file, protocol::FrameType::control, payload);
}

void writeFrames(const fs::path& folder) {
    fs::create_directories(folder);
    protocol::ClientMessage hello, camera;
    hello.mutable_hello()->set_protocol_version(protocol::protocolVersion);
    hello.mutable_hello()->add_capabilities("lossless");
    camera.mutable_set_camera()->mutable_position_mm()->set_x(1.5);
    camera.mutable_set_camera()->set_fov_degrees(90.0);
    writeControl(folder / "hello", hello);
    writeControl(folder / "camera", camera);
    protocol::ServerMessage opened;
    opened.mutable_case_opened()->set_name("first");
    for (int n = 0; n < 20; ++n)
        opened.mutable_case_opened()->add_centerline(n);
    writeControl(folder / "opened", opened);

    protocol::ClientMessage shown;
    shown.mutable_tell_shown()->set_number(1);
    shown.mutable_tell_shown()->add_pictures()->set_picture(7);
    writeControl(folder / "shown", shown);
    protocol::ServerMessage ledger;
    ledger.mutable_ledger()->set_triangles(12);
    ledger.mutable_ledger()->set_shown("\x05\x01");
    ledger.mutable_ledger()->mutable_limits()->set_least_ms(300);
    writeControl(folder / "ledger", ledger);
    protocol::TileHeader header;
    header.codec = protocol::TileCodec::lossless;
    header.last = header.exact = true;
    header.picture = 1;
    header.pictureWidth = header.width = 7;
    header.pictureHeight = header.height = 5;
    // protocol_fuzz takes 1 + 7 by 1 + 5 pixels to be coded.
    std::vector<std::uint8_t> rgb(8 * 6 * 3), payload;
    for (std::size_t n = 0; n < rgb.size(); ++n)
        rgb[n] = std::uint8_t(n * n);
    protocol::appendTileHeader(payload, header);
    const auto coded = protocol::encodeLossless(rgb, 8, 6);
    payload.insert(payload.end(), coded.begin(), coded.end());
    writeFrame(folder / "tile", protocol::FrameType::tile, payload);
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 2) {
        std::fprintf(stderr, "usage: write_seeds OUT\n");
        return 2;
    }
    const fs::path out = argv[1];
    writeDicom(out / "dicom_fuzz");
    writeNiftis(out / "nifti_fuzz");
    writeFrames(out / "protocol_fuzz");
}
