#include "window/commands.h"

#include "protocol/capabilities.h"
#include "window/findings_panel.h"
#include "window/look_steps.h"
#include "window/missed_panel.h"
#include "window/pane.h"
#include "window/reader_window.h"

#include <QCoreApplication>
#include <QSettings>
#include <array>

namespace haustra::window {
namespace {

using reader::Flight;
using reader::Motion;

Flight& flightOf(ReaderWindow& w) {
    return w.reader().flight();
}

void toggle(ReaderWindow& w, Motion motion) {
    w.reader().setMotion(w.reader().motion() == motion ? Motion::paused : motion);
}

void stepAlong(ReaderWindow& w, double mm) {
    Flight& flight = flightOf(w);
    flight.setMotion(Motion::paused);
    flight.goTo(flight.arcMm() + (flight.direction() == FlightDirection::antegrade ? mm : -mm));
}

void jumpTo(ReaderWindow& w, const char* text, double arcMm) {
    w.reading().jump(QCoreApplication::translate("Commands", text),
                     [&w, arcMm] { flightOf(w).goTo(arcMm); });
}

void needStrip(ReaderWindow& w, const auto& run) {
    if (w.reader().flat().hasStrip())
        run();
    else
        w.reading().tell(
            QCoreApplication::translate("Commands", "This case has not been flattened."));
}

void togglePaint(ReaderWindow& w, bool WallPaintChoice::*which) {
    needStrip(w, [&] {
        WallPaintChoice paint = w.reader().flat().paint();
        paint.*which = !(paint.*which);
        w.reader().flat().setPaint(paint);
    });
}

// A tool, or none where it was chosen already.
void toggle(ReaderWindow& w, DrawingTool tool) {
    w.reading().setTool(w.reading().tool() == tool ? DrawingTool::none : tool);
}

void setWindow(ReaderWindow& w, std::size_t n) {
    w.setWindowPreset(n);
}

void changeSlab(ReaderWindow& w, const Slab& slab) {
    reader::SliceViews& slices = w.reader().slices();
    if (!w.reader().session().serverCan(protocol::capability::slabs))
        return w.reading().tell(
            QCoreApplication::translate("Commands", "This server cannot show slabs."));
    const Slab before = slices.slab();
    if (slab == before) return;
    slices.setSlab(slab);
    w.reading().did(
        QCoreApplication::translate("Commands", "change the slab"),
        [&slices, before] { slices.setSlab(before); }, [&slices, slab] { slices.setSlab(slab); });
}

void setSlab(ReaderWindow& w, int step) {
    constexpr std::array thicknesses{0.0, 2.0, 5.0, 10.0, 20.0, 50.0};
    Slab slab = w.reader().slices().slab();
    std::size_t n = 0;
    while (n + 1 < thicknesses.size() && thicknesses[n + 1] <= slab.thicknessMm)
        ++n;
    const int next = std::clamp(int(n) + step, 0, int(thicknesses.size()) - 1);
    slab.thicknessMm = thicknesses[std::size_t(next)];
    changeSlab(w, slab);
}

void goToBookmark(ReaderWindow& w, int step) {
    if (const auto bookmark = w.reader().nextBookmark(step))
        w.reading().jump(QCoreApplication::translate("Commands", "go to a bookmark"),
                         [&w, bookmark] { w.reader().goTo(*bookmark); });
}

void onPane(ReaderWindow& w, const auto& what) {
    if (Pane* pane = w.keyboardPane()) what(*pane);
}
void dragPane(ReaderWindow& w, QPoint steps, Qt::MouseButton button) {
    onPane(w, [&](Pane& pane) { pane.dragByKeys(steps, button); });
}

// A switch that Ctrl+Z turns back.
void change(ReaderWindow& w, const char* text, bool before, const std::function<void(bool)>& set) {
    set(!before);
    w.reading().did(
        QCoreApplication::translate("Commands", text), [set, before] { set(before); },
        [set, before] { set(!before); });
}

void toggleLens(ReaderWindow& w) {
    reader::BiopsyLens& lens = w.reader().lens();
    if (lens.isOn() || lens.isAvailable()) return lens.setOn(!lens.isOn());
    w.reading().tell(
        w.reader().session().serverCan(protocol::capability::lens)
            ? QCoreApplication::translate("Commands", "This server has no electronic biopsy.")
            : QCoreApplication::translate("Commands", "This server cannot show a lens."));
}
void resizeLens(ReaderWindow& w, double factor) {
    reader::BiopsyLens& lens = w.reader().lens();
    if (lens.isOn()) lens.setRadius(lens.place().radius * factor);
}

// The first end of a ruler is no step yet.
void undo(ReaderWindow& w) {
    if (w.reader().rulers().isBegun())
        w.reader().rulers().giveUp();
    else
        w.reading().undoStack().undo();
}

// One thing at a time, the nearest first.
void stop(ReaderWindow& w) {
    if (w.showsCases()) return w.showCases();
    if (w.reader().rulers().isBegun()) return w.reader().rulers().giveUp();
    if (w.reading().tool() != DrawingTool::none) return w.reading().setTool(DrawingTool::none);
    if (w.pointsByKeys()) return w.togglePointing();
    if (w.reader().lens().isOn()) return w.reader().lens().setOn(false);
    if (w.isEnlarged()) return w.leaveEnlarged();
    w.reading().clearMeasures();
}

const std::array table = {
    // ---- file
    Command{.id = "cases",
            .menu = Menu::file,
            .text = QT_TRANSLATE_NOOP("Commands", "Cases of the server…"),
            .keys = "Ctrl+O",
            .symbol = Symbol::cases,
            .needsCase = false,
            .run = [](ReaderWindow& w) { w.showCases(); },
            .shortText = QT_TRANSLATE_NOOP("Commands", "Cases")},
    Command{.id = "connect-again",
            .menu = Menu::file,
            .text = QT_TRANSLATE_NOOP("Commands", "Connect again"),
            .keys = "Ctrl+R",
            .needsCase = false,
            .run = [](ReaderWindow& w) { w.connectAgain(); }},
    Command{.id = "save-picture",
            .menu = Menu::file,
            .text = QT_TRANSLATE_NOOP("Commands", "Save the picture…"),
            .keys = "Ctrl+S",
            .run = [](ReaderWindow& w) { w.savePicture(); },
            .separatorBefore = true},
    Command{.id = "copy-picture",
            .menu = Menu::file,
            .text = QT_TRANSLATE_NOOP("Commands", "Copy the picture"),
            .keys = "Ctrl+C",
            .run = [](ReaderWindow& w) { w.copyPicture(); }},
    Command{.id = "quit",
            .menu = Menu::file,
            .text = QT_TRANSLATE_NOOP("Commands", "Quit"),
            .keys = "Ctrl+Q",
            .needsCase = false,
            .run = [](ReaderWindow& w) { w.quit(); },
            .separatorBefore = true},
    // ---- edit
    Command{.id = "undo",
            .menu = Menu::edit,
            .text = QT_TRANSLATE_NOOP("Commands", "Undo"),
            .keys = "Ctrl+Z",
            .run = undo},
    Command{.id = "redo",
            .menu = Menu::edit,
            .text = QT_TRANSLATE_NOOP("Commands", "Redo"),
            .keys = "Ctrl+Shift+Z Ctrl+Y",
            .run = [](ReaderWindow& w) { w.reading().undoStack().redo(); }},
    Command{.id = "stop",
            .menu = Menu::edit,
            .text = QT_TRANSLATE_NOOP("Commands", "Stop measuring, clear what was measured"),
            .keys = "Esc",
            .needsCase = false,
            .run = stop,
            .separatorBefore = true},
    // ---- view
    Command{.id = "enlarge",
            .menu = Menu::view,
            .text = QT_TRANSLATE_NOOP("Commands", "Enlarge this pane, and back"),
            .keys = "Return Enter",
            .symbol = Symbol::enlarge,
            .run = [](ReaderWindow& w) { w.enlarge(); },
            .isOn = [](ReaderWindow& w) { return w.isEnlarged(); }},
    Command{.id = "layout-reading",
            .menu = Menu::view,
            .text = QT_TRANSLATE_NOOP("Commands", "Layout: endoscopic reading"),
            .keys = "Ctrl+1",
            .run = [](ReaderWindow& w) { w.arrange(BuiltinLayout::reading); },
            .separatorBefore = true},
    Command{.id = "layout-slices",
            .menu = Menu::view,
            .text = QT_TRANSLATE_NOOP("Commands", "Layout: slices first"),
            .keys = "Ctrl+2",
            .run = [](ReaderWindow& w) { w.arrange(BuiltinLayout::slicesFirst); }},
    Command{.id = "layout-flattened",
            .menu = Menu::view,
            .text = QT_TRANSLATE_NOOP("Commands", "Layout: flattened reading"),
            .keys = "Ctrl+3",
            .run = [](ReaderWindow& w) { w.arrange(BuiltinLayout::flattened); }},
    Command{.id = "layout-two-monitors",
            .menu = Menu::view,
            .text = QT_TRANSLATE_NOOP("Commands", "Layout: two monitors"),
            .keys = "Ctrl+4",
            .run = [](ReaderWindow& w) { w.arrange(BuiltinLayout::twoMonitors); }},
    Command{.id = "layout-save",
            .menu = Menu::view,
            .text = QT_TRANSLATE_NOOP("Commands", "Save this layout…"),
            .keys = "",
            .run = [](ReaderWindow& w) { w.saveLayout(); }},
    Command{.id = "full-screen",
            .menu = Menu::view,
            .text = QT_TRANSLATE_NOOP("Commands", "Full screen"),
            .keys = "F11",
            .needsCase = false,
            .run = [](ReaderWindow& w) { w.toggleFullScreen(); },
            .isOn = [](ReaderWindow& w) { return w.isFullScreen(); },
            .separatorBefore = true},
    // ---- pane
    Command{.id = "next-pane",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Next pane"),
            .keys = "F6",
            .run = [](ReaderWindow& w) { w.focusNextPane(+1); }},
    Command{.id = "previous-pane",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Previous pane"),
            .keys = "Shift+F6",
            .run = [](ReaderWindow& w) { w.focusNextPane(-1); }},
    Command{.id = "point",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands",
                                      "Point with the keys: arrows move, Return clicks or draws"),
            .keys = "Z",
            .run = [](ReaderWindow& w) { w.togglePointing(); },
            .isOn = [](ReaderWindow& w) { return w.pointsByKeys(); },
            .separatorBefore = true},
    Command{.id = "scroll-on",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Scroll on: the next slice, along the path"),
            .keys = "PgUp",
            .run = [](ReaderWindow& w) { onPane(w, [](Pane& p) { p.scrollByKeys(+1.0, false); }); },
            .separatorBefore = true},
    Command{
        .id = "scroll-back",
        .menu = Menu::pane,
        .text = QT_TRANSLATE_NOOP("Commands", "Scroll back"),
        .keys = "PgDown",
        .run = [](ReaderWindow& w) { onPane(w, [](Pane& p) { p.scrollByKeys(-1.0, false); }); }},
    Command{.id = "scroll-far-on",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Scroll on, ten times as far"),
            .keys = "Shift+PgUp",
            .run = [](ReaderWindow& w) { onPane(w, [](Pane& p) { p.scrollByKeys(+1.0, true); }); }},
    Command{.id = "scroll-far-back",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Scroll back, ten times as far"),
            .keys = "Shift+PgDown",
            .run = [](ReaderWindow& w) { onPane(w, [](Pane& p) { p.scrollByKeys(-1.0, true); }); }},
    Command{.id = "zoom-in",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Enlarge the picture"),
            .keys = "Ctrl++ Ctrl+=",
            .run = [](ReaderWindow& w) { onPane(w, [](Pane& p) { p.zoomByKeys(+1.0); }); },
            .separatorBefore = true},
    Command{.id = "zoom-out",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Make the picture smaller"),
            .keys = "Ctrl+-",
            .run = [](ReaderWindow& w) { onPane(w, [](Pane& p) { p.zoomByKeys(-1.0); }); }},
    Command{.id = "drag-left",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Look, turn, move or window: drag left"),
            .keys = "Alt+Left",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {-1, 0}, Qt::LeftButton);
                },
            .separatorBefore = true},
    Command{.id = "drag-right",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Look, turn, move or window: drag right"),
            .keys = "Alt+Right",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {1, 0}, Qt::LeftButton);
                }},
    Command{.id = "drag-up",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Look, turn, move or window: drag up"),
            .keys = "Alt+Up",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {0, -1}, Qt::LeftButton);
                }},
    Command{.id = "drag-down",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Look, turn, move or window: drag down"),
            .keys = "Alt+Down",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {0, 1}, Qt::LeftButton);
                }},
    Command{.id = "move-left",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Move the slice's picture left"),
            .keys = "Ctrl+Left",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {-1, 0}, Qt::MiddleButton);
                },
            .separatorBefore = true},
    Command{.id = "move-right",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Move the slice's picture right"),
            .keys = "Ctrl+Right",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {1, 0}, Qt::MiddleButton);
                }},
    Command{.id = "move-up",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Move the slice's picture up"),
            .keys = "Ctrl+Up",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {0, -1}, Qt::MiddleButton);
                }},
    Command{.id = "move-down",
            .menu = Menu::pane,
            .text = QT_TRANSLATE_NOOP("Commands", "Move the slice's picture down"),
            .keys = "Ctrl+Down",
            .run =
                [](ReaderWindow& w) {
                    dragPane(w, {0, 1}, Qt::MiddleButton);
                }},
    // ---- flight
    Command{.id = "fly-forward",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Fly forward, pause"),
            .keys = "Space",
            .symbol = Symbol::forward,
            .run = [](ReaderWindow& w) { toggle(w, Motion::forward); },
            .isOn = [](ReaderWindow& w) { return w.reader().motion() == Motion::forward; }},
    Command{.id = "fly-backward",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Fly backward, pause"),
            .keys = "Backspace",
            .symbol = Symbol::backward,
            .run = [](ReaderWindow& w) { toggle(w, Motion::backward); },
            .isOn = [](ReaderWindow& w) { return w.reader().motion() == Motion::backward; }},
    Command{.id = "pause",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Pause"),
            .keys = "",
            .symbol = Symbol::pause,
            .run = [](ReaderWindow& w) { w.reader().setMotion(Motion::paused); },
            .isOn = [](ReaderWindow& w) { return w.reader().motion() == Motion::paused; }},
    Command{.id = "step-forward",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "1 mm forward"),
            .keys = "Right Up",
            .run = [](ReaderWindow& w) { stepAlong(w, 1.0); },
            .separatorBefore = true},
    Command{.id = "step-backward",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "1 mm backward"),
            .keys = "Left Down",
            .run = [](ReaderWindow& w) { stepAlong(w, -1.0); }},
    Command{.id = "leap-forward",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "10 mm forward"),
            .keys = "Shift+Right Shift+Up",
            .run = [](ReaderWindow& w) { stepAlong(w, 10.0); }},
    Command{.id = "leap-backward",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "10 mm backward"),
            .keys = "Shift+Left Shift+Down",
            .run = [](ReaderWindow& w) { stepAlong(w, -10.0); }},
    Command{.id = "to-rectum",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "To the rectum"),
            .keys = "Home",
            .symbol = Symbol::toRectum,
            .run =
                [](ReaderWindow& w) {
                    jumpTo(w, QT_TRANSLATE_NOOP("Commands", "To the rectum"), 0.0);
                }},
    Command{.id = "to-cecum",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "To the cecum"),
            .keys = "End",
            .symbol = Symbol::toCecum,
            .run =
                [](ReaderWindow& w) {
                    jumpTo(w, QT_TRANSLATE_NOOP("Commands", "To the cecum"),
                           flightOf(w).centerline().lengthMm());
                }},
    Command{.id = "go-to-arc",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Go to a place along the path…"),
            .keys = "Ctrl+G",
            .run = [](ReaderWindow& w) { w.askForPlace(); }},
    Command{.id = "faster",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Faster"),
            .keys = "+ =",
            .run = [](ReaderWindow& w) { flightOf(w).setSpeed(flightOf(w).speedMmPerS() * 1.25); },
            .separatorBefore = true},
    Command{.id = "slower",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Slower"),
            .keys = "- _",
            .run = [](ReaderWindow& w) { flightOf(w).setSpeed(flightOf(w).speedMmPerS() / 1.25); }},
    Command{.id = "turn-round",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Turn round"),
            .keys = "R",
            .symbol = Symbol::turnRound,
            .run =
                [](ReaderWindow& w) {
                    Flight& f = flightOf(w);
                    f.setDirection(f.direction() == FlightDirection::antegrade
                                       ? FlightDirection::retrograde
                                       : FlightDirection::antegrade);
                }},
    Command{.id = "to-path",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Back to the path, straight ahead"),
            .keys = "C",
            .symbol = Symbol::center,
            .run =
                [](ReaderWindow& w) {
                    flightOf(w).returnToCenterline();
                    flightOf(w).resetLook();
                }},
    Command{.id = "free-flight",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Free flight, off the path"),
            .keys = "F",
            .run =
                [](ReaderWindow& w) {
                    Flight& f = flightOf(w);
                    f.isFree() ? f.returnToCenterline() : f.flyFreely();
                },
            .isOn = [](ReaderWindow& w) { return flightOf(w).isFree(); }},
    Command{.id = "free-forward",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Free flight: forward (held)"),
            .keys = "W",
            .heldWay = {0, 0, 1}},
    Command{.id = "free-back",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Free flight: back (held)"),
            .keys = "S",
            .heldWay = {0, 0, -1}},
    Command{.id = "free-left",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Free flight: left (held)"),
            .keys = "A",
            .heldWay = {-1, 0, 0}},
    Command{.id = "free-right",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Free flight: right (held)"),
            .keys = "D",
            .heldWay = {1, 0, 0}},
    Command{.id = "free-up",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Free flight: up (held)"),
            .keys = "E",
            .heldWay = {0, 1, 0}},
    Command{.id = "free-down",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Free flight: down (held)"),
            .keys = "Q",
            .heldWay = {0, -1, 0}},
    Command{.id = "fisheye",
            .menu = Menu::flight,
            .text = QT_TRANSLATE_NOOP("Commands", "Fisheye, which sees all around"),
            .keys = "I",
            .run = [](ReaderWindow& w) { flightOf(w).setFisheye(!flightOf(w).isFisheye()); },
            .isOn = [](ReaderWindow& w) { return flightOf(w).isFisheye(); },
            .separatorBefore = true},
    Command{
        .id = "wider",
        .menu = Menu::flight,
        .text = QT_TRANSLATE_NOOP("Commands", "Wider field of view"),
        .keys = ".",
        .run = [](ReaderWindow& w) { flightOf(w).setFov(flightOf(w).camera().fovDegrees + 5.0); }},
    Command{
        .id = "narrower",
        .menu = Menu::flight,
        .text = QT_TRANSLATE_NOOP("Commands", "Narrower field of view"),
        .keys = ",",
        .run = [](ReaderWindow& w) { flightOf(w).setFov(flightOf(w).camera().fovDegrees - 5.0); }},
    // ---- slices
    Command{.id = "window-colon",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands", "Window: colon"),
            .keys = "1",
            .run = [](ReaderWindow& w) { setWindow(w, 0); },
            .isOn = [](ReaderWindow& w) { return w.windowPreset() == 0; }},
    Command{.id = "window-soft",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands", "Window: soft tissue"),
            .keys = "2",
            .run = [](ReaderWindow& w) { setWindow(w, 1); },
            .isOn = [](ReaderWindow& w) { return w.windowPreset() == 1; }},
    Command{.id = "window-lung",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands", "Window: lung"),
            .keys = "3",
            .run = [](ReaderWindow& w) { setWindow(w, 2); },
            .isOn = [](ReaderWindow& w) { return w.windowPreset() == 2; }},
    Command{.id = "window-bone",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands", "Window: bone"),
            .keys = "4",
            .run = [](ReaderWindow& w) { setWindow(w, 3); },
            .isOn = [](ReaderWindow& w) { return w.windowPreset() == 3; }},
    Command{.id = "cleansed",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands", "As scanned, or cleansed"),
            .keys = "X",
            .run =
                [](ReaderWindow& w) {
                    reader::SliceViews& slices = w.reader().slices();
                    if (!w.reader().session().caseInfo()->cleansed)
                        return w.reading().tell(QCoreApplication::translate(
                            "Commands", "This case has no cleansed scan."));
                    change(w, QT_TRANSLATE_NOOP("Commands", "As scanned, or cleansed"),
                           slices.cleansed(), [&slices](bool on) { slices.setCleansed(on); });
                },
            .isOn = [](ReaderWindow& w) { return w.reader().slices().cleansed(); },
            .separatorBefore = true,
            .shortText = QT_TRANSLATE_NOOP("Commands", "cleansed")},
    Command{
        .id = "linked",
        .menu = Menu::slices,
        .text = QT_TRANSLATE_NOOP("Commands", "Linked: they follow the camera and one another"),
        .keys = "J",
        .run =
            [](ReaderWindow& w) { w.reader().slices().setLinked(!w.reader().slices().linked()); },
        .isOn = [](ReaderWindow& w) { return w.reader().slices().linked(); }},
    Command{.id = "thicker",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands", "Thicker slab"),
            .keys = "]",
            .run = [](ReaderWindow& w) { setSlab(w, +1); },
            .separatorBefore = true},
    Command{.id = "thinner",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands", "Thinner slab"),
            .keys = "[",
            .run = [](ReaderWindow& w) { setSlab(w, -1); }},
    Command{
        .id = "slab-maximum",
        .menu = Menu::slices,
        .text = QT_TRANSLATE_NOOP("Commands", "Slab: maximum instead of mean"),
        .keys = "H",
        .run =
            [](ReaderWindow& w) {
                Slab s = w.reader().slices().slab();
                s.projection =
                    s.projection == Projection::mean ? Projection::maximum : Projection::mean;
                changeSlab(w, s);
            },
        .isOn =
            [](ReaderWindow& w) {
                return w.reader().slices().slab().projection == Projection::maximum;
            }},
    Command{.id = "line",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP("Commands",
                                      "Measure a line: on a slice, or along the flattened wall"),
            .keys = "L",
            .symbol = Symbol::line,
            .run = [](ReaderWindow& w) { toggle(w, DrawingTool::line); },
            .isOn = [](ReaderWindow& w) { return w.reading().tool() == DrawingTool::line; },
            .separatorBefore = true},
    Command{.id = "outline",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP(
                "Commands", "Measure an ellipse on a slice, or an outline on the flattened wall"),
            .keys = "O",
            .symbol = Symbol::outline,
            .run = [](ReaderWindow& w) { toggle(w, DrawingTool::outline); },
            .isOn = [](ReaderWindow& w) { return w.reading().tool() == DrawingTool::outline; }},
    Command{.id = "ruler",
            .menu = Menu::slices,
            .text = QT_TRANSLATE_NOOP(
                "Commands", "Measure between two places that are clicked, in whichever views"),
            .keys = "Shift+L",
            .run = [](ReaderWindow& w) { toggle(w, DrawingTool::ruler); },
            .isOn = [](ReaderWindow& w) { return w.reading().tool() == DrawingTool::ruler; }},
    // ---- wall
    Command{.id = "next-optics",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Next look of the wall"),
            .keys = "T",
            .run =
                [](ReaderWindow& w) {
                    changeOptics(w.reading(),
                                 QCoreApplication::translate("Commands", "Next look of the wall"),
                                 [](auto& optics) {
                                     optics.choose((optics.chosen() + 1) % optics.presets());
                                 });
                }},
    Command{.id = "optics",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Colours, opacities and light"),
            .keys = "G",
            .run = [](ReaderWindow& w) { w.toggleOptics(); },
            .isOn = [](ReaderWindow& w) { return w.showsOptics(); },
            .shortText = QT_TRANSLATE_NOOP("Commands", "…")},
    Command{.id = "lens",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP(
                "Commands", "Lens over the endoscopic view: electronic biopsy beneath the wall"),
            .keys = "Shift+T",
            .run = toggleLens,
            .isOn = [](ReaderWindow& w) { return w.reader().lens().isOn(); },
            .shortText = QT_TRANSLATE_NOOP("Commands", "lens")},
    Command{.id = "lens-larger",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Larger lens"),
            .keys = "Alt+PgUp",
            .run = [](ReaderWindow& w) { resizeLens(w, reader::lensGrowth); }},
    Command{.id = "lens-smaller",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Smaller lens"),
            .keys = "Alt+PgDown",
            .run = [](ReaderWindow& w) { resizeLens(w, 1.0 / reader::lensGrowth); }},
    Command{.id = "fly-over",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Fly over the flattened wall"),
            .keys = "V",
            .symbol = Symbol::flyOver,
            .run =
                [](ReaderWindow& w) {
                    needStrip(w, [&] {
                        w.reader().flat().setFlyingOver(!w.reader().flat().tour().flyingOver());
                    });
                },
            .isOn = [](ReaderWindow& w) { return w.reader().flat().tour().flyingOver(); },
            .separatorBefore = true},
    Command{.id = "paint-marks",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Colour the wall around bookmarks"),
            .keys = "K",
            .run = [](ReaderWindow& w) { togglePaint(w, &WallPaintChoice::marks); },
            .isOn = [](ReaderWindow& w) { return w.reader().flat().paint().marks; },
            .shortText = QT_TRANSLATE_NOOP("Commands", "marks")},
    Command{.id = "paint-unseen",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Colour what has not been seen yet"),
            .keys = "U",
            .run = [](ReaderWindow& w) { togglePaint(w, &WallPaintChoice::unseen); },
            .isOn = [](ReaderWindow& w) { return w.reader().flat().paint().unseen; },
            .shortText = QT_TRANSLATE_NOOP("Commands", "unseen")},
    Command{.id = "forget-seen",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Nothing has been seen: begin anew"),
            .keys = "Shift+U",
            .run = [](ReaderWindow& w) { needStrip(w, [&] { w.reader().flat().forgetSeen(); }); }},
    Command{.id = "previous-missed",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Previous missed patch of the wall"),
            .keys = "Shift+H",
            .run = [](ReaderWindow& w) { goToNextMissed(w.reading(), -1); }},
    Command{.id = "next-missed",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Next missed patch of the wall"),
            .keys = "Shift+J",
            .run = [](ReaderWindow& w) { goToNextMissed(w.reading(), +1); }},
    Command{.id = "missed-panel",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Show what has been seen and missed"),
            .keys = "Ctrl+U",
            .run = [](ReaderWindow& w) { w.toggleMissed(); },
            .isOn = [](ReaderWindow& w) { return w.showsMissed(); },
            .shortText = QT_TRANSLATE_NOOP("Commands", "Missed")},
    Command{.id = "seen-report",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Save a report of what has been seen…"),
            .keys = "Ctrl+Shift+U",
            .run = [](ReaderWindow& w) { w.saveSeenReport(); }},
    Command{.id = "overview-body",
            .menu = Menu::wall,
            .text = QT_TRANSLATE_NOOP("Commands", "Overview: with the body"),
            .keys = "Y",
            .run =
                [](ReaderWindow& w) {
                    w.reader().outside().setShowsBody(!w.reader().outside().showsBody());
                },
            .isOn = [](ReaderWindow& w) { return w.reader().outside().showsBody(); },
            .separatorBefore = true},
    // ---- findings
    Command{
        .id = "detection-mode",
        .menu = Menu::findings,
        .text =
            QT_TRANSLATE_NOOP("Commands", "Findings: not shown, after the first reading, at once"),
        .keys = "Ctrl+F",
        .run =
            [](ReaderWindow& w) {
                const auto mode = w.reader().findings().choice().mode;
                chooseDetection(w.reading(),
                                mode == DetectionMode::off            ? DetectionMode::secondReader
                                : mode == DetectionMode::secondReader ? DetectionMode::concurrent
                                                                      : DetectionMode::off);
            },
        .isOn =
            [](ReaderWindow& w) {
                return w.reader().findings().choice().mode != DetectionMode::off;
            }},
    Command{.id = "first-pass-done",
            .menu = Menu::findings,
            .text = QT_TRANSLATE_NOOP("Commands", "First reading done: show findings"),
            .keys = "Ctrl+Shift+F",
            .run = [](ReaderWindow& w) { finishFirstPass(w.reading()); }},
    Command{.id = "previous-finding",
            .menu = Menu::findings,
            .text = QT_TRANSLATE_NOOP("Commands", "Previous finding"),
            .keys = "Shift+N",
            .run = [](ReaderWindow& w) { goToNextFinding(w.reading(), -1); },
            .separatorBefore = true},
    Command{.id = "next-finding",
            .menu = Menu::findings,
            .text = QT_TRANSLATE_NOOP("Commands", "Next finding"),
            .keys = "Shift+M",
            .run = [](ReaderWindow& w) { goToNextFinding(w.reading(), +1); }},
    Command{.id = "measure-finding",
            .menu = Menu::findings,
            .text = QT_TRANSLATE_NOOP("Commands", "Measure the finding"),
            .keys = "Shift+K",
            .run = [](ReaderWindow& w) { measureFinding(w.reading()); }},
    Command{.id = "findings-panel",
            .menu = Menu::findings,
            .text = QT_TRANSLATE_NOOP("Commands", "Show the list of findings"),
            .keys = "Shift+F",
            .run = [](ReaderWindow& w) { w.toggleFindings(); },
            .isOn = [](ReaderWindow& w) { return w.showsFindings(); },
            .separatorBefore = true,
            .shortText = QT_TRANSLATE_NOOP("Commands", "Findings")},
    // ---- bookmarks
    Command{.id = "bookmark",
            .menu = Menu::bookmarks,
            .text = QT_TRANSLATE_NOOP("Commands", "Bookmark this place"),
            .keys = "B",
            .symbol = Symbol::bookmark,
            .run = [](ReaderWindow& w) { w.reader().addBookmark(""); }},
    Command{.id = "bookmark-note",
            .menu = Menu::bookmarks,
            .text = QT_TRANSLATE_NOOP("Commands", "Bookmark with a note"),
            .keys = "Shift+B",
            .run = [](ReaderWindow& w) { w.writeNote(); }},
    Command{.id = "previous-bookmark",
            .menu = Menu::bookmarks,
            .text = QT_TRANSLATE_NOOP("Commands", "Previous bookmark"),
            .keys = "P",
            .run = [](ReaderWindow& w) { goToBookmark(w, -1); },
            .separatorBefore = true},
    Command{.id = "next-bookmark",
            .menu = Menu::bookmarks,
            .text = QT_TRANSLATE_NOOP("Commands", "Next bookmark"),
            .keys = "N",
            .run = [](ReaderWindow& w) { goToBookmark(w, +1); }},
    Command{.id = "bookmarks-panel",
            .menu = Menu::bookmarks,
            .text = QT_TRANSLATE_NOOP("Commands", "Show the list of bookmarks"),
            .keys = "M",
            .run = [](ReaderWindow& w) { w.toggleBookmarks(); },
            .isOn = [](ReaderWindow& w) { return w.showsBookmarks(); },
            .separatorBefore = true,
            .shortText = QT_TRANSLATE_NOOP("Commands", "Bookmarks")},
    // ---- help
    Command{.id = "help",
            .menu = Menu::help,
            .text = QT_TRANSLATE_NOOP("Commands", "Keys and mouse"),
            .keys = "? F1",
            .needsCase = false,
            .run = [](ReaderWindow& w) { w.showHelp(); },
            .shortText = QT_TRANSLATE_NOOP("Commands", "Keys")},
    Command{.id = "change-keys",
            .menu = Menu::help,
            .text = QT_TRANSLATE_NOOP("Commands", "Change the keys…"),
            .keys = "",
            .needsCase = false,
            .run = [](ReaderWindow& w) { w.changeKeys(); }},
    Command{.id = "about",
            .menu = Menu::help,
            .text = QT_TRANSLATE_NOOP("Commands", "About Haustra and this server"),
            .keys = "",
            .needsCase = false,
            .run = [](ReaderWindow& w) { w.showAbout(); },
            .separatorBefore = true},
};

