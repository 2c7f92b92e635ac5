// Balances of readers whose pictures come mixed, in bands, and unfinished.
#include "render/hybrid/reader_balances.h"

#include <array>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using namespace render;

/// Where split 6 is best, and where the lowest is.
constexpr std::array<double, 9> better = {100, 95, 90, 80, 70, 60, 50, 60, 80};
constexpr std::array<double, 9> worse = {40, 90, 120, 120, 120, 120, 120, 120, 120};

int splitOf(const HybridControls& controls) {
    for (std::size_t split = 0; split < hybridSplits.size(); ++split)
        if (hybridSplits[split] == controls) return int(split);
    return -1;
}

CameraView viewAt(double x) {
    return {{{x, 0.0, 0.0}, {0.0, 0.0, 1.0}, {0.0, -1.0, 0.0}, 90.0}, {}, {}};
}

Optics otherOptics() {
    Optics optics;
    optics.shading = !optics.shading;
    return optics;
}

struct Reader {
    CameraView view;
    const std::array<double, 9>* costMs;
    glm::ivec2 size{64, 48};
    int split = 0;  // of the last band
};

/// One band, whose share of the picture's cost is that of its rows.
void draw(ReaderBalances& balances, Reader& reader, int firstRow, int rows) {
    const Band band{reader.size, firstRow, rows};
    reader.split = splitOf(balances.controls(reader.view, band, 0.5));
    const double ms = (*reader.costMs)[std::size_t(reader.split)] * rows / reader.size.y;
    balances.drew(0.5 * ms, 0.5 * ms, ms);
}

void drawWhole(ReaderBalances& balances, Reader& reader) {
    draw(balances, reader, 0, reader.size.y);
}

TEST(ReaderBalances, ReadersWhosePicturesTakeTurnsEachFindTheirPlace) {
    Reader one{viewAt(0.0), &better}, other{viewAt(300.0), &worse}, third{viewAt(0.0), &better};
    third.view.optics = otherOptics();
    ReaderBalances balances(60.0);
    int ones = 0, others = 0, thirds = 0;
    for (int i = 0; i < 1200; ++i) {
        for (Reader* reader : {&one, &other, &third}) {
            reader->view.camera.positionMm.y = 0.05 * i;  // they fly
            drawWhole(balances, *reader);
        }
        ones += i >= 600 && one.split == 6;
        others += i >= 600 && other.split == 0;
        thirds += i >= 600 && third.split == 6;
    }
    EXPECT_GE(ones, 400);
    EXPECT_GE(others, 400);
    EXPECT_GE(thirds, 400);
}

TEST(ReaderBalances, BandsOfOnePictureAreDrawnAlikeAndCountOnce) {
    Reader whole{viewAt(0.0), &better}, banded = whole, beside{viewAt(300.0), &worse};
    ReaderBalances alone(60.0), mixed(60.0);
    for (int i = 0; i < 400; ++i) {
        drawWhole(alone, whole);
        std::vector<int> splits;
        for (int row = 0; row < 48; row += 16) {
            draw(mixed, banded, row, 16);
            splits.push_back(banded.split);
            draw(mixed, beside, row, 16);
        }
        EXPECT_EQ(splits, std::vector<int>(3, whole.split)) << "picture " << i;
    }
    EXPECT_EQ(whole.split, 6);
}

TEST(ReaderBalances, PicturesLeftUnfinishedTellNothing) {
    Reader reader{viewAt(0.0), &better};
    ReaderBalances balances(60.0);
    for (int i = 0; i < 400; ++i) {
        draw(balances, reader, 0, 16);
        reader.view.camera.positionMm.z += 0.01;
        draw(balances, reader, 16, 16);  // of a picture that was never begun
        draw(balances, reader, 32, 16);
        EXPECT_EQ(reader.split, 0);
    }
}

TEST(ReaderBalances, KnowsTheSameColoursElsewhereAndNotOthers) {
    Reader reader{viewAt(0.0), &better};
    ReaderBalances balances(60.0);
    const auto restsOn = [&] {  // but where another split is just being asked
        int most = 0;
        std::array<int, 9> drawn{};
        for (int i = 0; i < 600; ++i) {
            drawWhole(balances, reader);
            if (i >= 300 && ++drawn[std::size_t(reader.split)] > drawn[std::size_t(most)])
                most = reader.split;
        }
        return most;
    };
    EXPECT_EQ(restsOn(), 6);
    reader.view.camera.positionMm.x = 500.0;
    drawWhole(balances, reader);
    EXPECT_EQ(reader.split, 6);
    reader.size = {32, 24};
    drawWhole(balances, reader);
    EXPECT_EQ(reader.split, 6);
    const Optics before = reader.view.optics;
    reader.view.optics = otherOptics();
    reader.costMs = &worse;
    drawWhole(balances, reader);
    EXPECT_EQ(reader.split, 0);
    EXPECT_EQ(restsOn(), 0);
    reader.view.optics = before;
    reader.costMs = &better;
    drawWhole(balances, reader);
    EXPECT_EQ(reader.split, 6);
}

TEST(ReaderBalances, FollowsEveryColourThatIsTriedWithoutHarm) {
    // A transfer function that is dragged: no picture has the last one's colours.
    Reader reader{viewAt(0.0), &worse};
    ReaderBalances balances(60.0);
    for (int i = 0; i < 100; ++i) {
        reader.view.optics.light.ambient = 0.001 * i;
        drawWhole(balances, reader);
        EXPECT_EQ(reader.split, 0);
    }
}

}  // namespace
}  // namespace haustra::tests
