#include "window/language.h"

#include <QApplication>
#include <QLibraryInfo>
#include <QLocale>
#include <QTranslator>

// Of the resources of a library that the program links as an archive: outside any namespace.
static void initTranslations() {
    Q_INIT_RESOURCE(translations);
}

namespace haustra::window {

QStringList languages() {
    return {QString(), QStringLiteral("en"), QStringLiteral("de")};
}

QString nameOfLanguage(const QString& language) {
    if (language.isEmpty()) return QCoreApplication::translate("Language", "As the system");
    return language == QStringLiteral("de") ? QStringLiteral("Deutsch") : QStringLiteral("English");
}

void useLanguage(QApplication& application, const QString& language) {
    initTranslations();
    QLocale locale = language.isEmpty() ? QLocale::system() : QLocale(language);
    locale.setNumberOptions(QLocale::OmitGroupSeparator);
    QLocale::setDefault(locale);
    // English is the source's; its file has the plurals alone.
    const QString ours =
        languages().contains(locale.name().left(2)) ? locale.name().left(2) : QStringLiteral("en");
    auto* window = new QTranslator(&application);
    if (window->load(QStringLiteral(":/translations/haustra_") + ours))
        application.installTranslator(window);
    // Qt's own dialogs, where the system has their translations.
    auto* dialogs = new QTranslator(&application);
    if (dialogs->load(locale, QStringLiteral("qtbase"), QStringLiteral("_"),
                      QLibraryInfo::path(QLibraryInfo::TranslationsPath)))
        application.installTranslator(dialogs);
}

}  // namespace haustra::window
