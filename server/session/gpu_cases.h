// The cases on the GPU: whose they are, how long they stay, how much memory they may take.
#pragma once

#include "gpu/context.h"
#include "render/case_renderer.h"
#include "render/raycaster_choice.h"
#include "session/open_case.h"
#include "session/picture_job.h"

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haustra::session {

/// How cases are drawn.
struct DrawingOptions {
    std::optional<RaycasterKind> raycaster;  ///< none: the fastest, found by trying
    std::size_t gpuBudgetBytes = 0;          ///< for all cases; 0: what the device has
};

/// A case on the GPU, as far as its memory is concerned.
struct HeldCase {
    std::size_t bytes = 0;
    bool open = false;         ///< somebody has it open: it stays
    Clock::time_point leftAt;  ///< since when nobody has
};
struct Room {
    std::vector<std::size_t> released;  ///< indices of what has to go, growing
    std::size_t freeBytes = 0;          ///< when that is gone; without a budget the greatest number
};
/// Which cases that nobody has open must go so that `bytes` more fit into the budget: the one left
/// longest ago first, and none in vain where nothing helps. Without a budget (0) all of them: how
/// much a device can hold is not known.
Room makeRoom(const std::vector<HeldCase>& held, std::size_t budgetBytes, std::size_t bytes);

/// Belongs to the render thread, whose context must outlive it.
class GpuCases {
public:
    /// For how long a renderer is kept after the last copy of its case's pointer is gone, unless
    /// its memory is wanted meanwhile.
    static constexpr std::chrono::seconds keptAfterUse{30};

    /// `left` is called, on whichever thread, when the last copy of a case's pointer is gone.
    GpuCases(gpu::Context& context, DrawingOptions options, std::function<void()> left);

    /// The case of these products where it is here, else empty.
    std::shared_ptr<const OpenCase> find(const OpenCase& facts);

    /// Takes a case, as the one that is being opened, and copies to the GPU what a raycaster that
    /// was named needs there. Fails (device) where the budget has no room for that.
    Result<void> upload(OpenCase facts, render::PreparedCase prepared);
    /// Draws one picture of the case that is being opened to find its raycaster: of those that fit
    /// into the budget; where the whole volume does not, of those that draw it from cells that come
    /// and go, or from main memory. False where nothing is left to try.
    bool tryRaycaster();
    /// The case that was being opened: from now on it can be drawn, and find finds it.
    Result<std::shared_ptr<const OpenCase>> opened();

    /// Fails (io) where a page of the case's volumes that was read was not there: its pictures are
    /// worth nothing, and find() does not find it any more.
    Result<void> checkWhole(const std::shared_ptr<const OpenCase>& of) const;

    /// Null where the case is not here.
    render::CaseRenderer* rendererOf(const std::shared_ptr<const OpenCase>& of);

    /// When the next renderer is to be let go; none where all are in use.
    std::optional<Clock::time_point> nextRelease() const;
    void releaseLeft(Clock::time_point now);

private:
    struct Entry {
        OpenCase facts;
        std::weak_ptr<const OpenCase> of;
        std::optional<Clock::time_point> leftAt;  // since when nobody has it open
        std::unique_ptr<render::CaseRenderer> renderer;
        std::array<const void*, 2> volumes{};  // in mapped memory, which the renderer holds

        Result<void> checkWhole() const;
    };
    struct Opening {
        Entry entry;
        std::optional<render::RaycasterChoice> choice;
        std::vector<render::CameraView> views;
    };

    struct Made {
        std::unique_ptr<render::CaseRenderer> renderer;
        bool fits;  ///< there is room for the whole volume
    };
    Result<Made> makeRenderer(render::PreparedCase prepared);
    std::vector<RaycasterKind> candidates(bool fits) const;
    const Entry* entryOf(const std::shared_ptr<const OpenCase>& of) const;
    std::shared_ptr<const OpenCase> lend(const OpenCase& facts) const;
    /// For the log: what was tried, and what was not, and why.
    std::string whyDrawnBy(const Opening& opening) const;

    gpu::Context& context_;
    DrawingOptions options_;
    std::shared_ptr<const std::function<void()>> left_;
    std::vector<Entry> cases_;
    std::optional<Opening> opening_;
};

}  // namespace haustra::session
