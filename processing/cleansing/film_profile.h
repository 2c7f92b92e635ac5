// The HU across a film of tagging between wall and air.
#pragma once

#include <optional>
#include <vector>

namespace haustra::cleansing {

/// What lies before a wall, the wall, the film on it and air, one after the other along a line, and
/// each face between them blurred. Positions along the line in mm, HU in HU.
struct FilmProfile {
    double outerHu = 0.0, softHu = 0.0, taggedHu = 0.0, airHu = 0.0;
    double outerMm = 0.0, wallMm = 0.0, filmMm = 0.0;  ///< where each ends
    double blurMm = 0.5;                               ///< standard deviation
    double misfitHu = 0.0;                             ///< root mean square, once fitted

    /// HU at a place on the line if there were air in the film's place.
    double withoutFilm(double mm) const;
    /// HU that the film adds to withoutFilm().
    double film(double mm) const;
    double thicknessMm() const { return filmMm - wallMm; }
};

/// HU at equal steps along a line, the crest of a film in the middle.
struct LineSamples {
    double strideMm = 0.25;
    std::vector<double> hu;  ///< an odd number

    int middle() const { return int(hu.size()) / 2; }
    double mm(int n) const { return (n - middle()) * strideMm; }
};

/// Fits the places of the three faces, and the tagging's HU near `start.taggedHu`, by least squares
/// (Levenberg and Marquardt). `start` gives the HU and the blur. The fit begins with faces that are
/// read off the samples: past the crest the HU fall to air, before it to the wall's, or, where the
/// wall is thin, to those of what lies beyond it. Nothing where the HU do not fall so within
/// `thickestMm` of the crest, or no film explains the samples. About 10 µs.
std::optional<FilmProfile> fitFilm(const LineSamples& samples, const FilmProfile& start,
                                   double noiseSd, double thickestMm);

}  // namespace haustra::cleansing
