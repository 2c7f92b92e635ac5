#include "window/told_sentences.h"

#include <QCoreApplication>
#include <QLocale>
#include <QRegularExpression>
#include <optional>
#include <vector>

namespace haustra::window {
namespace {

// No program joins more; whoever does wants to keep the window busy.
constexpr qsizetype mostJoined = 4;

// As the folders below processing/, and server/cli, tell them (told_sentences_test holds them to
// that).
constexpr const char* sentences[] = {
    // Of findings: cad/detect.cpp, cad/wall_edges.cpp, pipeline/cad_stage.cpp.
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 mm2 of the wall were not examined: they enclose a bridge over a "
                      "collapse, or were rebuilt after a leak"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "%1 mm2 of the wall were not examined: they lie behind fluid without tagging or beside "
        "what stands in the lumen, where the wall's place is known to millimetres only"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the wall is %1 mm thick all around from %2 to %3 mm: it may be a cancer "
                      "that leaves a channel, or a segment that is contracted"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the wall is %1 mm thick all around from %2 to %3 mm: it may be a segment "
                      "that is inflamed or contracted, or a long tumour"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the wall is %1 mm thick all around from %2 to %3 mm, but the lumen is %4 mm wide: other "
        "bowel may lie around it, or it is inflamed"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "on %1 mm of the colon, from %2 mm on, nothing is told of how thick the wall is: %3 HU at "
        "most behind it are fluid's, around the colon or in a wall that is swollen"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the wall, or what lies between it and other loops, is thick all around at "
        "%1 mm: other bowel may lie on it without fat between, or a cancer narrow it"),
    QT_TRANSLATE_NOOP("ToldSentences", "polyps may be missed: %1"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "findings %1, from %2 mm on, lie rim to rim, %3 mm wide in all: they may be "
                      "lobes of one mass"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 place that looks like a polyp was taken for tagged residue on the wall: "
                      "%2 mm from the rectum"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 places that look like polyps were taken for tagged residue on the wall: "
                      "%2 mm from the rectum"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the tissue behind the wall is less even than where detection has learnt, %1 "
                      "HU or more after smoothing to 1 mm: by noise, by contrast in its vessels, "
                      "or by residue of weak tagging"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "more than %1 places may be polyps; the least probable are left out"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 places are told, more than a colon commonly has polyps: lumps of residue "
                      "without tagging look alike, and most may be such"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the colon was not flattened: the wall's texture was measured along other directions than "
        "detection has learnt from, and wall that is thick all around was not looked for"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the scan's kernel enhances edges, or the wall's surface is enhanced, as it "
                      "is brighter behind gas than its tissue: detection has learnt from few like "
                      "it, and may miss polyps of any size"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the scan's kernel enhances edges, or the wall's surface is enhanced, as it "
                      "is brighter behind gas than its tissue: detection has learnt from few like "
                      "it, and may miss polyps of any size, though it took off what it could"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the scan's kernel enhances edges, or the wall's surface is enhanced, as it is brighter "
        "behind gas than its tissue: detection has learnt from few like it, and may miss polyps of "
        "any size, though what was added to edges was taken off before"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the scan is more blurred than what detection has learnt from: polyps may be "
                      "missed, and residue be told as polyps"),
    // Of the scan: core/scan_coarseness.cpp, core/slice_steps.cpp, store/case_trust.cpp,
    // segmentation/.
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the scan has samples up to %1 mm apart (CT colonography needs %2 at most): "
                      "small and flat polyps may not show in it"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the scan has samples up to %1 mm apart (CT colonography needs %2 at most): "
                      "polyps may not show in it, large ones among them"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the scan has slices %1 mm thick (%2 at most): small and flat polyps may not show in it"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the scan has slices %1 mm thick (%2 at most): polyps may not show in it, "
                      "large ones among them"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the scan has samples up to %1 mm apart (CT colonography needs %2 at most) and slices %3 "
        "mm thick (%4 at most): small and flat polyps may not show in it"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the scan has samples up to %1 mm apart (CT colonography needs %2 at most) and slices %3 "
        "mm thick (%4 at most): polyps may not show in it, large ones among them"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the slices at %1 and %2 mm differ %3 times as much as those around: the "
                      "patient breathed or moved between them, or slices do not belong there"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the slices at %1 and %2 mm differ %3 times as much as those around, and %4 "
                      "more pair by %5 times and more: the patient breathed or moved between them, "
                      "or slices do not belong there"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the slices at %1 and %2 mm differ %3 times as much as those around, and %4 "
                      "more pairs by %5 times and more: the patient breathed or moved between "
                      "them, or slices do not belong there"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 slice is the same as the one before, the first at %2 mm"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 slices are the same as the one before, the first at %2 mm"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the record of the scan's series is damaged, so that nobody knows how thick "
                      "its slices are"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml are brighter than bone, as metal and thick barium are: at the height "
                      "of their streaks walls and fluid may be wrong or missing, at %2"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "the kernel is sharp: the wall beside gas is up to %1 HU bright, as tagged material is; "
        "thin residue on it is not seen, and detection may miss polyps, the more the sharper"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the air-fluid levels show that the patient lay %1, not %2 as the series "
                      "says; the levels are believed"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "patient position unknown, and no air-fluid level shows it: supine is assumed"),
    // Of the colon: segmentation/, core/colon_record.cpp, pipeline/.
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "%1 ml of air in the body are open to the room's, as through a stoma, and were taken for "
        "it: if they are bowel's, set up a wall (--cut X,Y,Z,R) between the skin and %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "an opening of %1 mm2 was kept, as without it the colon is parted: a polyp "
                      "or a fold may stand in the way, or two loops touch, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "about %1 mm of the colon have no centerline, up to the %2 at %3"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 % of the wall lies in blind pouches, which the strip shows as dots: the "
                      "largest, of %2 mm², begins at %3 mm of the centerline. Look at it from "
                      "within; the course may pass by a part of the colon"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "areas are not weighted, as the strip would fold, or has a large blind "
                      "pouch: it is the conformal one"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "no course of a colon was found in the mask; it is taken as it is"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 % of the mask are as bright as soft tissue in the scan: it may be "
                      "another scan's, or hold stool or fluid without tagging"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the scan ends within the %1, which it cuts open over %2 mm2; what lies "
                      "beyond is not in it, at %3"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the %1 is collapsed over %2 mm, or a mass closes it, at %3"),
    QT_TRANSLATE_NOOP("ToldSentences", "the %1 is collapsed, or a mass closes it, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "what looks like a thin wall in the %1 was taken for open lumen, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences", "the way on from the %1 is not sure (%2 %), at %3"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml at the wall of the %2 are as bright as metal, as of a stent, or thick "
                      "barium: what lies there is not seen, at %3"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of %2 nearest to the %3 lie open to the colon and were taken for "
                      "small bowel, at %4"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of %2 nearest to the %3, as wide as colon and where it may lie, were "
                      "taken for other than colon, at %4"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of %2 nearest to the %3 were taken for other than colon, at %4"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of gas away from the course were taken for the stomach's, other "
                      "bowel's or free, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml in the %2 are as bright as tagged material, which shows no level in "
                      "this scan; they may be bone, at %3"),
    QT_TRANSLATE_NOOP("ToldSentences", "a wall of %1 mm2 between two loops was rebuilt, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "a wall of %1 mm2 was set up, beyond which gas and fluid were taken for "
                      "other bowel; they may be the colon's, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of fluid of little or no tagging were taken out of the %2; its wall "
                      "shows little contrast and may lie elsewhere by millimetres"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of what was taken for tagged residue look like tissue once cleansed, "
                      "and are no part of the lumen, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of gas stand in the lumen of the %2 behind a wall of their own, as in "
                      "a catheter's balloon; both were taken out, at %3"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml behind what looks like a thin wall, as of a catheter's balloon, were "
                      "taken for the rectum's end, at %2"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "%1 ml of gas lie below where the rectum begins: its end may be missing, as where "
        "a catheter's balloon fills it, at %2"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "fluid without tagging (%1 HU) stands under the gas in the %2, its surface "
                      "%3 mm2; what lies in it and beneath is not seen, at %4"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "fluid of too little tagging (%1 HU) stands under the gas in the %2, its "
                      "surface %3 mm2; what lies in it and beneath is not seen, at %4"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "the tagging is weak: what stands under the gas has %1 HU in the median, "
                      "where 300 to 900 are best; residue may hide polyps, and be taken for them"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "another course is nearly as likely (%1 %): it adds %2 ml and drops %3 ml, at %4"),
    QT_TRANSLATE_NOOP("ToldSentences", "the course is right with no more than %1 %; gravest: %2"),
    QT_TRANSLATE_NOOP("ToldSentences", "the rectum was not found: the colon begins in the %1"),
    QT_TRANSLATE_NOOP("ToldSentences", "the cecum was not found: the colon ends in the %1"),
    QT_TRANSLATE_NOOP("ToldSentences", "%1 ml that nothing joins to the lumen were left out"),
    // What weighs most against its course: segmentation/course_doubts.cpp.
    QT_TRANSLATE_NOOP("ToldSentences",
                      "two loops may only touch where %1 mm were crossed from the %2 on"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "a loop may lie in the %1 mm that were crossed from the %2 on"),
    QT_TRANSLATE_NOOP("ToldSentences", "what was taken for open in the %1 may be a wall"),
    QT_TRANSLATE_NOOP("ToldSentences", "no more than %1 mm of %2 in all were found"),
    QT_TRANSLATE_NOOP("ToldSentences", "no more than %1 mm of %2 were found"),
    QT_TRANSLATE_NOOP("ToldSentences", "the rectum was not found"),
    QT_TRANSLATE_NOOP("ToldSentences", "the cecum was not found"),
    QT_TRANSLATE_NOOP("ToldSentences", "the course may end before the cecum"),
    QT_TRANSLATE_NOOP("ToldSentences", "the %1 goes on beyond the edge of the scan"),
    QT_TRANSLATE_NOOP("ToldSentences", "%1 % of the mask lie in soft tissue"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "%1 ml of the colon are joined to nothing, and were left out"),
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "%1 ml of %2 as wide as colon, and where it may lie, were left out near the %3"),
    QT_TRANSLATE_NOOP("ToldSentences", "%1 ml of gas near the %2 may be colon"),
    QT_TRANSLATE_NOOP("ToldSentences", "%1 ml of fluid that lie open to the %2 may be colon"),
    QT_TRANSLATE_NOOP("ToldSentences",
                      "a wall of %1 mm2 that was set up is wider than bowel that touches"),
    QT_TRANSLATE_NOOP("ToldSentences", "a rebuilt wall of %1 mm2 may be none"),
    QT_TRANSLATE_NOOP("ToldSentences", "%1 ml of untagged fluid may be other than lumen"),
    QT_TRANSLATE_NOOP("ToldSentences", "untagged fluid in the %1 may hide lumen"),
    // What a model has learnt from: cad/models, and cad train and calibrate.
    QT_TRANSLATE_NOOP(
        "ToldSentences",
        "%1 small and %2 full-size phantoms made by haustra phantom, and calibrated on %3 small "
        "and %4 full-size others, no patient: how probable a place is to be a polyp holds for "
        "phantoms, and is no more than an ordering for patients"),
    QT_TRANSLATE_NOOP("ToldSentences", "calibrated on %1 other case"),
    QT_TRANSLATE_NOOP("ToldSentences", "calibrated on %1 other cases"),
    QT_TRANSLATE_NOOP("ToldSentences", "cases that somebody chose"),
};

