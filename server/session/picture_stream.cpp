#include "session/picture_stream.h"

#include "protocol/view_message.h"
#include "render/optics/drawn_wall.h"
#include "session/case_presets.h"
#include "session/worker.h"

#include <algorithm>

#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

/// The wall itself, which a picture of this view shows; its flat window is in pixels of a picture
/// as large as was asked for. None of a view of something else, through a lens, or whose optics let
/// the eye through the wall.
std::optional<ViewState> wallOf(const AnyView& view) {
    if (const auto* camera = std::get_if<render::CameraView>(&view))
        return camera->beneathWallMm == 0.0 && render::drawsWall(camera->optics)
                   ? std::optional<ViewState>(camera->camera)
                   : std::nullopt;
    if (const auto* flat = std::get_if<render::FlatView>(&view))
        return render::drawsWall(flat->optics) ? std::optional<ViewState>(flat->window)
                                               : std::nullopt;
    if (const auto* strip = std::get_if<render::FlatOverview>(&view))
        return render::drawsWall(strip->optics) ? std::optional<ViewState>(WholeStrip{})
                                                : std::nullopt;
    return std::nullopt;
}

}  // namespace

Result<std::unique_ptr<EncoderThreads>> EncoderThreads::start(int threads) {
    std::unique_ptr<EncoderThreads> self(new EncoderThreads);
    for (int n = 0; n < threads; ++n) {
        auto encoder = TRY(encode::TileEncoder::create());
        self->Worker::start("encoder", 1, [encoder = std::move(encoder)](auto& taken) mutable {
            EncodeJob& job = taken.front();
            job.done(guarded([&] { return encoder.encode(job.image, job.header); }));
        });
    }
    return self;
}

PictureStream::PictureStream(SessionId session, asio::any_io_executor io, RenderThread& renderer,
                             EncoderThreads& encoders, const render::PresetLibrary& presets,
                             Outlet outlet)
    : session_(session),
      io_(std::move(io)),
      renderer_(renderer),
      encoders_(encoders),
      offered_(presets),
      presets_(presets),
      outlet_(std::move(outlet)) {}

void PictureStream::setCase(std::shared_ptr<const OpenCase> opened) {
    case_ = std::move(opened);
    if (case_) presets_ = withPresetOfCase(offered_, case_->scanBiopsy);
    reading_.reset();
    ofWall_.clear();
    ++caseNumber_;
    slots_ = {};
    renderer_.withdraw(session_);
    rendering_.reset();
    held_.reset();
}

void PictureStream::stop() {
    setCase(nullptr);
    renderer_.end(session_);
    stopped_ = true;
}

// ---- inputs -----------------------------------------------------------------------------------

Result<void> PictureStream::takeSequence(std::uint64_t sequence) {
    if (sequence <= lastSequence_)
        return fail(ErrorKind::badInput, "the sequence does not grow", "sequence");
    lastSequence_ = sequence;
    return {};
}

Result<void> PictureStream::input(const protocol::ClientMessage& message) {
    const protocol::InputHeader header = *protocol::inputHeader(message);
    TRY(takeSequence(header.sequence));
    if (header.viewport >= slots_.size())
        return fail(ErrorKind::badInput,
                    "viewports have numbers below " + std::to_string(slots_.size()), "viewport");
    Slot& slot = slots_[header.viewport];
    if (!message.has_set_viewport() && !slot.viewport.isOpen())
        return fail(ErrorKind::wrongState, "the viewport is not open", "viewport");
    Viewport next = slot.viewport;
    TRY(next.apply(message, presets_));
    if (next.isDrawable() && showsCleansed(*next.state()) && !(case_ && case_->cleansed))
        return fail(ErrorKind::badInput, "the case has no cleansed scan", "viewport");
    if (next.isOpen() && isFlat(next.kind()) && !(case_ && case_->wall))
        return fail(ErrorKind::badInput, "the case has not been flattened", "viewport");
    slot.viewport = std::move(next);
    slot.sequence = header.sequence;
    changed(header.viewport);
    // While it moved, the other views of the wall kept their paint.
    if (!slot.viewport.moving()) repaint();
    return {};
}

Result<void> PictureStream::input(const protocol::SetWallPaint& message) {
    TRY(takeSequence(message.sequence()));
    if (!reading_)
        return fail(ErrorKind::badInput, "the case has not been flattened: its wall has no paint",
                    "wall paint");
    const auto choice = TRY(protocol::paintFrom(message));
    reading_->choose(choice);
    wallChanged(message.sequence());
    return {};
}

Result<DetectionChoice> PictureStream::input(const protocol::SetDetection& message) {
    TRY(takeSequence(message.sequence()));
    const auto choice = TRY(protocol::detectionFrom(message));
    if (!reading_) return choice;  // its views have no paint
    reading_->chooseFindings(choice);
    wallChanged(message.sequence());
    return choice;
}

