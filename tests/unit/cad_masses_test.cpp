// Findings on the lobes of one mass are told to be so; polyps that are merely near are not.
#include "cad/masses.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

using namespace haustra;

namespace {

Finding findingAt(glm::dvec3 positionMm, double diameterMm) {
    Finding finding;
    finding.positionMm = positionMm;
    finding.diameterMm = diameterMm;
    return finding;
}

// Lobes side by side on a circle.
std::vector<Finding> ring(int lobes, double ringRadiusMm, double diameterMm) {
    std::vector<Finding> findings;
    for (int n = 0; n < lobes; ++n) {
        const double angle = 6.283185307179586 * n / lobes;
        findings.push_back(
            findingAt({40.0 + ringRadiusMm * std::cos(angle), ringRadiusMm * std::sin(angle), -7.0},
                      diameterMm));
    }
    return findings;
}

TEST(Masses, LobesSideBySideAreOneAsWideAsAllOfThem) {
    const auto masses = cad::massesOf(ring(6, 12.0, 11.0));  // centres 12 mm apart
    ASSERT_EQ(masses.size(), 1u);
    EXPECT_EQ(masses[0].findings, (std::vector<std::size_t>{0, 1, 2, 3, 4, 5}));
    EXPECT_NEAR(masses[0].widthMm, 24.0 + 11.0, 1e-9);
}

TEST(Masses, WhatGoesAllAroundIsNoLobe) {
    // Its centre is the lumen's, and its diameter its length, so that it would reach both others.
    auto findings = ring(2, 20.0, 10.0);
    findings.push_back(findingAt({40.0, 0.0, -7.0}, 60.0));
    EXPECT_EQ(cad::massesOf(findings).size(), 1u);
    findings.back().kind = annularKind;
    EXPECT_TRUE(cad::massesOf(findings).empty());
}

TEST(Masses, AGapWiderThanAllowedParts) {
    // Rims are 12 − diameter apart: 2.9 mm, then 3.1.
    EXPECT_EQ(cad::massesOf(ring(6, 12.0, 9.1)).size(), 1u);
    EXPECT_TRUE(cad::massesOf(ring(6, 12.0, 8.9)).empty());
}

TEST(Masses, TwoPolypsOrSmallOnesTogetherAreNone) {
    EXPECT_TRUE(cad::massesOf(ring(2, 8.0, 16.0)).empty());
    EXPECT_TRUE(cad::massesOf(ring(3, 5.0, 6.0)).empty());  // 15 mm in all
    EXPECT_TRUE(cad::massesOf({}).empty());
}

TEST(Masses, OrderAndOtherFindingsChangeNothing) {
    auto findings = ring(5, 10.0, 10.0);
    const auto other = ring(4, 14.0, 18.0);
    for (Finding each : other) {
        each.positionMm.x += 200.0;
        findings.push_back(each);
    }
    findings.push_back(findingAt({100.0, 0.0, 0.0}, 8.0));
    const auto masses = cad::massesOf(findings);
    ASSERT_EQ(masses.size(), 2u);
    std::ranges::reverse(findings);
    const auto reversed = cad::massesOf(findings);
    ASSERT_EQ(reversed.size(), 2u);
    EXPECT_EQ(reversed[0].widthMm, masses[1].widthMm);
    EXPECT_EQ(reversed[1].widthMm, masses[0].widthMm);
    EXPECT_EQ(reversed[1].findings, (std::vector<std::size_t>{5, 6, 7, 8, 9}));
}

}  // namespace
