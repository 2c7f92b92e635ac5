// NIfTI files for tests: patterns on oblique grids, and files written byte by byte.
#pragma once

#include "nifti/nifti_file.h"
#include "temporary_folder.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include <gtest/gtest.h>
#include <unistd.h>

namespace haustra {

namespace fs = std::filesystem;
/// A folder of its own for every test.
class Nifti : public testing::Test {
protected:
    const tests::TemporaryFolder temporary;
    const fs::path folder = temporary.path();
};

inline Grid obliqueGrid(glm::ivec3 size) {
    // Orthogonal, turned about z and x, left-handed.
    const double c = std::cos(0.4), s = std::sin(0.4), d = std::cos(-0.7), e = std::sin(-0.7);
    Grid grid;
    grid.size = size;
    grid.patientFromVoxel = glm::dmat4(0.75 * c, 0.75 * s * d, 0.75 * s * e, 0,  //
                                       -0.5 * s, 0.5 * c * d, 0.5 * c * e, 0,    //
                                       0, 1.25 * e, -1.25 * d, 0,                //
                                       -101.5, 33.25, -700.0, 1);
    return grid;
}

template <class T>
Volume<T> pattern(const Grid& grid) {
    Volume<T> volume(grid);
    std::uint32_t state = 1;
    for (T& value : volume.writable()) {
        state = state * 1664525u + 1013904223u;
        if constexpr (std::is_floating_point_v<T>)
            value = T(std::ldexp(double(std::int32_t(state)), -20));
        else
            value = T(state >> 13);
    }
    return volume;
}

inline std::vector<char> bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline void put(const fs::path& file, const std::vector<char>& bytes) {
    std::ofstream(file, std::ios::binary).write(bytes.data(), std::streamsize(bytes.size()));
}

/// A .nii file built byte by byte from the standard's offsets, in either byte order.
class HandWritten {
public:
    explicit HandWritten(bool bigEndian = false) : big_(bigEndian), bytes_(352, 0) {
        set<std::int32_t>(0, 348);
        set<float>(108, 352);  // vox_offset
        std::memcpy(bytes_.data() + 344, "n+1", 4);
        for (int axis = 1; axis < 8; ++axis)
            set<std::int16_t>(40 + 2 * axis, 1);
    }
    template <class T>
    void set(int offset, T value) {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), &value, sizeof value);
        if (big_) std::reverse(raw.begin(), raw.end());
        std::copy(raw.begin(), raw.end(), bytes_.begin() + offset);
    }
    void size(int x, int y, int z) {
        set<std::int16_t>(40, 3);
        set<std::int16_t>(42, std::int16_t(x));
        set<std::int16_t>(44, std::int16_t(y));
        set<std::int16_t>(46, std::int16_t(z));
    }
    void spacing(float x, float y, float z) {
        set(80, x);
        set(84, y);
        set(88, z);
    }
    void datatype(int code) { set<std::int16_t>(70, std::int16_t(code)); }
    template <class T>
    void append(T value) {
        const std::size_t at = bytes_.size();
        bytes_.resize(at + sizeof value);
        set(int(at), value);
    }
    const std::vector<char>& bytes() const { return bytes_; }

private:
    bool big_;
    std::vector<char> bytes_;
};

inline HandWritten oneVoxel(int datatype, bool bigEndian = false) {
    HandWritten file(bigEndian);
    file.size(1, 1, 1);
    file.spacing(1, 1, 1);
    file.datatype(datatype);
    return file;
}

}  // namespace haustra