// What stands in a sentence in place of a number: toString of core/colon_record.h and core/grid.h.
constexpr const char* words[] = {
    QT_TRANSLATE_NOOP("ToldSentences", "rectum"),
    QT_TRANSLATE_NOOP("ToldSentences", "sigmoid"),
    QT_TRANSLATE_NOOP("ToldSentences", "descending colon"),
    QT_TRANSLATE_NOOP("ToldSentences", "splenic flexure"),
    QT_TRANSLATE_NOOP("ToldSentences", "transverse colon"),
    QT_TRANSLATE_NOOP("ToldSentences", "hepatic flexure"),
    QT_TRANSLATE_NOOP("ToldSentences", "ascending colon"),
    QT_TRANSLATE_NOOP("ToldSentences", "cecum"),
    QT_TRANSLATE_NOOP("ToldSentences", "fluid without tagging"),
    QT_TRANSLATE_NOOP("ToldSentences", "tagged material"),
    QT_TRANSLATE_NOOP("ToldSentences", "gas"),
    QT_TRANSLATE_NOOP("ToldSentences", "fluid"),
    QT_TRANSLATE_NOOP("ToldSentences", "supine"),
    QT_TRANSLATE_NOOP("ToldSentences", "prone"),
    QT_TRANSLATE_NOOP("ToldSentences", "on the left side"),
    QT_TRANSLATE_NOOP("ToldSentences", "on the right side"),
    QT_TRANSLATE_NOOP("ToldSentences", "left-decubitus"),
    QT_TRANSLATE_NOOP("ToldSentences", "right-decubitus"),
};

