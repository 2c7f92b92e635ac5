// The order of the checks: every header is read and the series chosen; its slices are stacked
// (orientation, matrix, spacing, copies, holes, tilt); only then is memory for the volume taken and
// the pixels decoded, each frame straight into its place.
#include "dicom/import_series.h"

#include "dicom/frame_decoding.h"
#include "dicom/series_geometry.h"
#include "dicom/series_selection.h"
#include "dicom/slice_resampling.h"

#include <algorithm>
#include <cstring>
#include <mutex>
#include <new>
#include <thread>

namespace haustra::dicom {
namespace {

constexpr double headersShare = 0.15;  // of the time, for the progress
constexpr std::size_t framesAtATime = 16;

/// A frame and the slice of the volume that it becomes.
struct PlacedFrame {
    std::size_t image;
    int frame;
    std::size_t slice;
};

/// One piece of work: consecutive frames of one file, so that the file is opened once.
struct Batch {
    std::size_t begin, end;  ///< of the placed frames
};

std::vector<Slice> slicesOf(const Series& series, std::vector<PlacedFrame>& frames) {
    std::vector<Slice> slices;
    for (std::size_t n = 0; n < series.images.size(); ++n) {
        const ImageHeader& image = series.images[n];
        for (std::size_t f = 0; f < image.frames.size(); ++f) {
            const FrameHeader& frame = image.frames[f];
            const bool several = image.frames.size() > 1;
            const std::string suffix = several ? " frame " + std::to_string(f + 1) : "";
            slices.push_back({image.file.string() + suffix, image.instanceUid + suffix,
                              frame.positionMm, frame.rowDirection, frame.columnDirection,
                              frame.pixelSpacingMm, image.matrix, frame.thicknessMm});
            frames.push_back({n, int(f), 0});
        }
    }
    return slices;
}

std::string orEmpty(const std::string& text, bool (*sound)(std::string_view)) {
    return sound(text) ? text : std::string();
}

/// What the images agree on; empty where they do not.
std::string common(const Series& series, std::string ImageHeader::*value,
                   bool (*sound)(std::string_view)) {
    const std::string& first = series.images.front().*value;
    const bool same = std::ranges::all_of(
        series.images, [&](const ImageHeader& image) { return image.*value == first; });
    return same ? orEmpty(first, sound) : std::string();
}

/// `slices` and `frames` as slicesOf gives them.
SourceSeries sourceOf(const Series& series, const std::vector<Slice>& slices,
                      const std::vector<PlacedFrame>& frames, const SliceStack& stack) {
    SourceSeries source;
    source.studyUid = common(series, &ImageHeader::studyUid, isUid);
    source.seriesUid = common(series, &ImageHeader::seriesUid, isUid);
    source.frameOfReferenceUid = common(series, &ImageHeader::frameOfReferenceUid, isUid);
    source.studyDate = common(series, &ImageHeader::studyDate, isDicomDate);
    source.studyTime = common(series, &ImageHeader::studyTime, isDicomTime);
    source.position = series.summary.position;
    const Slice& first = slices[stack.order.front()];
    source.rowDirection = first.rowDirection;
    source.columnDirection = first.columnDirection;
    source.pixelSpacingMm = first.pixelSpacingMm;
    if (stack.order.size() > std::size_t(maxSourceImages)) return source;
    for (const std::size_t n : stack.order) {
        const ImageHeader& image = series.images[frames[n].image];
        source.images.push_back({orEmpty(image.sopClassUid, isUid),
                                 orEmpty(image.instanceUid, isUid),
                                 image.frames.size() > 1 ? frames[n].frame + 1 : 0,
                                 slices[n].positionMm, slices[n].thicknessMm});
    }
    return source;
}

/// The frames that the stack keeps, in file order, cut into batches.
std::vector<Batch> planBatches(const SliceStack& stack, std::vector<PlacedFrame>& frames) {
    std::vector<PlacedFrame> kept;
    for (std::size_t k = 0; k < stack.order.size(); ++k) {
        PlacedFrame frame = frames[stack.order[k]];
        frame.slice = k;
        kept.push_back(frame);
    }
    std::sort(kept.begin(), kept.end(), [](const PlacedFrame& a, const PlacedFrame& b) {
        return a.image != b.image ? a.image < b.image : a.frame < b.frame;
    });
    frames = std::move(kept);
    std::vector<Batch> batches;
    for (std::size_t n = 0; n < frames.size(); ++n) {
        const bool joins = !batches.empty() && n - batches.back().begin < framesAtATime &&
                           frames[n - 1].image == frames[n].image &&
                           frames[n - 1].frame + 1 == frames[n].frame;
        if (joins)
            batches.back().end = n + 1;
        else
            batches.push_back({n, n + 1});
    }
    return batches;
}

/// Decodes every batch into `volume`; of several failures the first in file order is returned.
Result<void> decodeSlices(const Series& series, const SliceStack& stack,
                          std::vector<PlacedFrame> frames, Volume<std::int16_t>& volume,
                          int threads, const Progress& progress) {
    const std::vector<Batch> batches = planBatches(stack, frames);
    const glm::ivec2 size(volume.grid().size);
    const std::size_t plane = std::size_t(size.x) * std::size_t(size.y);
    const std::span<std::int16_t> voxels = volume.writable();
    const std::thread::id caller = std::this_thread::get_id();
    std::mutex mutex;
    std::size_t failedBatch = batches.size();
    Error failure;
    parallelFor(batches.size(), 1, threads, [&](std::size_t b, std::size_t) {
        {
            std::lock_guard lock(mutex);
            if (failedBatch < b) return;
        }
        const Batch& batch = batches[b];
        const ImageHeader& image = series.images[frames[batch.begin].image];
        const int first = frames[batch.begin].frame;
        auto place = [&](int frame, std::span<const std::int16_t> hu) {
            const std::size_t slice = frames[batch.begin + std::size_t(frame - first)].slice;
            const std::span<std::int16_t> target = voxels.subspan(slice * plane, plane);
            if (stack.shiftPixels.empty())
                std::memcpy(target.data(), hu.data(), hu.size_bytes());
            else
                placeShifted(hu, image.matrix, stack.shiftPixels[slice], target, size);
        };
        const auto decoded =
            decodeFrames(image, first, first + int(batch.end - batch.begin), place);
        if (!decoded) {
            std::lock_guard lock(mutex);
            if (b < failedBatch) {
                failedBatch = b;
                failure = decoded.error();
            }
        }
        if (progress && std::this_thread::get_id() == caller)
            progress(headersShare + (1.0 - headersShare) * double(b + 1) / double(batches.size()));
    });
    if (failedBatch < batches.size()) return tl::make_unexpected(failure);
    return {};
}

/// Slices that are left out as copies of others must be so.
Result<void> checkCopies(const Series& series, const SliceStack& stack,
                         const std::vector<PlacedFrame>& frames) {
    const auto pixelsOf = [&](std::size_t slice, std::vector<std::int16_t>& pixels) {
        const PlacedFrame& frame = frames[slice];
        return decodeFrames(
            series.images[frame.image], frame.frame, frame.frame + 1,
            [&](int, std::span<const std::int16_t> hu) { pixels.assign(hu.begin(), hu.end()); });
    };
    std::vector<std::int16_t> kept, copy;
    for (const SliceStack::Copy& each : stack.copies) {
        TRY(pixelsOf(each.kept, kept));
        TRY(pixelsOf(each.slice, copy));
        if (copy == kept) continue;
        return fail(ErrorKind::badInput,
                    "it has place and Instance UID of " +
                        series.images[frames[each.kept].image].file.string() + ", but other pixels",
                    series.images[frames[each.slice].image].file.string());
    }
    return {};
}

}  // namespace

Result<std::vector<SeriesSummary>> listSeries(const std::filesystem::path& path) {
    auto found = TRY(findSeries(path, 0, {}));
    std::vector<SeriesSummary> summaries;
    for (const Series& series : found.series) {
        if (!series.images.empty()) summaries.push_back(series.summary);
    }
    return summaries;
}

Result<SeriesSummary> findSeries(const std::filesystem::path& path, const ImportOptions& options) {
    return findSeries(path, options.threads, {})
        .and_then([&](FoundSeries found) {
            return chooseSeries(std::move(found), options.seriesUid, path);
        })
        .map([](Series series) { return std::move(series.summary); });
}

Result<ImportedSeries> importSeries(const std::filesystem::path& path,
                                    const ImportOptions& options) try {
    auto found = TRY(findSeries(path, options.threads, [&](double fraction) {
        if (options.progress) options.progress(headersShare * fraction);
    }));
    auto series = TRY(chooseSeries(std::move(found), options.seriesUid, path));

    std::vector<PlacedFrame> frames;
    const std::vector<Slice> slices = slicesOf(series, frames);
    auto stack = TRY(stackSlices(slices));

    TRY(checkCopies(series, stack, frames));
    SourceSeries source = sourceOf(series, slices, frames, stack);
    Grid grid = stack.grid;
    grid.size.z = int(stack.order.size());
    Volume<std::int16_t> volume(grid);
    TRY(decodeSlices(series, stack, std::move(frames), volume, options.threads, options.progress));
    if (!stack.depthSlices.empty())
        volume = resampleDepth(volume, stack.depthSlices, stack.grid, options.threads);

    ImportedSeries result;
    result.scan.hu = std::move(volume);
    result.scan.position = series.summary.position;
    result.summary = series.summary;
    result.source = std::move(source);
    result.notes = std::move(series.notes);
    std::ranges::move(stack.notes, std::back_inserter(result.notes));
    if (series.localizers > 0) {
        result.notes.push_back("left out " + std::to_string(series.localizers) +
                               " scout views of the series");
    }
    return result;
} catch (const std::bad_alloc&) {
    return fail(ErrorKind::io, "there is not enough memory for the volume", path.string());
}

}  // namespace haustra::dicom
