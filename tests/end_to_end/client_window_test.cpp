// The reader's window, against a server on the loopback: hands and keys do what the table of
// commands and the page of gestures say, in every pane, and whoever does not see it is told.
#include "core/slice_placement.h"
#include "core/strip_layout.h"
#include "end_to_end/fake_server.h"
#include "end_to_end/fake_wall.h"
#include "protocol/limits.h"
#include "reader/overview_map.h"
#include "temporary_folder.h"
#include "window/missed_panel.h"
#include "window/narrow.h"
#include "window/pane.h"
#include "window/reader_window.h"
#include "window/theme.h"

#include <QAbstractButton>
#include <QAbstractScrollArea>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QAccessible>
#include <QApplication>
#include <QCheckBox>
#include <QClipboard>
#include <QComboBox>
#include <QDialog>
#include <QDialogButtonBox>
#include <QDockWidget>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QMenuBar>
#include <QMessageBox>
#include <QMimeData>
#include <QPlainTextEdit>
#include <QPointer>
#include <QPushButton>
#include <QSettings>
#include <QStatusBar>
#include <QTableView>
#include <QTest>
#include <QToolBar>
#include <QToolButton>
#include <QTreeWidget>
#include <QWheelEvent>
#include <chrono>
#include <cmath>
#include <fstream>
#include <functional>
#include <map>
#include <set>

namespace haustra::window {
namespace {

using reader::Freshness, reader::Motion, reader::Phase;
using tests::FakeServer, tests::Misbehaviour;

// One application for all tests: without a display, with settings of its own.
class Application : public ::testing::Environment {
public:
    void SetUp() override {
        for (const char* name : {"HOME", "XDG_CONFIG_HOME", "XDG_DATA_HOME", "XDG_CACHE_HOME"})
            qputenv(name, QByteArray::fromStdString(home_.path().string()));
        std::ofstream(home_ / "screens.json")
            << R"({"screens": [{"name": "left", "x": 0, "y": 0, "width": 1600, "height": 1100},
                               {"name": "right", "x": 1600, "y": 0, "width": 1280, "height": 1024}]})";
        qputenv("QT_QPA_PLATFORM", QByteArray::fromStdString("offscreen:configfile=" +
                                                             (home_ / "screens.json").string()));
        QCoreApplication::setOrganizationName(QStringLiteral("haustra"));
        QCoreApplication::setApplicationName(QStringLiteral("haustra-window-test"));
        application_ = std::make_unique<QApplication>(count_, arguments_);
        QApplication::setQuitOnLastWindowClosed(false);
        QLocale::setDefault(QLocale::c());
        applyTheme(*application_, QStringLiteral("dark"));
    }
    void TearDown() override { application_.reset(); }

private:
    tests::TemporaryFolder home_;
    int count_ = 1;
    char name_[5] = "test";
    char* arguments_[2] = {name_, nullptr};
    std::unique_ptr<QApplication> application_;
};
const auto* const application = ::testing::AddGlobalTestEnvironment(new Application);

bool areNear(const Camera& a, const Camera& b) {
    return glm::distance(a.positionMm, b.positionMm) < 1e-6 &&
           glm::distance(a.forward, b.forward) < 1e-9 && glm::distance(a.up, b.up) < 1e-9;
}

template <class Done>
bool waitFor(const Done& done) {
    const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(20);
    while (!done()) {
        if (std::chrono::steady_clock::now() > deadline) return false;
        QTest::qWait(2);
    }
    return true;
}

// ---- the hand -----------------------------------------------------------------------------------

QWindow* handleOf(const QWidget& widget) {
    return widget.window()->windowHandle();
}
QPoint inWindow(const QWidget& widget, QPoint at) {
    return widget.mapTo(widget.window(), at);
}

void moveTo(const QWidget& widget, QPoint at) {
    QTest::mouseMove(handleOf(widget), inWindow(widget, at));
}
void click(const QWidget& widget, QPoint at, Qt::MouseButton button = Qt::LeftButton,
           Qt::KeyboardModifiers modifiers = {}) {
    moveTo(widget, at);
    QTest::mouseClick(handleOf(widget), button, modifiers, inWindow(widget, at));
}
void doubleClick(const QWidget& widget, QPoint at) {
    moveTo(widget, at);
    QTest::mouseDClick(handleOf(widget), Qt::LeftButton, {}, inWindow(widget, at));
}
void drag(const QWidget& widget, const std::vector<QPoint>& way,
          Qt::MouseButton button = Qt::LeftButton, Qt::KeyboardModifiers modifiers = {}) {
    moveTo(widget, way.front());
    QTest::mousePress(handleOf(widget), button, modifiers, inWindow(widget, way.front()));
    for (std::size_t n = 1; n < way.size(); ++n)
        moveTo(widget, way[n]);
    QTest::mouseRelease(handleOf(widget), button, modifiers, inWindow(widget, way.back()));
}
void wheel(const QWidget& widget, QPoint at, int steps, Qt::KeyboardModifiers modifiers = {}) {
    moveTo(widget, at);
    QWheelEvent event(inWindow(widget, at), widget.mapToGlobal(at), {}, {0, 120 * steps},
                      Qt::NoButton, modifiers, Qt::NoScrollPhase, false);
    QCoreApplication::sendEvent(handleOf(widget), &event);
}
void press(int key, Qt::KeyboardModifiers modifiers = {}) {
    const QWidget* active = QApplication::activePopupWidget();
    if (!active) active = QApplication::activeWindow();
    ASSERT_TRUE(active) << "no window has the keyboard";
    QTest::keyClick(active->windowHandle(), Qt::Key(key), modifiers);
}
void press(const QKeySequence& keys) {
    for (int n = 0; n < keys.count(); ++n)
        press(keys[uint(n)].key(), keys[uint(n)].keyboardModifiers());
}
void type(const QString& text) {
    for (const QChar letter : text)
        QTest::keyClick(QApplication::activeWindow()->windowHandle(), letter.toLatin1());
}

// Answers the dialog or menu that what follows opens, from within its loop. What says whether it
// did comes true once it has.
template <class Widget, class Answer>
std::shared_ptr<bool> whenOpens(Answer answer) {
    auto done = std::make_shared<bool>(false);
    auto* timer = new QTimer(qApp);
    const auto since = std::chrono::steady_clock::now();
    QObject::connect(timer, &QTimer::timeout, qApp, [timer, done, answer, since] {
        QWidget* open = QApplication::activePopupWidget();
        if (!open) open = QApplication::activeModalWidget();
        const bool isLate = std::chrono::steady_clock::now() > since + std::chrono::seconds(10);
        if (isLate && open) {  // or its loop would never end
            ADD_FAILURE() << open->metaObject()->className() << " stays open";
            open->close();
        }
        if (isLate || (*done && !open)) return timer->deleteLater();
        auto* wanted = qobject_cast<Widget*>(open);
        if (*done || !wanted || !wanted->isVisible()) return;
        if (!wanted->isActiveWindow() && open != QApplication::activePopupWidget()) return;
        *done = true;
        answer(*wanted);
    });
    timer->start(5);
    return done;
}
std::shared_ptr<bool> chooseInMenu(const QString& entry) {
    return whenOpens<QMenu>([entry](QMenu& menu) {
        for (QAction* action : menu.actions())
            if (action->text() == entry) {
                EXPECT_TRUE(action->isEnabled()) << entry.toStdString();
                return click(menu, menu.actionGeometry(action).center());
            }
        ADD_FAILURE() << "no entry " << entry.toStdString();
        menu.close();
    });
}

// ---- the window ---------------------------------------------------------------------------------

class ClientWindow : public ::testing::Test {
protected:
    explicit ClientWindow(Misbehaviour misbehaviour = {}) : server_(misbehaviour) {}

    void SetUp() override {
        QSettings().clear();
        start("phantom");
        ASSERT_TRUE(waitFor([&] { return reader().isOpen() && settled(); }));
    }
    void TearDown() override {
        window_.reset();
        reading_.reset();
    }
    void start(const std::string& caseName) {
        link::ConnectionOptions options;
        options.address = {"127.0.0.1", server_.port()};
        options.pinning.knownServersFile = folder_ / "known_servers";
        reading_ = std::make_unique<Reading>(options, caseName);
        window_ = std::make_unique<ReaderWindow>(*reading_);
        window_->resize(1500, 1000);
        window_->show();
        window_->activateWindow();
        ASSERT_TRUE(QTest::qWaitForWindowActive(window_.get()));
        for (Pane* pane : window_->findChildren<Pane*>())
            panes_[pane->view()] = pane;
    }

    reader::Reader& reader() { return reading_->reader(); }
    reader::Flight& flight() { return reader().flight(); }
    reader::SliceViews& slices() { return reader().slices(); }
    Pane& pane(View view) { return *panes_.at(view); }
    double length() const { return FakeServer::centerline().lengthMm(); }
    bool settled() { return window_->isSettled() && !reader().restless(); }
    bool settle() {
        QTest::qWait(5);
        return waitFor([&] { return settled() && fits() && pictured(); });
    }
    // The layout has come to rest.
    bool fits() {
        return std::all_of(panes_.begin(), panes_.end(), [&](const auto& shown) {
            const Pane& pane = *shown.second;
            const bool inSight = pane.isVisible() && !pane.visibleRegion().isEmpty();
            return reader().panes().size(pane.view()) ==
                   (inSight ? glm::ivec2(pane.width(), pane.height()) : glm::ivec2(0));
        });
    }
    bool laidOut() {
        QTest::qWait(10);
        return waitFor([&] { return fits(); });
    }
    // So have pictures of that size.
    bool pictured() {
        return std::all_of(panes_.begin(), panes_.end(), [&](const auto& shown) {
            const glm::ivec2 size = reader().panes().size(shown.first);
            const tiles::Picture& picture = reader().panes().picture(shown.first);
            return size == glm::ivec2(0) || glm::ivec2(picture.width, picture.height) == size;
        });
    }
    // Nothing here hands the keyboard back when a dialog is closed.
    void activate() {
        window_->activateWindow();
        ASSERT_TRUE(waitFor([&] { return QApplication::activeWindow() == window_.get(); }));
    }
    // No place is asked about any more; pictures may be on their way.
    bool answered() {
        QTest::qWait(5);
        return waitFor(
            [&] { return !reader().flat().wall().waits() && !reader().measures().waits(); });
    }
    QAction* action(const char* id) {
        return window_->findChild<QAction*>(QString::fromLatin1(id));
    }
    QDockWidget* dock(const char* name) {
        for (QWidget* widget : QApplication::allWidgets())
            if (auto* dock = qobject_cast<QDockWidget*>(widget);
                dock && dock->objectName() == QLatin1String(name))
                return dock;
        return nullptr;
    }
    template <class Widget>
    Widget* named(const QString& accessibleName) {
        for (QWidget* widget : QApplication::allWidgets())
            if (auto* found = qobject_cast<Widget*>(widget);
                found && found->accessibleName() == accessibleName)
                return found;
        return nullptr;
    }
    QWidget* cases() { return window_->centralWidget(); }
    QTreeWidget& bookmarkList() {
        return *named<QTreeWidget>(QStringLiteral("Bookmarks along the colon"));
    }
    QLineEdit& note() { return *named<QLineEdit>(QStringLiteral("Note of a new bookmark")); }
    std::set<std::string> docksInSight() {
        std::set<std::string> names;
        for (QWidget* widget : QApplication::allWidgets())
            if (auto* dock = qobject_cast<QDockWidget*>(widget); dock && dock->isVisible())
                names.insert(dock->objectName().toStdString());
        return names;
    }
    // Where a slice is asked to lie.
    SlicePlacement placed(View view) {
        const glm::ivec2 size = reader().panes().size(view);
        return *placeSlice(slices().slice(view), reader().session().caseInfo()->grid, size.x,
                           size.y);
    }
    glm::dvec3 patientAt(View view, QPoint at) {
        return placed(view).patientFromPixel(vector(at) - 0.5);
    }
    QPoint positionOf(View view, glm::dvec3 mm) {
        return point(placed(view).pixelFromPatient(mm) + 0.5).toPoint();
    }
    bool notices(const QString& part) {
        for (QLabel* label : window_->findChildren<QLabel*>())
            if (label->isVisible() && label->text().contains(part)) return true;
        for (QPlainTextEdit* notes : window_->findChildren<QPlainTextEdit*>())
            if (notes->isVisible() && notes->toPlainText().contains(part)) return true;
        return false;
    }

    FakeServer server_;
    const tests::TemporaryFolder folder_;
    std::unique_ptr<Reading> reading_;
    std::unique_ptr<ReaderWindow> window_;
    std::map<View, Pane*> panes_;
};

// ---- commands and keys --------------------------------------------------------------------------

class ClientWindowCommands : public ClientWindow {
protected:
    using Check = std::function<bool()>;
    // Makes ready, and returns what is seen once the command has been done, and not before.
    using Expectation = std::function<Check()>;

    Check steps(double mm) {
        flight().goTo(100.0);
        return [this, mm] { return std::abs(flight().arcMm() - 100.0 - mm) < 1e-9; };
    }
    Check motion(Motion wanted) {
        reader().setMotion(Motion::paused);
        flight().goTo(200.0);
        return [this, wanted] { return reader().motion() == wanted; };
    }
    Check windowOf(WindowLevel wanted) {
        slices().setWindow({10, 77});
        return [this, wanted] { return slices().window() == wanted; };
    }
    // Another pane than the endoscopic one has the keyboard.
    Check focuses() {
        return [this] {
            const auto* pane = qobject_cast<Pane*>(QApplication::focusWidget());
            return pane && pane->view() != View::endoscopic;
        };
    }
    Check scrolls(double voxels) {
        pane(View::axial).setFocus();
        flight().goTo(200.0);
        settle();
        const double from = slices().slice(View::axial).positionMm.z,
                     mm = voxels * reader().session().caseInfo()->grid.spacingMm().z;
        return [=, this] {
            return std::abs(slices().slice(View::axial).positionMm.z - from - mm) < 1e-9;
        };
    }
    Check zooms(double wanted) {
        pane(View::axial).setFocus();
        slices().showWhole(View::axial);
        slices().zoom(View::axial, 2.0, {10, 10}, {20, 20});
        return [=, this] { return std::abs(slices().slice(View::axial).zoom - wanted) < 1e-9; };
    }
    // To the right and up.
    Check looks(glm::dvec2 way) {
        flight().resetLook();
        return [=, this] {
            const glm::dvec2 turned(flight().yawDegrees(), flight().pitchDegrees());
            return glm::dot(turned, way) > 1.0 &&
                   std::abs(turned.x * way.y + turned.y * way.x) < 1e-9;
        };
    }
    // To the right and down, a twentieth of the pane.
    Check pans(glm::dvec2 way) {
        pane(View::coronal).setFocus();
        slices().showWhole(View::coronal);
        settle();
        const glm::dvec2 mm =
            way * glm::dvec2(pane(View::coronal).width(), pane(View::coronal).height()) *
            placed(View::coronal).pixelMm() / 20.0;
        return [=, this] { return glm::distance(slices().slice(View::coronal).panMm, mm) < 1e-6; };
    }
    // On a second press it is off again.
    Check flips(std::function<bool()> isOn) {
        return [before = isOn(), isOn] { return isOn() != before; };
    }
    bool showFindings() {
        reader().findings().setCurrent({});
        return reader().findings().choose(DetectionMode::concurrent) &&
               waitFor([&] { return reader().findings().shown().size() == 2; });
    }
    bool isAtFinding(int number) {
        const auto* current = reader().findings().current();
        return current && current->number == number &&
               std::abs(flight().arcMm() - current->wall.arcMm) < 1e-6 &&
               reader().flat().picked() &&
               reader().flat().picked()->positionMm == current->wall.positionMm;
    }
    bool isAtPatch(std::size_t patch) {
        const auto current = reader().missed().current();
        return current && *current == patch && reader().flat().picked() &&
               reader().flat().picked()->positionMm ==
                   reader().missed().list()->patches[patch].place.positionMm;
    }
    Check fov(double change) {
        const double before = flight().camera().fovDegrees;
        return
            [=, this] { return std::abs(flight().camera().fovDegrees - before - change) < 1e-9; };
    }
    Check shows(std::set<std::string> docks, std::set<std::string> others = {}) {
        return [=, this] {
            const auto seen = docksInSight();
            return std::includes(seen.begin(), seen.end(), docks.begin(), docks.end()) &&
                   std::none_of(others.begin(), others.end(),
                                [&](const std::string& other) { return seen.contains(other); });
        };
    }
    template <class Dialog>
    Check dialog(std::function<void(Dialog&)> answer) {
        const auto done = whenOpens<Dialog>(answer);
        return [done] { return *done; };
    }

