// The catalogue of Haustra's products. What is to know of a product but how it is made is said
// here: prepare, export, list, the server and their --help read it.
//
// A new product has an entry here, and a stage that publishes it: either one that is there, or one
// of its own in a file of pipeline/, which is declared in pipeline/stages.h and has its turn in
// pipeline/prepare.cpp. Only a new kind of content needs more (store/content.h).
#pragma once

#include "store/catalogue.h"

namespace haustra::store {

namespace product {
inline constexpr char ct[] = "ct", segmentation[] = "segmentation", quality[] = "quality",
                      mixture[] = "mixture", cleansedLumen[] = "cleansed-lumen",
                      cleansed[] = "cleansed", lumen[] = "lumen", distance[] = "distance",
                      centerline[] = "centerline", branches[] = "branches", surface[] = "surface",
                      flatMap[] = "flatmap", edits[] = "edits", flatImage[] = "flat-image";
}  // namespace product

/// By the order in which they are made.
inline const Catalogue& catalogue() {
    using namespace product;
    static const std::vector<std::string> volume{".nii.gz", ".nii"};
    static const Catalogue products({
        {.name = ct,
         .stage = "import",
         .content = Content::int16Volume,
         .endings = volume,
         .help = "the scan as it came (int16, HU)",
         .shown = true},
        {.name = segmentation,
         .stage = "segmentation",
         .content = Content::uint8Volume,
         .parents = {ct},
         .endings = volume,
         .help =
             "the lumen as the organ's profile finds it, or as the mask says (uint8: 0 outside, "
             "1 air, 2 tagged, 3 bridge over a collapse, 4 fluid without tagging)"},
        {.name = quality,
         .stage = "segmentation",
         .content = Content::text,
         .parents = {ct},
         .endings = {".json"},
         .help = "of a colon: how sure it is, piece by piece, and where to look",
         .shown = true},
        {.name = mixture,
         .stage = "mixture",
         .content = Content::fractionsVolume,
         .parents = {ct, segmentation},
         .endings = volume,
         .help = "the tissues in each voxel (4-D uint8: air, soft tissue, tagged, in 255ths)"},
        {.name = cleansedLumen,
         .stage = "cleansing",
         .content = Content::uint8Volume,
         .parents = {ct, segmentation, mixture},
         .endings = volume,
         .help = "the lumen once the tagging is taken out (uint8, as segmentation)"},
        {.name = cleansed,
         .stage = "cleansing",
         .content = Content::int16Volume,
         .parents = {ct, segmentation, mixture},
         .endings = volume,
         .help = "the scan with air in the tagging's place (int16, HU)",
         .shown = true},
        // Of an organ that is cleansed from the one, else from the other.
        {.name = lumen,
         .stage = "denoising",
         .content = Content::uint8Volume,
         .parents = {segmentation, cleansedLumen},
         .endings = volume,
         .help = "the lumen with the organ's topology: a colon without handles (uint8, as "
                 "segmentation)"},
        {.name = distance,
         .stage = "distance",
         .content = Content::floatVolume,
         .parents = {lumen},
         .endings = volume,
         .help = "the distance to the lumen's boundary, 0 outside (float, mm)"},
        {.name = centerline,
         .stage = "centerline",
         .content = Content::centerline,
         .parents = {quality, lumen, distance},
         .endings = {".csv"},
         .help = "the path through the lumen, from the rectum to the cecum "
                 "(x_mm,y_mm,z_mm,arc_mm,radius_mm,gap in LPS)",
         .shown = true},
        {.name = branches,
         .stage = "centerline",
         .content = Content::centerline,
         .parents = {quality, lumen, distance},
         .endings = {".csv"},
         .help =
             "of an organ that branches: paths as centerline, one after the other, each from an "
             "arc of 0 on"},
        // The wall stands in the scan, cleansed or not, at the HU that the segmentation found.
        {.name = surface,
         .stage = "surface",
         .content = Content::mesh,
         .parents = {ct, segmentation, cleansed, lumen},
         .endings = {".ply", ".obj", ".off", ".stl"},
         .help = "the lumen's closed surface (LPS, mm)",
         .shown = true},
        {.name = flatMap,
         .stage = "flattening",
         .content = Content::flatMap,
         .parents = {centerline, surface},
         .endings = {".obj", ".ply"},
         .help = "of an organ that is a tube: the surface, cut open, on the plane: .obj (vt: flat "
                 "coordinates in circumferences) or .ply (s, t, and of each vertex the camera on "
                 "the centerline that sees it, its index and arc_mm, and of each face whether it "
                 "encloses a bridge)",
         .shown = true},
        // The next segmentation is made by it, under a key that holds it; until then what it is to
        // change stands.
        {.name = edits,
         .content = Content::text,
         .endings = {".json"},
         .help = "what a person said of a colon: seeds, excludes, cuts and joins"},
        {.name = flatImage,
         .parents = {ct, cleansed, lumen, flatMap},
         .endings = {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"},
         .help = "the whole flattened wall seen from within, the rectum at the bottom, black where "
                 "the surface crosses air and hatched along bridges"},
    });
    return products;
}

}  // namespace haustra::store
