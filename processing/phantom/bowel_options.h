// What a patient's bowel may have beyond what a preset gives it.
#pragma once

#include <vector>

namespace haustra::phantom {

/// Each member adds one thing; the defaults add nothing, and what one adds is drawn from random
/// numbers of its own, so that it leaves the rest of the patient as it was (a longer sigmoid moves
/// its neighbours, as it must).
///
/// Where the ranges come from: a colon of 189.5 ± 26.3 cm with 10.9 ± 2.4 acute flexures at CT
/// colonography (Khashab et al., Endoscopy 2009; 41: 674); a small bowel of at most 30 mm, ileum
/// the narrower part (the "3-6-9" rule of abdominal radiographs); a distended colon's wall of less
/// than 3 mm and, where two loops press on each other, hardly more than the mucosae; a valve of
/// 28 mm by 17 mm at barium enema (88 normal valves, PubMed 12601195), labial with a slit or
/// papillary (Silva et al., RadioGraphics 2007; 27: 1039); diverticula of 5 to 10 mm, most of them
/// in the sigmoid, none in the rectum.
struct BowelOptions {
    /// Length of the gas-filled ileum, mm; 0: none, and no ileocecal valve. It leaves the cecum
    /// through the valve and runs along the colon, wall to wall, for most of its way.
    double ileumMm = 0.0;
    double ileumCalibreMm = 20.0;  ///< inner diameter, 12…30 mm
    bool valveOpen = false;        ///< gas passes between the valve's lips
    /// Least tissue between the lumens of two loops of colon, and of colon and ileum, mm.
    double septumMm = 3.2;
    /// Lengths of the stretches where the lumen is closed, mm, 5…60, which come true to a few
    /// millimetres (Structure has what they came to); empty: the preset's (`hard` has one).
    std::vector<double> collapsesMm;
    double redundantSigmoidMm = 0.0;  ///< how much longer the sigmoid is, 0…400 mm
    /// Of the fluid's pools: the share that took no tagging at all, the share in which water stands
    /// over tagged sediment, and the share that is as full as gravity lets it be, so that some
    /// stretches have fluid up to their roof. 0…1.
    double untagged = 0.0, layered = 0.0, full = 0.0;
    int diverticula = 0;
    /// Without insufflation the colon is a cord of muscle with a few bubbles of gas and, on the
    /// right, stool: what an abdominal CT shows that is no colonography.
    bool insufflated = true;
    bool rectalTube = false;  ///< with an inflated balloon above the anus
};

}  // namespace haustra::phantom
