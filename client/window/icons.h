// The window's symbols, drawn: no picture files, sharp on every screen, in the theme's colour.
#pragma once

#include <QIcon>

namespace haustra::window {

enum class Symbol {
    none,
    forward,
    backward,
    pause,
    toRectum,
    toCecum,
    turnRound,
    bookmark,
    center,
    flyOver,
    line,
    outline,
    cases,
    enlarge,
    more
};

QIcon iconOf(Symbol symbol);

}  // namespace haustra::window