QString settingOf(const Command& command) {
    return QStringLiteral("keys/") + QString::fromLatin1(command.id);
}

}  // namespace

QString nameOf(Menu menu) {
    switch (menu) {
        case Menu::file:
            return QCoreApplication::translate("Commands", "&File");
        case Menu::edit:
            return QCoreApplication::translate("Commands", "&Edit");
        case Menu::view:
            return QCoreApplication::translate("Commands", "&View");
        case Menu::pane:
            return QCoreApplication::translate("Commands", "&Pane");
        case Menu::flight:
            return QCoreApplication::translate("Commands", "F&light");
        case Menu::slices:
            return QCoreApplication::translate("Commands", "&Slices");
        case Menu::wall:
            return QCoreApplication::translate("Commands", "&Wall");
        case Menu::findings:
            return QCoreApplication::translate("Commands", "F&indings");
        case Menu::bookmarks:
            return QCoreApplication::translate("Commands", "&Bookmarks");
        case Menu::help:
            break;
    }
    return QCoreApplication::translate("Commands", "&Help");
}

std::span<const Command> commands() {
    return table;
}

QString textOf(const Command& command) {
    return QCoreApplication::translate("Commands", command.text);
}

QList<QKeySequence> CommandSet::keysOfOld(const Command& command) {
    QList<QKeySequence> keys;
    for (const QString& key : QString::fromLatin1(command.keys).split(' ', Qt::SkipEmptyParts))
        keys += QKeySequence(key, QKeySequence::PortableText);
    return keys;
}

