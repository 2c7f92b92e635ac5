// Which profiles across a dense sheet are those of a film of fluid on a wall.
#include "cleansing/film_profile.h"

#include <cmath>

#include <gtest/gtest.h>

namespace haustra::cleansing {
namespace {

constexpr double airHu = -990.0, softHu = 42.0, taggedHu = 650.0, noiseSd = 12.0;

FilmProfile startFor(double hu) {
    FilmProfile start;
    start.softHu = softHu, start.airHu = airHu, start.taggedHu = hu;
    return start;
}

// Air, a wall, a film on it and air, the profile's crest in the middle.
LineSamples sampled(double wallThickMm, double filmThickMm) {
    FilmProfile truth = startFor(taggedHu);
    truth.outerHu = airHu, truth.outerMm = -wallThickMm, truth.filmMm = filmThickMm;
    const auto huAt = [&](double mm) { return truth.withoutFilm(mm) + truth.film(mm); };
    double crestMm = 0.0;
    for (double mm = -wallThickMm; mm < filmThickMm; mm += 0.01) {
        if (huAt(mm) > huAt(crestMm)) crestMm = mm;
    }
    LineSamples samples;
    for (int n = -16; n <= 16; ++n)
        samples.hu.push_back(huAt(crestMm + n * samples.strideMm));
    return samples;
}

TEST(FilmProfile, AFilmOnAThinWallIsMeasured) {
    for (const double wallThickMm : {1.6, 2.0, 2.4}) {
        const auto film = fitFilm(sampled(wallThickMm, 1.0), startFor(taggedHu), noiseSd, 2.5);
        ASSERT_TRUE(film) << wallThickMm;
        EXPECT_NEAR(film->thicknessMm(), 1.0, 0.1);
        EXPECT_NEAR(film->wallMm - film->outerMm, wallThickMm, 0.3);
    }
}

TEST(FilmProfile, ADenseSheetInAirIsNoFilm) {
    for (const double thickMm : {0.5, 0.8, 1.2, 1.8}) {
        EXPECT_FALSE(fitFilm(sampled(0.0, thickMm), startFor(taggedHu), noiseSd, 2.5)) << thickMm;
    }
}

}  // namespace
}  // namespace haustra::cleansing
