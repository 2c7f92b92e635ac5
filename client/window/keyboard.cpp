// What the keys do. The help page in overlays.cpp lists them.
#include "window/ui.h"

#include <algorithm>

#include <SDL_scancode.h>

namespace haustra::window {
namespace {

using reader::Flight;
using reader::Motion;

void toggle(reader::Reader& reader, Motion motion) {
    reader.setMotion(reader.motion() == motion ? Motion::paused : motion);
}

// A tool of the flattened wall, or none where it was chosen already.
void toggle(Ui& ui, DrawingTool tool) {
    if (!ui.reader.flat().hasStrip()) return ui.tell("this case has not been flattened");
    ui.tool = ui.tool == tool ? DrawingTool::none : tool;
}

void stepAlong(Flight& flight, double mm) {
    flight.setMotion(Motion::paused);
    flight.goTo(flight.arcMm() + (flight.direction() == FlightDirection::antegrade ? mm : -mm));
}

void nextTransferFunction(reader::OpticsEditor& optics) {
    optics.choose((optics.chosen() + 1) % optics.presets());
}

void togglePaint(Ui& ui, bool WallPaintChoice::*which) {
    WallPaintChoice paint = ui.reader.flat().paint();
    paint.*which = !(paint.*which);
    if (!ui.reader.flat().setPaint(paint))
        ui.tell("this case has not been flattened: its wall cannot be coloured");
}

// Letters as the layout of the keyboard gives them.
void handleLetter(Ui& ui, ImWchar letter) {
    reader::Reader& reader = ui.reader;
    Flight& flight = reader.flight();
    switch (letter) {
        case '?':
            ui.showHelp = !ui.showHelp;
            return;
        case 'm':
        case 'M':
            ui.showBookmarks = !ui.showBookmarks;
            return;
        default:
            break;
    }
    if (!reader.isOpen()) return;
    switch (letter) {
        case '+':
        case '=':
            flight.setSpeed(flight.speedMmPerS() * 1.25);
            break;
        case '-':
        case '_':
            flight.setSpeed(flight.speedMmPerS() / 1.25);
            break;
        case 'r':
        case 'R':
            flight.setDirection(flight.direction() == FlightDirection::antegrade
                                    ? FlightDirection::retrograde
                                    : FlightDirection::antegrade);
            break;
        case 'c':
        case 'C':
            flight.returnToCenterline(), flight.resetLook();
            break;
        case 'f':
        case 'F':
            flight.isFree() ? flight.returnToCenterline() : flight.flyFreely();
            break;
        case 'b':
            reader.addBookmark("");
            break;
        case 'B':
            ui.showBookmarks = ui.focusNote = true;
            break;
        case 'n':
        case 'N':
            reader.goToBookmark(+1);
            break;
        case 'p':
        case 'P':
            reader.goToBookmark(-1);
            break;
        case 't':
        case 'T':
            nextTransferFunction(reader.optics());
            break;
        case 'g':
        case 'G':
            ui.showTransfer = !ui.showTransfer;
            break;
        case 'i':
        case 'I':
            flight.setFisheye(!flight.isFisheye());
            break;
        case 'y':
        case 'Y':
            reader.outside().setShowsBody(!reader.outside().showsBody());
            break;
        case 'k':
        case 'K':
            togglePaint(ui, &WallPaintChoice::marks);
            break;
        case 'u':
            togglePaint(ui, &WallPaintChoice::unseen);
            break;
        case 'U':
            reader.flat().forgetSeen();
            break;
        case 'v':
        case 'V':
            if (reader.flat().hasStrip())
                reader.flat().setFlyingOver(!reader.flat().tour().flyingOver());
            else
                ui.tell("this case has not been flattened");
            break;
        case 'l':
        case 'L':
            toggle(ui, DrawingTool::line);
            break;
        case 'o':
        case 'O':
            toggle(ui, DrawingTool::outline);
            break;
        case 'x':
        case 'X':
            if (reader.session().caseInfo()->cleansed)
                reader.slices().setCleansed(!reader.slices().cleansed());
            else
                ui.tell("this case has no cleansed scan");
            break;
        default:
            break;
    }
}

void moveFreely(Flight& flight, double seconds, bool fast) {
    const auto held = [](SDL_Scancode code) { return ImGui::IsKeyDown(code) ? 1.0 : 0.0; };
    const glm::dvec3 way(held(SDL_SCANCODE_D) - held(SDL_SCANCODE_A),
                         held(SDL_SCANCODE_E) - held(SDL_SCANCODE_Q),
                         held(SDL_SCANCODE_W) - held(SDL_SCANCODE_S));
    flight.moveFreely(way * flight.speedMmPerS() * std::min(seconds, 0.1) * (fast ? 3.0 : 1.0));
}

void handleFlightKey(reader::Reader& reader, const KeyPress& key) {
    Flight& flight = reader.flight();
    const double stepMm = key.shift ? 10.0 : 1.0;
    switch (key.scancode) {
        case SDL_SCANCODE_SPACE:
            toggle(reader, Motion::forward);
            break;
        case SDL_SCANCODE_BACKSPACE:
            toggle(reader, Motion::backward);
            break;
        case SDL_SCANCODE_RIGHT:
        case SDL_SCANCODE_UP:
            stepAlong(flight, stepMm);
            break;
        case SDL_SCANCODE_LEFT:
        case SDL_SCANCODE_DOWN:
            stepAlong(flight, -stepMm);
            break;
        case SDL_SCANCODE_HOME:
            flight.setMotion(Motion::paused);
            flight.goTo(0.0);
            break;
        case SDL_SCANCODE_END:
            flight.setMotion(Motion::paused);
            flight.goTo(flight.centerline().lengthMm());
            break;
        default:
            break;
    }
}

}  // namespace

bool handleKeys(Ui& ui, const std::vector<KeyPress>& presses, double seconds) {
    const ImGuiIO& io = ImGui::GetIO();
    for (const KeyPress& key : presses) {
        if (key.ctrl && key.scancode == SDL_SCANCODE_Q) return false;
        if (key.scancode == SDL_SCANCODE_F1) ui.showHelp = !ui.showHelp;
        if (key.scancode == SDL_SCANCODE_ESCAPE) {
            if (!ui.showHelp)
                ui.tool = DrawingTool::none, ui.reader.flat().wall().clearMeasurement();
            ui.showHelp = false;
        }
    }
    if (io.WantTextInput) return true;
    for (const ImWchar letter : io.InputQueueCharacters)
        handleLetter(ui, letter);
    if (!ui.reader.isOpen()) return true;
    Flight& flight = ui.reader.flight();
    if (flight.isFree()) moveFreely(flight, seconds, io.KeyShift);
    if (flight.centerline().points.empty()) return true;
    for (const KeyPress& key : presses)
        if (!key.ctrl && !key.alt) handleFlightKey(ui.reader, key);
    return true;
}

}  // namespace haustra::window