CommandSet::CommandSet(ReaderWindow& window) : QObject(&window), window_(window) {
    const QSettings settings;
    // A key that the reader has given to one command is no other's of old.
    QList<QKeySequence> chosen;
    for (const Command& command : commands())
        chosen += QKeySequence::listFromString(settings.value(settingOf(command)).toString(),
                                               QKeySequence::PortableText);
    const auto keysLeft = [&](const Command& command) {
        QList<QKeySequence> keys = keysOfOld(command);
        keys.removeIf([&](const QKeySequence& key) { return chosen.contains(key); });
        return keys;
    };
    for (const Command& command : commands()) {
        auto* action = new QAction(iconOf(command.symbol), textOf(command), this);
        if (command.shortText)
            action->setIconText(QCoreApplication::translate("Commands", command.shortText));
        actions_[command.id] = action;
        action->setObjectName(QString::fromLatin1(command.id));
        action->setCheckable(command.isOn != nullptr);
        action->setShortcuts(
            settings.contains(settingOf(command))
                ? QKeySequence::listFromString(settings.value(settingOf(command)).toString(),
                                               QKeySequence::PortableText)
                : keysLeft(command));
        if (!command.run) continue;
        connect(action, &QAction::triggered, this, [this, &command] {
            command.run(window_);
            window_.reading().changed();
            look();
        });
    }
}