/// Numbers, "1, 2 and 3"; places, "(12, -40, 118) mm and elsewhere"; words.
QString patternOfArgument() {
    const QString place = QStringLiteral("\\(-?\\d+, -?\\d+, -?\\d+\\) mm");
    QStringList ways{
        QStringLiteral("-?\\d[\\d.]*(?:(?:, | and )\\d[\\d.]*)*"),
        place + QStringLiteral("(?:, ") + place + QStringLiteral(")*(?: and elsewhere)?")};
    for (const char* word : words)
        ways += QRegularExpression::escape(QString::fromLatin1(word));
    return ways.join(u'|');
}

/// A sentence as told, with a group for each thing that varies; what it ends with may be another
/// sentence.
QRegularExpression patternOf(const char* sentence) {
    static const QRegularExpression placeholder(QStringLiteral("%\\d"));
    static const QString argument = patternOfArgument();
    const QString text = QString::fromUtf8(sentence);
    QString pattern;
    qsizetype from = 0;
    for (auto found = placeholder.globalMatch(text); found.hasNext();) {
        const auto at = found.next();
        pattern += QRegularExpression::escape(text.sliced(from, at.capturedStart() - from));
        from = at.capturedEnd();
        pattern +=
            u'(' + argument + (from == text.size() ? QStringLiteral("|.+)") : QStringLiteral(")"));
    }
    pattern += QRegularExpression::escape(text.sliced(from));
    return QRegularExpression(QRegularExpression::anchoredPattern(pattern));
}

