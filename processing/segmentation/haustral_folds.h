// How folded the wall of each piece of bowel is.
#pragma once

#include "segmentation/tube_pieces.h"

#include <vector>

namespace haustra::segmentation {

/// Of each piece the volume of its folds over the area of its wall, mm; −1 where that is not
/// measured: under a fifth of gas, as bone looks alike, and under 3 ml.
///
/// A fold is what has the same piece's lumen on two opposite sides, no more than 4.5 mm apart along
/// one of 13 directions, and lies 2.5 mm deep at least in the lumen with its folds filled.
/// Semilunar folds of the colon stand in by 3 to 10 mm, 2 to 3 mm thick, every 15 to 40 mm: 0.05 to
/// 0.2 mm in all. Folds of the ileum are lower than 3.5 mm (Herlinger and Maglinte, Clinical
/// Radiology of the Small Intestine, 1989), and a distended one is smooth. `thinWalls` are
/// findThinWalls' for these pieces. The same for any number of threads.
std::vector<double> foldDensityMm(const TubePieces& cut, const Volume<std::uint8_t>& thinWalls,
                                  int threads);

}  // namespace haustra::segmentation
