// How noisy the scan is in gas, in soft tissue and in tagged contents.
#pragma once

#include "core/ct_scan.h"
#include "core/tissue.h"

namespace haustra::cleansing {

/// Standard deviation of one voxel's HU, 4…100. They differ: HU end at −1024, which cuts off the
/// noise of gas, and dense contents cast more of it.
struct NoiseSd {
    double gas = 0.0, soft = 0.0, tagged = 0.0;
};

/// Second differences (a − 2b + c)/√6 of voxels about 2.4 mm apart, beyond the noise's grain, along
/// the rows and columns: free of what changes linearly. All three must lie deeper inside one
/// material than the blur reaches (1.6 mm), so that no partial volume is read as noise; what is
/// farther out than four standard deviations is structure. Gas and tagging are what `segmentation`
/// (LumenLabel) says; soft tissue counts within 6 mm of tagging. A material with too little to
/// measure takes another's. The box of a scan that holds what is within 20 mm of the labels will
/// do. O(voxels); the same for any number of threads.
NoiseSd measureNoise(const CtScan& scan, const TissueModel& tissue,
                     const Volume<std::uint8_t>& segmentation, int threads);

}  // namespace haustra::cleansing