Result<void> PictureStream::shown(const protocol::TellShown& message) {
    const auto refuse = [](const char* why) { return fail(ErrorKind::badInput, why, "shown"); };
    if (message.number() <= lastShown_) return refuse("the number does not grow");
    if (std::size_t(message.pictures_size()) > protocol::maxShownPictures)
        return refuse("more pictures than may be told at a time");
    for (const protocol::ScreenTime& time : message.pictures()) {
        if (time.picture() == 0 || time.picture() > pictures_)
            return refuse("there has been no such picture");
        if (time.ms() == 0 || time.ms() > std::uint32_t(protocol::mostSeenMs))
            return refuse("a picture is on screen for 1 to 60000 ms more");
    }
    lastShown_ = message.number();
    if (!reading_) return {};
    std::vector<ShownPicture> pictures;
    for (const protocol::ScreenTime& time : message.pictures()) {
        const auto found = std::lower_bound(
            ofWall_.begin(), ofWall_.end(), time.picture(),
            [](const OfWall& known, std::uint32_t number) { return known.picture < number; });
        if (found == ofWall_.end() || found->picture != time.picture()) continue;
        pictures.push_back(found->shown);
        pictures.back().microseconds = 1000 * std::int64_t(time.ms());
    }
    reading_->shown(std::move(pictures), message.number());
    return {};
}

void PictureStream::wallChanged(std::uint64_t sequence) {
    for (std::size_t id = 0; id < slots_.size(); ++id) {
        Slot& slot = slots_[id];
        if (!slot.viewport.isOpen() || !slot.viewport.isPainted()) continue;
        slot.sequence = sequence;
        changed(id);
    }
}

void PictureStream::repaint() {
    if (!reading_ || stopped_) return;
    const bool moves = std::any_of(slots_.begin(), slots_.end(), [](const Slot& slot) {
        return slot.viewport.isDrawable() && slot.viewport.moving();
    });
    for (Slot& slot : slots_) {
        if (moves || slot.due || !slot.viewport.isDrawable() || !slot.viewport.isPainted() ||
            slot.paint == reading_->paint())
            continue;
        slot.due = true;
        slot.inputAt = Clock::now();
    }
    schedule();
}

// Not while the paint that it is to show is being made.
bool PictureStream::canDraw(const Slot& slot) const {
    return slot.due && (!reading_ || reading_->ready() || !slot.viewport.isPainted());
}

void PictureStream::changed(std::size_t id) {
    Slot& slot = slots_[id];
    slot.due = slot.viewport.isDrawable();
    slot.inputAt = Clock::now();
    slot.rest.reset();
    schedule();
}

// From the sending on, not from the input: however slow the drawing, a client that answers each
// picture with its next camera gets no stills in between.
void PictureStream::awaitRest(const protocol::TileHeader& sent) {
    Slot& slot = slots_[sent.viewport];
    if (sent.exact || slot.sequence != sent.sequence || slot.due) return;
    slot.rest.emplace(io_);
    slot.rest->expires_after(restAfter);
    slot.rest->async_wait(
        [weak = weak_from_this(), id = sent.viewport](const asio::error_code& error) {
            const auto self = weak.lock();
            if (self && !error) self->atRest(id);
        });
}

void PictureStream::atRest(std::size_t id) {
    Slot& slot = slots_[id];
    // The timer may have been set anew, or dropped, after this call was already on its way.
    if (!slot.rest || slot.rest->expiry() > Clock::now()) return;
    slot.rest.reset();
    slot.viewport.rest();
    slot.due = true;
    slot.inputAt = Clock::now();
    repaint();
    schedule();
}

// ---- pictures ---------------------------------------------------------------------------------

void PictureStream::schedule() {
    if (stopped_ || !case_) return;
    if (rendering_) return overtake();
    if (held_ || !unsent_.empty()) return;
    for (std::size_t n = 1; n <= slots_.size(); ++n) {
        const std::size_t id = (lastDrawn_ + n) % slots_.size();
        if (!canDraw(slots_[id])) continue;
        slots_[id].due = false;
        lastDrawn_ = id;
        rendering_ = id;
        renderer_.submit(makeJob(id));
        return;
    }
}

// Newer than what waits in the line or is under way: take its place. A hand that moves does not
// wait for the still of another viewport either.
void PictureStream::overtake() {
    const std::size_t before = *rendering_;
    for (std::size_t n = 0; n < slots_.size(); ++n) {
        const std::size_t id = (before + n) % slots_.size();
        Slot& slot = slots_[id];
        if (!canDraw(slot) || (id != before && !slot.viewport.moving())) continue;
        if (!renderer_.replace(makeJob(id))) continue;
        slot.due = false;
        // It may have been closed while it was drawn.
        if (id != before) slots_[before].due = slots_[before].viewport.isDrawable();
        rendering_ = lastDrawn_ = id;
        return;
    }
}

