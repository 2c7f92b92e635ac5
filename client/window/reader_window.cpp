#include "window/reader_window.h"

#include "core/raycasters.h"
#include "protocol/capabilities.h"
#include "window/accessible_panes.h"
#include "window/bookmark_panel.h"
#include "window/case_list.h"
#include "window/endoscopic_pane.h"
#include "window/findings_panel.h"
#include "window/flat_panes.h"
#include "window/flight_bar.h"
#include "window/help_pages.h"
#include "window/icons.h"
#include "window/language.h"
#include "window/look_steps.h"
#include "window/missed_panel.h"
#include "window/narrow.h"
#include "window/notices.h"
#include "window/optics_panel.h"
#include "window/overview_pane.h"
#include "window/path_track.h"
#include "window/picture_out.h"
#include "window/slice_panes.h"
#include "window/theme.h"
#include "window/told_sentences.h"

#include <QAbstractButton>
#include <QAbstractItemView>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QActionGroup>
#include <QApplication>
#include <QClipboard>
#include <QCloseEvent>
#include <QComboBox>
#include <QDockWidget>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QLabel>
#include <QLineEdit>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QScrollArea>
#include <QSettings>
#include <QStatusBar>
#include <QTimer>
#include <QToolBar>
#include <QToolButton>
#include <QVBoxLayout>

