// Pictures that programs wrote, read back and compared.
#pragma once

#include "core/image.h"
#include "pictures/picture_file.h"

#include <algorithm>
#include <cstdlib>
#include <string>

#include <gtest/gtest.h>

namespace haustra::tests {

/// The file's pixels; a failure of the test, and no pixels, where it is no PNG, TIFF or JPEG
/// picture.
inline Image readPicture(const std::string& file) {
    const auto read = pictures::readColorPicture(file, 1 << 20);
    if (!read) {
        ADD_FAILURE() << describe(read.error());
        return {};
    }
    Image image = blankImage(read->size);
    for (std::size_t i = 0; i < read->pixels.size(); ++i)
        for (int c = 0; c < 3; ++c)
            image.rgb[3 * i + std::size_t(c)] = read->pixels[i][c];
    return image;
}

/// Bytes that differ between pictures of one size.
inline std::size_t differingBytes(const Image& a, const Image& b) {
    EXPECT_EQ(a.rgb.size(), b.rgb.size());
    std::size_t differing = 0;
    for (std::size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); ++i)
        differing += a.rgb[i] != b.rgb[i];
    return differing;
}

/// By OpenImageIO's idiff: no pixel of one differs from the other's, whatever the files' formats.
inline testing::AssertionResult samePicture(const std::string& a, const std::string& b) {
    const std::string command = "idiff -fail 0 '" + a + "' '" + b + "'";
    if (std::system(command.c_str()) == 0) return testing::AssertionSuccess();
    return testing::AssertionFailure() << command << " tells a difference";
}

}  // namespace haustra::tests
