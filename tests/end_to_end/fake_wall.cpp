#include "end_to_end/fake_wall.h"

#include "protocol/view_message.h"

#include <cmath>
#include <numbers>

namespace haustra::tests {
namespace {

void set(protocol::Vec3* out, glm::dvec3 v) {
    out->set_x(v.x);
    out->set_y(v.y);
    out->set_z(v.z);
}

protocol::FlatMeasure measured(const protocol::MeasureFlat& question) {
    protocol::FlatMeasure measure;
    const auto point = [&](int n) {
        const auto& p = question.points(n % question.points_size());
        return fakeCircumferenceMm * glm::dvec2(p.x(), p.y());
    };
    const int count = question.points_size(), legs = question.closed() ? count : count - 1;
    double length = 0.0, doubleArea = 0.0, farthest = 0.0;
    for (int n = 0; n < legs; ++n) {
        const glm::dvec2 a = point(n), b = point(n + 1);
        length += glm::distance(a, b);
        doubleArea += a.x * b.y - a.y * b.x;
        for (int m = 0; m < count; ++m)
            farthest = std::max(farthest, glm::distance(a, point(m)));
    }
    measure.set_request(question.request());
    measure.set_length_mm(length);
    if (question.closed()) {
        measure.set_area_mm2(0.5 * std::abs(doubleArea));
        measure.set_largest_diameter_mm(farthest);
    } else {
        measure.set_straight_mm(glm::distance(point(0), point(count - 1)));
    }
    return measure;
}

}  // namespace

protocol::WallPlace fakeMark(double arcMm) {
    return fakePlace({0.75, arcMm / fakeCenterline().lengthMm() * fakeStripHeight});
}

protocol::ServerMessage fakePick(const protocol::PickWall& question, bool flattened) {
    protocol::ServerMessage answer;
    const glm::dvec3 from(question.position_mm().x(), question.position_mm().y(),
                          question.position_mm().z());
    const glm::dvec3 along = glm::normalize(
        glm::dvec3(question.direction().x(), question.direction().y(), question.direction().z()));
    if (along.z < -0.999) {
        answer.mutable_error()->set_code(protocol::ErrorReport::BAD_VALUE);
        answer.mutable_error()->set_message("no wall lies in this direction");
        answer.mutable_error()->set_request(question.request());
        return answer;
    }
    const Centerline path = fakeCenterline();
    const double arc = nearestArc(path, from);
    auto* place = answer.mutable_wall_place();
    *place = fakePlace({0.75, arc / path.lengthMm() * fakeStripHeight});
    if (!flattened) place->clear_flat();
    place->set_request(question.request());
    set(place->mutable_position_mm(), from + fakeRadiusMm * along);
    return answer;
}

protocol::ScanStatistics fakeStatistics(const protocol::MeasureScan& question) {
    const auto vector = [](const protocol::Vec3& v) { return glm::dvec3(v.x(), v.y(), v.z()); };
    const glm::dvec3 slope(2, 3, 1), a = vector(question.half_a_mm()),
                                     b = vector(question.half_b_mm());
    const double change = std::hypot(glm::dot(slope, a), glm::dot(slope, b));
    protocol::ScanStatistics found;
    found.set_request(question.request());
    found.set_samples(change > 0.0 ? 1000 : 1);
    found.set_mean_hu(glm::dot(slope, vector(question.center_mm())) +
                      (question.cleansed() ? 1000.0 : 0.0));
    found.set_deviation_hu(0.5 * change);
    found.set_least_hu(found.mean_hu() - change);
    found.set_greatest_hu(found.mean_hu() + change);
    found.set_area_mm2(std::numbers::pi * glm::length(glm::cross(a, b)));
    return found;
}

Centerline fakeCenterline() {
    Centerline path;
    for (int n = 0; n <= 600; ++n) {
        const double t = n / 600.0 * 9.0;
        CenterlinePoint point;
        point.positionMm = {60 * std::cos(t), 60 * std::sin(t), 18 * t};
        point.radiusMm = fakeRadiusMm;
        if (n > 0)
            point.arcMm = path.points.back().arcMm +
                          glm::distance(point.positionMm, path.points.back().positionMm);
        path.points.push_back(point);
    }
    return path;
}

protocol::FlatStrip fakeStrip() {
    protocol::FlatStrip strip;
    strip.set_height(fakeStripHeight);
    strip.set_circumference_mm(fakeCircumferenceMm);
    const double length = fakeCenterline().lengthMm();
    for (int n = 0; n <= 60; ++n) {
        strip.add_rows(length * n / 60);
        strip.add_rows(fakeStripHeight * n / 60);
    }
    return strip;
}

protocol::WallPlace fakePlace(glm::dvec2 flat) {
    static const Centerline path = fakeCenterline();
    protocol::WallPlace place;
    const double x = flat.x - std::floor(flat.x), arc = flat.y / fakeStripHeight * path.lengthMm();
    const glm::dvec3 camera = poseAtArc(path, arc).point.positionMm;
    const double angle = 2.0 * std::numbers::pi * x;
    place.mutable_flat()->set_x(x);
    place.mutable_flat()->set_y(flat.y);
    set(place.mutable_position_mm(),
        camera + fakeRadiusMm * glm::dvec3(std::cos(angle), std::sin(angle), 0.0));
    set(place.mutable_camera_mm(), camera);
    place.set_arc_mm(arc);
    place.set_triangle(std::uint32_t(1000.0 * flat.y));
    return place;
}

protocol::ServerMessage aboutFakeWall(const protocol::ClientMessage& question) {
    protocol::ServerMessage answer;
    if (question.has_measure_flat()) {
        *answer.mutable_flat_measure() = measured(question.measure_flat());
    } else if (question.has_locate_point()) {
        const Centerline path = fakeCenterline();
        const auto& p = question.locate_point().position_mm();
        const double arc = nearestArc(path, {p.x(), p.y(), p.z()});
        *answer.mutable_wall_place() = fakePlace({0.25, arc / path.lengthMm() * fakeStripHeight});
        answer.mutable_wall_place()->set_request(question.locate_point().request());
    } else {
        const auto& locate = question.locate_flat();
        if (locate.flat().y() < 0.0 || locate.flat().y() > fakeStripHeight) {
            answer.mutable_error()->set_code(protocol::ErrorReport::BAD_VALUE);
            answer.mutable_error()->set_message("the place lies beyond the strip");
            answer.mutable_error()->set_request(locate.request());
            return answer;
        }
        *answer.mutable_wall_place() = fakePlace({locate.flat().x(), locate.flat().y()});
        answer.mutable_wall_place()->set_request(locate.request());
    }
    return answer;
}

protocol::MissedList fakeMissed() {
    protocol::MissedList list;
    list.set_share(0.5);
    list.set_least_mm2(300.0);
    for (const auto& [y, mm2] : {std::pair{1.0, 900.0}, {4.0, 600.0}, {5.0, 400.0}}) {
        protocol::MissedPatch& patch = *list.add_patches();
        patch.set_area_mm2(mm2);
        *patch.mutable_place() = fakePlace({0.25, y});
        list.set_count(list.count() + 1);
        list.set_area_mm2(list.area_mm2() + mm2);
        if (y > 4.5) continue;
        // From beside the path, straight at it.
        const glm::dvec3 place = protocol::vectorFrom(patch.place().position_mm()),
                         path = protocol::vectorFrom(patch.place().camera_mm());
        protocol::fill(
            *patch.mutable_view(),
            haustra::Camera{
                path + 0.5 * (path - place), glm::normalize(place - path), {0.0, 0.0, 1.0}, 90.0});
    }
    return list;
}

protocol::FindingList fakeFindings(const protocol::SetDetection& choice) {
    using protocol::FindingList, protocol::SetDetection;
    FindingList list;
    const bool shows = choice.mode() == SetDetection::CONCURRENT ||
                       (choice.mode() == SetDetection::SECOND_READER && choice.first_pass_done());
    list.set_state(shows                                ? FindingList::SHOWN
                   : choice.mode() == SetDetection::OFF ? FindingList::OFF
                                                        : FindingList::FIRST_PASS);
    list.set_operating_point(0.5);
    list.set_model("fake-1");
    list.set_trained_on("nothing: this is a test");
    if (!shows) return list;
    const auto add = [&](std::uint32_t number, double part, double probability,
                         bool hidden = false) {
        protocol::Finding& finding = *list.add_findings();
        finding.set_number(number);
        *finding.mutable_wall() = fakePlace({0.25, part * fakeStripHeight});
        const auto& p = finding.wall().position_mm();
        set(finding.mutable_position_mm(), {p.x(), p.y(), p.z()});
        set(finding.mutable_diameter_from_mm(), {p.x() - 4.0, p.y(), p.z()});
        set(finding.mutable_diameter_to_mm(), {p.x() + 4.0, p.y(), p.z()});
        finding.set_diameter_mm(8.0);
        finding.set_height_mm(3.0);
        finding.set_arc_mm(finding.wall().arc_mm());
        finding.set_segment(protocol::Finding::SIGMOID);
        finding.set_kind("sessile");
        finding.set_probability(probability);
        finding.set_below_operating_point(probability < list.operating_point());
        for (const std::uint32_t n : {100u, 100u, 50u, 3u})
            finding.add_voxels(n);
        if (hidden)
            protocol::fill(*finding.mutable_view(), Camera{{p.x() + 1.0, p.y() + 2.0, p.z() - 9.0},
                                                           {0.0, 0.0, 2.0},
                                                           {0.0, -1.0, 0.5},
                                                           90.0});
    };
    add(1, 1.0 / 3.0, 0.9);
    if (choice.has_least_probability() && choice.least_probability() <= 0.3) add(3, 0.5, 0.3, true);
    add(2, 2.0 / 3.0, 0.7);
    return list;
}

}  // namespace haustra::tests