void CommandSet::setKeys(const Command& command, const QList<QKeySequence>& keys) {
    QSettings settings;
    action(command)->setShortcuts(keys);
    if (keys == keysOfOld(command))
        settings.remove(settingOf(command));
    else
        settings.setValue(settingOf(command),
                          QKeySequence::listToString(keys, QKeySequence::PortableText));
}

void CommandSet::resetKeys() {
    for (const Command& command : commands())
        setKeys(command, keysOfOld(command));
}

void CommandSet::look() {
    // Of a case behind the list of cases nothing is to be changed unseen.
    const bool open = window_.reader().isOpen() && !window_.showsCases();
    for (const Command& command : commands()) {
        QAction* action = actions_.at(command.id);
        action->setEnabled(open || !command.needsCase);
        if (command.isOn) action->setChecked(open && command.isOn(window_));
    }
    // A link that is lost comes back by itself.
    actions_.at("connect-again")
        ->setEnabled(window_.reader().session().phase() == reader::Phase::failed);
    const QUndoStack& stack = window_.reading().undoStack();
    const bool begun = open && window_.reader().rulers().isBegun();
    const QString undone =
        begun ? QCoreApplication::translate("Commands", "first end of a ruler") : stack.undoText();
    for (const auto& [id, can, what] : {std::tuple{"undo", begun || stack.canUndo(), undone},
                                        std::tuple{"redo", stack.canRedo(), stack.redoText()}}) {
        action(id)->setEnabled(open && can);
        const QString name =
            QCoreApplication::translate("Commands", id[0] == 'u' ? "Undo" : "Redo");
        action(id)->setText(can ? name + QStringLiteral(": ") + what : name);
    }
}

}  // namespace haustra::window
