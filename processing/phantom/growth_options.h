// What may grow on a patient's colon beyond what a preset gives it, for polyp detection to learn
// from and to be judged by.
#pragma once

namespace haustra::phantom {

/// Each member adds one thing; the defaults add nothing, and what one adds is drawn from random
/// numbers of its own.
///
/// Where the ranges come from: sessile lesions are as high as a half to nearly all of their width,
/// flat ones (Paris 0-IIa) at most 2.5 mm, the closed cups of a biopsy forceps, or less than half
/// their width, those that spread sideways often wider than 10 mm, with sides that slope
/// (Endoscopic Classification Review Group, Endoscopy 2005; 37: 570); most adenomas have about the
/// wall's density without contrast medium in the blood; stool without tagging is mottled with gas
/// (Pickhardt & Kim, Radiographics 2009); film.h tells where films come from.
struct GrowthOptions {
    /// Of all polyps the share that is no denser inside than outside, 0…1.
    double plainCores = 0.0;
    /// More polyps of 4…15 mm, of all kinds and more shapes than the presets', 0…40; fewer where
    /// there is no room.
    int morePolyps = 0;
    /// More lumps of stool that took no tagging, 5…12 mm, 0…40.
    int moreUntaggedStool = 0;
    /// More flat lesions, 6…18 mm wide and 1…2.5 mm high, whose sides go over into the wall over
    /// 0.8 to 3.5 mm, 0…40; fewer where there is no room.
    int moreFlat = 0;
    /// Of all growths that are not stool the share over which a film of tagged residue lies, 0…1.
    double coated = 0.0;
    /// Films of tagged residue on the bare wall, 8…22 mm wide, 0…40; fewer where there is no room.
    int films = 0;
    /// How much denser or, below 0, less dense than the wall polyps are, HU, −60…60: its mean, and
    /// its deviation from polyp to polyp, 0…30 (normal). Benign ones have 32 HU in the mean without
    /// contrast medium and 79 with it (Oto et al., Eur Radiol 2003; 13: 1657).
    double polypHu = 0.0, polypSdHu = 0.0;
};

}  // namespace haustra::phantom
