// Pictures that leave the window: to the clipboard, by a drag, to a file.
#pragma once

#include <QImage>

class QMimeData;
class QWidget;

namespace haustra::window {

/// The picture, as an image and as a PNG file whose texts say what it is of, and that text.
QMimeData* mimeDataOf(const QImage& image);
/// Asks for a file and writes the picture there as PNG, with what it is of among its texts. The
/// error to tell, or an empty string; also where nothing was chosen.
QString savePicture(QWidget* parent, const QImage& image, const QString& suggestedName);

}  // namespace haustra::window