    const std::map<std::string, Expectation> expectations{
        {"cases",
         [this]() -> Check {
             return [shown = cases()->isVisible(), this] { return cases()->isVisible() != shown; };
         }},
        {"save-picture",
         [this]() -> Check {
             const QString file = QString::fromStdString((folder_ / "picture.png").string());
             dialog<QDialog>([file](QDialog& dialog) {
                 dialog.findChild<QLineEdit*>()->setText(file);
                 press(Qt::Key_Return);
             });
             return [file] {
                 return QImage(file)
                     .text(QStringLiteral("Description"))
                     .contains(QStringLiteral("Case: phantom"));
             };
         }},
        {"copy-picture",
         [this]() -> Check {
             QApplication::clipboard()->clear();
             moveTo(pane(View::axial), {50, 50});
             return [] {
                 const QMimeData* data = QApplication::clipboard()->mimeData();
                 return data && data->hasImage() &&
                        data->text().contains(QStringLiteral("View: Axial"));
             };
         }},
        {"undo",
         [this]() -> Check {
             flight().goTo(123.0);
             press(Qt::Key_End);
             return [this] { return flight().arcMm() == 123.0; };
         }},
        {"redo",
         [this]() -> Check {
             flight().goTo(123.0);
             press(Qt::Key_End);
             press(Qt::Key_Z, Qt::ControlModifier);
             return [this] { return std::abs(flight().arcMm() - length()) < 1e-9; };
         }},
        {"stop",
         [this]() -> Check {
             reader().flat().wall().measure({{0.5, 1.0}, {0.6, 1.0}}, false);
             // The tool first, then what was measured by it.
             press(Qt::Key_L);
             press(Qt::Key_Escape);
             EXPECT_EQ(reading_->tool(), DrawingTool::none);
             EXPECT_TRUE(reader().flat().wall().measurement());
             return [this] { return !reader().flat().wall().measurement(); };
         }},
        {"enlarge", [this] { return flips([this] { return window_->isEnlarged(); }); }},
        {"layout-reading",
         [this] {
             return shows({"endoscopic", "axial", "coronal", "sagittal", "strip", "zoom",
                           "overview", "oblique", "bookmarks"});
         }},
        {"layout-slices",
         [this] {
             return shows({"endoscopic", "axial", "coronal", "sagittal", "overview", "bookmarks"},
                          {"strip", "zoom", "oblique"});
         }},
        {"layout-flattened",
         [this] {
             return shows({"endoscopic", "axial", "strip", "zoom", "bookmarks"},
                          {"coronal", "sagittal", "overview"});
         }},
        {"layout-two-monitors",
         [this] {
             return Check([this] {
                 return dock("axial")->window() != window_.get() && dock("axial")->isVisible() &&
                        dock("endoscopic")->window() == window_.get();
             });
         }},
        {"full-screen", [this] { return flips([this] { return window_->isFullScreen(); }); }},
        {"next-pane", [this] { return focuses(); }},
        {"previous-pane", [this] { return focuses(); }},
        {"point", [this] { return flips([this] { return reading_->pointsByKeys(); }); }},
        {"scroll-on", [this] { return scrolls(1.0); }},
        {"scroll-back", [this] { return scrolls(-1.0); }},
        {"scroll-far-on", [this] { return scrolls(10.0); }},
        {"scroll-far-back", [this] { return scrolls(-10.0); }},
        {"zoom-in", [this] { return zooms(2.4); }},
        {"zoom-out", [this] { return zooms(2.0 / 1.2); }},
        {"drag-left",
         [this] {
             return looks({-1.0, 0.0});
         }},
        {"drag-right",
         [this] {
             return looks({1.0, 0.0});
         }},
        {"drag-up",
         [this] {
             return looks({0.0, 1.0});
         }},
        {"drag-down",
         [this] {
             return looks({0.0, -1.0});
         }},
        {"move-left",
         [this] {
             return pans({-1.0, 0.0});
         }},
        {"move-right",
         [this] {
             return pans({1.0, 0.0});
         }},
        {"move-up",
         [this] {
             return pans({0.0, -1.0});
         }},
        {"move-down",
         [this] {
             return pans({0.0, 1.0});
         }},
        {"fly-forward", [this] { return motion(Motion::forward); }},
        {"fly-backward", [this] { return motion(Motion::backward); }},
        {"step-forward", [this] { return steps(1.0); }},
        {"step-backward", [this] { return steps(-1.0); }},
        {"leap-forward", [this] { return steps(10.0); }},
        {"leap-backward", [this] { return steps(-10.0); }},
        {"to-rectum",
         [this]() -> Check {
             flight().goTo(123.0);
             return [this] { return flight().arcMm() == 0.0; };
         }},
        {"to-cecum",
         [this]() -> Check {
             flight().goTo(123.0);
             return [this] { return std::abs(flight().arcMm() - length()) < 1e-9; };
         }},
        {"go-to-arc",
         [this]() -> Check {
             flight().goTo(0.0);
             whenOpens<QDialog>([](QDialog& dialog) {
                 dialog.findChild<QAbstractSpinBox*>()->selectAll();
                 type(QStringLiteral("321"));
                 press(Qt::Key_Return);
             });
             return [this] { return flight().arcMm() == 321.0; };
         }},
        {"faster",
         [this]() -> Check {
             const double before = flight().speedMmPerS();
             return [=, this] { return std::abs(flight().speedMmPerS() - 1.25 * before) < 1e-9; };
         }},
        {"slower",
         [this]() -> Check {
             const double before = flight().speedMmPerS();
             return [=, this] { return std::abs(flight().speedMmPerS() - before / 1.25) < 1e-9; };
         }},
        {"turn-round",
         [this] {
             return flips([this] { return flight().direction() == FlightDirection::antegrade; });
         }},
        {"to-path",
         [this]() -> Check {
             flight().look(20.0, 10.0);
             flight().flyFreely();
             return [this] { return !flight().isFree() && flight().yawDegrees() == 0.0; };
         }},
        {"free-flight", [this] { return flips([this] { return flight().isFree(); }); }},
        {"fisheye", [this] { return flips([this] { return flight().isFisheye(); }); }},
        {"wider", [this] { return fov(5.0); }},
        {"narrower", [this] { return fov(-5.0); }},
        {"window-colon",
         [this] {
             return windowOf({0, 2000});
         }},
        {"window-soft",
         [this] {
             return windowOf({40, 400});
         }},
        {"window-lung",
         [this] {
             return windowOf({-600, 1600});
         }},
        {"window-bone",
         [this] {
             return windowOf({400, 1800});
         }},
        {"cleansed", [this] { return flips([this] { return slices().cleansed(); }); }},
        {"linked", [this] { return flips([this] { return slices().linked(); }); }},
        {"thicker",
         [this]() -> Check {
             slices().setSlab({5.0, Projection::mean});
             return [this] { return slices().slab().thicknessMm == 10.0; };
         }},
        {"thinner",
         [this]() -> Check {
             slices().setSlab({5.0, Projection::mean});
             return [this] { return slices().slab().thicknessMm == 2.0; };
         }},
        {"slab-maximum",
         [this] {
             return flips([this] { return slices().slab().projection == Projection::maximum; });
         }},
        {"line",
         [this] { return flips([this] { return reading_->tool() == DrawingTool::line; }); }},
        {"outline",
         [this] { return flips([this] { return reading_->tool() == DrawingTool::outline; }); }},
        {"ruler",
         [this] { return flips([this] { return reading_->tool() == DrawingTool::ruler; }); }},
        {"detection-mode",
         [this]() -> Check {
             EXPECT_TRUE(reader().findings().choose(DetectionMode::off));
             return [this] {
                 return reader().findings().choice().mode == DetectionMode::secondReader;
             };
         }},
        {"first-pass-done",
         [this]() -> Check {
             EXPECT_TRUE(reader().findings().choose(DetectionMode::off));
             EXPECT_TRUE(reader().findings().choose(DetectionMode::secondReader));
             QTest::qWait(50);
             return [this] { return reader().findings().shown().size() == 2; };
         }},
        {"next-finding",
         [this]() -> Check {
             EXPECT_TRUE(showFindings());
             flight().goTo(0.0);
             return [this] { return isAtFinding(1); };
         }},
        {"previous-finding",
         [this]() -> Check {
             EXPECT_TRUE(showFindings());
             flight().goTo(length());
             return [this] { return isAtFinding(2); };
         }},
        {"measure-finding",
         [this]() -> Check {
             EXPECT_TRUE(showFindings());
             reader().goTo(reader().findings().shown()[0]);
             reader().rulers().set({});
             return [this] {
                 const auto& rulers = reader().rulers().rulers();
                 return rulers.size() == 1 && rulers[0].finding == 1 &&
                        std::abs(rulers[0].lengthMm() - 8.0) < 1e-9;
             };
         }},
        {"findings-panel",
         [this] { return flips([this] { return dock("findings")->isVisible(); }); }},
        {"next-optics",
         [this]() -> Check {
             const std::size_t before = reader().optics().chosen();
             return [=, this] {
                 return reader().optics().chosen() == (before + 1) % reader().optics().presets();
             };
         }},
        {"optics", [this] { return flips([this] { return dock("optics")->isVisible(); }); }},
        {"lens", [this] { return flips([this] { return reader().lens().isOn(); }); }},
        {"lens-larger",
         [this]() -> Check {
             reader().lens().setOn(true);
             const double before = reader().lens().place().radius;
             return [=, this] { return reader().lens().place().radius > before; };
         }},
        {"lens-smaller",
         [this]() -> Check {
             reader().lens().setOn(true);
             const double before = reader().lens().place().radius;
             return [=, this] { return reader().lens().place().radius < before; };
         }},
        {"fly-over",
         [this] { return flips([this] { return reader().flat().tour().flyingOver(); }); }},
        {"paint-marks", [this] { return flips([this] { return reader().flat().paint().marks; }); }},
        {"paint-unseen",
         [this] { return flips([this] { return reader().flat().paint().unseen; }); }},
        {"next-missed",
         [this]() -> Check {
             reader().missed().open();
             return [this] { return isAtPatch(0); };
         }},
        {"previous-missed",
         [this]() -> Check {
             reader().missed().open();
             goToNextMissed(*reading_, 1);
             EXPECT_TRUE(waitFor([this] { return isAtPatch(0); }));
             goToNextMissed(*reading_, 1);
             EXPECT_TRUE(waitFor([this] { return isAtPatch(1); }));
             return [this] { return isAtPatch(0); };
         }},
        {"missed-panel", [this] { return flips([this] { return window_->showsMissed(); }); }},
        {"seen-report",
         [this]() -> Check {
             const QString file = QString::fromStdString((folder_ / "seen.json").string());
             dialog<QDialog>([file](QDialog& dialog) {
                 dialog.findChild<QLineEdit*>()->setText(file);
                 press(Qt::Key_Return);
             });
             return [file] {
                 QFile written(file);
                 return written.open(QIODevice::ReadOnly) &&
                        written.readAll().contains("\"reader\": \"ada\"");
             };
         }},
        {"forget-seen",
         [this]() -> Check {
             const int before = server_.seenForgotten();
             return [=, this] { return server_.seenForgotten() == before + 1; };
         }},
        {"overview-body",
         [this] { return flips([this] { return reader().outside().showsBody(); }); }},
        {"bookmark",
         [this]() -> Check {
             const std::size_t before = server_.storedBookmarkKeys().size();
             flight().goTo(150.0);
             return [=, this] { return server_.storedBookmarkKeys().size() == before + 1; };
         }},
        {"bookmark-note",
         [this]() -> Check {
             pane(View::endoscopic).setFocus();
             return [this] { return note().hasFocus(); };
         }},
        {"previous-bookmark",
         [this]() -> Check {
             flight().goTo(60.0);
             press(Qt::Key_B);
             flight().goTo(90.0);
             return [this] { return std::abs(flight().arcMm() - 60.0) < 1e-9; };
         }},
        {"next-bookmark",
         [this]() -> Check {
             flight().goTo(70.0);
             press(Qt::Key_B);
             flight().goTo(65.0);
             return [this] { return std::abs(flight().arcMm() - 70.0) < 1e-9; };
         }},
        {"bookmarks-panel",
         [this] { return flips([this] { return dock("bookmarks")->isVisible(); }); }},
        {"help",
         [this]() -> Check {
             const auto page = [] {
                 QWidget* active = QApplication::activeWindow();
                 return active && active->inherits("haustra::window::HelpPage") ? active : nullptr;
             };
             return page;
         }},
    };
};

TEST_F(ClientWindowCommands, EachDoesByItsKeysWhatItSays) {
    for (const Command& command : commands()) {
        for (const QKeySequence& key : CommandSet::keysOfOld(command)) {
            const std::string what = command.id + (" by " + key.toString().toStdString());
            SCOPED_TRACE(what);
            if (std::string(command.id) == "quit") continue;  // below
            // Those have tests of their own.
            if (command.isHeld() || std::string(command.id) == "connect-again") continue;
            const auto found = expectations.find(command.id);
            ASSERT_NE(found, expectations.end()) << "say here how its effect is seen";
            pane(View::endoscopic).setFocus();
            if (command.menu == Menu::file) {
                ASSERT_TRUE(settle());
            }
            const Check seen = found->second();
            QTest::qWait(1);
            EXPECT_FALSE(seen());
            press(key);
            EXPECT_TRUE(waitFor(seen));
            // Back to where every command can be seen to work.
            if (QWidget* active = QApplication::activeWindow(); active != window_.get()) {
                if (active && active->inherits("QDialog")) press(Qt::Key_Escape);
                activate();
            }
            if (cases()->isVisible()) press(Qt::Key_O, Qt::ControlModifier);
            if (reading_->pointsByKeys()) press(Qt::Key_Z);
            if (window_->isFullScreen()) press(Qt::Key_F11);
            if (window_->isEnlarged()) press(Qt::Key_Return);
            if (dock("optics")->isVisible()) press(Qt::Key_G);
            reader().setMotion(Motion::paused);
            reader().flat().setFlyingOver(false);
            flight().returnToCenterline();
            flight().resetLook();
            if (flight().direction() == FlightDirection::retrograde) press(Qt::Key_R);
            if (flight().isFisheye()) press(Qt::Key_I);
            if (std::string(command.id).starts_with("layout"))
                press(command.id == std::string("layout-reading") ? Qt::Key_3 : Qt::Key_1,
                      Qt::ControlModifier);
            if (std::string(command.id) == "full-screen") press(Qt::Key_2, Qt::ControlModifier);
            if (std::string(command.id) == "enlarge") press(Qt::Key_2, Qt::ControlModifier);
        }
    }
    EXPECT_TRUE(window_->isVisible());
    press(Qt::Key_Q, Qt::ControlModifier);
    EXPECT_TRUE(waitFor([&] { return !window_->isVisible(); }));
}

TEST(ClientWindowKeys, NoKeyBelongsToTwoCommands) {
    std::map<std::string, std::string> owners;
    for (const Command& command : commands())
        for (const QKeySequence& key : CommandSet::keysOfOld(command)) {
            EXPECT_FALSE(key.isEmpty()) << command.id;
            const auto [owner, isNew] = owners.emplace(key.toString().toStdString(), command.id);
            EXPECT_TRUE(isNew) << key.toString().toStdString() << " is of " << owner->second
                               << " and " << command.id;
        }
    EXPECT_GT(owners.size(), 50u);
}

