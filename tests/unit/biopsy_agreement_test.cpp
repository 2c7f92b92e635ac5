// What detection sees beneath the wall, and what a reader is shown there, are one thing.
#include "cad/biopsy.h"
#include "cad/biopsy_transfer.h"
#include "cad/wall_evidence.h"
#include "render/optics/optics_presets.h"
#include "render/optics/transfer_table.h"

#include <gtest/gtest.h>

namespace haustra {
namespace {

TEST(BiopsyAgreement, ThePresetIsDetectionsFixedTransferFunction) {
    const auto preset = render::opticsPreset("biopsy");
    ASSERT_TRUE(preset);
    EXPECT_EQ(preset->transferFunction, cad::fixedBiopsyTransfer());
    EXPECT_EQ(preset->composition, Composition::emissionAbsorption);
    EXPECT_FALSE(preset->shading) << "the picture is of the tissue, not of a lamp";
}

TEST(BiopsyAgreement, AStepOfADetectionRayIsAStepOfARaycaster) {
    for (const TransferFunction& transfer :
         {cad::fixedBiopsyTransfer(), cad::automaticBiopsyTransfer({55.0, -85.0, 14.0})}) {
        Optics optics = render::opticsPreset("biopsy").value();
        optics.transferFunction = transfer;
        ASSERT_TRUE(checkOptics(optics));
        const cad::BiopsyTable detection(transfer);
        const auto raycaster = render::makeTransferTable(optics, cad::biopsyStepMm);
        for (int hu = -1000; hu <= 400; ++hu) {
            const double entry =
                std::clamp(raycaster.entryOf(hu), 0.0, double(render::TransferTable::entries - 1));
            const glm::vec4& shown = raycaster.rgba[std::size_t(std::lround(entry))];
            const cad::FourFloats seen = detection.at(float(hu));
            ASSERT_NEAR(seen[3], shown.a, 2e-3) << hu;
            for (int c = 0; c < 3; ++c)
                ASSERT_NEAR(seen[c], shown.a * shown[c], 2e-3) << hu;
        }
    }
}

}  // namespace
}  // namespace haustra
