// Reasons to doubt the course that was found which the search itself cannot see: it compares only
// the courses that it has generated.
#pragma once

#include "core/colon_record.h"

#include <vector>

namespace haustra::segmentation {

/// The ways in which courses are known to be wrong, each with the probability that this one is.
///
/// The weights of chains tell how sure one is among those that were weighed. They cannot tell that
/// the true one was not among them, as where a loop shows neither gas nor tagging. What gives it
/// away: the way across a collapse is long (even odds at 75 mm), no longer than two walls that
/// touch, or leads to quite another calibre; the course ends where no cecum lies; a
/// part of the colon is far shorter than in anyone; gas was left out, the more and the nearer the
/// likelier; a wall looked open or had to be set up; untagged fluid hides what lies beneath;
/// the scan's edge cuts the colon, whose limbs then look like the ends of a collapse; a part of the
/// colon is joined to nothing; a mask that was given lies in soft tissue.
/// Counted on wild phantoms, at 1.4 to 2 mm (seeds 1, 2 and 7 to 14: of 24 ways under 60 mm 7
/// passed a loop by, 4 of them between unlike calibres) and at full size (seeds 1 to 8: of ways of
/// 40 to 65 mm none, of four over 70 mm two): METHODS §3 "Segmentation". The odds of two
/// walls (15 %), of the end (40 %), of a cut (50 %) and of what is joined to nothing (90 %) are
/// judged, not counted. The parts' least lengths are a third of the usual ones (Gray's Anatomy:
/// sigmoid 40 cm, descending 25, transverse 50, ascending 20).
std::vector<Doubt> doubtsOf(const ColonRecord& record);

/// Whether a tenth and more of the mask in which the colon was found is as bright as soft tissue:
/// more than levels and a person's drawing make.
bool isAnothersMask(const ColonRecord& record);

/// That the course is right, given that the chain is with `chainConfidence`: doubts are
/// independent.
double courseConfidence(double chainConfidence, const std::vector<Doubt>& doubts);

}  // namespace haustra::segmentation
