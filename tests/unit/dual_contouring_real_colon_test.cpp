// The surface of a real lumen with all its handles, islands and cavities.
#include "contouring/dual_contouring.h"
#include "data_folder.h"
#include "handles/self_intersection.h"
#include "label_topology.h"
#include "mesh_laws.h"
#include "nifti/nifti_file.h"

#include <gtest/gtest.h>

namespace haustra {
namespace {

TEST(DualContouringRealColon, HasTheTopologyOfTheMask) {
    HAUSTRA_REAL_DATA(file, "masks/lumen460.nii.gz");
    const auto lumen = nifti::readNifti<std::uint8_t>(file);
    ASSERT_TRUE(lumen) << describe(lumen.error());
    // There are no HU: every crossing is midway, where diagonals are hardest to choose.
    const Volume<std::int16_t> hu(lumen->grid(), 0);
    const auto mesh = contouring::contourLumen(hu, *lumen, -480.0);
    ASSERT_TRUE(mesh) << describe(mesh.error());
    const MeshTopology topology = meshTopology(*mesh);
    EXPECT_TRUE(topology.closed());
    EXPECT_EQ(topology.eulerCharacteristic, 2 * tests::solidEuler(*lumen));
    EXPECT_TRUE(tests::everyVertexHasOneFan(*mesh));
    EXPECT_TRUE(handles::selfIntersections(*mesh).empty());
    double voxels = 0.0;
    for (const std::uint8_t label : lumen->voxels())
        voxels += label != 0;
    const double lumenMm3 = voxels * lumen->grid().voxelVolumeMm3();
    EXPECT_NEAR(tests::signedVolumeMm3(*mesh), lumenMm3, 0.02 * lumenMm3);
}

}  // namespace
}  // namespace haustra
