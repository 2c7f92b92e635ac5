// What a server tells in words of its own, in the window's language.
#pragma once

#include <QString>
#include <QStringList>

namespace haustra::window {

/// A sentence that a warning of Haustra's programs, or a model, is known to tell, with its numbers
/// and places, in the window's language; up to four, joined by "; ", each by itself. Any other as
/// it came.
QString translatedSentence(const QString& told);

/// The sentences that are known, in English: %1, %2 …, in this order, stand for what varies.
QStringList knownSentences();
/// The words that may stand there.
QStringList knownWords();

}  // namespace haustra::window