TEST_F(ClientWindow, CommandsWithoutAKeyAreInTheMenus) {
    for (const Command& command : commands()) {
        if (command.isHeld()) continue;
        bool found = false;
        for (QAction* menu : window_->findChild<QMenuBar*>()->actions())
            found = found || menu->menu()->actions().contains(action(command.id));
        EXPECT_TRUE(found) << command.id;
    }
    reader().setMotion(Motion::forward);
    action("pause")->trigger();
    EXPECT_EQ(reader().motion(), Motion::paused);
    const auto about = whenOpens<QDialog>([](QDialog&) { press(Qt::Key_Escape); });
    action("about")->trigger();
    EXPECT_TRUE(*about);
}

TEST_F(ClientWindow, FreeFlightFollowsTheKeysThatAreHeld) {
    pane(View::endoscopic).setFocus();
    flight().goTo(200.0);
    press(Qt::Key_F);
    ASSERT_TRUE(flight().isFree());
    const Camera before = flight().camera();
    QTest::keyPress(handleOf(*window_), Qt::Key_W);
    EXPECT_TRUE(waitFor([&] {
        return glm::dot(flight().camera().positionMm - before.positionMm, before.forward) > 1.0;
    }));
    // Back on the path with the key still held: the next free flight does not start by itself.
    press(Qt::Key_C);
    QTest::keyRelease(handleOf(*window_), Qt::Key_W);
    press(Qt::Key_F);
    const Camera again = flight().camera();
    ASSERT_TRUE(flight().isFree());
    QTest::qWait(100);
    EXPECT_EQ(flight().camera(), again);
    // Each of the table's keys its own way; a key that was let go moves no more.
    int ways = 0;
    for (const Command& command : commands()) {
        if (!command.isHeld()) continue;
        ++ways;
        const glm::dvec3 along = command.heldWay,
                         way = along.x * glm::cross(again.forward, again.up) + along.y * again.up +
                               along.z * again.forward;
        const Qt::Key key = CommandSet::keysOfOld(command).front()[0].key();
        const glm::dvec3 from = flight().camera().positionMm;
        QTest::keyPress(handleOf(*window_), key);
        EXPECT_TRUE(
            waitFor([&] { return glm::dot(flight().camera().positionMm - from, way) > 1.0; }));
        QTest::keyRelease(handleOf(*window_), key);
    }
    EXPECT_EQ(ways, 6);
    const glm::dvec3 stands = flight().camera().positionMm;
    QTest::qWait(60);
    EXPECT_EQ(flight().camera().positionMm, stands);
    // So does a key that the reader has chosen.
    for (const Command& command : commands())
        if (std::string(command.id) == "free-back")
            window_->findChild<CommandSet*>()->setKeys(command, {QKeySequence(Qt::Key_F9)});
    QTest::keyPress(handleOf(*window_), Qt::Key_F9);
    EXPECT_TRUE(waitFor(
        [&] { return glm::dot(flight().camera().positionMm - stands, again.forward) < -1.0; }));
    QTest::keyRelease(handleOf(*window_), Qt::Key_F9);
}

// ---- keys stay with controls --------------------------------------------------------------------

TEST_F(ClientWindow, KeysStayWithTheControlThatHasTheKeyboard) {
    auto* turn = window_->findChild<QToolButton*>();
    for (QToolButton* button : window_->findChildren<QToolButton*>())
        if (button->defaultAction() == action("turn-round")) turn = button;
    turn->setFocus();
    press(Qt::Key_Space);
    EXPECT_EQ(flight().direction(), FlightDirection::retrograde);
    EXPECT_EQ(reader().motion(), Motion::paused);

    press(Qt::Key_B, Qt::ShiftModifier);
    ASSERT_TRUE(note().hasFocus());
    const auto bookmarks = reader().session().bookmarks().size();
    const double arc = flight().arcMm();
    type(QStringLiteral("bBxX tTlL+-?,.1"));
    press(Qt::Key_Left);
    press(Qt::Key_Home);
    press(Qt::Key_Delete);
    press(Qt::Key_End);
    press(Qt::Key_Backspace);
    EXPECT_EQ(note().text(), QStringLiteral("BxX tTlL+-?,."));
    EXPECT_EQ(reader().session().bookmarks().size(), bookmarks);
    EXPECT_FALSE(slices().cleansed());
    EXPECT_EQ(flight().arcMm(), arc);
    EXPECT_EQ(reader().motion(), Motion::paused);
    EXPECT_EQ(reading_->tool(), DrawingTool::none);

    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] {
        return qobject_cast<QLineEdit*>(QApplication::focusWidget()) &&
               QApplication::focusWidget() != &note();
    }));
    type(QStringLiteral("bx"));
    EXPECT_EQ(qobject_cast<QLineEdit*>(QApplication::focusWidget())->text(), QStringLiteral("bx"));
    EXPECT_EQ(reader().session().bookmarks().size(), bookmarks);
    EXPECT_FALSE(slices().cleansed());
}

TEST_F(ClientWindow, WhileTheListOfCasesIsInSightNoKeyChangesTheCaseBehindIt) {
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return cases()->findChild<QTableView*>()->isVisible(); }));
    cases()->findChild<QTableView*>()->setFocus();
    const double arc = flight().arcMm();
    for (const int key : {Qt::Key_B, Qt::Key_X, Qt::Key_Home, Qt::Key_End, Qt::Key_Backspace})
        press(key);
    EXPECT_TRUE(settle());
    EXPECT_TRUE(reader().session().bookmarks().empty());
    EXPECT_FALSE(slices().cleansed());
    EXPECT_EQ(flight().arcMm(), arc);
    EXPECT_EQ(reader().motion(), Motion::paused);
}

// ---- gestures -----------------------------------------------------------------------------------

TEST_F(ClientWindow, HandsInTheEndoscopicView) {
    const QWidget& view = pane(View::endoscopic);
    flight().goTo(200.0);
    ASSERT_TRUE(settle());
    const double degrees = flight().camera().fovDegrees / view.height();
    drag(view, {{200, 200}, {210, 200}, {260, 180}});
    EXPECT_NEAR(flight().yawDegrees(), 60 * degrees, 1e-9);
    EXPECT_NEAR(flight().pitchDegrees(), 20 * degrees, 1e-9);
    doubleClick(view, {200, 200});
    EXPECT_EQ(flight().yawDegrees(), 0.0);
    EXPECT_EQ(flight().pitchDegrees(), 0.0);
    ASSERT_TRUE(settle());

    const double arc = flight().arcMm();
    wheel(view, {200, 200}, 1);
    EXPECT_NEAR(flight().arcMm(), arc + 3.0, 1e-9);
    wheel(view, {200, 200}, -1, Qt::ShiftModifier);
    EXPECT_NEAR(flight().arcMm(), arc - 7.0, 1e-9);
    wheel(view, {200, 200}, 2, Qt::ControlModifier);
    EXPECT_EQ(flight().camera().fovDegrees, 80.0);
    ASSERT_TRUE(settle());

    const QPoint at(view.width() / 2 + 60, view.height() / 2 - 40);
    const auto direction = *rayThrough(
        flight().camera(),
        (vector(at) - 0.5 * glm::dvec2(view.width(), view.height())) / double(view.height()));
    const Camera camera = flight().camera();
    click(view, at);
    ASSERT_TRUE(waitFor([&] { return reader().flat().picked().has_value(); }));
    const glm::dvec3 wall = camera.positionMm + tests::fakeRadiusMm * direction;
    EXPECT_LT(glm::distance(reader().flat().picked()->positionMm, wall), 1e-9);
    EXPECT_EQ(flight().camera(), camera);
    EXPECT_LT(glm::distance(slices().slice(View::coronal).positionMm, wall), 1e-9);
}

TEST_F(ClientWindow, TheLensFollowsTheMouseAndTheKeysPointer) {
    Pane& view = pane(View::endoscopic);
    flight().goTo(200.0);
    ASSERT_TRUE(settle());
    const int stills = server_.askedOf(View::endoscopic).pictures;
    const auto placeAt = [&](QPointF at) {
        return (vector(at) - 0.5 * glm::dvec2(view.width(), view.height())) / double(view.height());
    };
    const auto& lens = reader().lens();
    const auto shown = [&] {
        return lens.isExact() && lens.pictureOver(flight().camera()) != nullptr;
    };
    view.setFocus();
    moveTo(view, {120, 150});
    press(Qt::Key_T, Qt::ShiftModifier);
    ASSERT_TRUE(waitFor([&] { return shown() && settled(); }));
    EXPECT_LT(glm::distance(lens.place().center, placeAt({120, 150})), 1e-9);
    const int viewport = int(protocol::lensViewport);
    EXPECT_TRUE(server_.askedOf(viewport).lens);
    EXPECT_EQ(server_.askedOf(viewport).optics, "biopsy");
    EXPECT_LE(server_.askedOf(viewport).size.x, reader::mostLensPixels);
    EXPECT_TRUE(view.accessibleDescription().contains(QStringLiteral("electronic biopsy")));
    EXPECT_TRUE(view.provenance().contains(QStringLiteral("electronic biopsy")));
    // Within the ring another picture, beyond it the one beneath, which has not been asked anew.
    const QImage with = view.pictureWithMarks();
    moveTo(view, {200, 180});
    ASSERT_TRUE(waitFor([&] {
        return glm::distance(lens.place().center, placeAt({200, 180})) < 1e-9;
    }));
    ASSERT_TRUE(waitFor([&] { return shown() && settled(); }));
    EXPECT_NE(with, view.pictureWithMarks());
    EXPECT_EQ(server_.askedOf(View::endoscopic).pictures, stills);
    const double radius = lens.place().radius;
    wheel(view, {200, 180}, 1, Qt::AltModifier);
    EXPECT_NEAR(lens.place().radius, radius * reader::lensGrowth, 1e-9);
    EXPECT_EQ(flight().arcMm(), 200.0);
    // Of another place of the camera its picture is not shown, until there is one.
    const Camera before = flight().camera();
    flight().goTo(220.0);
    EXPECT_EQ(lens.pictureOver(flight().camera()), nullptr);
    EXPECT_NE(lens.pictureOver(before), nullptr);
    reading_->changed();
    ASSERT_TRUE(waitFor([&] { return shown() && settled(); }));
    // The keys' pointer, and away with it.
    moveTo(pane(View::axial), {5, 5});
    press(Qt::Key_Z);
    press(Qt::Key_Right, Qt::ShiftModifier);
    const QPointF keys = QRectF(view.rect()).center() + QPointF(24, 0);
    ASSERT_TRUE(waitFor([&] { return glm::distance(lens.place().center, placeAt(keys)) < 1e-9; }));
    press(Qt::Key_Escape);
    EXPECT_FALSE(reading_->pointsByKeys());
    EXPECT_TRUE(lens.isOn());
    press(Qt::Key_Escape);
    EXPECT_FALSE(lens.isOn());
    ASSERT_TRUE(waitFor([&] { return server_.askedOf(viewport).size == glm::ivec2(0); }));
}

class ClientWindowOfAnOldServer : public ClientWindow {
protected:
    ClientWindowOfAnOldServer() : ClientWindow({.old = true}) {}
};

TEST_F(ClientWindowOfAnOldServer, IsNotAskedForALens) {
    press(Qt::Key_T, Qt::ShiftModifier);
    EXPECT_TRUE(waitFor([&] {
        return window_->statusBar()->currentMessage().contains(QStringLiteral("lens")) ||
               notices(QStringLiteral("lens"));
    }));
    EXPECT_FALSE(reader().lens().isOn());
    // Nor where it was on before a newer one was exchanged for it.
    reader().lens().setOn(true);
    reading_->changed();
    QTest::qWait(50);
    EXPECT_EQ(server_.askedOf(int(protocol::lensViewport)).size, glm::ivec2(0));
    EXPECT_TRUE(pane(View::endoscopic)
                    .inWords()
                    .contains(QStringLiteral("this server cannot show a lens")));
}

TEST_F(ClientWindow, HandsOnASlice) {
    const QWidget& view = pane(View::axial);
    flight().goTo(200.0);
    ASSERT_TRUE(settle());
    const WindowLevel window = slices().window();
    drag(view, {{100, 100}, {140, 100}});
    EXPECT_NEAR(slices().window().widthHu, window.widthHu + 40 * 5, 1.0);
    drag(view, {{100, 100}, {100, 80}});
    EXPECT_LT(slices().window().centerHu, window.centerHu - 50);

    const double z = slices().slice(View::axial).positionMm.z;
    wheel(view, {100, 100}, 1);
    EXPECT_NEAR(slices().slice(View::axial).positionMm.z, z + 1.0, 1e-9);
    wheel(view, {100, 100}, 1, Qt::ShiftModifier);
    EXPECT_NEAR(slices().slice(View::axial).positionMm.z, z + 11.0, 1e-9);
    press(Qt::Key_PageDown);  // the pane that was dragged in has the keyboard
    EXPECT_NEAR(slices().slice(View::axial).positionMm.z, z + 10.0, 1e-9);

    const QPoint at(80, 120);
    const glm::dvec3 under = patientAt(View::axial, at);
    wheel(view, at, 3, Qt::ControlModifier);
    EXPECT_NEAR(slices().slice(View::axial).zoom, std::pow(1.2, 3), 1e-9);
    EXPECT_LT(glm::distance(patientAt(View::axial, at), under), 1e-6);
    EXPECT_EQ(slices().slice(View::sagittal).zoom, slices().slice(View::axial).zoom);
    ASSERT_TRUE(settle());
    for (const Qt::MouseButton button : {Qt::MiddleButton, Qt::RightButton}) {
        const glm::dvec3 held = patientAt(View::axial, at);
        drag(view, {at, at + QPoint(20, 0), at + QPoint(31, -17)}, button);
        EXPECT_LT(glm::distance(patientAt(View::axial, at + QPoint(31, -17)), held), 1e-6);
        ASSERT_TRUE(settle());
    }
    EXPECT_EQ(QApplication::activePopupWidget(), nullptr);
}

