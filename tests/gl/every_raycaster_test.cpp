// The table of raycasters: names and numbers, and that each of them can be made and draws.
#include "core/raycasters.h"
#include "render/raycaster_choice.h"
#include "wall_scene.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <set>
#include <string>

namespace haustra::tests {
namespace {

using namespace render;

TEST(EveryRaycaster, HasANameAndANumberOfItsOwn) {
    std::set<std::string> names;
    std::set<int> numbers;
    std::set<RaycasterKind> kinds;
    for (const RaycasterEntry& entry : raycasters()) {
        EXPECT_TRUE(names.insert(entry.name).second) << entry.name;
        EXPECT_TRUE(numbers.insert(entry.wireId).second) << entry.name;
        EXPECT_TRUE(kinds.insert(entry.kind).second) << entry.name;
        EXPECT_GT(entry.wireId, 0) << entry.name << ": 0 is for \"not told\"";
    }
    EXPECT_FALSE(names.contains(""));
}

TEST(EveryRaycaster, IsFoundByNameAndNumber) {
    for (const RaycasterEntry& entry : raycasters()) {
        const auto named = raycasterFromString(entry.name);
        ASSERT_TRUE(named) << entry.name;
        EXPECT_EQ(*named, entry.kind);
        EXPECT_STREQ(toString(entry.kind), entry.name);
        EXPECT_STREQ(raycasterName(entry.wireId), entry.name);
        EXPECT_NE(raycasterNames().find(entry.name), std::string::npos);
    }
    EXPECT_STREQ(raycasterName(0), "");
    EXPECT_STREQ(raycasterName(255), "");
    const auto unknown = raycasterFromString("fastest");
    ASSERT_FALSE(unknown);
    EXPECT_NE(unknown.error().message.find(raycasterNames()), std::string::npos);
}

// The numbers are a promise to clients of other versions.
TEST(EveryRaycaster, HasTheNumberThatTheProtocolTells) {
    std::ifstream in(std::filesystem::path(std::getenv("HAUSTRA_SOURCE")) / "protocol/PROTOCOL.md");
    const std::string text(std::istreambuf_iterator<char>(in), {});
    for (const RaycasterEntry& entry : raycasters()) {
        const std::string told = std::to_string(entry.wireId) + " `" + entry.name + "`";
        EXPECT_NE(text.find(told), std::string::npos) << told;
    }
}

TEST(EveryRaycaster, IsACandidate) {
    for (const bool software : {true, false}) {
        auto candidates = raycasterCandidates(software);
        std::sort(candidates.begin(), candidates.end());
        EXPECT_EQ(std::unique(candidates.begin(), candidates.end()), candidates.end());
        EXPECT_EQ(candidates.size(), raycasters().size());
    }
}

class EachRaycaster : public Drawing, public testing::WithParamInterface<RaycasterEntry> {};

TEST_P(EachRaycaster, DrawsASmallScene) {
    const Grid grid = obliqueGrid({48, 45, 55}, {0.8, 0.8, 0.8});
    auto prepared = prepareCase(sampled(grid, closedTube), {});
    ASSERT_TRUE(prepared);
    prepared->wall = std::make_shared<const TriMesh>(makeTube(96).wall);
    auto renderer =
        CaseRenderer::upload(*context, std::move(*prepared), {.raycaster = GetParam().kind});
    ASSERT_TRUE(renderer) << describe(renderer.error());
    EXPECT_EQ((*renderer)->raycaster(), GetParam().kind);
    CameraView view;
    view.optics = *opticsPreset("mucosa");
    const auto picture = (*renderer)->render(view, 40, 30);
    ASSERT_TRUE(picture) << describe(picture.error());
    EXPECT_GT(std::count_if(picture->rgb.begin(), picture->rgb.end(), [](int c) { return c > 20; }),
              std::ptrdiff_t(picture->rgb.size() / 2));
}

INSTANTIATE_TEST_SUITE_P(All, EachRaycaster,
                         testing::ValuesIn(raycasters().begin(), raycasters().end()),
                         nameOfRaycaster);

}  // namespace
}  // namespace haustra::tests
