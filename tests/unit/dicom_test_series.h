// Small synthetic CT series for the DICOM tests.
#pragma once

#include "core/ct_scan.h"
#include "dicom/write_series.h"
#include "temporary_folder.h"

#include <cmath>
#include <filesystem>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra::tests {

/// Every voxel differs from its neighbours, and the whole range of HU occurs.
inline CtScan patternScan(const Grid& grid, PatientPosition position = PatientPosition::supine) {
    CtScan scan{Volume<std::int16_t>(grid), position};
    std::uint32_t state = 12345;
    for (std::int16_t& hu : scan.hu.writable()) {
        state = state * 1664525u + 1013904223u;
        hu = std::int16_t(state >> 16);
    }
    return scan;
}

inline Grid smallGrid() {
    return axisAlignedGrid({17, 12, 24}, {0.7, 0.8, 1.25}, {-30, 12.5, -71});
}

/// Rotation about the z, then the x axis.
inline glm::dmat3 rotation(double aboutZ, double aboutX) {
    const glm::dmat3 z(std::cos(aboutZ), std::sin(aboutZ), 0, -std::sin(aboutZ), std::cos(aboutZ),
                       0, 0, 0, 1);
    const glm::dmat3 x(1, 0, 0, 0, std::cos(aboutX), std::sin(aboutX), 0, -std::sin(aboutX),
                       std::cos(aboutX));
    return x * z;
}

inline Grid rotated(Grid grid, const glm::dmat3& by) {
    grid.patientFromVoxel = glm::dmat4(by) * grid.patientFromVoxel;
    return grid;
}

inline void write(const std::filesystem::path& folder, const CtScan& scan,
                  const std::string& seed = "test") {
    dicom::WriteOptions options;
    options.uidSeed = seed;
    options.seriesDescription = seed;
    const auto written = dicom::writeSeries(folder, scan, options);
    ASSERT_TRUE(written) << describe(written.error());
}

}  // namespace haustra::tests