TEST_F(ClientWindow, AClickOnASliceShowsThatVeryVoxelInAllViews) {
    const Grid& grid = reader().session().caseInfo()->grid;
    const glm::dvec3 half = 0.5 * grid.spacingMm();
    const auto expectVoxel = [&](View view, glm::dvec3 voxel) {
        const glm::dvec3 mm = grid.patientFromVoxelPoint(voxel);
        moveTo(pane(view), {100, 100});
        press(Qt::Key_Return);  // so large that a pixel is less than a voxel
        ASSERT_TRUE(settle());
        // The slice that it lies in, at another place of it.
        const glm::dvec3 aside = glm::dvec3(5.0) * (1.0 - reader::sliceNormal(view));
        slices().show(mm + aside, flight().camera().positionMm, view);
        ASSERT_TRUE(settle());
        const QPoint there = positionOf(view, mm);
        ASSERT_TRUE(pane(view).rect().contains(there)) << int(view) << " at " << there.x() << ", "
                                                       << there.y() << " of " << pane(view).width();
        click(pane(view), positionOf(view, mm));
        press(Qt::Key_Return);
        ASSERT_TRUE(settle());
        for (const View other : {View::axial, View::coronal, View::sagittal}) {
            for (const glm::dvec3 shown : {slices().slice(other).positionMm,
                                           reader().panes().shown<SliceView>(other)->positionMm})
                for (int axis = 0; axis < 3; ++axis)
                    EXPECT_LT(std::abs(shown[axis] - mm[axis]), half[axis])
                        << "axis " << axis << " of " << int(other);
        }
        const glm::dvec3 gone = slices().slice(view).positionMm;
        ASSERT_TRUE(reader().flat().picked());
        EXPECT_EQ(reader().flat().picked()->positionMm, gone);
        EXPECT_TRUE(reader().flat().picked()->wall);
        const Camera camera = flight().camera();
        EXPECT_GT(glm::dot(camera.forward, glm::normalize(gone - camera.positionMm)), 1 - 1e-9);
        EXPECT_NEAR(flight().arcMm(), nearestArc(FakeServer::centerline(), gone), 1e-6);
    };
    expectVoxel(View::axial, {150, 100, 90});
    expectVoxel(View::coronal, {120, 140, 60});
    expectVoxel(View::sagittal, {128, 90, 110});
    // Enlarged and moved.
    wheel(pane(View::axial), {200, 200}, 8, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    drag(pane(View::axial), {{200, 200}, {150, 240}}, Qt::MiddleButton);
    ASSERT_TRUE(settle());
    press(Qt::Key_Return);
    ASSERT_TRUE(settle());
    const QPoint inSight = pane(View::axial).rect().center() + QPoint(150, -60);
    const glm::dvec3 near = glm::round(grid.voxelFromPatientPoint(patientAt(View::axial, inSight)));
    press(Qt::Key_Return);
    expectVoxel(View::axial, near);
    // Slices that are not linked: this one alone.
    press(Qt::Key_J);
    const SliceView sagittal = slices().slice(View::sagittal);
    const Camera camera = flight().camera();
    click(pane(View::axial), {60, 60});
    ASSERT_TRUE(settle());
    EXPECT_EQ(slices().slice(View::sagittal), sagittal);
    EXPECT_EQ(flight().camera(), camera);
}

TEST_F(ClientWindow, HandsAcrossTheGaze) {
    const QWidget& view = pane(View::oblique);
    flight().goTo(200.0);
    ASSERT_TRUE(settle());
    const auto slice = [&] { return slices().oblique(flight().camera()); };
    const auto before = slice();
    wheel(view, {80, 80}, 4);
    EXPECT_NEAR(glm::dot(slice().positionMm - before.positionMm, before.forward), 4.0, 1e-9);
    wheel(view, {80, 80}, 1, Qt::ShiftModifier);
    EXPECT_NEAR(glm::dot(slice().positionMm - before.positionMm, before.forward), 14.0, 1e-9);
    wheel(view, {80, 80}, 1, Qt::ControlModifier);
    EXPECT_NEAR(slice().heightMm, before.heightMm / 1.2, 1e-9);
    drag(view, {{80, 80}, {110, 80}});
    EXPECT_NEAR(slices().window().widthHu, 2150.0, 1.0);
    ASSERT_TRUE(settle());
    const glm::ivec2 size = reader().panes().size(View::oblique);
    // What the hand moves, moves with it; the menu brings it back.
    const auto placed = [&] { return *placeSlice(slice(), size.x, size.y); };
    const glm::dvec3 held = placed().patientFromPixel({40, 50});
    const auto middle = slice();
    drag(view, {{80, 80}, {90, 100}, {110, 120}}, Qt::MiddleButton);
    EXPECT_LT(glm::distance(placed().patientFromPixel({70, 90}), held), 1e-6);
    ASSERT_TRUE(settle());
    const auto menu = chooseInMenu(QStringLiteral("In the middle again"));
    click(view, {80, 80}, Qt::RightButton);
    ASSERT_TRUE(waitFor([&] { return *menu && slice() == middle; }));
    ASSERT_TRUE(settle());
    const glm::dvec3 there =
        placeSlice(slice(), size.x, size.y)->patientFromPixel(glm::dvec2(60, 70) - 0.5);
    click(view, {60, 70});
    ASSERT_TRUE(settle());
    EXPECT_LT(glm::distance(slices().slice(View::axial).positionMm, there), 1e-9);
    EXPECT_GT(
        glm::dot(flight().camera().forward, glm::normalize(there - flight().camera().positionMm)),
        1 - 1e-9);
}

TEST_F(ClientWindow, HandsOnTheStrip) {
    const QWidget& view = pane(View::flattened);
    const StripLayout layout =
        layOutStrip(tests::fakeStripHeight, reader().panes().size(View::flattened));
    const auto position = [&](glm::dvec2 flat) {
        return point(layout.pixelFromFlat(flat)).toPoint();
    };
    const auto flatAt = [&](QPoint at) {
        return *layout.flatFromPixel(vector(at), tests::fakeStripHeight);
    };
    const QPoint at = position({0.4, 2.0});
    click(view, at);
    ASSERT_TRUE(waitFor([&] { return reader().flat().picked().has_value(); }));
    EXPECT_NEAR(flight().arcMm(), flatAt(at).y / tests::fakeStripHeight * length(), 1e-6);
    EXPECT_NEAR(reader().flat().picked()->wall->flat->x, flatAt(at).x, 1e-9);
    ASSERT_TRUE(settle());
    // A drag looks it over, and goes where it ends.
    const double arc = flight().arcMm();
    const QPoint to = position({0.6, 3.0});
    moveTo(view, at);
    QTest::mousePress(handleOf(view), Qt::LeftButton, {}, inWindow(view, at));
    moveTo(view, to);
    ASSERT_TRUE(settle());
    EXPECT_NEAR(reader().flat().tour().window().center.y, flatAt(to).y, 1e-9);
    EXPECT_EQ(flight().arcMm(), arc);
    QTest::mouseRelease(handleOf(view), Qt::LeftButton, {}, inWindow(view, to));
    EXPECT_TRUE(waitFor([&] {
        return std::abs(flight().arcMm() - flatAt(to).y / tests::fakeStripHeight * length()) < 1e-6;
    }));
}

TEST_F(ClientWindow, HandsOnTheFlattenedWall) {
    const QWidget& view = pane(View::flattenedZoom);
    flight().goTo(0.5 * length());
    ASSERT_TRUE(settle());
    reader::StripTour& tour = reader().flat().tour();
    const auto flatAt = [&](QPoint at) {
        return tour.window().flatFromPixel(vector(at), tour.paneSize());
    };
    const QPoint at(90, 60);
    const Camera camera = flight().camera();
    const glm::dvec2 held = flatAt(at);
    drag(view, {at, at + QPoint(30, 10), at + QPoint(50, 30)});
    EXPECT_LT(glm::distance(flatAt(at + QPoint(50, 30)), held), 1e-9);
    const glm::dvec2 under = flatAt(at);
    wheel(view, at, 2);
    EXPECT_LT(glm::distance(flatAt(at), under), 1e-9);
    EXPECT_EQ(flight().camera(), camera);
    ASSERT_TRUE(settle());

    const glm::dvec2 a = flatAt({60, 60}), b = flatAt({160, 90});
    const auto measured = [&] {
        const auto& m = reader().flat().wall().measurement();
        return m && m->result ? m : std::nullopt;
    };
    drag(view, {{60, 60}, {100, 80}, {160, 90}}, Qt::LeftButton, Qt::ShiftModifier);
    ASSERT_TRUE(settle());
    ASSERT_TRUE(measured());
    EXPECT_FALSE(measured()->closed);
    EXPECT_NEAR(measured()->result->lengthMm, tests::fakeCircumferenceMm * glm::distance(a, b),
                1e-6);
    drag(view, {{60, 60}, {160, 60}, {160, 120}, {60, 120}}, Qt::LeftButton, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    ASSERT_TRUE(measured());
    EXPECT_TRUE(measured()->closed);
    const double scale = tests::fakeCircumferenceMm / tour.window().pixelsPerUnit;
    EXPECT_NEAR(measured()->result->areaMm2, 100 * 60 * scale * scale, 1e-6);

    const glm::dvec2 there = flatAt({200, 100});
    click(view, {200, 100});
    ASSERT_TRUE(waitFor([&] { return reader().flat().picked().has_value(); }));
    EXPECT_NEAR(reader().flat().picked()->wall->flat->y, there.y, 1e-9);
    EXPECT_FALSE(reader().flat().wall().measurement());
    // Each is taken back in its turn: what the click has cleared, and the line before the outline.
    press(Qt::Key_Z, Qt::ControlModifier);
    ASSERT_TRUE(reader().flat().wall().measurement());
    EXPECT_TRUE(reader().flat().wall().measurement()->closed);
    press(Qt::Key_Z, Qt::ControlModifier);
    ASSERT_TRUE(reader().flat().wall().measurement());
    EXPECT_FALSE(reader().flat().wall().measurement()->closed);
    EXPECT_EQ(reader().flat().wall().measurement()->points.front(), a);
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_FALSE(reader().flat().wall().measurement());
}

TEST_F(ClientWindow, HandsOnTheOverview) {
    const QWidget& view = pane(View::overview);
    const Orbit front = reader().outside().orbit();
    drag(view, {{60, 60}, {80, 60}, {100, 80}});
    EXPECT_NEAR(reader().outside().orbit().azimuthDegrees, front.azimuthDegrees - 20.0, 1e-9);
    EXPECT_NEAR(reader().outside().orbit().elevationDegrees, front.elevationDegrees + 10.0, 1e-9);
    wheel(view, {60, 60}, 1);
    EXPECT_NEAR(reader().outside().orbit().heightMm, front.heightMm / 1.15, 1e-6);
    ASSERT_TRUE(settle());
    const double arc = flight().arcMm();
    doubleClick(view, {3, 3});
    EXPECT_EQ(reader().outside().orbit(), front);
    EXPECT_EQ(flight().arcMm(), arc);
    // Wherever it is: on the path too it looks from the front, and leaves the flight.
    reader().outside().turn(30, 0);
    const glm::dvec2 size(view.width(), view.height());
    const auto onPath = [&](double arcMm) {
        return point(glm::dvec2(projected(
                         reader().outside().orbit(),
                         poseAtArc(FakeServer::centerline(), arcMm).point.positionMm, size)))
            .toPoint();
    };
    doubleClick(view, onPath(0.4 * length()));
    ASSERT_TRUE(settle());
    EXPECT_EQ(reader().outside().orbit(), front);
    EXPECT_EQ(flight().arcMm(), arc);

    const QPoint at = onPath(0.6 * length());
    click(view, at);
    ASSERT_TRUE(settle());
    EXPECT_NEAR(flight().arcMm(),
                *reader::arcAt(front, FakeServer::centerline(), vector(at), size, 40.0), 1e-9);
    EXPECT_GT(flight().arcMm(), 10.0);
    // A bookmark.
    press(Qt::Key_B);
    const double marked = flight().arcMm();
    flight().goTo(20.0);
    flight().look(40.0, 0.0);
    ASSERT_TRUE(waitFor([&] { return server_.storedBookmarkKeys().size() == 1; }));
    click(view, onPath(marked));
    EXPECT_EQ(flight().arcMm(), marked);
    EXPECT_TRUE(areNear(flight().camera(), reader().session().bookmarks()[0].camera));
    const auto menu = chooseInMenu(QStringLiteral("From the front"));
    reader().outside().turn(30, 0);
    click(view, {40, 40}, Qt::RightButton);
    EXPECT_TRUE(waitFor([&] { return *menu; }));
    EXPECT_TRUE(waitFor([&] { return reader().outside().orbit() == front; }));
}

TEST_F(ClientWindow, HandsOnTheTrack) {
    auto* track = window_->findChild<QWidget*>();
    for (QAbstractSlider* slider : window_->findChildren<QAbstractSlider*>())
        if (slider->inherits("haustra::window::PathTrack")) track = slider;
    const auto arcAt = [&](int x) { return (x - 10.0) / (track->width() - 20.0) * length(); };
    reader().setMotion(Motion::forward);
    click(*track, {200, 10});
    EXPECT_NEAR(flight().arcMm(), arcAt(200), 1e-9);
    EXPECT_EQ(reader().motion(), Motion::paused);
    drag(*track, {{300, 10}, {350, 10}, {400, 12}});
    EXPECT_NEAR(flight().arcMm(), arcAt(400), 1e-9);
    press(Qt::Key_Right);  // it has the keyboard
    EXPECT_NEAR(flight().arcMm(), arcAt(400) + 1.0, 1.0);
    press(Qt::Key_Home);
    EXPECT_EQ(flight().arcMm(), 0.0);
}

TEST_F(ClientWindow, HandsOnTheTransferFunction) {
    press(Qt::Key_G);
    auto* panel = dock("optics");
    ASSERT_TRUE(waitFor([&] { return panel->isVisible(); }));
    QWidget* graph = nullptr;
    for (QWidget* widget : panel->findChildren<QWidget*>())
        if (widget->inherits("haustra::window::TransferGraph")) graph = widget;
    ASSERT_TRUE(graph);
    ASSERT_TRUE(settle());
    // The axis is as wide as the points, −700…−500 HU, and an eighth on either side.
    const double low = -724.0, high = -476.0;
    const auto at = [&](double hu, double opacity) {
        const QRectF area = QRectF(graph->rect()).adjusted(38, 6, -8, -22);
        return QPointF(area.left() + (hu - low) / (high - low) * area.width(),
                       area.bottom() - std::sqrt(opacity) * area.height())
            .toPoint();
    };
    const auto points = [&] { return reader().optics().curve().points(); };
    ASSERT_EQ(points().size(), 2u);
    drag(*graph, {at(-700, 0.0), at(-690, 0.1), at(-680, 0.25)});
    EXPECT_NEAR(points()[0].hu, -680.0, 2.0);
    EXPECT_NEAR(points()[0].opacity, 0.25, 0.02);
    doubleClick(*graph, at(-600, 0.64));
    ASSERT_EQ(points().size(), 3u);
    EXPECT_NEAR(points()[1].hu, -600.0, 2.0);
    EXPECT_NEAR(points()[1].opacity, 0.64, 0.02);
    click(*graph, at(-600, 0.64), Qt::RightButton);
    ASSERT_EQ(points().size(), 2u);
    // The axis: the wheel enlarges it about the hand, a drag beside the points moves it.
    wheel(*graph, at(-600, 0.04), 1);
    const auto enlarged = [&](double hu) { return -600.0 + (hu + 600.0) / 0.85; };
    drag(*graph,
         {at(enlarged(-680), 0.25), at(enlarged(-680) + 10, 0.25), at(enlarged(-670), 0.25)});
    EXPECT_NEAR(points()[0].hu, -670.0, 2.0);
    drag(*graph, {at(-560, 0.04), at(-570, 0.04), at(-580, 0.04)});
    const auto moved = [&](double hu) { return enlarged(hu) - 20.0; };
    drag(*graph, {at(moved(-670), 0.25), at(moved(-670) - 6, 0.25), at(moved(-680), 0.25)});
    EXPECT_NEAR(points()[0].hu, -680.0, 3.0);
    EXPECT_TRUE(reader().optics().isChanged(0));
    // By keys: the second point, up and to the right.
    graph->activateWindow();
    ASSERT_TRUE(waitFor([&] { return QApplication::activeWindow() == graph->window(); }));
    graph->setFocus();
    const auto before = points()[1];
    press(Qt::Key_N);
    press(Qt::Key_Right);
    press(Qt::Key_Down);
    EXPECT_GT(points()[1].hu, before.hu);
    EXPECT_LT(points()[1].opacity, before.opacity);
    press(Qt::Key_Insert);
    EXPECT_EQ(points().size(), 3u);
    press(Qt::Key_Delete);
    EXPECT_EQ(points().size(), 2u);
}

TEST_F(ClientWindow, BookmarksAreWrittenAndGoneToInTheirList) {
    flight().goTo(250.0);
    flight().look(30.0, -10.0);
    press(Qt::Key_B, Qt::ShiftModifier);
    type(QStringLiteral("a fold"));
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] { return server_.storedBookmarkKeys().size() == 1; }));
    EXPECT_EQ(note().text(), QString());
    ASSERT_TRUE(waitFor([&] { return bookmarkList().topLevelItemCount() == 1; }));
    EXPECT_EQ(bookmarkList().topLevelItem(0)->text(1), QStringLiteral("a fold"));
    const Camera camera = flight().camera();
    pane(View::endoscopic).setFocus();
    press(Qt::Key_Home);
    ASSERT_TRUE(settle());
    click(*bookmarkList().viewport(),
          bookmarkList().visualItemRect(bookmarkList().topLevelItem(0)).center());
    EXPECT_TRUE(areNear(flight().camera(), camera));
    // The list has the keyboard: Return goes there.
    flight().goTo(10.0);
    press(Qt::Key_Return);
    EXPECT_TRUE(waitFor([&] { return areNear(flight().camera(), camera); }));
}

