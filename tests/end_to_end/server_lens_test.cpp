// The lens of the real haustra-server: a ninth viewport whose pictures show what lies beneath the
// wall, by colours that a case may have of its own scan.
#include "core/findings.h"
#include "end_to_end/flat_store.h"
#include "end_to_end/server_test_client.h"
#include "protocol/optics_message.h"

#include <numeric>
#include <set>

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

using protocol::ClientMessage;
using protocol::ErrorReport;
using protocol::ServerMessage;

constexpr int side = 64;
constexpr char biopsied[] = "biopsied";

Findings findingsOfScan() {
    Findings findings;
    findings.biopsy = {55.0,
                       -90.0,
                       11.0,
                       {{{-240.0, {0.1, 0.2, 0.95}, 0.0},
                         {20.0, {0.1, 0.85, 0.3}, 0.1},
                         {110.0, {0.95, 0.25, 0.1}, 0.3}}}};
    return findings;
}

class ServerLens : public FlatServer {
protected:
    static void SetUpTestSuite() {
        FlatServer::SetUpTestSuite();
        const auto store = store::CaseStore::open(folder_->path(), false).value();
        const auto plain = store.openCase(smallCaseName).value();
        auto own = store.createCase(biopsied).value();
        const auto key = [](const char* stage) { return store::makeKey(stage, 1, "", {}); };
        const auto ct = plain.readVolume<std::int16_t>("ct").value();
        ASSERT_TRUE(own.publishVolume("ct", key("ct"), ct));
        ASSERT_TRUE(own.publishText("findings", key("cad"), findingsJson(findingsOfScan())));
    }

    std::unique_ptr<TestClient> reader(const std::string& name = smallCaseName) {
        auto client = std::make_unique<TestClient>(server_->port());
        const auto welcome = client->hello();
        EXPECT_TRUE(welcome && welcome->has_welcome());
        const auto& can = welcome->welcome().capabilities();
        EXPECT_NE(std::find(can.begin(), can.end(), "lens"), can.end());
        opened_ = client->openCase(name).value_or(ServerMessage());
        EXPECT_TRUE(opened_.has_case_opened());
        return client;
    }
    static void open(TestClient& client, std::uint64_t sequence, std::uint32_t id, bool lens,
                     protocol::View view = protocol::ENDOSCOPIC) {
        ClientMessage message;
        auto* body = message.mutable_set_viewport();
        body->set_sequence(sequence);
        body->set_viewport(id);
        body->set_view(view);
        body->set_width(side);
        body->set_height(side);
        body->set_lens(lens);
        client.send(message);
    }
    static void choose(TestClient& client, std::uint64_t sequence, std::uint32_t id,
                       const std::string& preset) {
        ClientMessage message;
        auto* body = message.mutable_set_transfer_function();
        body->set_sequence(sequence);
        body->set_viewport(id);
        body->set_preset(preset);
        client.send(message);
    }
    /// The exact picture of a viewport that answers `sequence`.
    static TestPicture still(TestClient& client, int id, std::uint64_t sequence) {
        for (;;) {
            auto picture = client.picture();
            if (!picture) throw std::runtime_error("no picture came");
            if (picture->header.viewport == id && picture->header.sequence >= sequence &&
                picture->header.exact)
                return std::move(*picture);
        }
    }
    static double seen(TestClient& client, std::uint64_t request) {
        ClientMessage message;
        message.mutable_ask_seen()->set_request(request);
        client.send(message);
        for (;;) {
            const auto answer = client.answer();
            if (!answer) throw std::runtime_error("no answer came");
            if (answer->has_wall_seen() && answer->wall_seen().request() == request)
                return answer->wall_seen().share();
        }
    }
    static void expectRefusal(TestClient& client) {
        const auto answer = client.answer();
        ASSERT_TRUE(answer && answer->has_error());
        EXPECT_EQ(answer->error().code(), ErrorReport::BAD_VALUE) << answer->error().message();
        EXPECT_FALSE(answer->error().fatal());
    }
    static double brightness(const TestPicture& picture) {
        return std::accumulate(picture.rgb.begin(), picture.rgb.end(), 0.0) /
               double(picture.rgb.size());
    }

    ServerMessage opened_;
};

