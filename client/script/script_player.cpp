#include "script/script_player.h"

#include "script/player.h"

namespace haustra::reader {

PlayReport play(Session& session, const std::vector<Action>& actions, const PlayOptions& options) {
    PlayReport report;
    report.clientSoftware = options.software;
    Player player(session, options);
    const auto finish = [&](std::optional<Error> failure) {
        report.serverSoftware = session.server().serverSoftware;
        report.renderer = session.server().renderer;
        report.fingerprint = session.server().fingerprint;
        report.roundTripMs = session.roundTripMs();
        report.failure = std::move(failure);
        return std::move(report);
    };
    if (auto opened = player.awaitCase(); !opened) return finish(opened.error());
    report.caseName = session.caseInfo()->name;
    report.bridges = bridgesOf(session.caseInfo()->centerline);
    report.trust = session.caseInfo()->trust;
    report.centerlineMm = session.caseInfo()->centerline.lengthMm();
    for (const Action& action : actions) {
        ActionReport measured;
        measured.line = action.line;
        measured.name = action.name;
        auto done = player.play(action, measured);
        report.actions.push_back(std::move(measured));
        if (done) continue;
        Error error = done.error();
        const std::string line =
            options.scriptName + ":" + std::to_string(action.line) + ": " + action.name;
        error.place = error.place.empty() ? line : line + ": " + error.place;
        return finish(std::move(error));
    }
    return finish(std::nullopt);
}

}  // namespace haustra::reader
