// The window's language.
#pragma once

#include <QString>
#include <QStringList>

class QApplication;

namespace haustra::window {

/// Those that there are: "en", "de", and "", the system's.
QStringList languages();
/// "Deutsch": as its readers call it.
QString nameOfLanguage(const QString& language);
/// An empty one: the system's, where there is a translation for it. Before the first window; what
/// is open keeps its language until the next start.
void useLanguage(QApplication& application, const QString& language);

}  // namespace haustra::window
