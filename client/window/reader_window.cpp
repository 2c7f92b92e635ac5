#include "window/reader_window.h"

#include "window/gl_window.h"
#include "window/layout.h"
#include "window/ui.h"

#include <algorithm>
#include <atomic>

namespace haustra::window {
namespace {

using reader::Clock;
void drawEverything(Ui& ui) {
    ImGui::SetNextWindowPos({0, 0});
    ImGui::SetNextWindowSize(ImGui::GetIO().DisplaySize);
    ImGui::PushStyleVar(ImGuiStyleVar_WindowPadding, {0, 0});
    ImGui::Begin("haustra", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                     ImGuiWindowFlags_NoBringToFrontOnFocus | ImGuiWindowFlags_NoNav |
                     ImGuiWindowFlags_NoScrollWithMouse);
    ImGui::PopStyleVar();
    const Layout layout = layOut(ui, ImGui::GetIO().DisplaySize);
    drawTopBar(ui, layout.top);
    if (ui.reader.isOpen()) {
        drawEndoscopicPane(ui, layout.endoscopic);
        drawSlicePane(ui, View::axial, layout.axial);
        drawSlicePane(ui, View::coronal, layout.coronal);
        drawSlicePane(ui, View::sagittal, layout.sagittal);
        if (ui.reader.flat().hasStrip()) {
            drawStripPane(ui, layout.strip);
            drawZoomPane(ui, layout.zoom);
        }
        drawOverviewPane(ui, layout.overview);
        drawObliquePane(ui, layout.oblique);
        if (ui.showBookmarks) drawBookmarkPanel(ui, layout.bookmarks);
        drawTransportBar(ui, layout.transport);
    } else {
        drawStart(ui, {layout.middle.min, layout.transport.max});
    }
    drawNotices(ui, ui.reader.isOpen() ? layout.endoscopic : layout.middle);
    if (ui.showHelp) drawHelp(ui, {{0, 0}, ImGui::GetIO().DisplaySize});
    ImGui::End();
    if (ui.showTransfer && ui.reader.isOpen()) drawTransferPanel(ui, layout.middle);
}

// Turns what happened in the session since the last frame into notices.
class Watcher {
public:
    void look(Ui& ui) {
        reader::Session& session = ui.reader.session();
        for (const Error& refusal : session.takeRefusals())
            ui.tell(describe(refusal), true);
        if (session.server().firstUse && !toldFirstUse_) {
            ui.tell("First meeting with this server: its certificate is now pinned (" +
                    session.server().fingerprint.substr(0, 16) + "…)");
            toldFirstUse_ = true;
        }
        tellOfBookmarks(ui, session.takeBookmarkOutcomes());
    }

private:
    // What was refused and noted goes back to where notes are written, unless another one is being
    // written there.
    static void tellOfBookmarks(Ui& ui, const std::vector<reader::BookmarkOutcome>& outcomes) {
        std::size_t saved = 0, refused = 0;
        std::string notes;
        for (const auto& [bookmark, isSaved] : outcomes) {
            ++(isSaved ? saved : refused);
            if (!isSaved && !bookmark.note.empty())
                notes += (notes.empty() ? "" : "; ") + bookmark.note;
        }
        if (saved > 0)
            ui.tell(saved == 1 ? "Bookmark saved" : std::to_string(saved) + " bookmarks saved");
        if (refused == 0) return;
        std::string text = refused == 1 ? "A bookmark was not saved"
                                        : std::to_string(refused) + " bookmarks were not saved";
        if (!notes.empty() && ui.note[0] == 0 && notes.size() < ui.note.size()) {
            ui.note.fill(0);
            notes.copy(ui.note.data(), ui.note.size() - 1);
            ui.showBookmarks = true;
            text += "; what was noted is in its field again";
        } else if (!notes.empty()) {
            text += ": " + notes;
        }
        ui.tell(text, true);
    }

    bool toldFirstUse_ = false;
};

// When the time has come; where pictures are still on their way, up to 20 s later.
bool readyForScreenshot(const reader::Reader& reader, const WindowOptions& options,
                        Clock::duration elapsed) {
    const auto due = std::chrono::milliseconds(options.screenshotAfterMs);
    if (elapsed < due) return false;
    const reader::Phase phase = reader.session().phase();
    bool waiting = phase == reader::Phase::connecting;
    if (phase == reader::Phase::open && reader.motion() == reader::Motion::paused)
        for (const View view : allViews)
            // Views without a pane are never asked for, nor flat ones of a case without a strip.
            waiting = waiting ||
                      (reader.panes().size(view).x > 0 && !reader.panes().picture(view).exact &&
                       (reader.flat().hasStrip() || !isFlat(view)));
    return !waiting || elapsed > due + std::chrono::seconds(20);
}

// Bookmarks on their way are waited for, but not for long.
void finishBookmarks(reader::Session& session) {
    const auto deadline = Clock::now() + std::chrono::seconds(2);
    while (session.owedBookmarks() > 0 && session.phase() == reader::Phase::open &&
           Clock::now() < deadline)
        session.poll(std::chrono::milliseconds(50));
}

}  // namespace

Result<void> run(WindowOptions options) {
    auto made = TRY(GlWindow::create("Haustra", options.width, options.height, options.scale));
    GlWindow& window = *made;
    options.connection.reconnect = true;
    options.connection.onEvent = [&window] { window.wake(); };
    reader::Reader reader(options.connection, options.caseName, options.journal);
    Ui ui{reader, window.fonts(), float(window.scale()),
          link::toString(options.connection.address)};
    Watcher watcher;

    const auto start = Clock::now();
    auto before = start;
    int busyFrames = 3;  // ImGui settles in a few frames after each event
    while (window.beginFrame(busyFrames > 0)) {
        const auto now = Clock::now();
        const double seconds = std::chrono::duration<double>(now - before).count();
        before = now;
        const bool wanted = handleKeys(ui, window.keyPresses(), seconds);
        // A frame that was long in coming must not throw the reader far along the colon.
        reader.update(std::min(seconds, 0.1));
        watcher.look(ui);
        drawEverything(ui);
        window.endFrame();
        if (!wanted) break;
        const ImGuiIO& io = ImGui::GetIO();
        const bool handAtWork = io.MouseDelta.x != 0 || io.MouseDelta.y != 0 ||
                                ImGui::IsAnyMouseDown() || reader.flight().isFree();
        busyFrames = reader.restless() || handAtWork || !ui.notices.empty()
                         ? 3
                         : std::max(0, busyFrames - 1);
        if (options.screenshot && readyForScreenshot(reader, options, now - start)) {
            TRY(window.writeScreenshot(*options.screenshot));
            if (reader.session().phase() == reader::Phase::failed)
                return tl::make_unexpected(reader.session().failure());
            break;
        }
    }
    finishBookmarks(reader.session());
    if (!reader.isOpen() && reader.session().phase() == reader::Phase::failed)
        return tl::make_unexpected(reader.session().failure());
    return {};
}

}  // namespace haustra::window