PictureJob PictureStream::makeJob(std::size_t id) {
    Slot& slot = slots_[id];
    PictureJob job;
    job.session = session_;
    job.of = case_;
    job.view = slot.viewport.view(presets_);
    slot.paint = reading_ && slot.viewport.isPainted() ? reading_->paint() : nullptr;
    setPaint(job.view, slot.paint);
    const auto wall = reading_ ? wallOf(job.view) : std::nullopt;
    job.width = slot.viewport.width();
    job.height = slot.viewport.height();
    job.inputAt = slot.inputAt;
    job.moving = slot.viewport.moving();
    const bool exact = !job.moving || !jpeg_;
    job.coarse = coarse_ && !exact;
    job.header.viewport = std::uint8_t(id);
    job.header.codec = exact ? protocol::TileCodec::lossless : protocol::TileCodec::jpeg;
    job.header.exact = exact;
    job.header.sequence = slot.sequence;
    job.header.viewportWidth = std::uint16_t(job.width);
    job.header.viewportHeight = std::uint16_t(job.height);
    job.done = [weak = weak_from_this(), io = io_, ofCase = caseNumber_, wall](
                   const protocol::TileHeader& header, Result<Image> image) {
        postTo(io, weak,
               [ofCase, header, wall, image = std::move(image)](PictureStream& self) mutable {
                   self.rendered(ofCase, header, wall, std::move(image));
               });
    };
    return job;
}

void PictureStream::rendered(std::uint64_t ofCase, const protocol::TileHeader& header,
                             const std::optional<ViewState>& wall, Result<Image> image) {
    if (ofCase != caseNumber_ || stopped_) return;  // rendering_ speaks of a newer picture
    rendering_.reset();
    if (!image) {
        lost(slots_[header.viewport], image.error());
    } else {
        EncodeJob job{std::move(*image), header, {}};
        if (encoding_)
            held_ = Held{std::move(job), ofCase, wall};
        else
            encode(std::move(job), ofCase, wall);
    }
    schedule();
}

void PictureStream::encode(EncodeJob job, std::uint64_t ofCase,
                           const std::optional<ViewState>& wall) {
    encoding_ = true;
    job.header.picture = ++pictures_;
    if (wall && reading_ && ofCase == caseNumber_) {
        ShownPicture shown{*wall, {job.image.width, job.image.height}, 0, !job.header.exact};
        // A coarse picture shows the same in fewer pixels.
        if (auto* window = std::get_if<FlatWindow>(&shown.shown))
            window->pixelsPerUnit *= double(job.image.width) / job.header.viewportWidth;
        if (tellsShown_) {
            ofWall_.push_back({pictures_, std::move(shown)});
            if (ofWall_.size() > protocol::maxShownPictures) ofWall_.pop_front();
        } else if (std::holds_alternative<Camera>(shown.shown)) {
            shown.microseconds = 1000 * protocol::mostSeenMs;
            reading_->shown({std::move(shown)}, 0);
        }
    }
    job.done = [weak = weak_from_this(), io = io_, ofCase,
                header = job.header](Result<std::vector<std::uint8_t>> frames) {
        postTo(io, weak, [ofCase, header, frames = std::move(frames)](PictureStream& self) mutable {
            self.encoded(ofCase, header, std::move(frames));
        });
    };
    encoders_.push(std::move(job));
}

void PictureStream::encoded(std::uint64_t ofCase, const protocol::TileHeader& header,
                            Result<std::vector<std::uint8_t>> frames) {
    encoding_ = false;
    if (stopped_) return;
    if (ofCase == caseNumber_) {
        if (frames) {
            slots_[header.viewport].failed = false;
            unsent_.push_back(header);
            outlet_.send(std::move(*frames));
        } else {
            lost(slots_[header.viewport], frames.error());
        }
    }
    if (stopped_) return;  // the outlet may have ended everything
    if (held_) {
        Held held = std::move(*held_);
        held_.reset();
        encode(std::move(held.job), held.ofCase, held.wall);
    }
    schedule();
}

void PictureStream::pictureSent() {
    awaitRest(unsent_.front());
    unsent_.pop_front();
    schedule();
}

// A fault of the device may pass: the picture, or a newer one in its place, is drawn once more.
void PictureStream::lost(Slot& slot, const Error& error) {
    slot.failed = error.kind == ErrorKind::device && !slot.failed;
    if (slot.failed) {
        spdlog::warn("session {}: a picture is drawn once more: {}", session_, error.message);
        slot.due = true;
    } else {
        outlet_.failed(error);
    }
}

void PictureStream::broken(const std::string& what) {
    if (!stopped_) outlet_.broken(what);
}

}  // namespace haustra::session
