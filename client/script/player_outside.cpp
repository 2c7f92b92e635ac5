// Actions of the views beside the colon's inside: the slice across the gaze, and the overview.
#include "reader/overview_map.h"
#include "script/player.h"

namespace haustra::reader {

using Status = Player::Status;

Oblique Player::obliqueAtCamera() const {
    const Camera camera = flight_.camera();
    return {camera.positionMm, camera.forward, camera.up};
}

Overview Player::overviewFromFront(int width, int height) const {
    return {orbitOf(flight_.centerline(), double(width) / height), flight_.camera(), {}, true};
}

Status Player::run(const ObliqueAction& action, ActionReport& report) {
    Oblique oblique = obliqueAtCamera();
    if (action.positionMm) oblique.positionMm = *action.positionMm;
    if (action.forward) {
        oblique.forward = glm::normalize(*action.forward);
        oblique.up = *action.up;
    }
    oblique.positionMm += action.aheadMm * oblique.forward;
    oblique.heightMm = action.heightMm;
    oblique.cleansed = action.cleansed;
    open(action.viewport, View::oblique, action.size).oblique = oblique;
    const auto askedAt = Clock::now();
    return awaitStill(action.viewport, ask(action.viewport, false), askedAt, action.png, report);
}

Status Player::run(const OverviewAction& action, ActionReport& report) {
    OpenViewport& viewport = open(action.viewport, View::overview, action.size);
    Overview overview = overviewFromFront(viewport.width, viewport.height);
    overview.orbit.azimuthDegrees = action.azimuthDegrees;
    overview.orbit.elevationDegrees = action.elevationDegrees;
    if (action.heightMm) overview.orbit.heightMm = *action.heightMm;
    if (!action.reader) overview.reader.reset();
    overview.body = action.body;
    if (action.bookmarks) {
        TRY(awaitBookmarkList());
        for (const Bookmark& bookmark : session_.bookmarks())
            if (overview.bookmarksMm.size() < maxMarkedBookmarks)
                overview.bookmarksMm.push_back(bookmark.camera.positionMm);
    }
    viewport.overview = std::move(overview);
    const auto askedAt = Clock::now();
    return awaitStill(action.viewport, ask(action.viewport, false), askedAt, action.png, report);
}

}  // namespace haustra::reader
