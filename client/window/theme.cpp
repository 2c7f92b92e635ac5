#include "window/theme.h"

#include <QApplication>
#include <QPalette>
#include <QStyleFactory>
#include <array>

namespace haustra::window {
namespace {

const std::array<Theme, 3>& themes() {
    static const std::array<Theme, 3> all = [] {
        Theme dark;
        dark.name = QStringLiteral("dark");
        dark.window = QColor(21, 25, 31);
        dark.base = QColor(13, 16, 20);
        dark.raised = QColor(38, 45, 54);
        dark.text = QColor(222, 228, 235);
        dark.muted = QColor(150, 160, 173);
        dark.border = QColor(58, 67, 79);
        dark.accent = QColor(37, 120, 128);
        dark.accentText = Qt::white;
        dark.bookmark = QColor(235, 176, 88);
        dark.trouble = QColor(240, 106, 98);
        dark.onPicture = QColor(222, 228, 235);
        dark.dimOnPicture = QColor(200, 208, 216);
        dark.accentOnPicture = QColor(72, 190, 199);
        dark.bookmarkOnPicture = QColor(235, 176, 88);
        dark.troubleOnPicture = QColor(240, 106, 98);
        dark.measuredOnPicture = QColor(255, 221, 87);
        dark.outline = QColor(0, 0, 0, 200);
        Theme light = dark;
        light.name = QStringLiteral("light");
        light.window = QColor(240, 242, 245);
        light.base = Qt::white;
        light.raised = QColor(226, 230, 235);
        light.text = QColor(24, 29, 36);
        light.muted = QColor(90, 100, 112);
        light.border = QColor(178, 186, 196);
        light.accent = QColor(0, 110, 120);
        light.bookmark = QColor(150, 92, 0);
        light.trouble = QColor(180, 30, 24);
        Theme contrast = dark;
        contrast.name = QStringLiteral("contrast");
        contrast.window = contrast.base = contrast.raised = Qt::black;
        contrast.text = contrast.muted = contrast.border = Qt::white;
        contrast.accent = QColor(255, 235, 0);
        contrast.accentText = Qt::black;
        contrast.bookmark = QColor(255, 170, 0);
        contrast.trouble = QColor(255, 120, 120);
        contrast.onPicture = contrast.dimOnPicture = Qt::white;
        contrast.accentOnPicture = QColor(0, 255, 255);
        contrast.bookmarkOnPicture = QColor(255, 190, 0);
        contrast.troubleOnPicture = QColor(255, 120, 120);
        contrast.measuredOnPicture = QColor(255, 255, 0);
        contrast.outline = Qt::black;
        contrast.lineWidth = 1.6;
        return std::array{dark, light, contrast};
    }();
    return all;
}

const Theme* inUse = nullptr;

QPalette paletteOf(const Theme& theme) {
    QPalette palette;
    palette.setColor(QPalette::Window, theme.window);
    palette.setColor(QPalette::WindowText, theme.text);
    palette.setColor(QPalette::Base, theme.base);
    palette.setColor(QPalette::AlternateBase, theme.window);
    palette.setColor(QPalette::Text, theme.text);
    palette.setColor(QPalette::PlaceholderText, theme.muted);
    palette.setColor(QPalette::Button, theme.raised);
    palette.setColor(QPalette::ButtonText, theme.text);
    palette.setColor(QPalette::BrightText, theme.trouble);
    palette.setColor(QPalette::Highlight, theme.accent);
    palette.setColor(QPalette::HighlightedText, theme.accentText);
    palette.setColor(QPalette::Link, theme.accent);
    palette.setColor(QPalette::ToolTipBase, theme.raised);
    palette.setColor(QPalette::ToolTipText, theme.text);
    palette.setColor(QPalette::Mid, theme.border);
    palette.setColor(QPalette::Dark, theme.border);
    palette.setColor(QPalette::Light, theme.raised.lighter(115));
    const QColor faint =
        theme.name == QStringLiteral("contrast") ? QColor(170, 170, 170) : theme.muted.darker(130);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText})
        palette.setColor(QPalette::Disabled, role, faint);
    return palette;
}

}  // namespace

QStringList themeNames() {
    QStringList names;
    for (const Theme& theme : themes())
        names += theme.name;
    return names;
}

const Theme& themeOf(const QString& name) {
    for (const Theme& theme : themes())
        if (theme.name == name) return theme;
    return themes().front();
}

const Theme& theme() {
    return inUse ? *inUse : themes().front();
}

void applyTheme(QApplication& application, const QString& name) {
    inUse = &themeOf(name);
    application.setStyle(QStyleFactory::create(QStringLiteral("Fusion")));
    application.setPalette(paletteOf(*inUse));
    // Style sheets only where the palette cannot say it: frames of a colour, visible focus.
    const Theme& t = *inUse;
    // A palette all of black and white leaves fields without edges.
    const QString edges =
        t.name == QStringLiteral("contrast")
            ? QStringLiteral(
                  "QLineEdit, QTreeView, QTableView, QPushButton, QMenu, QComboBox, "
                  "QAbstractSpinBox { border: 1px solid white; }"
                  "QComboBox { padding: 1px 20px 1px 4px; }"
                  "QPushButton { padding: 4px 9px; } QMenuBar::item:selected, "
                  "QMenu::item:selected { background: #ffeb00; color: black; }"
                  "QSlider::groove:horizontal { height: 4px; background: #909090; }"
                  "QSlider::sub-page:horizontal { height: 4px; background: #ffeb00; }"
                  "QSlider::handle:horizontal { width: 10px; margin: -6px 0; "
                  "background: white; }")
            : QString();
    application.setStyleSheet(
        edges +
        QStringLiteral(
            "QToolTip { color: %1; background: %2; border: 1px solid %3; padding: 3px; }"
            "QDockWidget::title { background: %4; padding: 3px 6px; }"
            "QMainWindow::separator { background: %4; width: 4px; height: 4px; }"
            "QMainWindow::separator:hover { background: %5; }"
            "QStatusBar::item { border: none; }"
            "QToolBar { border: none; spacing: 3px; padding: 3px; }"
            "QToolBar::separator { width: 1px; margin: 5px 3px; background: %3; }"
            "QToolButton { background: %2; border: 1px solid %3; border-radius: 3px; "
            "padding: 3px 5px; color: %1; }"
            "QToolButton:hover { border-color: %6; }"
            "QToolButton:checked { background: %5; color: %7; border-color: %5; }"
            "QToolButton:pressed { background: %5; color: %7; }"
            "QToolButton:disabled { color: %8; }"
            "QToolButton[autoRaise=\"true\"]:!checked { background: transparent; border-color: "
            "transparent; "
            "}"
            "QToolButton#qt_toolbar_ext_button { background: %2; border-color: %6; padding: 0; }"
            "QToolButton:focus { border: 2px solid %6; padding: 2px 4px; }"
            "QPushButton:focus { border: 2px solid %6; border-radius: 3px; padding: 3px 8px; }"
            "QCheckBox::indicator { width: 11px; height: 11px; border: 1px solid %9; "
            "background: %4; }"
            "QCheckBox::indicator:checked { background: %5; border: 1px solid %1; }")
            .arg(t.text.name(), t.raised.name(), t.border.name(), t.window.name(), t.accent.name(),
                 t.name == QStringLiteral("dark") ? t.accentOnPicture.name() : t.accent.name(),
                 t.accentText.name(), t.muted.darker(130).name(), t.muted.name()));
}

}  // namespace haustra::window
