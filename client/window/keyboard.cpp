// What the keys do. The help page in overlays.cpp lists them.
#include "window/ui.h"

#include <algorithm>
#include <span>
#include <string_view>

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

void turnRound(Flight& flight) {
    flight.setDirection(flight.direction() == FlightDirection::antegrade
                            ? FlightDirection::retrograde
                            : FlightDirection::antegrade);
}

void toggleFlyingOver(Ui& ui) {
    reader::FlatReading& flat = ui.reader.flat();
    if (!flat.hasStrip()) return ui.tell("this case has not been flattened");
    flat.setFlyingOver(!flat.tour().flyingOver());
}

void toggleCleansed(Ui& ui) {
    if (!ui.reader.session().caseInfo()->cleansed) return ui.tell("this case has no cleansed scan");
    ui.reader.slices().setCleansed(!ui.reader.slices().cleansed());
}

// Letters as the layout of the keyboard gives them.
struct LetterKey {
    std::string_view letters;
    void (*press)(Ui& ui);
};

constexpr LetterKey alwaysKeys[] = {
    {"?", [](Ui& ui) { ui.showHelp = !ui.showHelp; }},
    {"mM", [](Ui& ui) { ui.showBookmarks = !ui.showBookmarks; }},
};

Flight& flightOf(Ui& ui) {
    return ui.reader.flight();
}

// With a case open.
constexpr LetterKey caseKeys[] = {
    {"+=", [](Ui& ui) { flightOf(ui).setSpeed(flightOf(ui).speedMmPerS() * 1.25); }},
    {"-_", [](Ui& ui) { flightOf(ui).setSpeed(flightOf(ui).speedMmPerS() / 1.25); }},
    {"rR", [](Ui& ui) { turnRound(flightOf(ui)); }},
    {"cC", [](Ui& ui) { flightOf(ui).returnToCenterline(), flightOf(ui).resetLook(); }},
    {"fF",
     [](Ui& ui) {
         Flight& flight = flightOf(ui);
         flight.isFree() ? flight.returnToCenterline() : flight.flyFreely();
     }},
    {"b", [](Ui& ui) { ui.reader.addBookmark(""); }},
    {"B", [](Ui& ui) { ui.showBookmarks = ui.focusNote = true; }},
    {"nN", [](Ui& ui) { ui.reader.goToBookmark(+1); }},
    {"pP", [](Ui& ui) { ui.reader.goToBookmark(-1); }},
    {"tT", [](Ui& ui) { nextTransferFunction(ui.reader.optics()); }},
    {"gG", [](Ui& ui) { ui.showTransfer = !ui.showTransfer; }},
    {"iI", [](Ui& ui) { flightOf(ui).setFisheye(!flightOf(ui).isFisheye()); }},
    {"yY", [](Ui& ui) { ui.reader.outside().setShowsBody(!ui.reader.outside().showsBody()); }},
    {"kK", [](Ui& ui) { togglePaint(ui, &WallPaintChoice::marks); }},
    {"u", [](Ui& ui) { togglePaint(ui, &WallPaintChoice::unseen); }},
    {"U", [](Ui& ui) { ui.reader.flat().forgetSeen(); }},
    {"vV", toggleFlyingOver},
    {"lL", [](Ui& ui) { toggle(ui, DrawingTool::line); }},
    {"oO", [](Ui& ui) { toggle(ui, DrawingTool::outline); }},
    {"xX", toggleCleansed},
};

void pressLetter(Ui& ui, std::span<const LetterKey> keys, ImWchar letter) {
    for (const LetterKey& key : keys)
        for (const char one : key.letters)
            if (letter == ImWchar(one)) key.press(ui);
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
    for (const ImWchar letter : io.InputQueueCharacters) {
        pressLetter(ui, alwaysKeys, letter);
        if (ui.reader.isOpen()) pressLetter(ui, caseKeys, letter);
    }
    if (!ui.reader.isOpen()) return true;
    Flight& flight = ui.reader.flight();
    if (flight.isFree()) moveFreely(flight, seconds, io.KeyShift);
    if (flight.centerline().points.empty()) return true;
    for (const KeyPress& key : presses)
        if (!key.ctrl && !key.alt) handleFlightKey(ui.reader, key);
    return true;
}

}  // namespace haustra::window