namespace haustra::window {
namespace {

// A case that has not been flattened hides two panes: its layout is none for those that have.
QString layoutSetting(bool flat) {
    return flat ? QStringLiteral("window/layout") : QStringLiteral("window/layout-not-flattened");
}
const auto geometrySetting = QStringLiteral("window/geometry");

QString nameOfPosition(PatientPosition position) {
    switch (position) {
        case PatientPosition::supine:
            return ReaderWindow::tr("supine");
        case PatientPosition::prone:
            return ReaderWindow::tr("prone");
        case PatientPosition::leftDecubitus:
            return ReaderWindow::tr("on the left side");
        case PatientPosition::rightDecubitus:
            return ReaderWindow::tr("on the right side");
        case PatientPosition::unknown:
            break;
    }
    return {};
}

// Keys that such a control needs for itself while it has the keyboard, though they are a command's.
bool needsKey(const QWidget* widget, const QKeyEvent& key) {
    if (const auto* pane = qobject_cast<const Pane*>(widget)) return pane->needsKey(key);
    if (!widget) return false;
    const bool upOrDown = key.key() == Qt::Key_Up || key.key() == Qt::Key_Down;
    if (key.modifiers() & Qt::AltModifier)
        return upOrDown && qobject_cast<const QComboBox*>(widget);
    if (key.modifiers() & Qt::ControlModifier)
        return upOrDown && (qobject_cast<const QAbstractSpinBox*>(widget) ||
                            qobject_cast<const QAbstractItemView*>(widget));
    const bool arrows = key.key() >= Qt::Key_Home && key.key() <= Qt::Key_PageDown;
    const bool presses =
        key.key() == Qt::Key_Space || key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter;
    const bool types = !key.text().isEmpty() && key.text()[0].isPrint();
    if (qobject_cast<const QAbstractButton*>(widget)) return presses;
    if (qobject_cast<const QAbstractSlider*>(widget)) return arrows;
    if (qobject_cast<const QComboBox*>(widget)) return arrows || presses;
    const bool enters = key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter;
    const bool erases = key.key() == Qt::Key_Backspace || key.key() == Qt::Key_Delete;
    if (qobject_cast<const QAbstractSpinBox*>(widget)) {
        const QChar typed = types ? key.text()[0] : QChar();
        return arrows || enters || erases || typed.isDigit() ||
               QStringLiteral("+-.,").contains(typed);
    }
    if (qobject_cast<const QLineEdit*>(widget)) return arrows || types || presses || erases;
    if (qobject_cast<const QAbstractItemView*>(widget)) return arrows || enters;
    // The transfer function's graph moves its points.
    return widget->inherits("haustra::window::TransferGraph") &&
           (arrows || key.key() == Qt::Key_Insert || key.key() == Qt::Key_Delete ||
            key.key() == Qt::Key_N || key.key() == Qt::Key_P);
}

// The dialog that is open, or a new one.
void showOne(QPointer<QDialog>& dialog, const auto& make) {
    if (!dialog) dialog = make();
    dialog->show();
    dialog->raise();
    dialog->activateWindow();
}

// An ampersand would be taken for the mark of a key.
QString plainInMenu(QString said) {
    return said.replace('&', QStringLiteral("&&"));
}

bool typesText(const QWidget* widget) {
    return qobject_cast<const QLineEdit*>(widget) || qobject_cast<const QAbstractSpinBox*>(widget);
}

}  // namespace

ReaderWindow::ReaderWindow(Reading& reading)
    : reading_(reading), commands_(*this), docks_(makeDocks()), layouts_(*this, second_, docks_) {
    setDockNestingEnabled(true);
    setDockOptions(AnimatedDocks | AllowNestedDocks | AllowTabbedDocks);
    second_.setDockNestingEnabled(true);
    second_.setObjectName(QStringLiteral("second"));
    makeHeader();
    makeMenus();
    makeStatus();
    cases_ = new CaseList(reading);
    setCentralWidget(cases_);
    for (const Command& command : commands())
        if (!command.isHeld())
            for (QMainWindow* window : {static_cast<QMainWindow*>(this), &second_})
                window->addAction(commands_.action(command));
    connect(cases_, &CaseList::chosenAgain, this, &ReaderWindow::caseOpened);
    connect(cases_, &CaseList::connectionWanted, this, &ReaderWindow::connectAgain);
    connect(&reading, &Reading::caseOpened, this, &ReaderWindow::caseOpened);
    connect(&reading, &Reading::phaseChanged, this, [this] {
        if (reader().session().phase() == reader::Phase::choosing && !cases_->isVisible())
            showCases();
    });
    connect(&reading, &Reading::stepped, this, &ReaderWindow::look);
    connect(&reading, &Reading::told, this, [this](const QString& text, bool trouble) {
        if (!trouble) statusBar()->showMessage(text, 4000);
    });
    connect(&reading, &Reading::toolChanged, this, [this] {
        // The view from outside measures nothing.
        for (Pane* pane : panes_)
            pane->setCursor(reading_.tool() == DrawingTool::none || pane->view() == View::overview
                                ? Qt::ArrowCursor
                                : Qt::CrossCursor);
    });
    qApp->installEventFilter(this);
    setWindowTitle(QStringLiteral("Haustra"));
    second_.setWindowTitle(tr("Haustra, second window"));
    menus_->setAccessibleName(tr("Menus"));
    nameParts(*this);
    restoreGeometry(QSettings().value(geometrySetting).toByteArray());
    look();
}

ReaderWindow::~ReaderWindow() {
    qApp->removeEventFilter(this);
    // Panes tell the reader that they are gone: not while it goes itself.
    for (Pane* pane : panes_)
        delete pane;
}

// ---- what it consists of ------------------------------------------------------------------------

QDockWidget* ReaderWindow::dock(QWidget* content, const char* name, const QString& title) {
    auto* dock = new QDockWidget(title, this);
    dock->setObjectName(QString::fromLatin1(name));
    dock->setAccessibleName(title);
    dock->setWidget(content);
    dock->setAllowedAreas(Qt::AllDockWidgetAreas);
    dock->hide();
    return dock;
}

Docks ReaderWindow::makeDocks() {
    describePanes();  // what was made before stays unknown to what reads the screen
    Docks docks;
    const auto pane = [&](Pane* made, const char* name) {
        panes_.push_back(made);
        connect(made, &Pane::menuWanted, this,
                [this, made](const QPoint& at) { showMenuOf(*made, at); });
        QDockWidget* around = dock(made, name, made->title());
        // Behind another's tab it is not hidden, only out of sight.
        connect(around, &QDockWidget::visibilityChanged, made, &Pane::tellSizeSoon);
        return around;
    };
    docks.endoscopic = pane(new EndoscopicPane(reading_), "endoscopic");
    docks.axial = pane(new SlicePane(reading_, View::axial), "axial");
    docks.coronal = pane(new SlicePane(reading_, View::coronal), "coronal");
    docks.sagittal = pane(new SlicePane(reading_, View::sagittal), "sagittal");
    docks.strip = pane(new StripPane(reading_), "strip");
    docks.zoom = pane(new FlatZoomPane(reading_), "zoom");
    docks.overview = pane(new OverviewPane(reading_), "overview");
    docks.oblique = pane(new ObliquePane(reading_), "oblique");
    bookmarks_ = new BookmarkPanel(reading_);
    connect(bookmarks_, &BookmarkPanel::written, this, [this] {
        if (Pane* pane = currentPane()) pane->setFocus();
    });
    docks.bookmarks = dock(bookmarks_, "bookmarks", tr("Bookmarks"));
    docks.findings = dock(new FindingsPanel(reading_), "findings", tr("Findings"));
    missed_ = new MissedPanel(reading_);
    docks.missed = dock(missed_, "missed", tr("Seen and missed"));
    docks.optics = dock(new OpticsPanel(reading_), "optics", tr("Colours, opacities and light"));
    return docks;
}

void ReaderWindow::makeMenus() {
    for (std::size_t n = 0; n < menuCount; ++n) {
        QMenu* menu = menus_->addMenu(nameOf(Menu(n)));
        for (const Command& command : commands()) {
            if (command.menu != Menu(n) || command.isHeld()) continue;
            if (command.separatorBefore) menu->addSeparator();
            menu->addAction(commands_.action(command));
            if (std::string_view(command.id) == "layout-save") {
                layoutMenu_ = menu->addMenu(tr("Saved layouts"));
                connect(layoutMenu_, &QMenu::aboutToShow, this, &ReaderWindow::fillLayoutMenu);
            }
        }
        if (Menu(n) != Menu::view) continue;
        menu->addSeparator();
        QMenu* panes = menu->addMenu(tr("Panes"));
        for (QDockWidget* dock : docks_.all())
            panes->addAction(dock->toggleViewAction());
        const auto choices = [&](const QString& title, const QStringList& values,
                                 const QString& setting, const QString& current, const auto& name,
                                 const auto& choose) {
            QMenu* choice = menu->addMenu(title);
            auto* group = new QActionGroup(choice);
            for (const QString& value : values) {
                QAction* action = choice->addAction(name(value));
                action->setCheckable(true);
                action->setChecked(value == current);
                group->addAction(action);
                connect(action, &QAction::triggered, this, [setting, value, choose] {
                    QSettings().setValue(setting, value);
                    choose(value);
                });
            }
        };
        choices(
            tr("Theme"), themeNames(), QStringLiteral("appearance/theme"), theme().name,
            [](const QString& name) {
                return name == QStringLiteral("dark")    ? tr("Dark")
                       : name == QStringLiteral("light") ? tr("Light")
                                                         : tr("High contrast");
            },
            [this](const QString& name) {
                applyTheme(*qApp, name);
                for (Pane* pane : panes_)
                    pane->update();
            });
        choices(tr("Language"), languages(), QStringLiteral("appearance/language"),
                QSettings().value(QStringLiteral("appearance/language")).toString(), nameOfLanguage,
                [this](const QString&) {
                    statusBar()->showMessage(tr("The language changes with the next start."), 8000);
                });
    }
}

// Menus, the line about the case, notices: as high as these need at the window's width.
void ReaderWindow::makeHeader() {
    auto* top = new QWidget;
    auto* lines = new QVBoxLayout(top);
    lines->setContentsMargins(0, 0, 0, 0);
    lines->setSpacing(0);
    menus_ = new QMenuBar;
    notices_ = new Notices(reading_);
    auto* widget = new QWidget;
    auto* row = new QHBoxLayout(widget);
    row->setContentsMargins(6, 3, 6, 3);
    const auto button = [&](const char* id, Qt::ToolButtonStyle style) {
        auto* made = new QToolButton;
        made->setDefaultAction(commands_.action(id));
        made->setToolButtonStyle(style);
        row->addWidget(made);
    };
    button("cases", Qt::ToolButtonTextBesideIcon);
    row->addSpacing(10);
    caseName_ = new QLabel;
    QFont bold = caseName_->font();
    bold.setBold(true);
    bold.setPointSizeF(bold.pointSizeF() * 1.15);
    caseName_->setFont(bold);
    caseName_->setTextFormat(Qt::PlainText);
    about_ = new NarrowLabel;
    notCleansed_ = new QLabel(tr("not cleansed"));
    trust_ = new NarrowButton;
    trust_->setPopupMode(QToolButton::InstantPopup);
    trust_->setToolButtonStyle(Qt::ToolButtonTextOnly);
    trust_->setAutoRaise(true);
    for (QWidget* shown : {static_cast<QWidget*>(caseName_), static_cast<QWidget*>(about_),
                           static_cast<QWidget*>(notCleansed_), static_cast<QWidget*>(trust_)}) {
        row->addWidget(shown);
        row->addSpacing(8);
    }
    row->addStretch(1);
    button("missed-panel", Qt::ToolButtonTextOnly);
    button("findings-panel", Qt::ToolButtonTextOnly);
    button("bookmarks-panel", Qt::ToolButtonTextOnly);
    button("help", Qt::ToolButtonTextOnly);
    lines->addWidget(menus_);
    lines->addWidget(widget);
    lines->addWidget(notices_);
    setMenuWidget(top);

    trackBar_ = new QToolBar(tr("Place along the colon"));
    auto* track = new QWidget;
    auto* along = new QHBoxLayout(track);
    along->setContentsMargins(6, 0, 6, 0);
    along->addWidget(new QLabel(tr("rectum")));
    along->addWidget(new PathTrack(reading_), 1);
    along->addWidget(new QLabel(tr("cecum")));
    trackBar_->addWidget(track);
    flightBar_ = new FlightBar(reading_, commands_);
    trackBar_->setObjectName(QStringLiteral("track"));
    flightBar_->setObjectName(QStringLiteral("flight"));
    for (QToolBar* bar : {trackBar_, flightBar_}) {
        bar->setMovable(false);
        bar->setContextMenuPolicy(Qt::PreventContextMenu);
        // What shows the rest where a bar is too long: Qt's own arrows are black in any theme.
        for (auto* more : bar->findChildren<QToolButton*>(QStringLiteral("qt_toolbar_ext_button"),
                                                          Qt::FindDirectChildrenOnly)) {
            more->setIcon(iconOf(Symbol::more));
            more->setToolTip(tr("More"));
        }
    }
    // Lines of this area are added from the bottom up.
    addToolBar(Qt::BottomToolBarArea, flightBar_);
    addToolBarBreak(Qt::BottomToolBarArea);
    addToolBar(Qt::BottomToolBarArea, trackBar_);
}

void ReaderWindow::makeStatus() {
    figures_ = new QLabel;
    figures_->setAccessibleName(tr("Figures of the link and the pictures"));
    server_ = new QLabel;
    server_->setAccessibleName(tr("Server"));
    statusBar()->setSizeGripEnabled(false);  // the window's frame has one
    statusBar()->addPermanentWidget(figures_);
    statusBar()->addPermanentWidget(server_);
    server_->setContentsMargins(0, 0, 8, 0);
}

// ---- cases --------------------------------------------------------------------------------------

void ReaderWindow::showCases() {
    if (cases_->isVisible()) {
        const reader::Session& session = reader().session();
        if (reader().isOpen() && session.wantedCase() == session.caseInfo()->name) caseOpened();
        return;
    }
    keepLayout();
    layouts_.letGo();
    for (QDockWidget* dock : docks_.all())
        dock->hide();
    second_.hide();
    cases_->show();
}

void ReaderWindow::caseOpened() {
    cases_->hide();
    beforeEnlarged_.clear();
    const bool flat = reader().flat().hasStrip();
    // The case's reader has no strip before its first step; the server has said whether it will.
    const bool hasFlat = reader().session().caseInfo() && reader().session().caseInfo()->flat;
    const QByteArray kept = QSettings().value(layoutSetting(flat || hasFlat)).toByteArray();
    if (kept.isEmpty() || !layouts_.restore(kept, flat || hasFlat))
        layouts_.arrange(BuiltinLayout::reading, flat || hasFlat);
    focusPane(nullptr);
    look();
}

// ---- layouts ------------------------------------------------------------------------------------

void ReaderWindow::keepLayout() {
    if (isEnlarged())
        QSettings().setValue(layoutSetting(reader().flat().hasStrip()), beforeEnlarged_);
    else if (!cases_->isVisible())
        QSettings().setValue(layoutSetting(reader().flat().hasStrip()), layouts_.state());
}

void ReaderWindow::arrange(BuiltinLayout layout) {
    Pane* pane = focusedPane();
    beforeEnlarged_.clear();
    cases_->hide();
    layouts_.arrange(layout, reader().flat().hasStrip());
    focusPane(pane);
}

Pane* ReaderWindow::focusedPane() const {
    for (Pane* pane : panes_)
        if (pane->hasFocus()) return pane;
    return nullptr;
}

// What is hidden while panes are arranged leaves the keyboard to whatever control comes next, a
// button, which would take Space and Return: it goes to a pane.
void ReaderWindow::focusPane(Pane* wanted) {
    for (std::size_t n = 0; n < panes_.size() && !(wanted && wanted->isVisible()); ++n)
        wanted = panes_[n];
    if (wanted->isVisible()) wanted->setFocus();
}

void ReaderWindow::saveLayout() {
    bool wanted = false;
    const QString name = QInputDialog::getText(this, tr("Save this layout"), tr("Name"),
                                               QLineEdit::Normal, {}, &wanted)
                             .trimmed();
    if (!wanted || name.isEmpty()) return;
    leaveEnlarged();
    layouts_.save(name);
    statusBar()->showMessage(tr("The layout “%1” is saved.").arg(name), 4000);
}

void ReaderWindow::fillLayoutMenu() {
    layoutMenu_->clear();
    const QStringList names = Layouts::names();
    for (const QString& name : names)
        layoutMenu_->addAction(plainInMenu(name), this, [this, name] {
            Pane* pane = focusedPane();
            beforeEnlarged_.clear();
            const bool restored = layouts_.restore(name, reader().flat().hasStrip());
            focusPane(pane);
            if (!restored) reading_.tell(tr("The layout “%1” cannot be read.").arg(name), true);
        });
    if (names.isEmpty()) layoutMenu_->addAction(tr("none yet"))->setEnabled(false);
    layoutMenu_->addSeparator();
    QMenu* remove = layoutMenu_->addMenu(tr("Remove"));
    remove->setEnabled(!names.isEmpty());
    for (const QString& name : names)
        remove->addAction(plainInMenu(name), this, [name] { Layouts::remove(name); });
}

void ReaderWindow::enlarge() {
    if (isEnlarged()) return leaveEnlarged();
    Pane* pane = currentPane();
    if (!pane) return;
    auto* of = qobject_cast<QDockWidget*>(pane->parentWidget());
    if (!of) return;
    layouts_.letGo();
    beforeEnlarged_ = layouts_.state();
    // A pane of the second window is enlarged there.
    for (QDockWidget* dock : docks_.all())
        if (dock != of && (dock->isFloating() || dock->parentWidget() == of->parentWidget()))
            dock->hide();
    of->setFloating(false);
    of->show();
    pane->setFocus();
}

void ReaderWindow::leaveEnlarged() {
    if (!isEnlarged()) return;
    Pane* pane = currentPane();
    layouts_.restore(std::exchange(beforeEnlarged_, {}), reader().flat().hasStrip());
    focusPane(pane);
}

Pane* ReaderWindow::currentPane() const {
    for (Pane* pane : panes_)
        if (pane->isVisible() && pane->underMouse()) return pane;
    if (Pane* pane = focusedPane(); pane && pane->isVisible()) return pane;
    for (Pane* pane : panes_)
        if (pane->isVisible()) return pane;
    return nullptr;
}

Pane* ReaderWindow::keyboardPane() const {
    Pane* pane = focusedPane();
    return pane && pane->isVisible() ? pane : currentPane();
}

void ReaderWindow::focusNextPane(int step) {
    std::vector<Pane*> shown;
    for (Pane* pane : panes_)
        if (pane->isVisible() && !pane->visibleRegion().isEmpty()) shown.push_back(pane);
    if (shown.empty()) return;
    const auto at = std::find(shown.begin(), shown.end(), focusedPane());
    const auto count = std::ptrdiff_t(shown.size());
    const std::ptrdiff_t next = at == shown.end() ? 0 : (at - shown.begin() + step + count) % count;
    Pane* pane = shown[std::size_t(next)];
    pane->window()->activateWindow();
    pane->setFocus(Qt::TabFocusReason);
}

void ReaderWindow::togglePointing() {
    for (Pane* pane : panes_)
        if (pane->hasKeyPointer()) return pane->setKeyPointer(false);
    if (Pane* pane = keyboardPane()) pane->setKeyPointer(true);
}

void ReaderWindow::connectAgain() {
    const int unkept = int(reader().session().unkeptBookmarks());
    if (unkept > 0 &&
        QMessageBox::question(
            this, tr("Bookmarks are not sent yet"),
            tr("%n bookmark(s) wait for the server, and this station cannot keep them: they are "
               "lost with this session. Connect again all the same?",
               nullptr, unkept)) != QMessageBox::Yes)
        return;
    if (!cases_->isVisible()) showCases();  // until the case is open again
    reading_.connectAgain();
}

void ReaderWindow::toggleFullScreen() {
    setWindowState(windowState() ^ Qt::WindowFullScreen);
}

// ---- pictures -----------------------------------------------------------------------------------

void ReaderWindow::showMenuOf(Pane& pane, const QPoint& globalPosition) {
    QMenu menu(this);
    pane.fillMenu(menu);
    if (!menu.isEmpty()) menu.addSeparator();
    const auto take = [&](const char* id) { return commands_.action(id)->text(); };
    menu.addAction(iconOf(Symbol::enlarge), take("enlarge"), this, [this, &pane] {
        pane.setFocus();
        isEnlarged() ? leaveEnlarged() : enlarge();
    });
    menu.addAction(take("copy-picture"), this, [this, &pane] {
        const QImage image = pane.pictureWithMarks();
        if (!image.isNull()) QApplication::clipboard()->setMimeData(mimeDataOf(image));
    });
    menu.exec(globalPosition);
}

void ReaderWindow::copyPicture() {
    Pane* pane = currentPane();
    const QImage image = pane ? pane->pictureWithMarks() : QImage();
    if (image.isNull()) return;
    QApplication::clipboard()->setMimeData(mimeDataOf(image));
    statusBar()->showMessage(tr("The picture of “%1” is copied.").arg(pane->title()), 4000);
}

void ReaderWindow::savePicture() {
    Pane* pane = currentPane();
    const QImage image = pane ? pane->pictureWithMarks() : QImage();
    if (image.isNull()) return;
    const QString name = QStringLiteral("%1-%2mm.png")
                             .arg(text(reader().session().caseInfo()->name))
                             .arg(reader().flight().placeArcMm(), 0, 'f', 0);
    if (const QString error = window::savePicture(this, image, name); !error.isEmpty())
        reading_.tell(error, true);
}

// ---- other commands -----------------------------------------------------------------------------

void ReaderWindow::quit() {
    close();
}

void ReaderWindow::askForPlace() {
    const double length = reader().flight().centerline().lengthMm();
    bool wanted = false;
    const double arc =
        QInputDialog::getDouble(this, tr("Go to a place along the path"),
                                tr("mm from the rectum (up to %1)").arg(length, 0, 'f', 0),
                                reader().flight().arcMm(), 0.0, length, 0, &wanted);
    if (wanted)
        reading_.jump(tr("go along the path"), [this, arc] { reader().flight().goTo(arc); });
}

void ReaderWindow::setWindowPreset(std::size_t n) {
    changeWindow(reading_, windowPresets[n].window);
}

std::size_t ReaderWindow::windowPreset() const {
    std::size_t n = 0;
    while (n < windowPresets.size() &&
           !(windowPresets[n].window == reading_.reader().slices().window()))
        ++n;
    return n;
}

void ReaderWindow::toggleOptics() {
    QDockWidget* dock = docks_.optics;
    if (dock->isVisible()) {
        dock->hide();
        return keepKeysOnPanes();
    }
    if (dock->isFloating() && !placedOptics_) {
        placedOptics_ = true;
        const QSize size = dock->widget()->sizeHint() + QSize(20, 40);
        dock->resize(size);
        dock->move(mapToGlobal(QPoint(width() - size.width() - 24, 120)));
    }
    dock->show();
    dock->raise();
}
bool ReaderWindow::showsCases() const {
    return cases_->isVisible();
}
bool ReaderWindow::showsOptics() const {
    return docks_.optics->isVisible();
}

void ReaderWindow::writeNote() {
    docks_.bookmarks->show();
    docks_.bookmarks->raise();
    bookmarks_->writeNote();
}
void ReaderWindow::toggleBookmarks() {
    docks_.bookmarks->setVisible(!docks_.bookmarks->isVisible());
    if (!docks_.bookmarks->isVisible()) keepKeysOnPanes();
}
// What was hidden leaves the keyboard to the next control, such as the button that leaves the case,
// which Space would press.
void ReaderWindow::keepKeysOnPanes() {
    const QWidget* focused = QApplication::focusWidget();
    for (const QDockWidget* dock : docks_.all())
        if (focused && dock->isVisible() && dock->isAncestorOf(focused)) return;
    // Of a floating one that goes, the pane that had them before.
    focusPane(qobject_cast<Pane*>(focusWidget()));
}
bool ReaderWindow::showsBookmarks() const {
    return docks_.bookmarks->isVisible();
}

// Beside the list of bookmarks, as its tab, until the reader moves it.
void ReaderWindow::toggleFindings() {
    toggleList(docks_.findings);
}
void ReaderWindow::toggleMissed() {
    toggleList(docks_.missed);
}
bool ReaderWindow::showsMissed() const {
    return docks_.missed->isVisible();
}
void ReaderWindow::saveSeenReport() {
    missed_->saveReport();
}
void ReaderWindow::toggleList(QDockWidget* dock) {
    if (dock->isVisible() && !dock->visibleRegion().isEmpty()) {
        dock->hide();
        return keepKeysOnPanes();
    }
    dock->show();
    dock->raise();
    // The list of bookmarks, whose place it shares, needs less.
    const int high = dock->widget()->sizeHint().height();
    if (auto* window = qobject_cast<QMainWindow*>(dock->parentWidget());
        window && !dock->isFloating() && dock->height() < high)
        window->resizeDocks({dock}, {std::min(high, window->height() * 45 / 100)}, Qt::Vertical);
}
bool ReaderWindow::showsFindings() const {
    return docks_.findings->isVisible();
}

void ReaderWindow::showHelp() {
    showOne(help_, [this] { return new HelpPage(commands_, this); });
}
void ReaderWindow::changeKeys() {
    showOne(keys_, [this] { return new KeysDialog(commands_, this); });
}
void ReaderWindow::showAbout() {
    window::showAbout(this, reading_);
}

// ---- what it shows ------------------------------------------------------------------------------

void ReaderWindow::look() {
    const reader::Session& session = reader().session();
    const bool open = reader().isOpen();
    // A layout that was kept says which bars were shown then.
    flightBar_->setVisible(open && !cases_->isVisible());
    trackBar_->setVisible(open && !cases_->isVisible());
    caseName_->setVisible(open);
    about_->setVisible(open);
    const bool up =
        session.phase() != reader::Phase::lost && session.phase() != reader::Phase::failed;
    const auto paint = [](QWidget* widget, const QColor& color) {
        QPalette palette = widget->palette();
        if (palette.color(QPalette::WindowText) == color) return;
        palette.setColor(QPalette::WindowText, color);
        widget->setPalette(palette);
    };
    const auto say = [](QLabel* label, const QString& text) {
        if (label->text() != text) label->setText(text);
    };
    say(server_, up ? reading_.serverName() : tr("%1: no link").arg(reading_.serverName()));
    paint(server_, up ? theme().text : theme().trouble);
    commands_.look();
    notCleansed_->setVisible(open && !session.caseInfo()->cleansed);
    trust_->setVisible(open && session.caseInfo()->trust.has_value());
    if (!open) return say(figures_, {});

    const reader::CaseInfo& info = *session.caseInfo();
    say(caseName_, text(info.name));
    const QString position = info.position == PatientPosition::unknown
                                 ? QString()
                                 : nameOfPosition(info.position) + QStringLiteral("   ");
    say(about_, position + QStringLiteral("%1×%2×%3")
                               .arg(info.grid.size.x)
                               .arg(info.grid.size.y)
                               .arg(info.grid.size.z));
    paint(about_, theme().muted);
    paint(notCleansed_, theme().bookmark);
    if (info.trust) {
        const auto& warnings = info.trust->warnings;
        const QString sure = tr("colon %1 % sure").arg(100.0 * info.trust->confidence, 0, 'f', 0);
        QString words = sure;
        if (!warnings.empty())
            words +=
                QStringLiteral(", ") + tr("%n place(s) to look at", nullptr, int(warnings.size()));
        if (trust_->accessibleName() != words) {
            trust_->setWords(words, sure);
            QMenu* places = new QMenu(trust_);
            QStringList all;
            for (const std::string& warning : warnings) {
                const QString sentence = translatedSentence(text(warning));
                places->addAction(plainInMenu(sentence));
                all += sentence;
            }
            // It may be open now.
            if (QMenu* former = trust_->menu()) former->deleteLater();
            trust_->setMenu(warnings.empty() ? nullptr : places);
            trust_->setToolTip(toolTipOf(all.join('\n')));
        }
        // A style sheet paints buttons: it leaves the palette out.
        const QString color =
            QStringLiteral("QToolButton { color: %1 }")
                .arg((warnings.empty() ? theme().muted : theme().bookmark).name());
        if (trust_->styleSheet() != color) trust_->setStyleSheet(color);
    }

    QStringList figures;
    const std::optional<double> seen = session.seenShare();
    if (info.flat)
        figures += !seen ? tr("wall seen –")
                   : session.serverCan(protocol::capability::ledger) && !session.seenIsRecorded()
                       ? tr("wall seen %1 %, not kept").arg(decimal(100.0 * *seen))
                       : tr("wall seen %1 %").arg(decimal(100.0 * *seen));
    const tiles::Picture& shown = reader().panes().picture(View::endoscopic);
    const std::string raycaster = raycasterName(shown.raycaster);
    if (!raycaster.empty())
        figures += QStringLiteral("%1 %2 ms")
                       .arg(text(raycaster))
                       .arg(1e-3 * shown.renderMicroseconds, 0, 'f', 0);
    figures += tr("%1 pictures/s").arg(reader().panes().picturesPerSecond(), 0, 'f', 0);
    const reader::Summary latency = reader().panes().latencyMs();
    if (latency.count > 0)
        figures += tr("hand to picture %1 ms, p95 %2")
                       .arg(latency.p50, 0, 'f', 0)
                       .arg(latency.p95, 0, 'f', 0);
    figures += tr("link %1 ms").arg(decimal(session.roundTripMs()));
    say(figures_, figures.join(QStringLiteral("   ·   ")));
}

bool ReaderWindow::isSettled() const {
    const reader::Reader& reader = reading_.reader();
    const reader::Phase phase = reader.session().phase();
    if (phase == reader::Phase::connecting) return false;
    if (phase != reader::Phase::open || reader.motion() != reader::Motion::paused) return true;
    for (const Pane* pane : panes_)
        if (!pane->isAtRest()) return false;
    for (const View view : allViews)
        if (reader.panes().size(view).x > 0 && (reader.flat().hasStrip() || !isFlat(view)) &&
            reader.freshness(view) != reader::Freshness::exact)
            return false;
    return true;
}

// ---- keys ---------------------------------------------------------------------------------------

bool ReaderWindow::eventFilter(QObject* object, QEvent* event) {
    // Its panes come back into the main window: hidden ones would be out of reach.
    if (object == &second_ && event->type() == QEvent::Close && isVisible()) {
        event->ignore();
        arrange(BuiltinLayout::reading);
        return true;
    }
    if (event->type() == QEvent::Close && qobject_cast<QDockWidget*>(object))
        QTimer::singleShot(0, this, &ReaderWindow::keepKeysOnPanes);
    if (event->type() == QEvent::ShortcutOverride) {
        const auto& key = static_cast<const QKeyEvent&>(*event);
        if (needsKey(qobject_cast<QWidget*>(object), key)) {
            event->accept();
            return false;
        }
    }
    if ((event->type() == QEvent::KeyPress || event->type() == QEvent::KeyRelease) &&
        handleHeldKeys(event))
        return true;
    if (event->type() == QEvent::WindowDeactivate && !held_.empty()) {
        held_.clear();
        reading_.setHeldWay(glm::dvec3(0.0), false);
    }
    return QMainWindow::eventFilter(object, event);
}

// Free flight: keys that are held. True: the key is one of them.
bool ReaderWindow::handleHeldKeys(QEvent* event) {
    if (!reader().isOpen() || !reader().flight().isFree() || cases_->isVisible()) {
        if (!std::exchange(held_, {}).empty()) reading_.setHeldWay(glm::dvec3(0.0), false);
        return false;
    }
    const auto& key = static_cast<const QKeyEvent&>(*event);
    const Command* way = nullptr;
    for (const Command& command : commands())
        if (command.isHeld() &&
            commands_.action(command)->shortcuts().contains(QKeySequence(key.key())))
            way = &command;
    if (way && event->type() == QEvent::KeyRelease && !key.isAutoRepeat()) held_.erase(key.key());
    if (!way || typesText(QApplication::focusWidget()) || QApplication::activeModalWidget() ||
        (key.modifiers() & (Qt::ControlModifier | Qt::AltModifier)))
        return false;
    if (key.isAutoRepeat()) return true;
    if (event->type() == QEvent::KeyPress) held_[key.key()] = way;
    glm::dvec3 sum(0.0);
    for (const auto& [held, command] : held_)
        sum += command->heldWay;
    reading_.setHeldWay(sum, key.modifiers().testFlag(Qt::ShiftModifier));
    return true;
}

void ReaderWindow::closeEvent(QCloseEvent* event) {
    const int owed = int(reader().session().owedBookmarks()),
              unkept = int(reader().session().unkeptBookmarks());
    const bool isOpen = reader().session().phase() == reader::Phase::open;
    if ((unkept > 0 || (owed > 0 && !isOpen)) &&
        QMessageBox::question(
            this, tr("Bookmarks are not sent yet"),
            unkept == 0
                ? tr("%n bookmark(s) wait for the server. They are kept on this station, and sent "
                     "when the case is opened here again. Quit?",
                     nullptr, owed)
                : tr("%n bookmark(s) wait for the server, and this station cannot keep them: they "
                     "are lost with this window. Quit all the same?",
                     nullptr, unkept)) != QMessageBox::Yes)
        return event->ignore();
    if (reader().isOpen()) keepLayout();
    QSettings().setValue(geometrySetting, saveGeometry());
    second_.hide();
    event->accept();
    QApplication::quit();
}

}  // namespace haustra::window
