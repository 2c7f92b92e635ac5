#include "window/picture_out.h"

#include <QBuffer>
#include <QCoreApplication>
#include <QFileDialog>
#include <QImageWriter>
#include <QMimeData>
#include <QSaveFile>

namespace haustra::window {

QMimeData* mimeDataOf(const QImage& image) {
    QByteArray png;
    QBuffer buffer(&png);
    buffer.open(QIODevice::WriteOnly);
    QImageWriter(&buffer, "png").write(image);
    auto* data = new QMimeData;
    data->setImageData(image);
    data->setData(QStringLiteral("image/png"), png);
    data->setText(image.text(QStringLiteral("Description")));
    return data;
}

QString savePicture(QWidget* parent, const QImage& image, const QString& suggestedName) {
    const QString file = QFileDialog::getSaveFileName(
        parent, QCoreApplication::translate("PictureOut", "Save the picture"), suggestedName,
        QCoreApplication::translate("PictureOut", "Pictures (*.png)"));
    if (file.isEmpty()) return {};
    QSaveFile out(file);  // replaced in one step
    if (out.open(QIODevice::WriteOnly) && QImageWriter(&out, "png").write(image) && out.commit())
        return {};
    return QCoreApplication::translate("PictureOut", "cannot write %1: %2")
        .arg(file, out.errorString());
}

}  // namespace haustra::window