// ---- measuring ----------------------------------------------------------------------------------

TEST_F(ClientWindow, RulersAndEllipsesMeasureTheScan) {
    const QWidget& view = pane(View::axial);
    flight().goTo(200.0);
    ASSERT_TRUE(settle());
    const double mm = placed(View::axial).pixelMm();
    press(Qt::Key_L);
    drag(view, {{60, 60}, {80, 90}, {120, 140}});
    ASSERT_EQ(reader().measures().measures().size(), 1u);
    EXPECT_NEAR(reader().measures().measures()[0].lengthMm(), 100.0 * mm, 1e-9);
    press(Qt::Key_L);
    drag(view, {{50, 50}, {70, 60}, {90, 110}}, Qt::LeftButton, Qt::ShiftModifier);
    ASSERT_EQ(reader().measures().measures().size(), 2u);
    EXPECT_NEAR(reader().measures().measures()[1].lengthMm(), std::hypot(40.0, 60.0) * mm, 1e-9);
    drag(view, {{100, 100}, {120, 130}, {140, 160}}, Qt::LeftButton, Qt::ControlModifier);
    ASSERT_EQ(reader().measures().measures().size(), 3u);
    const auto ellipse = [&] { return reader().measures().measures()[2]; };
    ASSERT_TRUE(waitFor([&] { return ellipse().values.has_value(); }));
    const glm::dvec3 center = patientAt(View::axial, {120, 130});
    EXPECT_LT(glm::distance(ellipse().centerMm(), center), 1e-9);
    EXPECT_NEAR(ellipse().values->meanHu, 2 * center.x + 3 * center.y + center.z, 1e-6);
    EXPECT_NEAR(ellipse().values->areaMm2, M_PI * 20 * mm * 30 * mm, 1e-6);
    // The value under the mouse.
    moveTo(view, {70, 80});
    const glm::dvec3 under = patientAt(View::axial, {70, 80});
    EXPECT_TRUE(waitFor([&] {
        const auto& pointed = reader().measures().pointed();
        return pointed && glm::distance(pointed->placeMm, under) < 1e-9 &&
               std::abs(pointed->hu - (2 * under.x + 3 * under.y + under.z)) < 1e-6;
    }));
    const auto menu = chooseInMenu(QStringLiteral("Clear rulers and ellipses"));
    click(view, {70, 80}, Qt::RightButton);
    EXPECT_TRUE(waitFor([&] { return *menu && reader().measures().measures().empty(); }));
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(reader().measures().measures().size(), 3u);
}

// All that a mouse does in the views, by keys alone; the mouse rests elsewhere.
// Two clicks, each in whichever pane, are the ends of one length.
TEST_F(ClientWindow, TwoClicksInAnyViewsMeasureBetweenTheirPlaces) {
    flight().goTo(200.0);
    ASSERT_TRUE(settle());
    press(Qt::Key_L, Qt::ShiftModifier);
    ASSERT_EQ(reading_->tool(), DrawingTool::ruler);
    const auto& rulers = reader().rulers().rulers();
    // Both ends on a slice.
    Pane& axial = pane(View::axial);
    const QPoint from(axial.width() / 3, axial.height() / 2), to(axial.width() / 2, from.y() + 20);
    const double arc = flight().arcMm();
    const glm::dvec3 a = patientAt(View::axial, from), b = patientAt(View::axial, to);
    click(axial, from);
    EXPECT_TRUE(reader().rulers().begun());
    click(axial, to);
    ASSERT_TRUE(waitFor([&] { return rulers.size() == 1; }));
    EXPECT_LT(glm::distance(rulers[0].from.positionMm, a), 1e-6);
    EXPECT_NEAR(rulers[0].lengthMm(), glm::distance(a, b), 1e-6);
    EXPECT_EQ(flight().arcMm(), arc) << "a click that measures goes nowhere";
    EXPECT_TRUE(axial.inWords().contains(QStringLiteral("mm")));
    // From the wall before the camera to the flattened one.
    Pane &endoscopic = pane(View::endoscopic), &zoom = pane(View::flattenedZoom);
    click(endoscopic, endoscopic.rect().center());
    ASSERT_TRUE(waitFor([&] { return reader().rulers().begun().has_value(); }));
    const glm::dvec3 ahead = flight().camera().positionMm +
                             tests::fakeRadiusMm * glm::normalize(flight().camera().forward);
    EXPECT_LT(glm::distance(reader().rulers().begun()->positionMm, ahead), 0.2);
    // It is in sight, where a ray to it meets the wall; the slice's ends, this side of it or
    // beyond, are not.
    EXPECT_TRUE(waitFor([&] {
        return reader().seenEnds().has(flight().camera(), reader().rulers().begun()->positionMm);
    }));
    for (const glm::dvec3 end : {a, b})
        EXPECT_EQ(reader().seenEnds().has(flight().camera(), end),
                  std::abs(glm::distance(end, flight().camera().positionMm) - tests::fakeRadiusMm) <
                          2.0 &&
                      reader::seenAt(flight().camera(), end).has_value());
    click(zoom, zoom.rect().center());
    ASSERT_TRUE(waitFor([&] { return rulers.size() == 2; }));
    const auto place = tests::fakePlace(reader().flat().tour().window().center);
    const glm::dvec3 there(place.position_mm().x(), place.position_mm().y(),
                           place.position_mm().z());
    EXPECT_LT(glm::distance(rulers[1].to.positionMm, there), 0.5);
    // From end to end along the strip, which the whole of it measures, too.
    Pane& strip = pane(View::flattened);
    click(strip, {strip.width() / 2, strip.height() / 2});
    ASSERT_TRUE(waitFor([&] { return reader().rulers().begun().has_value(); }));
    // Two clicks on one place measure nothing; to take back gives up what was begun, and so does
    // Escape before it puts the tool away.
    click(strip, {strip.width() / 2, strip.height() / 2});
    ASSERT_TRUE(settle());
    EXPECT_EQ(rulers.size(), 2u);
    EXPECT_TRUE(reader().rulers().begun());
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_FALSE(reader().rulers().begun());
    EXPECT_EQ(rulers.size(), 2u);
    click(strip, {strip.width() / 2, strip.height() / 2});
    ASSERT_TRUE(waitFor([&] { return reader().rulers().begun().has_value(); }));
    press(Qt::Key_Escape);
    EXPECT_EQ(reading_->tool(), DrawingTool::ruler);
    EXPECT_FALSE(reader().rulers().begun());
    // A drag keeps its meaning: it leads along the colon and sets no end.
    const double arcBefore = flight().arcMm();
    drag(strip, {{strip.width() / 2, strip.height() / 2},
                 {strip.width() / 2, strip.height() / 2 + 20},
                 {strip.width() / 2, strip.height() / 2 + 40}});
    EXPECT_TRUE(waitFor([&] { return flight().arcMm() != arcBefore; }));
    EXPECT_FALSE(reader().rulers().begun());
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_NEAR(flight().arcMm(), arcBefore, 1e-6);
    // What is measured can be taken back, when the tool has been put away, too.
    press(Qt::Key_Escape);
    EXPECT_EQ(reading_->tool(), DrawingTool::none);
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(rulers.size(), 1u);
    press(Qt::Key_Y, Qt::ControlModifier);
    EXPECT_EQ(rulers.size(), 2u);
    press(Qt::Key_Escape);
    EXPECT_TRUE(rulers.empty());
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(rulers.size(), 2u);
}

TEST_F(ClientWindow, WhatIsOnScreenIsToldAsLongAsItIs) {
    const auto toldIn = [&](int ms) {
        const std::uint64_t before = server_.onScreenMs();
        QTest::qWait(ms);
        return server_.onScreenMs() - before;
    };
    ASSERT_TRUE(settle());
    // Of each pane in sight but the strip's; the server hears of it a few times a second.
    const std::uint64_t mapped = server_.onScreenMs(View::flattened);
    EXPECT_GT(toldIn(1500), 1500u);
    EXPECT_EQ(server_.onScreenMs(View::flattened), mapped);
    moveTo(pane(View::flattened), {50, 50});
    QTest::qWait(800);
    EXPECT_GT(server_.onScreenMs(View::flattened), mapped + 100) << "it is pointed at";
    moveTo(pane(View::axial), {50, 50});
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return cases()->isVisible(); }));
    QTest::qWait(600);
    EXPECT_LT(toldIn(800), 100u) << "the list of cases lies over the case";
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return !cases()->isVisible(); }));
    ASSERT_TRUE(settle());
    EXPECT_GT(toldIn(1500), 1500u);
    window_->hide();
    QTest::qWait(600);
    EXPECT_LT(toldIn(800), 100u) << "a window that is hidden shows nothing";
}

TEST_F(ClientWindow, TheTopLineEndsInAnEllipsisAndKeepsItsFirstWords) {
    const QString least = QStringLiteral("colon 88 % sure"),
                  whole = least + QStringLiteral(", 4 places to look at");
    QWidget line;
    line.resize(600, 60);
    NarrowButton button(&line);
    button.setWords(whole, least);
    line.show();
    for (const int wider : {0, 3, 8, 20}) {
        button.resize(button.minimumSizeHint() + QSize(wider, 0));
        EXPECT_TRUE(button.text().startsWith(least)) << wider << ' ' << button.text().toStdString();
        EXPECT_FALSE(button.text() == whole) << wider;
    }
    button.resize(button.sizeHint() + QSize(1, 0));
    EXPECT_EQ(button.text().toStdString(), whole.toStdString());
    EXPECT_EQ(button.accessibleName().toStdString(), whole.toStdString());
}

// Docks that are arranged anew pass beneath a mouse that rests: panes are entered, and never left.
TEST_F(ClientWindow, WhatIsEnteredAtRestIsNotPointedAt) {
    ASSERT_TRUE(settle());
    Pane& strip = pane(View::flattened);
    const auto toldMs = [&] {
        QTest::qWait(400);
        const std::uint64_t before = server_.onScreenMs(View::flattened);
        QTest::qWait(800);
        return server_.onScreenMs(View::flattened) - before;
    };
    const auto enter = [&] {
        strip.setAttribute(Qt::WA_UnderMouse);
        QEnterEvent event({50, 50}, {50, 50}, strip.mapToGlobal(QPointF(50, 50)));
        QApplication::sendEvent(&strip, &event);
    };
    enter();
    EXPECT_EQ(toldMs(), 0u);
    moveTo(strip, {60, 60});
    EXPECT_GT(toldMs(), 100u) << "the mouse has moved in it";
    enter();
    EXPECT_EQ(toldMs(), 0u);
}

TEST_F(ClientWindow, MissedPatchesAreListedAndGoneTo) {
    press(Qt::Key_U, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return dock("missed")->isVisible(); }));
    auto& list =
        *named<QTreeWidget>(QStringLiteral("Missed patches of the wall, the largest first"));
    ASSERT_TRUE(waitFor([&] { return list.topLevelItemCount() == 3; }));
    EXPECT_EQ(list.topLevelItem(0)->text(0), QStringLiteral("900"));
    EXPECT_TRUE(waitFor([&] { return notices(QStringLiteral("3 patch")); }));
    EXPECT_TRUE(notices(QStringLiteral("19.0 cm²")));
    EXPECT_TRUE(notices(QStringLiteral("It is not kept"))) << "nobody has been named";
    const reader::MissedList patches = *reader().missed().list();
    const auto isAt = [&](std::size_t n) {
        return waitFor([&] { return reader().missed().current() == n; }) &&
               reader().flat().picked()->positionMm == patches.patches[n].place.positionMm;
    };
    // The camera is the one that shows it, beside the path; Ctrl+Z leads back.
    flight().goTo(10.0);
    press(Qt::Key_J, Qt::ShiftModifier);
    ASSERT_TRUE(isAt(0));
    EXPECT_TRUE(areNear(flight().camera(), *patches.patches[0].view));
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_TRUE(waitFor([&] { return flight().arcMm() == 10.0 && !flight().isFree(); }));
    press(Qt::Key_J, Qt::ShiftModifier);
    ASSERT_TRUE(isAt(1));
    press(Qt::Key_H, Qt::ShiftModifier);
    ASSERT_TRUE(isAt(0));
    press(Qt::Key_H, Qt::ShiftModifier);
    EXPECT_TRUE(waitFor([&] {
        return window_->statusBar()->currentMessage().startsWith(
            QStringLiteral("No earlier patch"));
    }));
    click(*list.viewport(), list.visualItemRect(list.topLevelItem(2)).center());
    ASSERT_TRUE(isAt(2));
    // All have been visited: another round begins.
    press(Qt::Key_J, Qt::ShiftModifier);
    ASSERT_TRUE(isAt(0));
    // Limits go to the server, and to the next start.
    auto& ms = *named<QAbstractSpinBox>(
        QStringLiteral("How long a place must have been on screen to count as seen"));
    ms.findChild<QLineEdit*>()->setText(QStringLiteral("450 ms"));
    ms.setFocus();
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] {
        return reader().session().seenLimits() && reader().session().seenLimits()->leastMs == 450;
    }));
    EXPECT_EQ(reader().session().seenLimits()->pixelsPerMm, SeenLimits{}.pixelsPerMm);
    EXPECT_EQ(QSettings().value("reading/seen-ms").toInt(), 450);
}

