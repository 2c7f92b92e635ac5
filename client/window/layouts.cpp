#include "window/layouts.h"

#include <QDataStream>
#include <QDockWidget>
#include <QGuiApplication>
#include <QIODevice>
#include <QMainWindow>
#include <QMouseEvent>
#include <QScreen>
#include <QSettings>

namespace haustra::window {
namespace {

constexpr auto left = Qt::LeftDockWidgetArea;
constexpr int version = 1;  // of the docks' arrangement

QString settingOf(const QString& name) {
    return QStringLiteral("layouts/") + QString::fromLatin1(name.toUtf8().toPercentEncoding());
}

}  // namespace

// All docks in the main window, none shown, none of the past arrangement left.
void Layouts::gather() {
    letGo();
    for (QDockWidget* dock : docks_.all()) {
        dock->setFloating(false);
        dock->hide();
        main_.removeDockWidget(dock);
        second_.removeDockWidget(dock);
    }
    second_.hide();
    floatOptics();
}

void Layouts::letGo() {
    const auto release = [](QWidget& widget) {
        QMouseEvent event(QEvent::MouseButtonRelease, {-1, -1}, widget.mapToGlobal(QPointF(-1, -1)),
                          Qt::LeftButton, Qt::NoButton, Qt::NoModifier);
        QCoreApplication::sendEvent(&widget, &event);
    };
    for (QDockWidget* dock : docks_.all())
        release(*dock);
    release(main_);
    release(second_);
}

// Beside the views, not among them, until the reader docks it.
void Layouts::floatOptics() {
    main_.addDockWidget(Qt::RightDockWidgetArea, docks_.optics);
    docks_.optics->hide();
    docks_.optics->setFloating(true);
}

void Layouts::showFlat(bool flat) {
    if (flat) return;
    docks_.strip->hide();
    docks_.zoom->hide();
}

void Layouts::arrange(BuiltinLayout layout, bool flat) {
    gather();
    const Docks& d = docks_;
    const auto split = [&](QDockWidget* first, QDockWidget* second, Qt::Orientation way) {
        main_.splitDockWidget(first, second, way);
    };
    const int wide = main_.width(), high = main_.height();
    switch (layout) {
        case BuiltinLayout::reading:
            main_.addDockWidget(left, d.axial);
            split(d.axial, d.endoscopic, Qt::Horizontal);
            split(d.endoscopic, d.strip, Qt::Horizontal);
            split(d.strip, d.overview, Qt::Horizontal);
            split(d.axial, d.coronal, Qt::Vertical);
            split(d.coronal, d.sagittal, Qt::Vertical);
            split(d.endoscopic, d.zoom, Qt::Vertical);
            split(d.overview, d.oblique, Qt::Vertical);
            split(d.oblique, d.bookmarks, Qt::Vertical);
            for (QDockWidget* dock : d.all())
                dock->setVisible(dock != d.optics && dock != d.findings && dock != d.missed &&
                                 (flat || !d.isFlat(dock)));
            main_.resizeDocks({d.axial, d.endoscopic, d.strip, d.overview},
                              {wide * 20 / 100, wide * 41 / 100, wide * 20 / 100, wide * 19 / 100},
                              Qt::Horizontal);
            main_.resizeDocks({d.endoscopic, d.zoom}, {high * 58 / 100, high * 42 / 100},
                              Qt::Vertical);
            main_.resizeDocks({d.overview, d.oblique, d.bookmarks},
                              {high * 42 / 100, high * 32 / 100, high * 26 / 100}, Qt::Vertical);
            main_.resizeDocks({d.axial, d.coronal, d.sagittal}, {high / 3, high / 3, high / 3},
                              Qt::Vertical);
            break;
        case BuiltinLayout::slicesFirst:
            main_.addDockWidget(left, d.axial);
            split(d.axial, d.coronal, Qt::Horizontal);
            split(d.coronal, d.endoscopic, Qt::Horizontal);
            split(d.coronal, d.sagittal, Qt::Vertical);
            split(d.endoscopic, d.overview, Qt::Vertical);
            split(d.overview, d.bookmarks, Qt::Vertical);
            for (QDockWidget* dock :
                 {d.axial, d.coronal, d.sagittal, d.endoscopic, d.overview, d.bookmarks})
                dock->show();
            main_.resizeDocks({d.axial, d.coronal, d.endoscopic},
                              {wide * 50 / 100, wide * 26 / 100, wide * 24 / 100}, Qt::Horizontal);
            main_.resizeDocks({d.endoscopic, d.overview, d.bookmarks},
                              {high * 38 / 100, high * 36 / 100, high * 26 / 100}, Qt::Vertical);
            main_.resizeDocks({d.coronal, d.sagittal}, {high / 2, high / 2}, Qt::Vertical);
            break;
        case BuiltinLayout::flattened:
            main_.addDockWidget(left, d.strip);
            split(d.strip, d.zoom, Qt::Horizontal);
            split(d.zoom, d.endoscopic, Qt::Horizontal);
            split(d.endoscopic, d.axial, Qt::Vertical);
            split(d.axial, d.bookmarks, Qt::Vertical);
            for (QDockWidget* dock : {d.strip, d.zoom, d.endoscopic, d.axial, d.bookmarks})
                dock->show();
            main_.resizeDocks({d.strip, d.zoom, d.endoscopic},
                              {wide * 22 / 100, wide * 48 / 100, wide * 30 / 100}, Qt::Horizontal);
            main_.resizeDocks({d.endoscopic, d.axial, d.bookmarks},
                              {high * 42 / 100, high * 34 / 100, high * 24 / 100}, Qt::Vertical);
            showFlat(flat);
            break;
        case BuiltinLayout::twoMonitors:
            main_.addDockWidget(left, d.endoscopic);
            split(d.endoscopic, d.strip, Qt::Horizontal);
            split(d.endoscopic, d.zoom, Qt::Vertical);
            for (QDockWidget* dock : {d.endoscopic, d.strip, d.zoom})
                dock->show();
            main_.resizeDocks({d.endoscopic, d.strip}, {wide * 70 / 100, wide * 30 / 100},
                              Qt::Horizontal);
            main_.resizeDocks({d.endoscopic, d.zoom}, {high * 62 / 100, high * 38 / 100},
                              Qt::Vertical);
            showFlat(flat);
            fillSecond();
            break;
    }
    placeLists();
}

// Tabs beside the bookmarks once they are shown.
void Layouts::placeLists() {
    QMainWindow& window = docks_.bookmarks->parentWidget() == &second_ ? second_ : main_;
    for (QDockWidget* list : {docks_.findings, docks_.missed}) {
        window.tabifyDockWidget(docks_.bookmarks, list);
        list->hide();
    }
}

void Layouts::fillSecond() {
    const Docks& d = docks_;
    // The other monitor, or beside the main window where there is but one.
    QScreen* here = main_.screen();
    QRect area = here->availableGeometry();
    for (QScreen* screen : QGuiApplication::screens())
        if (screen != here) area = screen->availableGeometry();
    if (area == here->availableGeometry()) area.setLeft(area.center().x());
    second_.setGeometry(area.adjusted(8, 32, -8, -8));
    second_.addDockWidget(left, d.axial);
    second_.splitDockWidget(d.axial, d.coronal, Qt::Horizontal);
    second_.splitDockWidget(d.coronal, d.overview, Qt::Horizontal);
    second_.splitDockWidget(d.axial, d.oblique, Qt::Vertical);
    second_.splitDockWidget(d.coronal, d.sagittal, Qt::Vertical);
    second_.splitDockWidget(d.overview, d.bookmarks, Qt::Vertical);
    for (QDockWidget* dock : {d.axial, d.coronal, d.sagittal, d.overview, d.oblique, d.bookmarks})
        dock->show();
    second_.show();
    second_.resizeDocks({d.axial, d.coronal, d.overview},
                        {area.width() * 38 / 100, area.width() * 38 / 100, area.width() * 24 / 100},
                        Qt::Horizontal);
}

// ---- kept
// -----------------------------------------------------------------------------------------

QByteArray Layouts::state() const {
    QByteArray bytes;
    QDataStream out(&bytes, QIODevice::WriteOnly);
    QStringList inSecond;
    for (QDockWidget* dock : docks_.all())
        if (dock->parentWidget() == &second_) inSecond += dock->objectName();
    out << version << main_.saveState(version) << inSecond << second_.saveState(version)
        << second_.saveGeometry() << second_.isVisible();
    return bytes;
}

bool Layouts::restore(const QByteArray& state, bool flat) {
    QDataStream in(state);
    int kept = 0;
    QByteArray main, second, geometry;
    QStringList inSecond;
    bool secondShows = false;
    in >> kept;
    if (kept != version) return false;
    in >> main >> inSecond >> second >> geometry >> secondShows;
    if (in.status() != QDataStream::Ok) return false;
    gather();
    for (QDockWidget* dock : docks_.all())
        if (dock != docks_.optics)
            (inSecond.contains(dock->objectName()) ? second_ : main_).addDockWidget(left, dock);
    const bool restored = main_.restoreState(main, version);
    if (!inSecond.isEmpty()) {
        second_.restoreGeometry(geometry);
        second_.restoreState(second, version);
        second_.setVisible(secondShows);
    }
    showFlat(flat);
    return restored;
}

QStringList Layouts::names() {
    QSettings settings;
    settings.beginGroup(QStringLiteral("layouts"));
    QStringList names;
    for (const QString& key : settings.childKeys())
        names += QString::fromUtf8(QByteArray::fromPercentEncoding(key.toLatin1()));
    return names;
}

void Layouts::save(const QString& name) const {
    QSettings().setValue(settingOf(name), state());
}

bool Layouts::restore(const QString& name, bool flat) {
    return restore(QSettings().value(settingOf(name)).toByteArray(), flat);
}

void Layouts::remove(const QString& name) {
    QSettings().remove(settingOf(name));
}

}  // namespace haustra::window
