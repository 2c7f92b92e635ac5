// Changes of how walls and slices look that Ctrl+Z takes back.
#pragma once

#include "window/reading.h"

#include <QCoreApplication>

namespace haustra::window {

/// Changes how the wall is shown; those of one kind that follow one another within a second are one
/// step.
template <class Change>
void changeOptics(Reading& reading, const QString& text, const Change& change) {
    reader::OpticsEditor& optics = reading.reader().optics();
    const auto before = optics.shown();
    change(optics);
    constexpr int opticsSteps = 3;
    reading.did(
        text, [&optics, before] { optics.show(before); },
        [&optics, after = optics.shown()] { optics.show(after); }, opticsSteps);
}

/// `before` is the window that Ctrl+Z brings back.
inline void changedWindow(Reading& reading, const WindowLevel& before) {
    reader::SliceViews& slices = reading.reader().slices();
    if (before == slices.window()) return;
    constexpr int windowSteps = 2;
    reading.did(
        QCoreApplication::translate("Commands", "change the window"),
        [&slices, before] { slices.setWindow(before); },
        [&slices, after = slices.window()] { slices.setWindow(after); }, windowSteps);
}
inline void changeWindow(Reading& reading, const WindowLevel& window) {
    const WindowLevel before = reading.reader().slices().window();
    reading.reader().slices().setWindow(window);
    changedWindow(reading, before);
}

}  // namespace haustra::window
