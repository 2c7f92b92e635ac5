// What the colon was found to be, and what a person said of it, as JSON.
#include "core/colon_record.h"

#include "core/colon_edits.h"
#include "core/segments_along.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

using namespace haustra;

namespace {

ColonRecord collapsedColon() {
    ColonRecord record;
    record.pieces = {{ColonPart::rectum, {0, 40, -300}, 20, 120, 150, 10},
                     {ColonPart::sigmoid, {30, 10, -250}, 14, 200, 90, 30},
                     {ColonPart::splenicFlexure, {90, 10, -20}, 15, 180, 100, 20},
                     {ColonPart::cecum, {-80, 0, -200}, 25, 90, 160, 5}};
    record.junctions = {{JunctionKind::openLumen, {10, 30, -280}, 0, 8, 1.0},
                        {JunctionKind::collapse, {60, 10, -150}, 31, 0, 0.9},
                        {JunctionKind::openLumen, {0, 10, -50}, 0, 9, 1.0}};
    record.confidence = 0.875;
    record.leftOut = {{{-40, 0, -220}, 28.0, BodyContent::gas, ColonPart::cecum, 4.0, true}};
    record.warnings = {"the sigmoid is collapsed over 31 mm, at (60, 10, -150) mm"};
    return record;
}

TEST(ColonRecord, SegmentsHoldWhatThePiecesHold) {
    const ColonRecord record = collapsedColon();
    double lengthMm = 0.0, gasMl = 0.0, taggedMl = 0.0, collapsedMm = 0.0;
    for (const SegmentDistension& segment : distensionOf(record)) {
        lengthMm += segment.lengthMm, collapsedMm += segment.collapsedMm;
        gasMl += segment.gasMl, taggedMl += segment.taggedMl;
    }
    EXPECT_DOUBLE_EQ(lengthMm + collapsedMm, record.lengthMm());
    EXPECT_DOUBLE_EQ(gasMl, 500.0);
    EXPECT_DOUBLE_EQ(taggedMl, 65.0);
    EXPECT_DOUBLE_EQ(distensionOf(record)[std::size_t(ColonSegment::sigmoid)].collapsedMm, 31.0);
    EXPECT_DOUBLE_EQ(distensionOf(record)[std::size_t(ColonSegment::descending)].diameterMm, 30.0);
}

TEST(ColonRecord, ItsJsonSaysAllOfIt) {
    const auto json = nlohmann::json::parse(qualityJson(collapsedColon()));
    EXPECT_EQ(json.at("confidence"), 0.88);
    EXPECT_EQ(json.at("pieces").size(), json.at("junctions").size() + 1);
    EXPECT_EQ(json.at("junctions")[1].at("kind"), "collapse");
    EXPECT_EQ(json.at("segments").size(), 6u);
    EXPECT_EQ(json.at("left_out_gas_ml"), 28.0);
    EXPECT_EQ(json.at("warnings").size(), 1u);
    EXPECT_TRUE(json.at("tagging_hu").is_null());
    EXPECT_EQ(json.at("left_out")[0].at("like_colon"), false);
    EXPECT_TRUE(json.at("ends_at").is_null());
    ColonRecord record = collapsedColon();
    record.taggingHu = 312.5, record.leftOut[0].likeColon = true;
    record.endsAt = {1.0 / 3.0, -2.0, 0.125};
    record.leftOut.push_back({{}, 3.5, BodyContent::tagged});
    record.leftOut.push_back({{}, 7.25, BodyContent::untagged});
    record.leftOut.push_back({{}, 64.0, BodyContent::gas, ColonPart::rectum, 90.0});
    const auto other = nlohmann::json::parse(qualityJson(record));
    EXPECT_EQ(other.at("tagging_hu"), 312.5);
    EXPECT_EQ(other.at("ends_at"), nlohmann::json({0.33, -2.0, 0.13}));
    EXPECT_EQ(other.at("left_out_gas_ml"), 28.0);
    EXPECT_EQ(other.at("left_out_far_gas_ml"), 64.0) << "that of the stomach, say, is apart";
    EXPECT_EQ(other.at("left_out_tagged_ml"), 3.5);
    EXPECT_EQ(other.at("left_out_untagged_ml"), 7.25);
    EXPECT_EQ(other.at("left_out")[2].at("content"), "untagged");
    EXPECT_EQ(other.at("left_out")[0].at("like_colon"), true);
}

// Up x = 0 for 100 mm, 20 mm across, and down x = 20.
Centerline hairpin() {
    Centerline path;
    for (int mm = 0; mm <= 220; ++mm) {
        const glm::dvec3 at = mm <= 100   ? glm::dvec3(0, 0, mm)
                              : mm <= 120 ? glm::dvec3(mm - 100, 0, 100)
                                          : glm::dvec3(20, 0, 220 - mm);
        path.points.push_back({at, double(mm), 8.0, false});
    }
    return path;
}

TEST(SegmentsAlong, BordersLieHalfWayBetweenPiecesOfTwoSegments) {
    const auto starts = segmentsAlong(hairpin(), {{ColonPart::rectum, {1, 0, 10}},
                                                  {ColonPart::sigmoid, {-2, 0, 50}},
                                                  {ColonPart::sigmoid, {10, 1, 99}},
                                                  {ColonPart::cecum, {19, 0, 30}}});
    EXPECT_EQ(segmentAt(starts, -5.0), ColonSegment::rectum);
    EXPECT_EQ(segmentAt(starts, 29.9), ColonSegment::rectum);
    EXPECT_EQ(segmentAt(starts, 30.1), ColonSegment::sigmoid);
    EXPECT_EQ(segmentAt(starts, 149.0), ColonSegment::sigmoid);
    EXPECT_EQ(segmentAt(starts, 151.0), ColonSegment::cecum);
    EXPECT_EQ(segmentAt(starts, 1e6), ColonSegment::cecum);
    EXPECT_FALSE(segmentAt(segmentsAlong(hairpin(), {}), 10.0));
    EXPECT_FALSE(segmentAt(segmentsAlong({}, {{ColonPart::rectum, {0, 0, 10}}}), 10.0));
}

TEST(SegmentsAlong, APieceThatIsNearestToAnotherLoopMovesNoBorder) {
    const std::vector<ColonPiece> pieces{{ColonPart::rectum, {0, 0, 10}},
                                         {ColonPart::sigmoid, {11, 0, 40}},  // nearer to x = 20
                                         {ColonPart::sigmoid, {0, 0, 60}},
                                         {ColonPart::transverse, {10, 0, 100}},
                                         {ColonPart::cecum, {20, 0, 20}}};
    const auto starts = segmentsAlong(hairpin(), pieces);
    ASSERT_EQ(starts.size(), 4u);
    for (std::size_t n = 1; n < starts.size(); ++n) {
        EXPECT_GT(starts[n].arcMm, starts[n - 1].arcMm);
        EXPECT_GT(int(starts[n].segment), int(starts[n - 1].segment));
    }
    EXPECT_EQ(segmentAt(starts, 40.0), ColonSegment::sigmoid);
    EXPECT_EQ(segmentAt(starts, 180.0), ColonSegment::cecum);
}

TEST(ColonRecord, PiecesReadBack) {
    const ColonRecord record = collapsedColon();
    const auto pieces = piecesOfQuality(qualityJson(record));
    ASSERT_TRUE(pieces) << describe(pieces.error());
    ASSERT_EQ(pieces->size(), record.pieces.size());
    for (std::size_t n = 0; n < pieces->size(); ++n) {
        EXPECT_EQ((*pieces)[n].part, record.pieces[n].part);
        EXPECT_EQ((*pieces)[n].centerMm, record.pieces[n].centerMm);
        EXPECT_EQ((*pieces)[n].radiusMm, record.pieces[n].radiusMm);
    }
    EXPECT_FALSE(piecesOfQuality("{\"pieces\":[{\"part\":\"spleen\"}]}"));
}

TEST(ColonEdits, ReadBackAsTheyWereBitForBit) {
    ColonEdits edits;
    edits.seedsMm = {{1.0 / 3.0, -2e-9, 417.25}};
    edits.excludesMm = {{-0.1, 0.2, 0.3}, {5, 6, 7}};
    edits.cuts = {{{10.1, 20.2, 30.3}, 4.7}};
    edits.joins = {{{1, 2, 3}, {4, 5, 6.0000001}}};
    const auto back = editsFromJson(editsJson(edits));
    ASSERT_TRUE(back) << describe(back.error());
    EXPECT_EQ(*back, edits);
    EXPECT_TRUE(editsFromJson(editsJson({}))->empty());
}

TEST(ColonEdits, WhatIsNoneIsRefused) {
    for (const char* text :
         {"", "{}", "[1,2]",
          "{\"seeds_mm\":[[1,2]],\"excludes_mm\":[],\"cuts\":[],\"joins_mm\":[]}",
          "{\"seeds_mm\":[[1,2,\"x\"]],\"excludes_mm\":[],\"cuts\":[],\"joins_mm\":[]}",
          "{\"seeds_mm\":[[1,2,1e300]],\"excludes_mm\":[],\"cuts\":[],\"joins_mm\":[]}",
          "{\"seeds_mm\":[],\"excludes_mm\":[],\"cuts\":[{\"center_mm\":[1,2,3],"
          "\"radius_mm\":1e300}],\"joins_mm\":[]}",
          "{\"seeds_mm\":[],\"excludes_mm\":[],\"cuts\":[{\"center_mm\":[1,2,3],"
          "\"radius_mm\":-1}],\"joins_mm\":[]}"}) {
        const auto edits = editsFromJson(text);
        ASSERT_FALSE(edits) << text;
        EXPECT_EQ(edits.error().kind, ErrorKind::badInput);
    }
}

}  // namespace
