#include "session/gpu_cases.h"

#include "session/worker.h"
#include "store/lost_pages.h"

#include <algorithm>
#include <limits>
#include <utility>

#include <spdlog/spdlog.h>

namespace haustra::session {

namespace {

constexpr int trialSide = 256;  // pixels of the pictures that find the fastest raycaster

double msSince(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

std::size_t mib(std::size_t bytes) {
    return bytes >> 20;
}

// Along the path where there is one, as a reader flies; else from the middle of the scan.
std::vector<render::CameraView> trialViews(const OpenCase& facts, int count) {
    const auto optics = render::opticsPreset(render::opticsPresets().front());
    std::vector<render::CameraView> views;
    const auto ups = rotationMinimizingUps(facts.centerline, flightPreferredUp);
    for (int n = 0; n < count; ++n) {
        render::CameraView view;
        if (optics) view.optics = *optics;
        if (facts.centerline.points.empty()) {
            view.camera.positionMm =
                facts.grid.patientFromVoxelPoint(0.5 * glm::dvec3(facts.grid.size));
        } else {
            const double arc = facts.centerline.lengthMm() * (n + 0.5) / count;
            const auto pose = cameraAtArc(facts.centerline, ups, arc, FlightDirection::antegrade);
            view.camera = {pose.positionMm, pose.forward, pose.up};
        }
        views.push_back(std::move(view));
    }
    return views;
}

RaycasterKind firstThatKeeps(VolumeOnGpu volume) {
    return std::find_if(raycasters().begin(), raycasters().end(),
                        [&](const RaycasterEntry& entry) { return entry.volume == volume; })
        ->kind;
}

}  // namespace

Room makeRoom(const std::vector<HeldCase>& held, std::size_t budgetBytes, std::size_t bytes) {
    Room room;
    std::vector<std::size_t> left;
    std::size_t used = 0;
    for (std::size_t n = 0; n < held.size(); ++n) {
        used += held[n].bytes;
        if (!held[n].open) left.push_back(n);
    }
    if (budgetBytes == 0) return {std::move(left), std::numeric_limits<std::size_t>::max()};
    std::stable_sort(left.begin(), left.end(),
                     [&](std::size_t a, std::size_t b) { return held[a].leftAt < held[b].leftAt; });
    for (const std::size_t n : left) {
        if (used <= budgetBytes && budgetBytes - used >= bytes) break;
        used -= held[n].bytes;
        room.released.push_back(n);
    }
    std::sort(room.released.begin(), room.released.end());
    room.freeBytes = budgetBytes > used ? budgetBytes - used : 0;
    return room;
}

GpuCases::GpuCases(gpu::Context& context, DrawingOptions options, std::function<void()> left)
    : context_(context),
      options_(options),
      left_(std::make_shared<const std::function<void()>>(std::move(left))) {}

// The pointer of which sessions hold copies.
std::shared_ptr<const OpenCase> GpuCases::lend(const OpenCase& facts) const {
    return {new OpenCase(facts),
            [left = std::weak_ptr<const std::function<void()>>(left_)](const OpenCase* of) {
                delete of;
                if (const auto alive = left.lock()) (*alive)();
            }};
}

std::shared_ptr<const OpenCase> GpuCases::find(const OpenCase& facts) {
    for (Entry& entry : cases_) {
        if (entry.facts.name != facts.name || entry.facts.content != facts.content ||
            !entry.checkWhole())
            continue;
        if (auto of = entry.of.lock()) return of;
        auto of = lend(entry.facts);
        entry.of = of;
        entry.leftAt.reset();
        return of;
    }
    return nullptr;
}

const GpuCases::Entry* GpuCases::entryOf(const std::shared_ptr<const OpenCase>& of) const {
    const auto entry = std::find_if(cases_.begin(), cases_.end(), [&](const Entry& candidate) {
        return candidate.of.lock() == of;
    });
    return entry == cases_.end() ? nullptr : &*entry;
}

render::CaseRenderer* GpuCases::rendererOf(const std::shared_ptr<const OpenCase>& of) {
    const Entry* const entry = entryOf(of);
    return entry ? entry->renderer.get() : nullptr;
}

// ---- files that are cut short while they are read -----------------------------------------------

Result<void> GpuCases::Entry::checkWhole() const {
    if (std::all_of(volumes.begin(), volumes.end(), store::isWhole)) return {};
    return fail(ErrorKind::io, "the case's files were cut short, or their disk fails", "render");
}

Result<void> GpuCases::checkWhole(const std::shared_ptr<const OpenCase>& of) const {
    const Entry* const entry = entryOf(of);
    return entry ? entry->checkWhole() : Result<void>();
}

// ---- memory -------------------------------------------------------------------------------------

std::optional<Clock::time_point> GpuCases::nextRelease() const {
    std::optional<Clock::time_point> first;
    for (const Entry& entry : cases_)
        if (entry.leftAt && (!first || *entry.leftAt + keptAfterUse < *first))
            first = *entry.leftAt + keptAfterUse;
    return first;
}

void GpuCases::releaseLeft(Clock::time_point now) {
    for (Entry& entry : cases_)
        if (!entry.leftAt && entry.of.expired()) entry.leftAt = now;
    std::erase_if(cases_, [&](const Entry& entry) {
        return entry.leftAt && now >= *entry.leftAt + keptAfterUse;
    });
}

Result<GpuCases::Made> GpuCases::makeRenderer(render::PreparedCase prepared) {
    releaseLeft(Clock::now());
    std::vector<HeldCase> held;
    for (const Entry& entry : cases_)
        held.push_back({entry.renderer->gpuBytes(), !entry.leftAt,
                        entry.leftAt.value_or(Clock::time_point{})});
    const render::CaseGpuBytes wanted = render::CaseRenderer::gpuBytesFor(prepared);
    const std::size_t whole = wanted.whole();
    const Room room = makeRoom(held, options_.gpuBudgetBytes, whole);
    for (auto gone = room.released.rbegin(); gone != room.released.rend(); ++gone)
        cases_.erase(cases_.begin() + std::ptrdiff_t(*gone));

    // Whoever is chosen later, one that keeps nothing on the GPU costs nothing to begin with. A
    // scan without block ranges is drawn from cells alone.
    const RaycasterKind kind = options_.raycaster.value_or(
        firstThatKeeps(prepared.ranges.lowHu.empty() ? VolumeOnGpu::cells : VolumeOnGpu::none));
    const bool fits = whole <= room.freeBytes;
    render::RendererOptions how;
    how.raycaster = kind;
    if (options_.gpuBudgetBytes > 0) {
        // Cells get what the rest leaves, but half at least; 0 would have no bounds.
        how.gpuBudgetBytes =
            std::max<std::size_t>(room.freeBytes - std::min(wanted.rest, room.freeBytes / 2), 1);
        how.gradientBudgetBytes =
            std::min(how.gradientBudgetBytes, fits ? room.freeBytes - whole : 0);
    }
    if (!fits && raycasterEntry(kind).needsWholeVolume())
        return fail(ErrorKind::device,
                    "the GPU has no room for the case: it needs " + std::to_string(mib(whole)) +
                        " MiB, and " + std::to_string(mib(room.freeBytes)) + " of " +
                        std::to_string(mib(options_.gpuBudgetBytes)) + " MiB are free",
                    "render");
    auto renderer = TRY(render::CaseRenderer::upload(context_, std::move(prepared), how));
    return Made{std::move(renderer), fits};
}

std::vector<RaycasterKind> GpuCases::candidates(bool fits) const {
    auto kinds = render::raycasterCandidates(context_.software());
    if (options_.gpuBudgetBytes == 0) return kinds;
    // Within a budget cells make sense where the whole does not fit, and nothing else does.
    std::erase_if(kinds, [&](RaycasterKind kind) {
        const VolumeOnGpu volume = raycasterEntry(kind).volume;
        return volume == (fits ? VolumeOnGpu::cells : VolumeOnGpu::whole);
    });
    return kinds;
}

// ---- opening ------------------------------------------------------------------------------------

std::string GpuCases::whyDrawnBy(const Opening& opening) const {
    if (!opening.choice) return "which the options name";
    std::string why = "the fastest at " + std::to_string(trialSide) +
                      "² pixels: " + describe(opening.choice->trials());
    std::string others;
    for (const RaycasterKind kind : render::raycasterCandidates(context_.software())) {
        const auto& trials = opening.choice->trials();
        if (std::none_of(trials.begin(), trials.end(),
                         [&](const auto& trial) { return trial.kind == kind; }))
            others += std::string(others.empty() ? "" : ", ") + toString(kind);
    }
    if (!others.empty()) why += "; not considered within the GPU budget: " + others;
    return why;
}

Result<void> GpuCases::upload(OpenCase facts, render::PreparedCase prepared) {
    opening_.reset();
    const std::array<const void*, 2> volumes{prepared.ct.voxels().data(),
                                             prepared.cleansed.voxels().data()};
    auto made = TRY(makeRenderer(std::move(prepared)));
    opening_.emplace(
        Opening{{std::move(facts), {}, {}, std::move(made.renderer), volumes}, {}, {}});
    if (options_.raycaster) return {};
    const render::ChoiceLimits limits;
    opening_->choice.emplace(candidates(made.fits), limits);
    opening_->views = trialViews(opening_->entry.facts, limits.rounds);
    return {};
}

bool GpuCases::tryRaycaster() {
    if (!opening_ || !opening_->choice) return false;
    Opening& my = *opening_;
    const auto next = my.choice->next();
    if (!next) return false;
    const auto start = Clock::now();
    auto drawn = guarded([&]() -> Result<Image> {
        TRY(my.entry.renderer->use(next->kind));
        const auto& view = my.views[std::size_t(next->round) % my.views.size()];
        return my.entry.renderer->render(view, trialSide, trialSide);
    });
    if (drawn)
        my.choice->took(msSince(start));
    else
        my.choice->failed(drawn.error().message);
    return true;
}

Result<std::shared_ptr<const OpenCase>> GpuCases::opened() {
    if (!opening_) return fail(ErrorKind::wrongState, "no case is being opened", "render");
    Opening my = std::move(*opening_);
    opening_.reset();
    TRY(my.entry.checkWhole());
    render::CaseRenderer& renderer = *my.entry.renderer;
    OpenCase& facts = my.entry.facts;
    if (my.choice) {
        facts.trials = my.choice->trials();
        const auto fastest = my.choice->fastest();
        if (!fastest)
            return fail(ErrorKind::device,
                        "no raycaster can draw the case: " + describe(facts.trials), "render");
        TRY(renderer.use(*fastest));
        renderer.keepOnlyUsed();
    }
    facts.raycaster = renderer.raycaster();
    spdlog::info("a case is ready: {} MiB on the GPU, drawn by the {} raycaster, {}",
                 mib(renderer.gpuBytes()), toString(facts.raycaster), whyDrawnBy(my));
    auto of = lend(facts);
    my.entry.of = of;
    cases_.push_back(std::move(my.entry));
    return of;
}

}  // namespace haustra::session