QString translatedArgument(QString argument) {
    for (const char* word : words)
        if (argument == QLatin1String(word))
            return QCoreApplication::translate("ToldSentences", word);
    static const QRegularExpression letter(QStringLiteral("[A-Za-z]{3}")),
        point(QStringLiteral("(?<=\\d)\\.(?=\\d)"));
    const QString conjunction = QStringLiteral(" and "),
                  elsewhere = QStringLiteral(" and elsewhere");
    const bool more = argument.endsWith(elsewhere);
    if (more) argument.chop(elsewhere.size());
    QString numbers = argument;
    numbers.remove(conjunction);
    if (numbers.contains(letter))
        return translatedSentence(argument) + (more ? elsewhere : QString());
    argument.replace(point, QLocale().decimalPoint())
        .replace(conjunction,
                 QCoreApplication::translate("ToldSentences", " and ", "between the last two"));
    return more ? argument + QCoreApplication::translate("ToldSentences", " and elsewhere")
                : argument;
}

std::optional<QString> translatedOne(const QString& told) {
    static const auto patterns = [] {
        std::vector<QRegularExpression> made;
        for (const char* sentence : sentences)
            made.push_back(patternOf(sentence));
        return made;
    }();
    for (std::size_t n = 0; n < patterns.size(); ++n) {
        const auto match = patterns[n].match(told);
        if (!match.hasMatch()) continue;
        QString text = QCoreApplication::translate("ToldSentences", sentences[n]), filled;
        // In one pass, as what is put in may hold a percent sign.
        for (qsizetype at = 0; at < text.size(); ++at) {
            const int number =
                text[at] == u'%' && at + 1 < text.size() ? text[at + 1].digitValue() : -1;
            if (number >= 1)
                filled += translatedArgument(match.captured(number)), ++at;
            else
                filled += text[at];
        }
        if (text.startsWith(u'%')) filled[0] = filled[0].toUpper();
        return filled;
    }
    return std::nullopt;
}

}  // namespace

QString translatedSentence(const QString& told) {
    if (const auto whole = translatedOne(told)) return *whole;
    QStringList parts = told.split(QStringLiteral("; "));
    if (parts.size() > mostJoined) return told;
    for (QString& part : parts)
        part = translatedOne(part).value_or(part);
    return parts.join(QStringLiteral("; "));
}

QStringList knownWords() {
    QStringList known;
    for (const char* word : words)
        known += QString::fromUtf8(word);
    return known;
}

QStringList knownSentences() {
    QStringList known;
    for (const char* sentence : sentences)
        known += QString::fromUtf8(sentence);
    return known;
}

}  // namespace haustra::window
