// Decides which picture of a session is drawn when, and has it encoded.
#pragma once

#include "encode/tile_encoder.h"
#include "session/open_case.h"
#include "session/render_thread.h"
#include "session/viewport.h"
#include "session/wall_reading.h"
#include "session/worker.h"

#include <array>
#include <deque>
#include <functional>
#include <memory>
#include <optional>

#include <asio/any_io_executor.hpp>
#include <asio/steady_timer.hpp>

namespace haustra::session {

/// A viewport that was moving gets its exact still when no input has come for this long after its
/// picture had been sent.
inline constexpr std::chrono::milliseconds restAfter{150};

struct EncodeJob {
    Image image;
    protocol::TileHeader header;  ///< as TileEncoder::encode takes it
    /// Called on an encoder thread with the picture's frames.
    std::function<void(Result<std::vector<std::uint8_t>>)> done;
};

/// The threads that turn pictures into bytes, each with a TileEncoder. A session has one job here
/// at a time, so its pictures stay in order.
class EncoderThreads : public Worker<EncodeJob> {
public:
    static Result<std::unique_ptr<EncoderThreads>> start(int threads);

private:
    EncoderThreads() = default;
};

/// The viewports of one session, and at most one picture being drawn, one being encoded and one
/// waiting between the two. Nothing is drawn while a picture waits to be sent: what the link
/// cannot carry is never made, and the next picture shows the newest input. Belongs to the io
/// thread; what render and encoder threads finish is posted there.
class PictureStream : public std::enable_shared_from_this<PictureStream> {
public:
    struct Outlet {
        std::function<void(std::vector<std::uint8_t> frames)> send;  ///< then call pictureSent()
        std::function<void(const Error& error)> failed;              ///< a picture was lost
        std::function<void(const std::string& what)> broken;         ///< nothing else will come
    };
    PictureStream(SessionId session, asio::any_io_executor io, RenderThread& renderer,
                  EncoderThreads& encoders, const render::PresetLibrary& presets, Outlet outlet);

    /// False: the client takes lossless tiles alone.
    void setJpeg(bool accepted) { jpeg_ = accepted; }
    /// True: moving pictures may be smaller than their viewport.
    void setCoarse(bool accepted) { coarse_ = accepted; }
    /// True: the client tells which pictures have been on screen; else an endoscopic picture that
    /// has been drawn has been.
    void setTellsShown(bool tells) { tellsShown_ = tells; }
    /// From here on pictures are of this case (null: of none). Closes all viewports; pictures of
    /// the case before do not appear any more.
    void setCase(std::shared_ptr<const OpenCase> opened);
    /// What colours the wall of the case that was set, and learns what pictures have shown of it.
    void setReading(std::shared_ptr<WallReading> reading) { reading_ = std::move(reading); }
    /// The reading's paint is another: views of the wall that are at rest are drawn again. While
    /// one moves, only that one shows it.
    void repaint();

    /// An input of one viewport, or SetWallPaint or SetDetection, which are for all views of the
    /// wall. Fails (badInput) and changes nothing but the sequence where the message is out of
    /// bounds, (wrongState) where the viewport is not open.
    Result<void> input(const protocol::ClientMessage& message);
    Result<void> input(const protocol::SetWallPaint& message);
    Result<DetectionChoice> input(const protocol::SetDetection& message);

    /// Pictures have been on screen, which the reading's ledger learns of, as far as they show the
    /// wall and are among the newest protocol::maxShownPictures that do. Fails (badInput), and
    /// takes nothing in, where the message is out of bounds.
    Result<void> shown(const protocol::TellShown& message);

    void pictureSent();
    /// After a fault in what was posted here (postTo).
    void broken(const std::string& what);
    /// Ends everything; the outlet is not used again.
    void stop();

private:
    struct Slot {
        Viewport viewport;
        std::uint64_t sequence = 0;
        bool due = false;                                // has to be drawn
        bool failed = false;                             // the last one; it is drawn once more
        std::shared_ptr<const render::WallPaint> paint;  // of the picture that was asked for last
        Clock::time_point inputAt;
        std::optional<asio::steady_timer> rest;
    };

    Result<void> takeSequence(std::uint64_t sequence);
    void changed(std::size_t id);
    void wallChanged(std::uint64_t sequence);
    bool canDraw(const Slot& slot) const;
    void awaitRest(const protocol::TileHeader& sent);
    void atRest(std::size_t id);
    void schedule();
    void overtake();
    PictureJob makeJob(std::size_t id);
    void rendered(std::uint64_t ofCase, const protocol::TileHeader& header,
                  const std::optional<ViewState>& wall, Result<Image> image);
    void encode(EncodeJob job, std::uint64_t ofCase, const std::optional<ViewState>& wall);
    void encoded(std::uint64_t ofCase, const protocol::TileHeader& header,
                 Result<std::vector<std::uint8_t>> frames);
    void lost(Slot& slot, const Error& error);

    struct Held {
        EncodeJob job;
        std::uint64_t ofCase;
        std::optional<ViewState> wall;  // that it shows
    };

    const SessionId session_;
    asio::any_io_executor io_;
    RenderThread& renderer_;
    EncoderThreads& encoders_;
    const render::PresetLibrary& offered_;  // in any case
    render::PresetLibrary presets_;         // in the open one
    Outlet outlet_;
    std::shared_ptr<const OpenCase> case_;
    std::shared_ptr<WallReading> reading_;  // null where the case has not been flattened
    std::uint64_t caseNumber_ = 0;          // counts setCase: tells old pictures from new ones
    bool jpeg_ = true, coarse_ = false, tellsShown_ = false, stopped_ = false;

    std::array<Slot, protocol::maxViewports> slots_;
    std::size_t lastDrawn_ = 0;
    std::uint64_t lastSequence_ = 0;
    std::uint32_t pictures_ = 0;

    std::optional<std::size_t> rendering_;  // the viewport whose picture waits or is drawn
    std::optional<Held> held_;              // drawn, while another is being encoded
    bool encoding_ = false;
    std::deque<protocol::TileHeader> unsent_;  // given to the outlet, in order
    struct OfWall {
        std::uint32_t picture;
        ShownPicture shown;
    };
    std::deque<OfWall> ofWall_;    // that were encoded last and show the wall, by number
    std::uint64_t lastShown_ = 0;  // number of the newest TellShown
};

}  // namespace haustra::session