TEST_F(ClientWindow, FindingsAreListedWhereTheModeShowsThemAndGoneToInTheirList) {
    press(Qt::Key_F, Qt::ShiftModifier);
    ASSERT_TRUE(waitFor([&] { return dock("findings")->isVisible(); }));
    auto& list = *named<QTreeWidget>(QStringLiteral("Findings along the colon"));
    auto& mode = *named<QComboBox>(QStringLiteral("When findings are shown"));
    EXPECT_EQ(mode.currentIndex(), int(DetectionMode::off));
    EXPECT_EQ(list.topLevelItemCount(), 0);
    EXPECT_TRUE(notices(QStringLiteral("nothing: this is a test")));
    EXPECT_TRUE(notices(QStringLiteral("For a physician to judge")));
    // A second reader sees nothing before the first reading is done.
    press(Qt::Key_F, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return mode.currentIndex() == int(DetectionMode::secondReader); }));
    ASSERT_TRUE(waitFor([&] { return notices(QStringLiteral("once the first reading is done")); }));
    EXPECT_EQ(list.topLevelItemCount(), 0);
    const double arcBefore = flight().arcMm();
    const int stepsBefore = reading_->undoStack().index();
    press(Qt::Key_M, Qt::ShiftModifier);
    EXPECT_EQ(flight().arcMm(), arcBefore);
    EXPECT_EQ(reading_->undoStack().index(), stepsBefore);
    // Nor by the wheel over the mode, nor by a key that is meant for the flight.
    const auto waits = [&] {
        QTest::qWait(20);
        return mode.currentIndex() == int(DetectionMode::secondReader) &&
               reader().findings().choice() == DetectionChoice{DetectionMode::secondReader} &&
               list.topLevelItemCount() == 0;
    };
    wheel(mode, mode.rect().center(), -1);
    EXPECT_TRUE(waits());
    for (const auto key : {Qt::Key_Down, Qt::Key_End, Qt::Key_PageDown, Qt::Key_F}) {
        QTest::keyClick(&mode, key);
        EXPECT_TRUE(waits()) << key;
        mode.hidePopup();
    }
    // Who asks for them now is asked.
    const auto answers = [&](QMessageBox::StandardButton answer) {
        const auto asked = whenOpens<QMessageBox>(
            [=](QMessageBox& box) { QTest::mouseClick(box.button(answer), Qt::LeftButton); });
        press(Qt::Key_F, Qt::ControlModifier);
        window_->activateWindow();
        return waitFor([&] { return *asked && QApplication::activeWindow() == window_.get(); });
    };
    EXPECT_TRUE(answers(QMessageBox::No));
    EXPECT_TRUE(waits());
    EXPECT_EQ(QSettings().value("reading/detection").toInt(), int(DetectionMode::secondReader));
    EXPECT_TRUE(answers(QMessageBox::Yes));
    ASSERT_TRUE(waitFor([&] { return list.topLevelItemCount() == 2; }));
    press(Qt::Key_F, Qt::ControlModifier);
    press(Qt::Key_F, Qt::ControlModifier);
    ASSERT_TRUE(waitFor(waits));
    QPushButton* done = nullptr;
    for (auto* button : window_->findChildren<QPushButton*>())
        if (button->text() == QStringLiteral("First reading done:\nshow findings")) done = button;
    ASSERT_TRUE(done && done->isVisible() && done->isEnabled());
    click(*done, done->rect().center());
    ASSERT_TRUE(waitFor([&] { return list.topLevelItemCount() == 2; }));
    EXPECT_FALSE(done->isVisible());
    // The button that hides leaves the keyboard to no other, which Space would press.
    const auto spaceFlies = [&] {
        press(Qt::Key_Space);
        const bool flies = waitFor([&] { return reader().motion() == reader::Motion::forward; });
        if (flies) press(Qt::Key_Space);
        return flies && waitFor([&] { return reader().motion() == reader::Motion::paused; });
    };
    EXPECT_EQ(QApplication::focusWidget(), &list);
    EXPECT_TRUE(spaceFlies());
    EXPECT_FALSE(reader().findings().choice().leastProbability);
    EXPECT_EQ(list.topLevelItem(0)->text(0), QStringLiteral("1"));
    EXPECT_EQ(list.topLevelItem(0)->text(2), QStringLiteral("sigmoid"));
    EXPECT_EQ(list.topLevelItem(1)->text(4), QStringLiteral("70 %"));
    // Less probable ones stand among them.
    auto& least =
        *named<QAbstractSpinBox>(QStringLiteral("Least probability of less probable findings"));
    for (auto* box : window_->findChildren<QCheckBox*>())
        if (box->text().startsWith(QStringLiteral("also those"))) box->click();
    ASSERT_TRUE(waitFor([&] { return list.topLevelItemCount() == 3; }));
    EXPECT_EQ(list.topLevelItem(1)->text(0), QStringLiteral("3"));
    EXPECT_TRUE(least.isEnabled());
    wheel(least, {5, 5}, -1);
    EXPECT_EQ(least.text(), QStringLiteral("30 %"));
    EXPECT_FALSE(least.hasFocus());
    // A click leads all views there.
    flight().goTo(0.0);
    list.scrollToItem(list.topLevelItem(1));
    click(*list.viewport(), list.visualItemRect(list.topLevelItem(1)).center());
    const auto* third = reader().findings().find(3);
    ASSERT_TRUE(third && third->view);
    ASSERT_TRUE(waitFor([&] { return flight().isFree(); })) << "it is not seen from the path";
    EXPECT_LT(glm::distance(flight().camera().positionMm, third->view->positionMm), 1e-9);
    EXPECT_LT(glm::distance(flight().camera().forward, glm::dvec3(0, 0, 1)), 1e-9);
    EXPECT_LT(glm::distance(slices().slice(View::axial).positionMm, third->wall.positionMm), 1.0);
    EXPECT_LT(glm::distance(reader().flat().tour().window().center, *third->wall.flat), 1e-6);
    // A double click is one step, and so is Enter.
    const auto stepsBy = [&](const auto& choose) {
        const int before = reading_->undoStack().index();
        choose();
        QTest::qWait(20);
        return reading_->undoStack().index() - before;
    };
    EXPECT_EQ(stepsBy([&] {
                  doubleClick(*list.viewport(), list.visualItemRect(list.topLevelItem(1)).center());
              }),
              1);
    EXPECT_EQ(stepsBy([&] { QTest::keyClick(&list, Qt::Key_Return); }), 1);
    EXPECT_EQ(reader().findings().current()->number, 3);
    // Its row alone is bold, wherever the arrow keys have led the list's mark.
    QTest::keyClick(&list, Qt::Key_Down);
    EXPECT_EQ(list.currentItem(), list.topLevelItem(2));
    for (int row = 0; row < 3; ++row)
        EXPECT_EQ(list.topLevelItem(row)->font(0).bold(), row == 1) << row;
    // A panel that is hidden leaves the keyboard to the views.
    list.setFocus();
    press(Qt::Key_F, Qt::ShiftModifier);
    EXPECT_TRUE(waitFor([&] { return qobject_cast<Pane*>(QApplication::focusWidget()); }));
    press(Qt::Key_F, Qt::ShiftModifier);
    ASSERT_TRUE(waitFor([&] { return list.isVisible(); }));
    // Who goes on and takes it back is at the former one again, and measures that.
    press(Qt::Key_M, Qt::ShiftModifier);
    const auto isAt = [&](int number) {
        const auto* current = reader().findings().current();
        return current && current->number == number;
    };
    ASSERT_TRUE(waitFor([&] { return isAt(2); }));
    reading_->undoStack().undo();
    EXPECT_TRUE(isAt(3));
    press(Qt::Key_K, Qt::ShiftModifier);
    ASSERT_TRUE(waitFor([&] { return reader().shownRulers().size() == 1; }));
    EXPECT_EQ(reader().shownRulers().front().finding, 3);
    // Off again, nothing is left of them, nor of what was measured on them.
    EXPECT_TRUE(reader().findings().choose(DetectionMode::off));
    ASSERT_TRUE(waitFor([&] { return list.topLevelItemCount() == 0; }));
    EXPECT_TRUE(reader().shownRulers().empty());
    EXPECT_FALSE(reader().findings().current());
    // What another window of this reader's chooses meanwhile is not this one's next mode.
    QSettings().setValue("reading/detection", int(DetectionMode::concurrent));
    emit reading_->caseOpened();
    EXPECT_EQ(reader().findings().choice().mode, DetectionMode::secondReader);
    EXPECT_FALSE(reader().findings().choice().shows());
    EXPECT_TRUE(reader().findings().choose(DetectionMode::off));
    // Nor does any step that is taken back and done again lead to one.
    QUndoStack& steps = reading_->undoStack();
    while (steps.canUndo())
        steps.undo();
    EXPECT_LT(std::abs(flight().arcMm()), 1e-6);
    while (steps.canRedo())
        steps.redo();
    EXPECT_LT(std::abs(flight().arcMm()), 1e-6);
    EXPECT_TRUE(reader().shownRulers().empty());
    EXPECT_FALSE(reader().findings().current());
}

TEST_F(ClientWindow, TheKeysPointGoAndMeasure) {
    flight().goTo(200.0);
    ASSERT_TRUE(settle());
    moveTo(pane(View::overview), {3, 3});
    Pane& axial = pane(View::axial);
    axial.setFocus();
    press(Qt::Key_Z);
    for (int n = 0; n < 4; ++n)
        press(Qt::Key_Left);
    press(Qt::Key_Up, Qt::ShiftModifier);
    press(Qt::Key_Down, Qt::ControlModifier);
    const QPointF middle = QRectF(axial.rect()).center();
    const auto placeOf = [&](QPointF at) {
        return placed(View::axial).patientFromPixel(vector(at) - 0.5);
    };
    const QPointF at = middle + QPointF(-20, -24 + 1);
    const glm::dvec3 under = placeOf(at);
    // The value there, shown and said.
    ASSERT_TRUE(waitFor([&] {
        const auto& pointed = reader().measures().pointed();
        return pointed && glm::distance(pointed->placeMm, under) < 1e-9;
    }));
    EXPECT_TRUE(
        waitFor([&] { return axial.accessibleDescription().contains(QStringLiteral("HU, ")); }));
    // A ruler from there.
    press(Qt::Key_L);
    press(Qt::Key_Return);
    for (int n = 0; n < 6; ++n)
        press(Qt::Key_Right);
    press(Qt::Key_Return);
    ASSERT_EQ(reader().measures().measures().size(), 1u);
    const reader::ScanMeasure ruler = reader().measures().measures()[0];
    EXPECT_LT(glm::distance(ruler.fromMm, under), 1e-9);
    EXPECT_LT(glm::distance(ruler.toMm, placeOf(at + QPointF(30, 0))), 1e-9);
    EXPECT_TRUE(axial.inWords().contains(decimal(ruler.lengthMm()) + QStringLiteral(" mm")));
    press(Qt::Key_Right);  // it has ended
    EXPECT_EQ(reader().measures().measures()[0].toMm, ruler.toMm);
    // An ellipse.
    press(Qt::Key_O);
    press(Qt::Key_Return);
    press(Qt::Key_Right, Qt::ShiftModifier);
    press(Qt::Key_Down, Qt::ShiftModifier);
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] {
        return reader().measures().measures().size() == 2 &&
               reader().measures().measures()[1].values.has_value();
    }));
    // Without a tool Return goes there, in all views.
    press(Qt::Key_O);
    press(Qt::Key_Return);
    ASSERT_TRUE(answered());
    const glm::dvec3 there = placeOf(at + QPointF(35 + 24, 24));
    for (const View plane : {View::axial, View::coronal, View::sagittal})
        EXPECT_LT(glm::distance(slices().slice(plane).positionMm, there), 1e-6);
    // A notice that takes room from the panes leaves it.
    reading_->tell(QStringLiteral("a notice"), true);
    ASSERT_TRUE(waitFor([&] { return notices(QStringLiteral("a notice")); }));
    QTest::qWait(20);
    EXPECT_TRUE(reading_->pointsByKeys());
    // The arrows are the pointer's until it is gone.
    const double arc = flight().arcMm();
    press(Qt::Key_Right);
    EXPECT_EQ(flight().arcMm(), arc);
    press(Qt::Key_Escape);
    EXPECT_FALSE(reading_->pointsByKeys());
    press(Qt::Key_Right);
    EXPECT_NEAR(flight().arcMm(), arc + 1.0, 1e-9);
    // The wall in the endoscopic view, a place of the strip, a line on the flattened wall.
    const auto goneByKeys = [&](View view) {
        reading_->undoStack().clear();
        reader().flat().forgetPicked();
        pane(view).setFocus();
        press(Qt::Key_Z);
        press(Qt::Key_Right, Qt::ShiftModifier);
        press(Qt::Key_Return);
        const bool gone = waitFor([&] { return reader().flat().picked().has_value(); });
        EXPECT_TRUE(settle());
        return gone && reading_->undoStack().count() == 1;
    };
    EXPECT_TRUE(goneByKeys(View::endoscopic));
    EXPECT_TRUE(goneByKeys(View::flattened));
    EXPECT_TRUE(goneByKeys(View::flattenedZoom));
    press(Qt::Key_L);
    press(Qt::Key_Return);
    press(Qt::Key_Right, Qt::ShiftModifier);
    press(Qt::Key_Return);
    EXPECT_TRUE(waitFor([&] {
        const auto& line = reader().flat().wall().measurement();
        return line && line->result;
    }));
    press(Qt::Key_L);
    // Another pane with the keyboard: this one's pointer is gone.
    press(Qt::Key_F6);
    EXPECT_FALSE(reading_->pointsByKeys());
    // A drag by keys goes along the strip from where the reader is.
    press(Qt::Key_Escape);
    flight().goTo(250.0);
    ASSERT_TRUE(settle());
    pane(View::flattened).setFocus();
    const double from = flight().placeArcMm();
    press(Qt::Key_Up, Qt::AltModifier);
    ASSERT_TRUE(answered());
    EXPECT_GT(flight().placeArcMm(), from + 1.0);
    EXPECT_LT(flight().placeArcMm(), from + 0.2 * length());
}

// ---- undo ---------------------------------------------------------------------------------------

TEST_F(ClientWindow, EachThingThatIsUndoneAndRedoneLeavesNoTrace) {
    struct State {
        std::vector<ViewState> views;
        std::vector<double> measures;
        std::vector<TransferFunctionPoint> points;
        std::size_t preset;
        bool operator==(const State& other) const {
            if (points.size() != other.points.size()) return false;
            for (std::size_t n = 0; n < points.size(); ++n)
                if (points[n].hu != other.points[n].hu ||
                    points[n].opacity != other.points[n].opacity)
                    return false;
            return views == other.views && measures == other.measures && preset == other.preset;
        }
    };
    const auto state = [&] {
        State now;
        for (const View view :
             {View::endoscopic, View::axial, View::coronal, View::sagittal, View::oblique})
            now.views.push_back(reader().stateOf(view));
        for (const auto& measure : reader().measures().measures())
            now.measures.push_back(measure.lengthMm());
        now.points = reader().optics().curve().points();
        now.preset = reader().optics().chosen();
        return now;
    };
    const auto expectUndone = [&](const char* what, const std::function<void()>& act) {
        SCOPED_TRACE(what);
        ASSERT_TRUE(answered());
        const State before = state();
        const int steps = reading_->undoStack().index();
        act();
        ASSERT_TRUE(answered());
        const State after = state();
        EXPECT_FALSE(after == before);
        ASSERT_EQ(reading_->undoStack().index(), steps + 1);
        press(Qt::Key_Z, Qt::ControlModifier);
        ASSERT_TRUE(answered());
        EXPECT_TRUE(state() == before) << "undo";
        press(Qt::Key_Z, Qt::ControlModifier | Qt::ShiftModifier);
        ASSERT_TRUE(answered());
        EXPECT_TRUE(state() == after) << "redo";
        press(Qt::Key_Z, Qt::ControlModifier);
        ASSERT_TRUE(answered());
        EXPECT_TRUE(state() == before);
        EXPECT_EQ(reading_->undoStack().index(), steps);
    };
    press(Qt::Key_G);
    flight().goTo(150.0);
    flight().look(12.0, 3.0);
    press(Qt::Key_B);
    ASSERT_TRUE(waitFor([&] { return bookmarkList().topLevelItemCount() == 1; }));
    flight().goTo(200.0);
    wheel(pane(View::axial), {60, 60}, 2);
    wheel(pane(View::oblique), {60, 60}, 2);
    expectUndone("window", [&] { drag(pane(View::axial), {{60, 60}, {90, 70}, {100, 90}}); });
    expectUndone("ruler", [&] {
        drag(pane(View::axial), {{60, 60}, {90, 90}}, Qt::LeftButton, Qt::ShiftModifier);
    });
    expectUndone("ellipse", [&] {
        drag(pane(View::coronal), {{60, 60}, {90, 90}}, Qt::LeftButton, Qt::ControlModifier);
    });
    expectUndone("voxel", [&] { click(pane(View::axial), {70, 60}); });
    expectUndone("across the gaze", [&] { click(pane(View::oblique), {70, 60}); });
    expectUndone("the wall ahead", [&] { click(pane(View::endoscopic), {170, 160}); });
    expectUndone("strip", [&] {
        click(pane(View::flattened), pane(View::flattened).rect().center() + QPoint(10, -40));
    });
    expectUndone("wall", [&] { click(pane(View::flattenedZoom), {150, 60}); });
    expectUndone("overview",
                 [&] { click(pane(View::overview), pane(View::overview).rect().center()); });
    expectUndone("to the cecum", [&] { press(Qt::Key_End); });
    expectUndone("bookmark", [&] {
        click(*bookmarkList().viewport(),
              bookmarkList().visualItemRect(bookmarkList().topLevelItem(0)).center());
    });
    pane(View::endoscopic).setFocus();
    expectUndone("previous bookmark", [&] { press(Qt::Key_P); });
    QWidget *track = nullptr, *graph = nullptr;
    for (QWidget* widget : QApplication::allWidgets()) {
        if (widget->inherits("haustra::window::PathTrack")) track = widget;
        if (widget->inherits("haustra::window::TransferGraph")) graph = widget;
    }
    expectUndone("track", [&] { click(*track, {300, 10}); });
    expectUndone("drag of the track", [&] { drag(*track, {{300, 10}, {330, 10}, {420, 10}}); });
    expectUndone("a point of the optics",
                 [&] { doubleClick(*graph, graph->rect().center() + QPoint(0, 20)); });
    auto* presets = named<QComboBox>(QStringLiteral("Preset of the wall's optics"));
    ASSERT_TRUE(presets);
    const auto choose = [&](QComboBox& box) {
        return [&box] {
            box.setFocus();
            QTest::keyClick(box.window()->windowHandle(), Qt::Key_Down);
        };
    };
    presets->window()->activateWindow();
    expectUndone("preset", choose(*presets));
    window_->activateWindow();
    pane(View::endoscopic).setFocus();
    expectUndone("next look", [&] { press(Qt::Key_T); });
    expectUndone("look in the bar", choose(*named<QComboBox>(QStringLiteral("Look of the wall"))));
    expectUndone("window in the bar",
                 choose(*named<QComboBox>(QStringLiteral("Window of the slices"))));
    pane(View::endoscopic).setFocus();
    expectUndone("window by its key", [&] { press(Qt::Key_2); });
}

