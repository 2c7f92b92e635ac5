// Colours of the window, and of what is written on its pictures.
#pragma once

#include <QColor>
#include <QString>
#include <QStringList>

class QApplication;

namespace haustra::window {

/// A name is what the settings keep: "dark", "light" or "contrast".
struct Theme {
    QString name;
    // Of the window.
    QColor window, base, raised, text, muted, border, accent, accentText, bookmark, trouble;
    // On pictures, whatever the window's colours are: they are dark, or they would tire the eye.
    QColor onPicture, dimOnPicture, accentOnPicture, bookmarkOnPicture, troubleOnPicture,
        measuredOnPicture, outline;
    double lineWidth = 1.0;  ///< times as wide as usual
};

QStringList themeNames();
/// Another name gives the dark one, nearly without colour, so that nothing competes with the
/// pictures.
const Theme& themeOf(const QString& name);
/// The theme in use.
const Theme& theme();
/// All windows take it on.
void applyTheme(QApplication& application, const QString& name);

}  // namespace haustra::window
