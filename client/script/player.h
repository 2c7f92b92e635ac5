// What plays a script's actions, one after the other.
#pragma once

#include "script/script_player.h"

#include <functional>
#include <map>

namespace haustra::reader {

/// One script's reader: a flight through the case, and the viewports that the script has opened.
/// The session and the options must outlive it.
class Player {
public:
    using Status = Result<void>;

    Player(Session& session, const PlayOptions& options)
        : session_(session), options_(options), flight_({}) {}

    /// Waits until the case is open; where none was named, opens the only one.
    Status awaitCase();
    Status play(const Action& action, ActionReport& report) {
        return std::visit([&](const auto& body) { return run(body, report); }, action.body);
    }

private:
    struct OpenViewport {
        View view;
        int width, height;
        Slice slice;
        FlatWindow window;
        Oblique oblique;
        Overview overview;
    };
    /// A way past equally spaced positions, each of which is asked for and measured.
    struct Course {
        int positions = 0, viewport = 0;
        bool pipelined = false;
        /// To so much of the way, 0…1; returns the sequence that the picture will reach.
        std::function<std::uint64_t(double)> goTo;
    };

    Status run(const ViewAction&, ActionReport&);
    Status run(const GoAction&, ActionReport&);
    Status run(const FlyAction&, ActionReport&);
    Status run(const StillAction&, ActionReport&);
    Status run(const SliceAction&, ActionReport&);
    Status run(const ObliqueAction&, ActionReport&);
    Status run(const OverviewAction&, ActionReport&);
    Status run(const FlatAction&, ActionReport&);
    Status run(const StripAction&, ActionReport&);
    Status run(const FlyOverAction&, ActionReport&);
    Status run(const LocateAction&, ActionReport&);
    Status run(const MeasureAction&, ActionReport&);
    Status run(const PaintAction&, ActionReport&);
    Status run(const SeenAction&, ActionReport&);
    Status run(const WindowAction&, ActionReport&);
    Status run(const TransferAction&, ActionReport&);
    Status run(const BookmarkAction&, ActionReport&);
    Status run(const BookmarksAction&, ActionReport&);
    Status run(const WaitAction&, ActionReport&);

    Status travel(const Course&, ActionReport&);
    Status travelStepwise(const Course&, ActionReport&);
    Status travelPipelined(const Course&, ActionReport&);

    OpenViewport& open(int viewport, View view, int width, int height);
    /// As large as it was, or `size`, or as the options say.
    OpenViewport& open(int viewport, View view, std::optional<glm::ivec2> size);
    Status mustBeOpen(int viewport);
    Status mustBeFlattened();
    Oblique obliqueAtCamera() const;
    Overview overviewFromFront(int width, int height) const;
    FlatWindow windowAround(double y, std::optional<double> pixelsPerCircumference,
                            int width) const;
    std::uint64_t ask(int viewport, bool moving);
    Status awaitStill(int viewport, std::uint64_t sequence, Clock::time_point askedAt,
                      const std::string& png, ActionReport& report);
    Result<Arrival> awaitPicture(int viewport, std::uint64_t sequence, bool exact);
    Result<Session::WallAnswer> awaitWallAnswer(std::uint64_t request, ActionReport& report);
    Status awaitBookmarkList();
    Status awaitThat(const std::function<bool()>& done, const std::string& what);
    Status writeJson(const std::string& file, const std::string& text, ActionReport& report);

    Session& session_;
    const PlayOptions& options_;
    Flight flight_;
    std::map<int, OpenViewport> viewports_;
    std::deque<Arrival> arrivals_;
    std::map<int, int> passedOver_;  // pictures that came while another viewport's was awaited
};

/// Adds a picture's times to a report.
void count(ActionReport& report, const Arrival& arrival, Clock::time_point askedAt);
double msBetween(Clock::time_point from, Clock::time_point to);

}  // namespace haustra::reader