// What has been set since is not the jump's, and stays.
TEST_F(ClientWindow, UndoOfAJumpLeavesWhatWasSetSince) {
    press(Qt::Key_End);
    press(Qt::Key_X);
    press(Qt::Key_I);
    press(Qt::Key_Plus);
    const double speed = flight().speedMmPerS();
    wheel(pane(View::axial), {60, 60}, 2, Qt::ControlModifier);
    const double zoom = slices().slice(View::axial).zoom;
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_FALSE(slices().cleansed());  // a step of its own
    EXPECT_NEAR(flight().arcMm(), length(), 1e-9);
    press(Qt::Key_Z, Qt::ControlModifier);
    EXPECT_EQ(flight().arcMm(), 0.0);
    EXPECT_TRUE(flight().isFisheye());
    EXPECT_EQ(flight().speedMmPerS(), speed);
    EXPECT_EQ(slices().slice(View::axial).zoom, zoom);
}

// ---- panes in and out of sight ------------------------------------------------------------------

TEST_F(ClientWindow, PanesOutOfSightAskForNothingAndComeBackAsTheyAre) {
    press(Qt::Key_2, Qt::ControlModifier);  // neither strip nor slice across the gaze
    ASSERT_TRUE(settle());
    const View hidden[] = {View::oblique, View::flattened, View::flattenedZoom};
    std::map<View, int> asked;
    for (const View view : hidden) {
        ASSERT_TRUE(waitFor([&] { return server_.askedOf(view).size == glm::ivec2(0); }));
        asked[view] = server_.askedOf(view).pictures;
        EXPECT_FALSE(pane(view).isVisible());
    }
    press(Qt::Key_End);
    press(Qt::Key_3);
    press(Qt::Key_T);
    ASSERT_TRUE(settle());
    for (const View view : hidden)
        EXPECT_EQ(server_.askedOf(view).pictures, asked[view]) << int(view);
    press(Qt::Key_1, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    for (const View view : hidden) {
        EXPECT_GT(server_.askedOf(view).pictures, asked[view]) << int(view);
        EXPECT_EQ(server_.askedOf(view).size, glm::ivec2(pane(view).width(), pane(view).height()));
    }
    EXPECT_EQ(server_.askedOf(View::oblique).window, (WindowLevel{-600, 1600}));
    EXPECT_EQ(server_.askedOf(View::flattened).optics, "translucent");
    EXPECT_EQ(server_.askedOf(View::flattenedZoom).optics, "translucent");
    // Behind another one's tab it is out of sight too.
    window_->tabifyDockWidget(dock("coronal"), dock("sagittal"));
    dock("coronal")->raise();
    ASSERT_TRUE(waitFor([&] { return server_.askedOf(View::sagittal).size == glm::ivec2(0); }));
    ASSERT_TRUE(settle());
    const int behind = server_.askedOf(View::sagittal).pictures;
    press(Qt::Key_Home);
    ASSERT_TRUE(settle());
    EXPECT_EQ(server_.askedOf(View::sagittal).pictures, behind);
    dock("sagittal")->raise();
    ASSERT_TRUE(waitFor([&] { return server_.askedOf(View::coronal).size == glm::ivec2(0); }));
    ASSERT_TRUE(settle());
    EXPECT_GT(server_.askedOf(View::sagittal).pictures, behind);
    EXPECT_EQ(server_.askedOf(View::sagittal).window, (WindowLevel{-600, 1600}));
}

// Counts what is painted, but for the status line: the link's time is another each second.
class PaintCount : public QObject {
public:
    PaintCount() { qApp->installEventFilter(this); }
    int count = 0;
    std::set<std::string> painted;

private:
    bool eventFilter(QObject* object, QEvent* event) override {
        auto* widget = qobject_cast<QWidget*>(object);
        if (event->type() != QEvent::Paint || !widget) return false;
        for (const QWidget* up = widget; up; up = up->parentWidget())
            if (up->inherits("QStatusBar")) return false;
        painted.insert(widget->metaObject()->className() +
                       (" " + widget->objectName()).toStdString());
        ++count;
        return false;
    }
};

TEST_F(ClientWindow, NothingIsPaintedWhereNothingHasChanged) {
    press(Qt::Key_G);
    window_->activateWindow();
    pane(View::endoscopic).setFocus();
    ASSERT_TRUE(settle());
    std::set<std::string> last;
    EXPECT_TRUE(waitFor([&] {
        PaintCount paints;
        QTest::qWait(1000);
        last = paints.painted;
        return paints.count == 0;
    })) << ::testing::PrintToString(last);
    // Where something has, only what shows it.
    PaintCount paints;
    moveTo(pane(View::axial), {50, 50});
    slices().setWindow({40, 400});
    ASSERT_TRUE(settle());
    EXPECT_GT(paints.count, 0);
    EXPECT_FALSE(paints.painted.contains("haustra::window::StripPane "));
}

// ---- layouts ------------------------------------------------------------------------------------

class ClientWindowLayouts : public ClientWindow {
protected:
    using Geometry = std::map<std::string, std::pair<bool, std::array<int, 4>>>;
    Geometry geometry() {
        Geometry all;
        for (const char* name : {"endoscopic", "axial", "coronal", "sagittal", "strip", "zoom",
                                 "overview", "oblique", "bookmarks", "optics"}) {
            const QDockWidget& d = *dock(name);
            const QRect r = d.isVisible() ? d.geometry() : QRect();
            all[name] = {d.isVisible(), {r.x(), r.y(), r.width(), r.height()}};
        }
        return all;
    }
};

TEST_F(ClientWindowLayouts, EachIsTheSameWhereverOneComesFrom) {
    std::map<int, Geometry> first;
    for (const int key : {Qt::Key_1, Qt::Key_2, Qt::Key_3, Qt::Key_4, Qt::Key_2, Qt::Key_1,
                          Qt::Key_4, Qt::Key_3, Qt::Key_1}) {
        SCOPED_TRACE(key - Qt::Key_0);
        window_->activateWindow();
        press(key, Qt::ControlModifier);
        ASSERT_TRUE(laidOut());
        for (const auto& [view, shown] : panes_)
            if (shown->isVisible()) {
                EXPECT_GT(shown->width(), 100) << int(view);
                EXPECT_GT(shown->height(), 80) << int(view);
                EXPECT_EQ(reader().panes().size(view), glm::ivec2(shown->width(), shown->height()));
            }
        const auto [kept, isNew] = first.emplace(key, geometry());
        if (!isNew) {
            EXPECT_EQ(kept->second, geometry());
        }
    }
}

TEST_F(ClientWindowLayouts, EnlargedAndBackIsAsItWas) {
    for (const int layout : {Qt::Key_1, Qt::Key_3}) {
        press(layout, Qt::ControlModifier);
        ASSERT_TRUE(laidOut());
        const Geometry before = geometry();
        for (const View view : {View::axial, View::endoscopic, View::flattenedZoom}) {
            SCOPED_TRACE(int(view));
            moveTo(pane(view), pane(view).rect().center());
            press(Qt::Key_Return);
            ASSERT_TRUE(laidOut());
            EXPECT_EQ(docksInSight().size(), 1u);
            EXPECT_GT(pane(view).width(), 1300);
            press(Qt::Key_Return);
            ASSERT_TRUE(laidOut());
            EXPECT_EQ(geometry(), before);
        }
    }
}

TEST_F(ClientWindowLayouts, OneIsSavedByNameAndRestored) {
    const auto choose = [&](const QStringList& path) {
        QMenu* menu = nullptr;
        for (QMenu* any : window_->findChildren<QMenu*>())
            if (any->title() == QStringLiteral("Saved layouts")) menu = any;
        emit menu->aboutToShow();
        for (const QString& name : path) {
            QAction* found = nullptr;
            for (QAction* entry : menu->actions())
                if (entry->text() == name) found = entry;
            ASSERT_TRUE(found) << name.toStdString();
            found->menu() ? void(menu = found->menu()) : found->trigger();
        }
    };
    const Geometry atFirst = geometry();
    press(Qt::Key_3, Qt::ControlModifier);
    dock("axial")->close();
    window_->resizeDocks({dock("strip")}, {500}, Qt::Horizontal);
    ASSERT_TRUE(laidOut());
    const Geometry mine = geometry();
    EXPECT_FALSE(mine.at("axial").first);
    const auto named = whenOpens<QDialog>([](QDialog&) {
        type(QStringLiteral("mine / two"));
        press(Qt::Key_Return);
    });
    action("layout-save")->trigger();
    ASSERT_TRUE(*named);
    activate();
    press(Qt::Key_1, Qt::ControlModifier);
    ASSERT_TRUE(laidOut());
    EXPECT_NE(geometry(), mine);
    choose({QStringLiteral("mine / two")});
    ASSERT_TRUE(laidOut());
    EXPECT_EQ(geometry(), mine);
    choose({QStringLiteral("Remove"), QStringLiteral("mine / two")});
    EXPECT_TRUE(Layouts::names().isEmpty());
    press(Qt::Key_1, Qt::ControlModifier);
    ASSERT_TRUE(laidOut());
    EXPECT_EQ(geometry(), atFirst);
}

// ---- cases --------------------------------------------------------------------------------------

class ClientWindowCases : public ClientWindow {
protected:
    static Misbehaviour two() {
        Misbehaviour misbehaviour;
        misbehaviour.anotherCase = true;
        return misbehaviour;
    }
    ClientWindowCases() : ClientWindow(two()) {}
    bool listed() {
        return waitFor([&] {
            QWidget* search = QApplication::focusWidget();
            return cases()->isVisible() && qobject_cast<QLineEdit*>(search) &&
                   cases()->findChild<QTableView*>()->model()->rowCount() == 2;
        });
    }
};

TEST_F(ClientWindowCases, OneIsFoundOpenedAndLeftForAnother) {
    press(Qt::Key_End);
    press(Qt::Key_3, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    const auto docks = docksInSight();
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(listed());
    EXPECT_TRUE(docksInSight().empty());
    auto& table = *cases()->findChild<QTableView*>();
    type(QStringLiteral("SEC"));
    ASSERT_EQ(table.model()->rowCount(), 1);
    EXPECT_EQ(table.model()->index(0, 0).data().toString(), QStringLiteral("second"));
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] {
        return reader().session().caseInfo()->name == "second" && !cases()->isVisible() &&
               settled();
    }));
    EXPECT_EQ(docksInSight(), docks);
    EXPECT_EQ(flight().arcMm(), 0.0);
    EXPECT_TRUE(notices(QStringLiteral("second")));
    press(Qt::Key_Z, Qt::ControlModifier);  // the jump was in the other case
    EXPECT_EQ(flight().arcMm(), 0.0);
    // Back by the mouse.
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return cases()->isVisible() && table.isVisible(); }));
    auto* search = cases()->findChild<QLineEdit*>();
    search->setFocus();
    search->selectAll();
    type(QStringLiteral("phan"));
    ASSERT_EQ(table.model()->rowCount(), 1);
    doubleClick(*table.viewport(), table.visualRect(table.model()->index(0, 0)).center());
    ASSERT_TRUE(waitFor([&] {
        return reader().session().caseInfo()->name == "phantom" && !cases()->isVisible() &&
               settled();
    }));
    EXPECT_EQ(docksInSight(), docks);
    // The list, and the same case again.
    press(Qt::Key_End);
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return cases()->isVisible() && table.isVisible(); }));
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    EXPECT_EQ(docksInSight(), docks);
    EXPECT_NEAR(flight().arcMm(), length(), 1e-9);
}

TEST_F(ClientWindowCases, WithoutACaseTheListIsThere) {
    TearDown();
    panes_.clear();
    start("");
    ASSERT_TRUE(listed());
    EXPECT_TRUE(docksInSight().empty());
    auto& table = *cases()->findChild<QTableView*>();
    press(Qt::Key_Space);  // no key does anything to a case that is not open
    EXPECT_EQ(reader().motion(), Motion::paused);
    cases()->findChild<QLineEdit*>()->clear();
    for (int n = 0; n < 10 && !table.hasFocus(); ++n)
        press(Qt::Key_Tab);
    ASSERT_TRUE(table.hasFocus());
    table.selectRow(0);
    press(Qt::Key_Return);
    EXPECT_TRUE(waitFor([&] { return reader().isOpen() && settled() && !cases()->isVisible(); }));
}

// ---- a link that goes, a server that refuses ----------------------------------------------------

TEST_F(ClientWindow, WhileTheLinkIsDownTheReaderStands) {
    flight().goTo(250.0);
    flight().look(20.0, 5.0);
    press(Qt::Key_3, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    press(Qt::Key_Space);
    ASSERT_TRUE(waitFor([&] { return flight().arcMm() > 252.0; }));
    server_.setDown(true);
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::lost; }));
    ASSERT_TRUE(waitFor([&] { return notices(QStringLiteral("The link is down")); }));
    const double arc = flight().arcMm();
    EXPECT_EQ(reader().motion(), Motion::paused);
    EXPECT_EQ(reader().freshness(View::endoscopic), Freshness::old);
    EXPECT_TRUE(pane(View::endoscopic).inWords().contains(QStringLiteral("old")));
    EXPECT_TRUE(waitFor([&] {
        return pane(View::endoscopic).accessibleDescription().contains(QStringLiteral("old"));
    }));
    press(Qt::Key_Space);
    press(Qt::Key_B);
    EXPECT_TRUE(waitFor([&] { return notices(QStringLiteral("1 bookmark")); }));
    EXPECT_TRUE(waitFor([&] { return reader().motion() == Motion::paused; }));
    EXPECT_EQ(flight().arcMm(), arc);
    const auto docks = docksInSight();
    server_.setDown(false);
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::open && settled(); }));
    EXPECT_TRUE(waitFor([&] { return !notices(QStringLiteral("The link is down")); }));
    EXPECT_EQ(flight().arcMm(), arc);
    EXPECT_NEAR(flight().yawDegrees(), 20.0, 1e-9);
    EXPECT_EQ(docksInSight(), docks);
    EXPECT_EQ(reader().freshness(View::endoscopic), Freshness::exact);
    EXPECT_TRUE(waitFor([&] { return server_.storedBookmarkKeys().size() == 1; }));
}

