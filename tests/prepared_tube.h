// A scan of a bent tube and its mask in files, and what prepare makes of them.
#pragma once

#include "nifti/nifti_file.h"
#include "pipeline/prepare.h"
#include "store/products.h"
#include "temporary_folder.h"

#include <cmath>
#include <fstream>
#include <iterator>
#include <map>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::pipeline {

namespace fs = std::filesystem;

inline std::string content(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void overwrite(const fs::path& file, const std::string& bytes) {
    fs::create_directories(file.parent_path());
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

// A bent tube of air in soft tissue, and its mask.
constexpr glm::ivec3 tubeSize{48, 40, 90};

inline Volume<std::uint8_t> tubeMask(double radiusMm, std::uint8_t label = 1) {
    Volume<std::uint8_t> mask(axisAlignedGrid(tubeSize, {0.8, 0.8, 1.2}, {-20.0, 5.0, -300.0}));
    for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n) {
        const glm::ivec3 v = mask.grid().voxelAt(n);
        const glm::dvec2 axis(24.0 + 8.0 * std::sin(v.z * 0.06), 20.0);
        const bool inside =
            0.8 * glm::distance(glm::dvec2(v), axis) < radiusMm && v.z > 4 && v.z < 85;
        mask.writable()[n] = inside ? label : 0;
    }
    return mask;
}

class Prepare : public testing::Test {
protected:
    void SetUp() override {
        ASSERT_TRUE(nifti::writeNifti(maskFile(), tubeMask(6.0)));
        writeScan(6.0);
    }

    void writeScan(double radiusMm) const {
        const auto mask = tubeMask(radiusMm);
        Volume<std::int16_t> ct(mask.grid());
        for (std::size_t n = 0; n < mask.grid().voxelCount(); ++n) {
            ct.writable()[n] = mask[n] ? -1000 : std::int16_t(40 + n % 7);
        }
        ASSERT_TRUE(nifti::writeNifti(ctFile(), ct));
    }
    fs::path ctFile() const { return folder_ / "ct.nii.gz"; }
    fs::path maskFile() const { return folder_ / "mask.nii.gz"; }
    store::CaseStore store(const std::string& name = "store") const {
        return store::CaseStore::open(folder_ / name, true).value();
    }
    PrepareOptions options() const {
        PrepareOptions options;
        options.series = ctFile();
        options.lumenMask = maskFile();
        return options;
    }
    // Runs it and gives which stages were reused.
    std::map<std::string, bool> reused(const PrepareOptions& options) const {
        const auto report = prepare(store(), "tube", options);
        EXPECT_TRUE(report) << describe(report.error());
        std::map<std::string, bool> stages;
        if (report) {
            for (const StageReport& stage : report->stages)
                stages[stage.stage] = stage.reused;
        }
        return stages;
    }
    static std::map<std::string, std::string> bytesOf(const store::Case& source) {
        std::map<std::string, std::string> bytes;
        const auto entries = source.products().value();
        for (const auto& entry : entries) {
            bytes[entry.product + " " + entry.key.hex] = content(source.folder() / entry.file);
        }
        return bytes;
    }

    using Stages = std::map<std::string, bool>;
    static Stages all(bool reused, const std::vector<std::string>& stages = stageNames()) {
        Stages result;
        for (const std::string& stage : stages)
            result[stage] = reused;
        return result;
    }
    static Stages redone(const std::vector<std::string>& stages) {
        Stages result = all(true);
        for (const std::string& stage : stages)
            result[stage] = false;
        return result;
    }
    static std::string stageOf(const std::string& product) {
        return store::catalogue().find(product)->stage;
    }
    const tests::TemporaryFolder temporary_;
    const fs::path folder_ = temporary_.path();
};

}  // namespace haustra::pipeline
