// What a server tells in words of its own, in the window's language.
#pragma once

#include <QString>
#include <QStringList>

namespace haustra::window {

/// A sentence that detection or segmentation is known to tell, with its numbers and places, in the
/// window's language; several, joined by "; ", each by itself. Any other as it came.
QString translatedSentence(const QString& told);

/// The sentences that are known, in English: %1, %2 … stand for what varies.
QStringList knownSentences();

}  // namespace haustra::window