// A picture of another shape than its pane's keeps its own, and what is marked in it its place.
TEST_F(ClientWindow, AFormerPictureKeepsItsShapeAndItsPlaces) {
    flight().goTo(250.0);
    ASSERT_TRUE(settle());
    const glm::ivec2 before = reader().panes().size(View::axial);
    server_.setDown(true);
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::lost; }));
    dock("axial")->setFloating(true);
    dock("axial")->resize(900, 300);
    ASSERT_TRUE(laidOut());
    const Pane& axial = pane(View::axial);
    const QImage image = pane(View::axial).pictureWithMarks();
    ASSERT_GT(image.width(), 2 * image.height());
    const double high = axial.height(), wide = high * before.x / before.y;
    const double margin = 0.5 * (axial.width() - wide);
    const auto grey = [&](double x) {  // off the marks
        return qGray(image.pixel(int(x), int(0.3 * high)));
    };
    int beside = 0, inside = 0;
    for (double x = 20.0; x < margin - 20.0; x += 7.0)
        beside = std::max(beside, grey(x));
    for (double x = margin + 5.0; x < margin + wide - 5.0; x += 3.0)
        inside = std::max(inside, grey(x));
    EXPECT_LT(beside, 12);
    EXPECT_GT(inside, 12);
    // A click means what is seen there.
    const SlicePlacement placed = *placeSlice(
        slices().slice(View::axial), reader().session().caseInfo()->grid, before.x, before.y);
    const QPoint at(int(margin + 0.25 * wide), int(0.4 * high));
    const glm::dvec3 there = placed.patientFromPixel(
        (glm::dvec2(at.x(), at.y()) - glm::dvec2(margin, 0.0)) * (double(before.y) / high) - 0.5);
    click(axial, at);
    EXPECT_LT(glm::distance(slices().slice(View::axial).positionMm, there), 1e-6);
}

// Where panes are only moved, the server hears of none.
TEST_F(ClientWindow, AnotherLayoutAsksAnewForNoPaneThatIsAsLargeAsBefore) {
    press(Qt::Key_1, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    std::map<View, int> asked;
    for (const auto& [view, shown] : panes_)
        asked[view] = server_.askedOf(view).pictures;
    press(Qt::Key_1, Qt::ControlModifier);
    ASSERT_TRUE(settle());
    QTest::qWait(300);
    for (const auto& [view, shown] : panes_)
        EXPECT_EQ(server_.askedOf(view).pictures, asked[view]) << int(view);
}

class ClientWindowOfASlowServer : public ClientWindow {
protected:
    static Misbehaviour slow() {
        Misbehaviour misbehaviour;
        misbehaviour.anotherCase = true;
        misbehaviour.opensLate = "second";
        return misbehaviour;
    }
    ClientWindowOfASlowServer() : ClientWindow(slow()) {}
};

TEST_F(ClientWindowOfASlowServer, ACaseThatDoesNotOpenCanBeLeft) {
    press(Qt::Key_O, Qt::ControlModifier);
    auto& table = *cases()->findChild<QTableView*>();
    ASSERT_TRUE(waitFor([&] { return table.isVisible() && table.model()->rowCount() == 2; }));
    table.selectRow(1);
    table.setFocus();
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::connecting; }));
    QPushButton* back = nullptr;
    for (QPushButton* button : cases()->findChildren<QPushButton*>())
        if (button->text() == QStringLiteral("Back to the list of cases")) back = button;
    ASSERT_TRUE(back && waitFor([&] { return back->isVisible(); }));
    click(*back, back->rect().center());
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::choosing; }));
    ASSERT_TRUE(waitFor([&] { return table.isVisible(); }));
    EXPECT_FALSE(back->isVisible());
    table.selectRow(0);
    table.setFocus();
    press(Qt::Key_Return);
    // The server has not done with the other yet; then it is asked for this one.
    QTest::qWait(50);
    EXPECT_EQ(reader().session().phase(), Phase::connecting);
    reader().session().requestCases();
    EXPECT_TRUE(waitFor([&] {
        return reader().isOpen() && reader().session().caseInfo()->name == "phantom" &&
               reader().session().phase() == Phase::open && settled();
    }));
}

class ClientWindowOfALiar : public ClientWindow {
protected:
    ClientWindowOfALiar() : ClientWindow(liar()) {}
    static inline std::atomic<bool> lies = false;

private:
    static Misbehaviour liar() {
        Misbehaviour misbehaviour;
        misbehaviour.alters = [](protocol::ServerMessage& message) {
            if (lies && message.has_case_list())
                message.mutable_case_list()->set_request(1'000'000);
        };
        return misbehaviour;
    }
};

TEST_F(ClientWindowOfALiar, AfterASessionThatEndedForGoodAnotherBeginsAtTheSamePlace) {
    flight().goTo(250.0);
    press(Qt::Key_3, Qt::ControlModifier);
    press(Qt::Key_Z);
    // A second reader who has done the first reading.
    press(Qt::Key_F, Qt::ControlModifier);
    press(Qt::Key_F, Qt::ControlModifier | Qt::ShiftModifier);
    ASSERT_TRUE(waitFor([&] { return reader().findings().shown().size() == 2; }));
    ASSERT_TRUE(settle());
    EXPECT_FALSE(action("connect-again")->isEnabled());
    lies = true;
    reader().session().requestCases();
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::failed; }));
    ASSERT_TRUE(waitFor([&] { return notices(QStringLiteral("The session has ended")); }));
    EXPECT_EQ(reader().freshness(View::endoscopic), Freshness::old);
    lies = false;
    const auto docks = docksInSight();
    ASSERT_TRUE(waitFor([&] { return action("connect-again")->isEnabled(); }));
    press(Qt::Key_R, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::open; }));
    ASSERT_TRUE(settle());
    EXPECT_EQ(flight().arcMm(), 250.0);
    EXPECT_EQ(docksInSight(), docks);
    EXPECT_TRUE(reader().findings().choice().firstPassDone);
    EXPECT_TRUE(waitFor([&] { return reader().findings().shown().size() == 2; }));
    EXPECT_FALSE(notices(QStringLiteral("The session has ended")));
    EXPECT_EQ(reader().freshness(View::endoscopic), Freshness::exact);
    // From the list as well.
    lies = true;
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::failed; }));
    lies = false;
    QPushButton* again = nullptr;
    for (QPushButton* button : cases()->findChildren<QPushButton*>())
        if (button->text() == QStringLiteral("Connect again")) again = button;
    ASSERT_TRUE(again && waitFor([&] { return again->isVisible(); }));
    click(*again, again->rect().center());
    ASSERT_TRUE(waitFor([&] { return reader().session().phase() == Phase::open; }));
    EXPECT_TRUE(waitFor([&] { return !cases()->isVisible(); }));
    EXPECT_TRUE(settle());
    EXPECT_EQ(flight().arcMm(), 250.0);
}

class ClientWindowOfAFullDisk : public ClientWindow {
protected:
    static Misbehaviour full() {
        Misbehaviour misbehaviour;
        misbehaviour.refuseBookmarks = 2;
        return misbehaviour;
    }
    ClientWindowOfAFullDisk() : ClientWindow(full()) {}
    QTreeWidgetItem* row(int n) { return bookmarkList().topLevelItem(n); }
    bool shows(int n, const QString& state) {
        return waitFor([&] { return row(n) && row(n)->text(2) == state; });
    }
    void menuOf(int n, const QString& entry) {
        const auto menu = chooseInMenu(entry);
        click(*bookmarkList().viewport(), bookmarkList().visualItemRect(row(n)).center(),
              Qt::RightButton);
        // A context menu of a list follows its own event.
        QContextMenuEvent asked(QContextMenuEvent::Mouse,
                                bookmarkList().visualItemRect(row(n)).center());
        if (!*menu) QCoreApplication::sendEvent(bookmarkList().viewport(), &asked);
        EXPECT_TRUE(*menu);
    }
};

TEST_F(ClientWindowOfAFullDisk, ARefusedBookmarkStaysInTheListUntilItIsDealtWith) {
    flight().goTo(100.0);
    press(Qt::Key_B);
    flight().goTo(200.0);
    press(Qt::Key_B, Qt::ShiftModifier);
    type(QStringLiteral("x"));
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] { return bookmarkList().topLevelItemCount() == 2; }));
    ASSERT_TRUE(shows(0, QStringLiteral("refused")));
    ASSERT_TRUE(shows(1, QStringLiteral("refused")));
    EXPECT_TRUE(notices(QStringLiteral("not saved")));
    EXPECT_TRUE(row(0)->toolTip(1).contains(QStringLiteral("full")));
    // Again: the note it had is offered.
    const auto dialog = std::make_shared<QString>(QStringLiteral("?"));
    whenOpens<QDialog>([dialog](QDialog& asked) {
        *dialog = asked.findChild<QLineEdit*>()->text();
        type(QStringLiteral("better"));
        press(Qt::Key_Return);
    });
    menuOf(0, QStringLiteral("Send again…"));
    EXPECT_EQ(*dialog, QString());  // it has no note
    activate();
    // The other's note is in the field again, with the reason; a new one leaves it in the list.
    EXPECT_EQ(note().text(), QStringLiteral("x"));
    EXPECT_TRUE(notices(QStringLiteral("Enter sends it again")));
    EXPECT_TRUE(note().accessibleDescription().contains(QStringLiteral("Enter sends it again")));
    note().setFocus();
    press(Qt::Key_A, Qt::ControlModifier);
    press(Qt::Key_Backspace);
    EXPECT_FALSE(notices(QStringLiteral("Enter sends it again")));
    press(Qt::Key_Z, Qt::ControlModifier);  // as a note of this place it must not come back
    EXPECT_EQ(note().text(), QString());
    ASSERT_TRUE(waitFor([&] { return server_.storedBookmarkKeys().size() == 1; }));
    ASSERT_TRUE(waitFor([&] { return row(0)->text(1) == QStringLiteral("better"); }));
    EXPECT_NE(row(0)->text(2), QStringLiteral("refused"));
    menuOf(1, QStringLiteral("Discard"));
    EXPECT_TRUE(waitFor([&] { return bookmarkList().topLevelItemCount() == 1; }));
    EXPECT_TRUE(reader().session().refusedBookmarks().empty());
}

TEST_F(ClientWindowOfAFullDisk, ARefusedNoteIsInItsFieldUntilItIsSaved) {
    flight().goTo(200.0);
    press(Qt::Key_B, Qt::ShiftModifier);
    type(QStringLiteral("polyp"));
    press(Qt::Key_Return);
    const auto offered = [&] {
        return note().text() == QStringLiteral("polyp") &&
               notices(QStringLiteral("Enter sends it again"));
    };
    ASSERT_TRUE(waitFor(offered));
    // From another place it is sent of its own; refused again, it is there again.
    flight().goTo(100.0);
    note().setFocus();
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] { return server_.bookmarkMessages() == 2; }));
    ASSERT_TRUE(waitFor(offered));
    note().setFocus();
    press(Qt::Key_End);
    type(QStringLiteral("s"));
    press(Qt::Key_Return);
    ASSERT_TRUE(waitFor([&] { return server_.storedBookmarkKeys().size() == 1; }));
    ASSERT_TRUE(waitFor([&] { return row(0)->text(1) == QStringLiteral("polyps"); }));
    EXPECT_EQ(row(0)->text(0), QStringLiteral("200"));
    EXPECT_EQ(note().text(), QString());
    EXPECT_EQ(bookmarkList().topLevelItemCount(), 1);
    EXPECT_TRUE(reader().session().refusedBookmarks().empty());
}

// ---- for whoever does not see it ----------------------------------------------------------------

class ClientWindowAccessibility : public ClientWindow {
protected:
    // A part of another control, which speaks for it.
    static bool isPart(const QWidget& widget) {
        const QWidget* parent = widget.parentWidget();
        return qobject_cast<const QAbstractSpinBox*>(parent) ||
               qobject_cast<const QComboBox*>(parent) || widget.inherits("QHeaderView") ||
               widget.inherits("QScrollBar") || widget.inherits("QComboBoxPrivateContainer");
    }
    static bool isControl(const QWidget& widget) {
        return widget.focusPolicy() != Qt::NoFocus ||
               qobject_cast<const QAbstractButton*>(&widget) ||
               qobject_cast<const QAbstractSlider*>(&widget) ||
               qobject_cast<const QAbstractSpinBox*>(&widget) ||
               qobject_cast<const QComboBox*>(&widget) || qobject_cast<const QLineEdit*>(&widget) ||
               qobject_cast<const QAbstractItemView*>(&widget);
    }
    static std::string nameOf(const QWidget& widget) {
        return widget.metaObject()->className() + (" \"" + widget.objectName()).toStdString() +
               "\" in " +
               (widget.parentWidget() ? widget.parentWidget()->metaObject()->className()
                                      : "nothing");
    }
    int expectNamed(const QWidget& root) {
        int controls = 0;
        QList<QWidget*> all = root.findChildren<QWidget*>();
        if (root.isWindow()) all << const_cast<QWidget*>(&root);
        for (QWidget* widget : all) {
            if (!widget->isVisibleTo(&root) || isPart(*widget)) continue;
            if (widget != &root && !isControl(*widget)) continue;
            ++controls;
            QAccessibleInterface* spoken = QAccessible::queryAccessibleInterface(widget);
            EXPECT_TRUE(spoken) << nameOf(*widget);
            if (!spoken) continue;
            EXPECT_FALSE(spoken->text(QAccessible::Name).isEmpty()) << nameOf(*widget);
            EXPECT_NE(spoken->role(), QAccessible::Client) << nameOf(*widget);
            EXPECT_NE(spoken->role(), QAccessible::NoRole) << nameOf(*widget);
        }
        return controls;
    }
    // By Tab alone.
    void expectReached(QWidget& root) {
        root.window()->activateWindow();
        ASSERT_TRUE(waitFor([&] { return QApplication::activeWindow() == root.window(); }));
        std::set<QWidget*> reached;
        for (int n = 0; n < 200; ++n) {
            press(Qt::Key_Tab);
            QWidget* now = QApplication::focusWidget();
            if (!now) break;
            reached.insert(now);
        }
        for (QWidget* widget : root.findChildren<QWidget*>()) {
            if (widget->window() != root.window() || !widget->isVisible() || !widget->isEnabled() ||
                isPart(*widget) || widget->focusProxy())
                continue;
            if ((widget->focusPolicy() & Qt::TabFocus) != Qt::TabFocus) continue;
            EXPECT_TRUE(reached.contains(widget)) << nameOf(*widget);
        }
    }
};

TEST_F(ClientWindowAccessibility, EveryControlHasANameARoleAndATabStop) {
    press(Qt::Key_B);
    press(Qt::Key_G);
    ASSERT_TRUE(settle());
    EXPECT_GT(expectNamed(*window_), 30);
    EXPECT_GT(expectNamed(*dock("optics")), 12);
    expectReached(*window_);
    expectReached(*dock("optics"));
    window_->activateWindow();
    for (const auto& [view, shown] : panes_) {
        QAccessibleInterface* spoken = QAccessible::queryAccessibleInterface(shown);
        EXPECT_EQ(spoken->role(), QAccessible::Graphic) << int(view);
        EXPECT_EQ(spoken->text(QAccessible::Name), shown->title());
        EXPECT_EQ(spoken->text(QAccessible::Description), shown->inWords()) << int(view);
        EXPECT_FALSE(shown->inWords().isEmpty());
    }
    press(Qt::Key_O, Qt::ControlModifier);
    ASSERT_TRUE(waitFor([&] { return cases()->findChild<QTableView*>()->isVisible(); }));
    EXPECT_GT(expectNamed(*cases()), 2);
    expectReached(*cases());
}

TEST_F(ClientWindowAccessibility, SoHasEveryControlOfADialog) {
    for (const char* id : {"help", "change-keys"}) {
        SCOPED_TRACE(id);
        window_->activateWindow();
        action(id)->trigger();
        ASSERT_TRUE(waitFor([&] {
            return QApplication::activeWindow() && QApplication::activeWindow() != window_.get();
        }));
        EXPECT_GT(expectNamed(*QApplication::activeWindow()), 1);
        expectReached(*QApplication::activeWindow());
        QPointer<QWidget> dialog = QApplication::activeWindow();
        press(Qt::Key_Escape);
        EXPECT_TRUE(waitFor([&] { return !dialog; }));
    }
    for (const char* id : {"about", "go-to-arc", "layout-save", "save-picture"}) {
        SCOPED_TRACE(id);
        window_->activateWindow();
        const auto seen = whenOpens<QDialog>([&](QDialog& dialog) {
            if (std::string(id) != "save-picture") expectNamed(dialog);  // Qt's own
            press(Qt::Key_Escape);
        });
        action(id)->trigger();
        EXPECT_TRUE(*seen);
    }
}

}  // namespace
}  // namespace haustra::window
