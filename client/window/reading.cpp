#include "window/reading.h"

#include "protocol/capabilities.h"
#include "window/pane.h"

#include <QLocale>
#include <QLoggingCategory>
#include <QSettings>
#include <QTextDocument>
#include <QUndoCommand>
#include <algorithm>
#include <chrono>
#include <utility>

namespace haustra::window {
namespace {

using reader::Clock;
using std::chrono::milliseconds;

constexpr auto steadyInterval = milliseconds(15), idleInterval = milliseconds(250),
               mergeWithin = milliseconds(1000);
constexpr auto detectionSetting = "reading/detection";

// What the person who reads is told, for whoever reads the log instead:
// QT_LOGGING_RULES=haustra.reading=true.
Q_LOGGING_CATEGORY(readingLog, "haustra.reading", QtCriticalMsg)

class Step : public QUndoCommand {
public:
    Step(const QString& text, std::function<void()> undo, std::function<void()> redo, int mergeId)
        : QUndoCommand(text), undo_(std::move(undo)), redo_(std::move(redo)), mergeId_(mergeId) {}
    void undo() override { undo_(); }
    void redo() override {
        if (!std::exchange(first_, false)) redo_();
    }
    int id() const override { return mergeId_; }
    bool mergeWith(const QUndoCommand* other) override {
        const auto* later = static_cast<const Step*>(other);
        if (later->madeAt_ - madeAt_ > mergeWithin) return false;
        redo_ = later->redo_;
        madeAt_ = later->madeAt_;
        return true;
    }

private:
    std::function<void()> undo_, redo_;
    int mergeId_;
    bool first_ = true;  // it has been done when it is pushed
    Clock::time_point madeAt_ = Clock::now();
};

}  // namespace

QString text(const std::string& utf8) {
    return QString::fromStdString(utf8);
}

QString decimal(double value) {
    return QLocale().toString(value, 'f', 1);
}

QString text(const Error& error) {
    return text(describe(error));
}

QString toolTipOf(const QString& said) {
    return said.isEmpty() ? said : Qt::convertFromPlainText(said);
}

Reading::Reading(link::ConnectionOptions options, std::string caseName,
                 std::optional<reader::BookmarkJournal> journal)
    : options_(std::move(options)),
      journal_(std::move(journal)),
      serverName_(text(link::toString(options_.address))) {
    options_.reconnect = true;
    options_.onEvent = [this] { wakeFromThread(); };
    steady_.setTimerType(Qt::PreciseTimer);
    soon_.setSingleShot(true);
    connect(&soon_, &QTimer::timeout, this, &Reading::step);
    steady_.setInterval(steadyInterval);
    idle_.setInterval(idleInterval);
    connect(&steady_, &QTimer::timeout, this, &Reading::step);
    connect(&idle_, &QTimer::timeout, this, &Reading::step);
    undoStack_.setUndoLimit(100);
    if (const int kept = QSettings().value(QLatin1String(detectionSetting)).toInt();
        kept > 0 && kept <= int(DetectionMode::concurrent))
        nextDetection_ = DetectionMode(kept);
    makeReader(std::move(caseName));
    sinceStep_.start();
    idle_.start();
}

void Reading::makeReader(std::string caseName) {
    reader_ = std::make_unique<reader::Reader>(options_, std::move(caseName), journal_);
}

void Reading::connectAgain() {
    const std::string caseName = reader_->session().wantedCase();
    if (case_)
        placeBefore_ =
            Place{case_->scan, reader_->flight(), reader_->slices(), reader_->findings().choice()};
    const bool offers = reader_->session().offersCases();
    undoStack_.clear();  // its steps are of the former reader
    case_.reset();
    reader_.reset();
    makeReader(caseName);
    reader_->session().setOffersCases(offers);
    emit readerReplaced();
    changed();
}

Reading::~Reading() {
    // Bookmarks on their way, and what has been seen last, are waited for, but not for long.
    reader::Session& session = reader_->session();
    const auto deadline = Clock::now() + std::chrono::seconds(2);
    session.tellShown();
    while ((session.owedBookmarks() > 0 || session.owesShown()) &&
           session.phase() == reader::Phase::open && Clock::now() < deadline)
        session.poll(milliseconds(50));
    // Its thread wakes the timers: it ends before they do.
    reader_.reset();
}

// From the connection's thread: the many pictures of one moment are one step. By a timer, since
// Qt delivers what is queued before it paints or hears the hand, for ever where more comes
// meanwhile.
void Reading::wakeFromThread() {
    if (stepWaits_.exchange(true)) return;
    QMetaObject::invokeMethod(&soon_, qOverload<>(&QTimer::start), Qt::QueuedConnection);
}

void Reading::changed() {
    wakeFromThread();
}

void Reading::step() {
    stepWaits_ = false;
    // A step that was long in coming must not throw the reader far along the colon.
    const double seconds = std::min(1e-3 * double(sinceStep_.restart()), 0.1);
    reader::Flight& flight = reader_->flight();
    const bool holds = flight.isFree() && heldWay_ != glm::dvec3(0.0);
    if (holds)
        flight.moveFreely(heldWay_ * flight.speedMmPerS() * seconds * (heldFast_ ? 3.0 : 1.0));
    reader_->update(seconds);
    watchSession();
    watchRulers();
    const bool steadily = holds || reader_->restless();
    if (steadily != steady_.isActive()) steadily ? steady_.start() : steady_.stop();
    emit stepped();
}

void Reading::watchSession() {
    reader::Session& session = reader_->session();
    if (session.caseInfo() != case_) {
        case_ = session.caseInfo();
        undoStack_.clear();
        setTool(DrawingTool::none);
        if (const auto before = std::exchange(placeBefore_, {});
            before && case_->scan == before->scan) {
            reader_->reopen(before->flight, before->slices);
            if (reader_->findings().has()) (void)reader_->findings().choose(before->detection);
        }
        emit caseOpened();
    }
    if (session.phase() != phase_) {
        const bool kept =
            !options_.reader.empty() && session.serverCan(protocol::capability::ledger);
        if (phase_ == reader::Phase::lost && session.phase() != reader::Phase::failed && case_ &&
            case_->flat && !kept)
            tell(tr("The server counts what has been seen of the wall anew with this link."), true);
        phase_ = session.phase();
        if (phase_ == reader::Phase::lost)
            qCInfo(readingLog) << "lost:" << text(session.failure());
        else if (phase_ == reader::Phase::failed)
            qCInfo(readingLog) << "failed:" << text(session.failure());
        emit phaseChanged();
    }
    for (const Error& refusal : session.takeRefusals())
        tell(text(refusal), true);
    if (session.server().firstUse && !std::exchange(toldFirstUse_, true))
        tell(tr("First meeting with this server: its certificate is now pinned (%1…)")
                 .arg(text(session.server().fingerprint.substr(0, 16))));
    int saved = 0, refused = 0;
    for (const auto& outcome : session.takeBookmarkOutcomes())
        ++(outcome.saved ? saved : refused);
    if (saved > 0) tell(tr("%n bookmark(s) saved", nullptr, saved));
    if (refused > 0)
        tell(tr("%n bookmark(s) not saved: the server refused. They are kept in the list of "
                "bookmarks, to be sent again or discarded.",
                nullptr, refused),
             true);
}

// The second end of one may have come from the server.
void Reading::watchRulers() {
    reader::PlaceRulers& rulers = reader_->rulers();
    const auto before = rulers.takeBefore();
    if (!before) return;
    did(
        tr("measure between two places"), [&rulers, before = *before] { rulers.set(before); },
        [&rulers, after = rulers.rulers()] { rulers.set(after); });
    // Not every view has room for its length, or shows the place.
    if (rulers.rulers().size() > before->size()) tell(textOf(rulers.rulers().back()));
}

void Reading::tell(const QString& text, bool trouble) {
    qCInfo(readingLog) << (trouble ? "trouble:" : "told:") << text;
    emit told(text, trouble);
}

void Reading::did(const QString& text, std::function<void()> undo, std::function<void()> redo,
                  int mergeId) {
    const auto andStep = [this](std::function<void()> what) {
        return [this, what = std::move(what)] {
            what();
            changed();
        };
    };
    undoStack_.push(new Step(text, andStep(std::move(undo)), andStep(std::move(redo)), mergeId));
    changed();
}

std::function<void()> Reading::wayBack() {
    reader::Reader& reader = *reader_;
    const reader::ListedFinding* at = reader.findings().current();
    return [&reader, flight = reader.flight(), slices = reader.slices(),
            finding = at ? std::optional(*at) : std::nullopt] {
        reader.setMotion(reader::Motion::paused);
        reader.restore(flight, slices);
        reader.findings().setCurrent(finding);
    };
}

void Reading::jump(const QString& text, std::function<void()> go, std::function<void()> alsoBack) {
    reader::Reader& reader = *reader_;
    const auto goThere = [&reader, go = std::move(go)] {
        reader.setMotion(reader::Motion::paused);
        reader.flat().forgetPicked();  // an answer on its way would lead back
        go();
    };
    const auto back = [way = wayBack(), also = std::move(alsoBack)] {
        way();
        if (also) also();
    };
    goThere();
    did(text, back, goThere);
}

void Reading::clearMeasures() {
    reader::ScanMeasures& measures = reader_->measures();
    reader::WallQuestions& wall = reader_->flat().wall();
    const auto before = measures.measures();
    const auto onWall = wall.measurement();
    reader::PlaceRulers& rulers = reader_->rulers();
    const auto between = rulers.rulers();
    rulers.giveUp();
    if (before.empty() && between.empty() && !onWall) return;
    const auto clear = [&measures, &wall, &rulers] {
        measures.set({});
        rulers.set({});
        wall.clearMeasurement();
    };
    clear();
    did(
        tr("clear measurements"),
        [&measures, &wall, &rulers, before, between, onWall] {
            measures.set(before);
            rulers.set(between);
            if (onWall) wall.measure(onWall->points, onWall->closed);
        },
        clear);
}

void Reading::setNextDetection(DetectionMode mode) {
    nextDetection_ = mode;
    QSettings().setValue(QLatin1String(detectionSetting), int(mode));
}

void Reading::setTool(DrawingTool tool) {
    if (std::exchange(tool_, tool) == tool) return;
    reader_->rulers().giveUp();
    emit toolChanged();
}

void Reading::setHeldWay(glm::dvec3 way, bool fast) {
    heldWay_ = way;
    heldFast_ = fast;
    changed();
}

}  // namespace haustra::window
