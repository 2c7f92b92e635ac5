// Scripts of the headless client, and the statistics it reports.
#include "reader/latency.h"
#include "reader/pacing.h"
#include "script/report.h"
#include "script/script.h"

#include <algorithm>
#include <cmath>
#include <random>
#include <sstream>

#include <gtest/gtest.h>

namespace haustra::reader {
namespace {

Result<std::vector<Action>> parse(const std::string& text) {
    std::istringstream in(text);
    return parseScript(in, "tour.jsonl");
}

TEST(Script, PaintsTheWallWithinBounds) {
    const auto actions = parse(R"({"do":"paint","marks":true,"radius_mm":8})"
                               "\n"
                               R"({"do":"paint","unseen":true})"
                               "\n"
                               R"({"do":"seen","forget":true,"json":"seen.json"})");
    ASSERT_TRUE(actions) << describe(actions.error());
    const WallPaintChoice marks = std::get<PaintAction>((*actions)[0].body).paint;
    EXPECT_TRUE(marks.marks && !marks.unseen);
    EXPECT_EQ(marks.markRadiusMm, 8.0);
    const WallPaintChoice unseen = std::get<PaintAction>((*actions)[1].body).paint;
    EXPECT_TRUE(unseen.unseen && !unseen.marks);
    EXPECT_TRUE(std::get<SeenAction>((*actions)[2].body).forget);
    EXPECT_EQ(std::get<SeenAction>((*actions)[2].body).json, "seen.json");
    for (const char* bad : {R"({"do":"paint","radius_mm":21})", R"({"do":"paint","marks":1})",
                            R"({"do":"seen","png":"a.png"})"})
        EXPECT_FALSE(parse(bad)) << bad;
}

TEST(Script, AsksWhatHasBeenSeenAndMissedWithinBounds) {
    const auto actions = parse(R"({"do":"seen-limits","pixels_per_mm":2,"least_ms":0}
        {"do":"seen-limits"}
        {"do":"missed","least_mm2":50,"json":"missed.json"}
        {"do":"next-missed","step":-1}
        {"do":"ledger","json":"ledger.json"}
        {"do":"seen-report"}
        {"do":"fly","hold_ms":40})");
    ASSERT_TRUE(actions) << describe(actions.error());
    EXPECT_EQ(std::get<SeenLimitsAction>((*actions)[0].body).limits, (SeenLimits{2.0, 0}));
    EXPECT_EQ(std::get<SeenLimitsAction>((*actions)[1].body).limits, SeenLimits{});
    EXPECT_EQ(std::get<MissedAction>((*actions)[2].body).leastMm2, 50.0);
    EXPECT_EQ(std::get<NextMissedAction>((*actions)[3].body).step, -1);
    EXPECT_EQ(std::get<LedgerAction>((*actions)[4].body).json, "ledger.json");
    EXPECT_EQ(std::get<SeenReportAction>((*actions)[5].body).leastMm2, 300.0);
    EXPECT_EQ(std::get<FlyAction>((*actions)[6].body).holdMs, 40.0);
    for (const char* bad :
         {R"({"do":"seen-limits","pixels_per_mm":0})", R"({"do":"seen-limits","least_ms":60001})",
          R"({"do":"missed","least_mm2":0.5})", R"({"do":"next-missed","step":0})",
          R"({"do":"next-missed","step":2})", R"({"do":"ledger"})",
          R"({"do":"still","hold_ms":-1})", R"({"do":"seen-report","png":"a.png"})"})
        EXPECT_FALSE(parse(bad)) << bad;
}

TEST(Script, ChoosesTheModeOfFindingsAndGoesToOne) {
    const auto actions = parse(R"({"do":"detection","mode":"second-reader"})"
                               "\n"
                               R"({"do":"detection","mode":"concurrent","least_probability":0.3})"
                               "\n"
                               R"({"do":"findings","json":"findings.json"})"
                               "\n"
                               R"({"do":"finding","number":3})");
    ASSERT_TRUE(actions) << describe(actions.error());
    EXPECT_EQ(std::get<DetectionAction>((*actions)[0].body).choice,
              DetectionChoice{DetectionMode::secondReader});
    EXPECT_EQ(std::get<DetectionAction>((*actions)[1].body).choice,
              (DetectionChoice{DetectionMode::concurrent, false, 0.3}));
    EXPECT_EQ(std::get<FindingsAction>((*actions)[2].body).json, "findings.json");
    EXPECT_EQ(std::get<FindingAction>((*actions)[3].body).number, 3);
    for (const char* bad :
         {R"({"do":"detection"})", R"({"do":"detection","mode":"third-reader"})",
          R"({"do":"detection","mode":"off","least_probability":1.5})", R"({"do":"finding"})",
          R"({"do":"finding","number":0})", R"({"do":"findings","png":"a.png"})"})
        EXPECT_FALSE(parse(bad)) << bad;
}

TEST(Script, ReadsEveryActionWithItsLine) {
    const auto actions = parse(
        "# a tour\n"
        "\n"
        R"({"do":"view","viewport":2,"view":"coronal","size":[640,480]})"
        "\n"
        R"({"do":"go","arc_mm":120,"direction":"retrograde","yaw_deg":-15})"
        "\n"
        R"({"do":"fly","from_mm":0,"to_mm":1500,"positions":200,"pipelined":true})"
        "\n"
        R"({"do":"still","png":"rectum.png"})"
        "\n"
        R"({"do":"slice","view":"axial","position_mm":[1,-2,3.5],"zoom":2,"cleansed":true,"png":"a.png"})"
        "\n"
        R"({"do":"window","viewport":1,"center_hu":40,"width_hu":400})"
        "\r\n"
        R"({"do":"transfer","preset":"translucent"})"
        "\n"
        R"({"do":"bookmark","note":"sessile, 8 mm"})"
        "\n"
        R"({"do":"bookmarks","json":"all.json"})"
        "\n"
        R"({"do":"wait","ms":12.5})");
    ASSERT_TRUE(actions) << describe(actions.error());
    ASSERT_EQ(actions->size(), 10u);
    EXPECT_EQ((*actions)[0].line, 3);
    const auto& view = std::get<ViewAction>((*actions)[0].body);
    EXPECT_EQ(view.viewport, 2);
    EXPECT_EQ(view.view, View::coronal);
    EXPECT_EQ(view.width, 640);
    const auto& go = std::get<GoAction>((*actions)[1].body);
    EXPECT_EQ(go.arcMm, 120.0);
    EXPECT_EQ(go.direction, FlightDirection::retrograde);
    EXPECT_EQ(go.yawDegrees, -15.0);
    EXPECT_FALSE(go.pitchDegrees);
    EXPECT_TRUE(std::get<FlyAction>((*actions)[2].body).pipelined);
    EXPECT_EQ(std::get<StillAction>((*actions)[3].body).png, "rectum.png");
    EXPECT_EQ(std::get<SliceAction>((*actions)[4].body).positionMm, glm::dvec3(1, -2, 3.5));
    EXPECT_TRUE(std::get<SliceAction>((*actions)[4].body).cleansed);
    EXPECT_EQ(std::get<WindowAction>((*actions)[5].body).window.widthHu, 400.0);
    EXPECT_EQ(std::get<BookmarkAction>((*actions)[7].body).note, "sessile, 8 mm");
    EXPECT_EQ((*actions)[9].line, 12);
    EXPECT_EQ(std::get<WaitAction>((*actions)[9].body).ms, 12.5);
}

TEST(Script, ReadsALens) {
    const auto actions =
        parse(R"({"do":"lens","at":[0.25,-0.1],"radius":0.2,"preset":"biopsy","png":"l.png"})"
              "\n"
              R"({"do":"lens","position_mm":[1,2,3]})");
    ASSERT_TRUE(actions) << describe(actions.error());
    const auto& lens = std::get<LensAction>((*actions)[0].body);
    EXPECT_EQ(lens.at, glm::dvec2(0.25, -0.1));
    EXPECT_EQ(lens.radius, 0.2);
    EXPECT_EQ(lens.preset, "biopsy");
    EXPECT_EQ(lens.png, "l.png");
    const auto& there = std::get<LensAction>((*actions)[1].body);
    EXPECT_EQ(there.positionMm, glm::dvec3(1, 2, 3));
    EXPECT_FALSE(there.at || there.preset);
    for (const char* bad :
         {R"({"do":"lens","radius":0.6})", R"({"do":"lens","at":[0,0],"position_mm":[1,2,3]})",
          R"({"do":"lens","at":[0]})", R"({"do":"view","view":"endoscopic","viewport":8})"})
        EXPECT_FALSE(parse(bad)) << bad;
}

TEST(Script, ReadsTheActionsOnTheFlattenedWall) {
    const auto actions = parse(
        R"({"do":"flat","center":[0.25,3.5],"pixels_per_circumference":900,"size":[640,480],"png":"f.png"})"
        "\n"
        R"({"do":"flat","arc_mm":250,"viewport":6})"
        "\n"
        R"({"do":"strip","size":[400,800],"png":"s.png"})"
        "\n"
        R"({"do":"flyover","from":1,"to":9.5,"positions":50,"pipelined":true,"endoscopic":true})"
        "\n"
        R"({"do":"locate","flat":[0.5,2],"json":"place.json"})"
        "\n"
        R"({"do":"locate","position_mm":[1,2,3]})"
        "\n"
        R"({"do":"measure","flat":[[0.1,1],[0.2,1],[0.2,1.1]],"closed":true,"json":"m.json"})");
    ASSERT_TRUE(actions) << describe(actions.error());
    ASSERT_EQ(actions->size(), 7u);
    const auto& flat = std::get<FlatAction>((*actions)[0].body);
    EXPECT_EQ(flat.center, glm::dvec2(0.25, 3.5));
    EXPECT_EQ(flat.pixelsPerCircumference, 900.0);
    EXPECT_EQ(flat.size, glm::ivec2(640, 480));
    EXPECT_EQ(flat.viewport, 5);
    EXPECT_EQ(std::get<FlatAction>((*actions)[1].body).arcMm, 250.0);
    EXPECT_EQ(std::get<FlatAction>((*actions)[1].body).viewport, 6);
    EXPECT_EQ(std::get<StripAction>((*actions)[2].body).viewport, 4);
    const auto& over = std::get<FlyOverAction>((*actions)[3].body);
    EXPECT_EQ(over.from, 1.0);
    EXPECT_EQ(over.to, 9.5);
    EXPECT_TRUE(over.pipelined && over.endoscopic);
    EXPECT_EQ(std::get<LocateAction>((*actions)[4].body).flat, glm::dvec2(0.5, 2.0));
    EXPECT_EQ(std::get<LocateAction>((*actions)[5].body).positionMm, glm::dvec3(1, 2, 3));
    const auto& measure = std::get<MeasureAction>((*actions)[6].body);
    EXPECT_TRUE(measure.closed);
    EXPECT_EQ(measure.points, (std::vector<glm::dvec2>{{0.1, 1.0}, {0.2, 1.0}, {0.2, 1.1}}));
}

TEST(Script, ActionsOnTheFlattenedWallHaveTheirBounds) {
    std::string many = R"({"do":"measure","flat":[[0,0])";
    for (int n = 0; n < 128; ++n)
        many += ",[0,0]";
    many += "]}";
    const char* wrong[][2] = {
        {R"({"do":"flat","center":[0.5,1],"arc_mm":3})", "arc_mm"},
        {R"({"do":"flat","center":[0.5]})", "center"},
        {R"({"do":"flat","center":0.5})", "center"},
        {R"({"do":"flat","center":[0.5,1e9]})", "center"},
        {R"({"do":"flat","pixels_per_circumference":2})", "pixels_per_circumference"},
        {R"({"do":"flat","viewport":9})", "viewport"},
        {R"({"do":"flat","png":"../f.png"})", "png"},
        {R"({"do":"strip","center":[0.5,1]})", "center"},
        {R"({"do":"flyover","from":-1})", "from"},
        {R"({"do":"flyover","positions":1})", "positions"},
        {R"({"do":"flyover","endoscopic":true,"viewport":0})", "viewport"},
        {R"({"do":"locate"})", "flat"},
        {R"({"do":"locate","flat":[0,0],"position_mm":[0,0,0]})", "flat"},
        {R"({"do":"measure"})", "flat"},
        {R"({"do":"measure","flat":[[0,0]]})", "flat"},
        {R"({"do":"measure","flat":[[0,0],[1]]})", "flat"},
        {R"({"do":"measure","flat":[[0,0],[0.1,"1"]]})", "flat"},
        {R"({"do":"measure","flat":[[0,0],[33,0]]})", "flat"},
        {R"({"do":"measure","flat":[[0,0],[0.1,0]],"closed":true})", "flat"},
        {many.c_str(), "flat"},
        {R"({"do":"slice","view":"flattened"})", "view"},
    };
    for (const auto& [line, key] : wrong) {
        const auto actions = parse(line);
        ASSERT_FALSE(actions) << line;
        EXPECT_NE(actions.error().message.find(std::string("\"") + key + "\""), std::string::npos)
            << actions.error().message;
    }
}

TEST(Script, ErrorsNameTheLineAndTheKey) {
    const struct {
        const char* line;
        const char* says;
    } cases[] = {
        {"{\"do\":\"go\",", "not a JSON object"},
        {"[1,2]", "not a JSON object"},
        {"{\"arc_mm\":3}", "\"do\" is missing"},
        {"{\"do\":\"dance\"}", "no such action: \"dance\""},
        {"{\"do\":\"go\",\"arc\":3}", "\"arc\" is not a key of this action"},
        {"{\"do\":\"go\",\"arc_mm\":\"3\"}", "\"arc_mm\" must be a number"},
        {"{\"do\":\"go\",\"arc_mm\":-1}", "\"arc_mm\" must lie in 0…100000"},
        {"{\"do\":\"go\",\"arc_mm\":1,\"fraction\":0.5}", "exclude each other"},
        {"{\"do\":\"fly\",\"positions\":1.5}", "\"positions\" must be a whole number"},
        {"{\"do\":\"view\",\"view\":\"upside\"}",
         "\"view\" must be endoscopic, axial, coronal, sagittal, flattened, flattened-zoom, "
         "oblique "
         "or overview"},
        {"{\"do\":\"view\",\"view\":\"axial\",\"viewport\":8}", "\"viewport\" must lie in 0…7"},
        {"{\"do\":\"view\",\"view\":\"axial\",\"size\":[4096,4]}",
         "\"size\" must hold numbers in 16…2048"},
        {"{\"do\":\"still\",\"png\":\"../x.png\"}",
         "\"png\" must be a plain file name ending in .png"},
        {"{\"do\":\"still\",\"png\":\"x.jpg\"}",
         "\"png\" must be a plain file name ending in .png"},
        {"{\"do\":\"slice\",\"view\":\"endoscopic\"}",
         "\"view\" must be axial, coronal or sagittal"},
        {"{\"do\":\"window\",\"center_hu\":40}", "\"width_hu\" is missing"},
        {"{\"do\":\"bookmark\",\"note\":\"\xff\"}", "not a JSON object"},
    };
    for (const auto& one : cases) {
        const auto actions =
            parse(std::string("# first\n{\"do\":\"wait\",\"ms\":1}\n") + one.line + "\n");
        ASSERT_FALSE(actions) << one.line;
        EXPECT_EQ(actions.error().place, "tour.jsonl:3") << one.line;
        EXPECT_NE(actions.error().message.find(one.says), std::string::npos)
            << actions.error().message;
    }
}

// The definition itself: the smallest value that at least p % of the values do not exceed.
double percentileByCounting(const std::vector<double>& values, double percent) {
    double best = INFINITY;
    for (const double candidate : values) {
        const auto below =
            std::count_if(values.begin(), values.end(), [&](double v) { return v <= candidate; });
        if (double(below) >= percent / 100.0 * double(values.size()))
            best = std::min(best, candidate);
    }
    return best;
}

TEST(Latency, PercentilesAgreeWithTheirDefinition) {
    std::mt19937 random(3);
    for (int count = 1; count <= 60; ++count) {
        std::vector<double> values;
        for (int n = 0; n < count; ++n)
            values.push_back(double(random() % 50));
        const Summary summary = summarize(values);
        EXPECT_EQ(summary.count, values.size());
        EXPECT_EQ(summary.p50, percentileByCounting(values, 50.0));
        EXPECT_EQ(summary.p95, percentileByCounting(values, 95.0));
        EXPECT_EQ(summary.max, *std::max_element(values.begin(), values.end()));
    }
    EXPECT_EQ(summarize(std::vector<double>{}).count, 0u);
    EXPECT_DOUBLE_EQ(summarize(std::vector<double>{1, 2, 6}).mean, 3.0);
}

TEST(Latency, RecentTimesForgetTheOldest) {
    RecentTimes times(3);
    for (const double ms : {100.0, 1.0, 2.0, 3.0})
        times.add(ms);
    EXPECT_EQ(times.summary().max, 3.0);
    EXPECT_EQ(times.summary().count, 3u);
}

TEST(ScriptReport, HoldsTheStatisticsAndTheError) {
    PlayReport report;
    report.caseName = "phantom";
    report.failure = Error{ErrorKind::device, "too late", "tour.jsonl:3: fly"};
    ActionReport fly;
    fly.line = 3;
    fly.name = "fly";
    fly.seconds = 2.0;
    fly.positions = 4;
    fly.latencyMs = {10, 20, 30, 40};
    fly.decodeMs = {1, 1, 1, 1};
    fly.renderMicroseconds = fly.encodeMicroseconds = fly.queueMicroseconds = {7, 8, 9, 10};
    fly.bytes = 4000;
    report.actions.push_back(fly);
    const std::string text = toJson(report);
    for (const char* part :
         {"\"fps\": 2.0", "\"p50\": 20.0", "\"p95\": 40.0", "\"bytes_per_picture\": 1000",
          "\"error\": \"tour.jsonl:3: fly: too late\"", "\"render\": 8.0"})
        EXPECT_NE(text.find(part), std::string::npos) << part << " in " << text;
}

TEST(ViewPacer, AsksAsMovingWhileMovingAndOnceForTheStill) {
    using std::chrono::milliseconds;
    ViewPacer pacer(milliseconds(20), milliseconds(100));
    const ViewPacer::Time start = ViewPacer::Time{} + std::chrono::hours(1);
    int moving = 0, still = 0;
    for (int ms = 0; ms < 1000; ++ms) {
        const auto ask = pacer.next(ms < 500, start + milliseconds(ms));
        moving += ask == ViewPacer::Ask::moving;
        still += ask == ViewPacer::Ask::still;
        if (ask == ViewPacer::Ask::still) {
            EXPECT_GE(ms, 599);
        }
    }
    EXPECT_EQ(still, 1);
    EXPECT_NEAR(moving, 25, 1);
    EXPECT_FALSE(pacer.owes());
    pacer.touch();
    EXPECT_TRUE(pacer.owes());
}

TEST(MovingDetail, GivesWayToASlowServerAndComesBack) {
    MovingDetail detail;
    detail.add(500.0);  // a hiccup is no slow server
    EXPECT_EQ(detail.scale(), 1.0);
    for (int n = 0; n < 100; ++n)
        detail.add(200.0);
    const double lowest = detail.scale();
    EXPECT_LT(lowest, 0.5);
    for (int n = 0; n < 100; ++n)
        detail.add(60.0);
    EXPECT_EQ(detail.scale(), lowest);
    for (int n = 0; n < 1000; ++n)
        detail.add(10.0);
    EXPECT_EQ(detail.scale(), 1.0);
}

}  // namespace
}  // namespace haustra::reader
