// What the window translates of a server's sentences, and that the programs still tell them so.
#include "window/told_sentences.h"

#include "core/colon_record.h"
#include "core/scan_coarseness.h"
#include "core/slice_steps.h"
#include "core/text_file.h"
#include "window/language.h"

#include <QApplication>
#include <QRegularExpression>
#include <cstdlib>
#include <filesystem>
#include <set>
#include <string>

#include <gtest/gtest.h>

namespace haustra::window {
namespace {

namespace fs = std::filesystem;

const QRegularExpression placeholder(QStringLiteral("%\\d"));

fs::path sources() {
    return std::getenv("HAUSTRA_SOURCE");
}

std::string textOfStages() {
    std::string all;
    for (const auto& entry : fs::recursive_directory_iterator(sources() / "processing"))
        if (entry.path().extension() == ".cpp") all += readTextFile(entry.path()).value() + "\n";
    return all;
}
std::string textOfCadCommand() {
    return readTextFile(sources() / "server/cli/cad_command.cpp").value();
}

// A source's text with the literals that stand one after another joined; whatever is put into one
// is a '\1'.
QString withJoinedLiterals(const std::string& source) {
    QString text = QString::fromStdString(source);
    text.replace(QRegularExpression(QStringLiteral("\"\\s*\"")), QString());
    text.replace(QRegularExpression(QStringLiteral("%(?:\\.\\d)?(?:zu|[dfgs])|\\{\\}")),
                 QStringLiteral("\1"));
    return text.replace(QStringLiteral("%%"), QStringLiteral("%"));
}

// A sentence is made of stretches of literals: each is long enough to be no chance, or all of one,
// or what one has before its first gap. Empty: all of it is; else the rest from where it is not.
QString restThatNobodyTells(const QString& sentence, const QString& told) {
    constexpr qsizetype least = 12;
    const auto longest = [&](QStringView rest) -> qsizetype {
        if (told.contains(rest)) return rest.size();
        qsizetype length = 0;
        while (told.contains(rest.first(length + 1)))
            ++length;
        if (length >= least) return length;
        for (; length > 0; --length)
            for (const char* end : {"\"", "\1"})
                if (told.contains(u'"' + rest.first(length).toString() + QLatin1String(end)))
                    return length;
        return rest.front() == u'\1' ? 1 : 0;
    };
    for (qsizetype at = 0; at < sentence.size();) {
        const qsizetype length = longest(QStringView(sentence).sliced(at));
        if (length == 0) return sentence.sliced(at);
        at += length;
    }
    return {};
}

// The arguments of each call, in the sources' text, by which a stage warns or doubts.
QStringList callsThatWarn(const QString& told) {
    static const QRegularExpression call(
        QStringLiteral("\\b(?:warnings\\.push_back|say|doubt)\\(")),
        quoted(QStringLiteral("\"(?:[^\"\\\\\n]|\\\\.)*\""));
    const QRegularExpressionMatch no;
    QStringList calls;
    for (auto found = call.globalMatch(told); found.hasNext();) {
        const qsizetype from = found.next().capturedEnd();
        int open = 1;
        qsizetype at = from;
        while (open > 0 && at < told.size()) {
            const auto literal = told[at] == u'"' ? quoted.match(told, at) : no;
            if (literal.hasMatch()) {
                at = literal.capturedEnd();
                continue;
            }
            open += told[at] == u'(' ? 1 : told[at] == u')' ? -1 : 0;
            ++at;
        }
        calls += told.sliced(from, at - from);
    }
    return calls;
}

QString translated(const std::string& told) {
    return translatedSentence(QString::fromStdString(told));
}

class ToldSentences : public testing::Test {
protected:
    ToldSentences() { useLanguage(application_, QStringLiteral("de")); }

private:
    static inline int count_ = 1;
    static inline char name_[] = "test", *arguments_[] = {name_, nullptr};
    const bool offscreen_ = qputenv("QT_QPA_PLATFORM", "offscreen");
    QApplication application_{count_, arguments_};
};

TEST_F(ToldSentences, AreThoseThatTheSourcesHave) {
    const QString told = withJoinedLiterals(textOfStages() + textOfCadCommand());
    for (QString sentence : knownSentences()) {
        // A model's file has its numbers written out.
        if (sentence.contains(QStringLiteral("haustra phantom"))) continue;
        sentence.replace(placeholder, QStringLiteral("\1"));
        EXPECT_EQ(restThatNobodyTells(sentence, told).toStdString(), "") << sentence.toStdString();
    }
    EXPECT_EQ(restThatNobodyTells(QStringLiteral("polyps may not show in it, tiny ones"), told)
                  .toStdString(),
              "tiny ones")
        << "a word that has changed is seen";
}

// A warning that is new has to be known, too.
TEST_F(ToldSentences, AreAllByWhichAStageWarns) {
    constexpr qsizetype least = 12;  // shorter stretches join sentences, or are words of their own
    static const QRegularExpression quoted(QStringLiteral("\"((?:[^\"\\\\\n]|\\\\.)*)\""));
    QString known = knownSentences().join(u'\n');
    known.replace(placeholder, QStringLiteral("\1"));
    int stretches = 0;
    for (const QString& call : callsThatWarn(withJoinedLiterals(textOfStages()))) {
        for (auto literal = quoted.globalMatch(call); literal.hasNext();) {
            for (const QString& stretch : literal.next().captured(1).split(u'\1')) {
                if (stretch.size() < least) continue;
                ++stretches;
                EXPECT_TRUE(known.contains(stretch)) << stretch.toStdString();
            }
        }
    }
    EXPECT_GE(stretches, 60) << "that many there were when this was written";
    EXPECT_EQ(callsThatWarn(QStringLiteral("say(f(1, \"a)\") + g()); no(\"b\")")),
              QStringList{QStringLiteral("f(1, \"a)\") + g())")});
}

TEST_F(ToldSentences, AreGermanWithTheirNumbers) {
    for (const QString& sentence : knownSentences()) {
        QString told = sentence,
                german = QCoreApplication::translate("ToldSentences", sentence.toUtf8());
        EXPECT_NE(german, sentence) << sentence.toStdString();
        int number = 0;
        for (auto found = placeholder.globalMatch(sentence); found.hasNext();) {
            const QString captured = found.next().captured();
            EXPECT_EQ(captured, QStringLiteral("%%1").arg(++number)) << sentence.toStdString();
            EXPECT_EQ(german.count(captured), 1) << sentence.toStdString();
        }
        told.replace(placeholder, QStringLiteral("7.5"));
        german.replace(placeholder, QStringLiteral("7,5"));
        EXPECT_EQ(translatedSentence(told).toStdString(), german.toStdString());
    }
}

TEST_F(ToldSentences, AreKnownAsTheProgramsTellThem) {
    const auto coarse = coarsenessOf(axisAlignedGrid({10, 10, 10}, {0.8, 0.8, 2.1}), nullptr);
    EXPECT_EQ(translated(coarse.value()).toStdString(),
              "Die Abtastpunkte der Aufnahme liegen bis zu 2,1 mm auseinander (CT-Kolonographie "
              "verlangt höchstens 1,5): Kleine und flache Polypen sind darin vielleicht nicht zu "
              "sehen");
    // Slices that are the same, and one that differs from its neighbours.
    Volume<std::int16_t> steps(axisAlignedGrid({20, 20, 40}, {1, 1, 1}));
    const auto voxels = steps.writable();
    for (std::size_t n = 0; n < voxels.size(); ++n) {
        const int k = steps.grid().voxelAt(n).z;
        voxels[n] = std::int16_t((n % 7) * 10 + (k % 2) * 20 + (k >= 20 ? 200 : 0));
        if (k == 31) voxels[n] = voxels[n - 400];
    }
    const std::string uneven = unevenStepsOf(steps, 1).value();
    ASSERT_NE(uneven.find("; "), std::string::npos) << uneven;
    const QString german = translated(uneven);
    EXPECT_FALSE(german.contains(QStringLiteral("the "))) << german.toStdString();
    EXPECT_TRUE(german.contains(QStringLiteral("gleicht der vorigen"))) << german.toStdString();
}

TEST_F(ToldSentences, KeepPlacesAndTranslateWords) {
    EXPECT_EQ(translated("what looks like a thin wall in the splenic flexure was taken for open "
                         "lumen, at (80, -34, 322) mm, (1, 2, 3) mm and elsewhere")
                  .toStdString(),
              "Linke Flexur: Was wie eine dünne Wand aussieht, wurde für offenes Lumen gehalten, "
              "bei (80, -34, 322) mm, (1, 2, 3) mm und anderswo");
    EXPECT_EQ(translated("findings 1, 2 and 3, from 465 mm on, lie rim to rim, 36 mm wide in all: "
                         "they may be lobes of one mass")
                  .toStdString(),
              "Die Befunde 1, 2 und 3, ab 465 mm, liegen Rand an Rand, zusammen 36 mm breit: Es "
              "können Lappen einer einzigen Raumforderung sein");
    EXPECT_EQ(translated("the course is right with no more than 32 %; gravest: a loop may lie in "
                         "the 62 mm that were crossed from the sigmoid on")
                  .toStdString(),
              "Der Verlauf stimmt mit einer Wahrscheinlichkeit von höchstens 32 %; am schwersten "
              "wiegt: Sigma: In den 62 mm, die überbrückt wurden, kann eine Schlinge liegen");
}

TEST_F(ToldSentences, KnowTheWordsThatStandInThem) {
    std::set<std::string> told{"fluid", "on the left side", "on the right side"};
    for (std::size_t part = 0; part < colonParts; ++part)
        told.insert(toString(ColonPart(part)));
    for (const BodyContent content : {BodyContent::gas, BodyContent::tagged, BodyContent::untagged})
        told.insert(toString(content));
    for (const auto position : {PatientPosition::supine, PatientPosition::prone,
                                PatientPosition::leftDecubitus, PatientPosition::rightDecubitus})
        told.insert(toString(position));
    std::set<std::string> known;
    for (const QString& word : knownWords()) {
        known.insert(word.toStdString());
        EXPECT_NE(QCoreApplication::translate("ToldSentences", word.toUtf8()), word);
    }
    EXPECT_EQ(known, told);
}

// What a newer server tells, or a hostile one.
TEST_F(ToldSentences, StayAsTheyCameWhereTheyAreNotKnown) {
    for (const std::string told :
         {"", "; ", "a sentence of tomorrow, 7.5 mm", "the rectum was not found, or so",
          "%1 and %2; %3", "mm2 of the wall were not examined"})
        EXPECT_EQ(translated(told).toStdString(), told);
    EXPECT_EQ(
        translated("the rectum was not found: the colon begins in the %2 %1 (tail)").toStdString(),
        "Das Rektum wurde nicht gefunden: Das Kolon beginnt hier: %2 %1 (tail)");
    EXPECT_EQ(translated("a sentence of tomorrow; the rectum was not found").toStdString(),
              "a sentence of tomorrow; Das Rektum wurde nicht gefunden");
    std::string nested;
    for (int n = 0; n < 100; ++n)
        nested += "the course is right with no more than 1 %; gravest: ";
    EXPECT_TRUE(translated(nested + "x").endsWith(u'x'));
}

}  // namespace
}  // namespace haustra::window
