// Changes of the wall's optics that Ctrl+Z takes back.
#pragma once

#include "window/reading.h"

namespace haustra::window {

/// Changes what is shown; those of one kind that follow one another within a second are one step.
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

}  // namespace haustra::window