TEST_F(ServerLens, NineViewportsAreDrawnAndATenthIsRefused) {
    const auto client = reader();
    std::uint64_t sequence = 0;
    for (std::uint32_t id = 0; id < 9; ++id) {
        open(*client, ++sequence, id, id == 8);
        client->camera(++sequence, id, {0, 0, 10.0 + id}, true);
    }
    // Moving as they are, each comes to rest by itself.
    std::set<int> exact;
    while (exact.size() < 9) {
        const auto picture = client->picture();
        ASSERT_TRUE(picture);
        if (picture->header.exact) exact.insert(picture->header.viewport);
    }
    EXPECT_EQ(*exact.rbegin(), 8);
    open(*client, ++sequence, 9, false);
    expectRefusal(*client);
    open(*client, ++sequence, 1, true, protocol::AXIAL);
    expectRefusal(*client);
}

TEST_F(ServerLens, WhatALensShowsHasNotBeenSeenAndIsNotPainted) {
    const auto client = reader();
    open(*client, 1, 8, true);
    choose(*client, 2, 8, "biopsy");
    client->camera(3, 8, {0, 0, 10}, false);
    const TestPicture plain = still(*client, 8, 3);
    EXPECT_EQ(seen(*client, 1), 0.0);
    ClientMessage paint;
    paint.mutable_set_wall_paint()->set_sequence(4);
    paint.mutable_set_wall_paint()->set_unseen(true);
    client->send(paint);
    client->camera(5, 8, {0, 0, 10}, false);
    EXPECT_EQ(still(*client, 8, 5).rgb, plain.rgb);
    EXPECT_EQ(seen(*client, 2), 0.0);
    // The same viewport as a view of the wall shows it.
    open(*client, 6, 8, false);
    client->camera(7, 8, {0, 0, 10}, false);
    still(*client, 8, 7);
    EXPECT_GT(seen(*client, 3), 0.05);
}

TEST_F(ServerLens, ItsRaysEndBeneathTheWall) {
    const auto client = reader();
    auto shown = [&, sequence = std::uint64_t(0)](bool lens, const char* preset) mutable {
        open(*client, ++sequence, 8, lens);
        choose(*client, ++sequence, 8, preset);
        client->camera(++sequence, 8, {0, 0, 10}, false);
        return still(*client, 8, sequence);
    };
    // Where nothing is seen beneath the wall it is the same picture.
    EXPECT_EQ(shown(true, "mucosa").rgb, shown(false, "mucosa").rgb);
    const TestPicture through = shown(true, "biopsy"), endless = shown(false, "biopsy");
    EXPECT_GT(brightness(through), 5.0);
    EXPECT_NE(through.rgb, endless.rgb);
    EXPECT_LT(brightness(through), brightness(endless));
}

TEST_F(ServerLens, ACaseHasTheColoursOfItsOwnScan) {
    const auto without = reader();
    for (const auto& preset : opened_.case_opened().presets())
        EXPECT_NE(preset.name(), scanBiopsyPreset);
    open(*without, 1, 0, false);
    choose(*without, 2, 0, scanBiopsyPreset);
    expectRefusal(*without);

    const auto client = reader(biopsied);
    const auto& presets = opened_.case_opened().presets();
    const auto found = std::find_if(presets.begin(), presets.end(), [](const auto& preset) {
        return preset.name() == scanBiopsyPreset;
    });
    ASSERT_NE(found, presets.end());
    const auto preset = protocol::presetFrom(*found);
    ASSERT_TRUE(preset) << describe(preset.error());
    EXPECT_EQ(preset->optics.transferFunction, findingsOfScan().biopsy->transferFunction);
    EXPECT_FALSE(preset->optics.shading);
    EXPECT_NE(preset->description.find("55 HU"), std::string::npos);
    // By its name, and by what it is.
    open(*client, 1, 8, true);
    choose(*client, 2, 8, scanBiopsyPreset);
    client->camera(3, 8, {0, 0, 10}, false);
    const TestPicture named = still(*client, 8, 3);
    ClientMessage own;
    own.mutable_set_transfer_function()->set_sequence(4);
    own.mutable_set_transfer_function()->set_viewport(8);
    fill(*own.mutable_set_transfer_function()->mutable_optics(), preset->optics);
    client->send(own);
    EXPECT_EQ(still(*client, 8, 4).rgb, named.rgb);
    choose(*client, 5, 8, "biopsy");
    EXPECT_NE(still(*client, 8, 5).rgb, named.rgb);
}

}  // namespace
}  // namespace haustra::tests
