#include "window/run.h"

#include "window/language.h"
#include "window/reader_window.h"
#include "window/theme.h"

#include <QApplication>
#include <QSaveFile>
#include <QScreen>
#include <QSettings>
#include <cstdlib>

namespace haustra::window {
namespace {

// Qt ends the program where it finds no display.
bool hasDisplay() {
    const auto set = [](const char* name) {
        const char* value = std::getenv(name);
        return value && *value;
    };
    return set("DISPLAY") || set("QT_QPA_PLATFORM");
}

QString settingOr(const std::string& given, const char* setting, const char* otherwise) {
    return given.empty() ? QSettings().value(setting, otherwise).toString() : text(given);
}

Result<void> writeScreenshot(QWidget& window, const std::filesystem::path& file) {
    const QImage image = window.grab().toImage();
    QSaveFile out(QString::fromStdString(file.string()));
    if (!out.open(QIODevice::WriteOnly) || !image.save(&out, "png") || !out.commit())
        return fail(ErrorKind::io, "cannot write the PNG file: " + out.errorString().toStdString(),
                    file.string());
    return {};
}

}  // namespace

Result<void> run(const WindowOptions& options) {
    if (!hasDisplay())
        return fail(ErrorKind::device, "there is no display to open a window on", "DISPLAY");
    // Qt looks for a GL driver at its start, though nothing here draws by it.
    qputenv("QT_XCB_GL_INTEGRATION", "none");
    if (options.scale) qputenv("QT_SCALE_FACTOR", QByteArray::number(*options.scale));
    QCoreApplication::setOrganizationName(QStringLiteral("haustra"));
    QCoreApplication::setApplicationName(QStringLiteral("haustra-client"));
    QCoreApplication::setApplicationVersion(text(options.connection.software));
    QGuiApplication::setApplicationDisplayName(QStringLiteral("Haustra"));
    int count = 1;
    char name[] = "haustra-client";
    char* arguments[] = {name, nullptr};
    QApplication application(count, arguments);
    QApplication::setQuitOnLastWindowClosed(false);
    useLanguage(application, settingOr(options.language, "appearance/language", ""));
    applyTheme(application, settingOr(options.theme, "appearance/theme", "dark"));

    Reading reading(options.connection, options.caseName, options.journal);
    // A picture to be taken of a case that is not there is a failure.
    reading.reader().session().setOffersCases(!options.screenshot);
    ReaderWindow window(reading);
    if (options.width > 0)
        window.resize(options.width, options.height);
    else if (!QSettings().contains("window/geometry"))
        window.resize(window.screen()->availableGeometry().size() * 0.9);
    window.show();

    Result<void> ended;
    QTimer due;
    if (options.screenshot) {
        // When the time has come; where pictures are still on their way, up to 20 s later.
        QElapsedTimer since;
        since.start();
        QObject::connect(&due, &QTimer::timeout, &window, [&, since] {
            const auto elapsed = since.elapsed();
            if (elapsed < options.screenshotAfterMs ||
                (!window.isSettled() && elapsed < options.screenshotAfterMs + 20'000))
                return;
            due.stop();
            ended = writeScreenshot(window, *options.screenshot);
            QApplication::exit();  // what is set by hand stays: the window is not closed
        });
        due.start(50);
    }
    application.exec();
    const reader::Session& session = reading.reader().session();
    if (!ended) return ended;
    if ((options.screenshot || !reading.reader().isOpen()) &&
        session.phase() == reader::Phase::failed)
        return tl::make_unexpected(session.failure());
    return {};
}

}  // namespace haustra::window
