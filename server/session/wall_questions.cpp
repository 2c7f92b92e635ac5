#include "session/wall_questions.h"

#include "protocol/view_message.h"

#include <algorithm>
#include <cmath>

namespace haustra::session {
namespace {

tl::unexpected<Error> refuse(std::string message) {
    return fail(ErrorKind::badInput, std::move(message), "measurement");
}

}  // namespace

Result<WallQuestion> questionFrom(const protocol::LocateFlat& message, const Wall& wall) {
    const auto flat = TRY(protocol::flatPointFrom(message.flat()));
    if (!(flat.y >= 0.0 && flat.y <= wall.map->height))
        return fail(ErrorKind::badInput, "the place lies beyond the strip", "flat");
    return LocateInStrip{flat};
}

Result<WallQuestion> questionFrom(const protocol::LocatePoint& message, const Wall&) {
    const auto position = TRY(protocol::positionFrom(message.position_mm()));
    return LocateInSpace{position};
}

Result<WallQuestion> questionFrom(const protocol::MeasureFlat& message, const Wall& wall) {
    Measure question;
    question.closed = message.closed();
    if (message.points_size() <
            (question.closed ? protocol::minOutlinePoints : protocol::minLinePoints) ||
        message.points_size() > protocol::maxMeasuredPoints)
        return refuse("a line has 2, an outline 3, and both at most " +
                      std::to_string(protocol::maxMeasuredPoints) + " points");
    for (const protocol::FlatPoint& corner : message.points()) {
        const auto point = TRY(protocol::flatPointFrom(corner));
        if (std::abs(point.x) > protocol::maxMeasuredTurns)
            return refuse("a point lies more than 32 turns away");
        question.points.push_back({point.x, std::clamp(point.y, 0.0, wall.map->height)});
    }
    const auto& points = question.points;
    double legs = question.closed ? glm::distance(points.front(), points.back()) : 0.0;
    for (std::size_t n = 1; n < points.size(); ++n)
        legs += glm::distance(points[n - 1], points[n]);
    if (legs >
        (question.closed ? protocol::maxOutlineCircumferences : protocol::maxLineCircumferences))
        return refuse("what is measured is too long");
    const auto [left, right] = std::minmax_element(
        points.begin(), points.end(), [](glm::dvec2 a, glm::dvec2 b) { return a.x < b.x; });
    if (question.closed && right->x - left->x > 1.0)
        return refuse("the outline is wider than the colon");
    return question;
}

protocol::ServerMessage messageOf(const WallAnswer& answer, std::uint64_t request) {
    protocol::ServerMessage message;
    if (const auto* place = std::get_if<WallPlace>(&answer)) {
        auto* body = message.mutable_wall_place();
        body->set_request(request);
        body->mutable_flat()->set_x(place->flat.x);
        body->mutable_flat()->set_y(place->flat.y);
        protocol::fill(*body->mutable_position_mm(), place->positionMm);
        body->set_triangle(std::uint32_t(place->sourceTriangle));
        body->set_arc_mm(place->arcMm);
        protocol::fill(*body->mutable_camera_mm(), place->cameraMm);
        return message;
    }
    const auto& measure = std::get<WallMeasure>(answer);
    auto* body = message.mutable_flat_measure();
    body->set_request(request);
    body->set_length_mm(measure.lengthMm);
    body->set_straight_mm(measure.straightMm);
    body->set_area_mm2(measure.areaMm2);
    body->set_largest_diameter_mm(measure.largestDiameterMm);
    return message;
}

}  // namespace haustra::session
