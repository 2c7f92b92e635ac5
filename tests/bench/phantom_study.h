// One phantom taken through every stage up to the surface, and scored against its truth.
#pragma once

#include "core/tri_mesh.h"
#include "phantom/cleansing_score.h"
#include "phantom/colon_score.h"
#include "phantom/score.h"
#include "phantom/surface_score.h"
#include "topology/handle_cutting.h"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace haustra::bench {

struct PhantomStudy;

struct StudyOptions {
    phantom::PhantomOptions phantom;
    std::vector<double> errorBoundsMm = {0.05, 0.1, 0.2};
    bool colon = true;  ///< surface and flattening as prepare makes them
    bool cleansing = true;
    bool onlySegmentation = false;  ///< the path through the segmentation's own lumen; no flat map
    bool surface = true;            ///< the surface against the true one
    double prepareErrorMm = 0.1;    ///< bound of the surface that is flattened
    std::filesystem::path out;  ///< for the cleansed scan, the lumen and the meshes; empty: none
    std::function<void(const std::string&)> log;
    std::function<void(const PhantomStudy&)> beforeFlattening;  ///< which may take long; or empty
};

/// Of each triangle's smallest angle, degrees.
struct SmallestAngles {
    double least = 0.0, p1 = 0.0, median = 0.0;
    double shareBelow10 = 0.0;
};

struct SurfaceStudy {
    std::string what;  ///< which surface: "fine", "0.10 mm" …
    std::size_t triangles = 0;
    MeshTopology topology;
    std::size_t selfIntersections = 0;
    SmallestAngles angles;
    phantom::SurfaceScore score;
    double seconds = 0.0;  ///< to make it
};

/// What the later stages made of the colon that was found.
struct ColonStudy {
    phantom::ColonScore score;
    double confidence = 0.0;  ///< of the quality record
    std::size_t warnings = 0;
    std::size_t flips = 0;
    std::string failed;  ///< the stage that failed, and why; empty: none
    double surfaceSeconds = 0, flatteningSeconds = 0;
};

struct PhantomStudy {
    double noiseSdHu = 0.0, airBelowHu = 0.0;
    double lumenMl = 0.0, lengthMm = 0.0;
    phantom::LumenScore segmentation, lumen;  ///< before cleansing, and after denoising
    phantom::CleansingScore cleansing;
    topology::DigitalTopology before, after;
    topology::CutLumen cut;  ///< its labels moved out
    std::vector<SurfaceStudy> surfaces;
    ColonStudy colon;
    double phantomSeconds = 0, segmentationSeconds = 0, mixtureSeconds = 0, cleansingSeconds = 0,
           denoisingSeconds = 0, centerlineSeconds = 0;
};

/// Fails with the first stage that does; of centerline, surface and flattening the study tells that
/// they failed.
Result<PhantomStudy> studyPhantom(const StudyOptions& options);

/// Everything about one mesh but how it was made.
Result<SurfaceStudy> studySurface(std::string what, const TriMesh& mesh,
                                  const phantom::TrueSurface& truth, int threads);

}  // namespace haustra::bench
