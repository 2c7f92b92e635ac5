#include "dicom/series_selection.h"

#include "core/files_below.h"

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <optional>
#include <set>
#include <thread>
#include <utility>

namespace haustra::dicom {
namespace {

namespace fs = std::filesystem;

constexpr int fewestSlicesOfAVolume = 16;

std::string line(const SeriesSummary& series) {
    return series.seriesUid + " (" + std::to_string(series.images) + " images of " +
           std::to_string(series.matrix.x) + "x" + std::to_string(series.matrix.y) + ", " +
           toString(series.position) +
           (series.description.empty() ? "" : ", \"" + series.description + "\"") + ")";
}

/// Scout views leave a series that has other images.
void dropLocalizers(Series& series) {
    auto isScout = [](const ImageHeader& image) { return image.localizer; };
    const auto scouts = std::count_if(series.images.begin(), series.images.end(), isScout);
    series.localizers = int(scouts);
    std::erase_if(series.images, isScout);
}

void summarise(Series& series) {
    SeriesSummary& summary = series.summary;
    summary.images = 0;
    for (const ImageHeader& image : series.images)
        summary.images += int(image.frames.size());
    if (series.images.empty()) return;
    const ImageHeader& first = series.images.front();
    summary.studyUid = first.studyUid;
    summary.description = first.description;
    summary.matrix = first.matrix;
    summary.position = PatientPosition::unknown;
    for (const ImageHeader& image : series.images)
        if (summary.position == PatientPosition::unknown) summary.position = image.position;
}

/// A file's ending; none where it is a number, as of a file that is named by its UID.
std::string endingOf(const fs::path& file) {
    const std::string ending = file.extension().string();
    return ending.find_first_not_of(".0123456789") == std::string::npos ? std::string() : ending;
}

bool holdsNothing(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::array<char, 4096> head{};
    in.read(head.data(), head.size());
    return std::ranges::all_of(head, [](char byte) { return byte == 0; });
}

/// The first of some files that are no DICOM that is named as the series' files beside it are, so
/// that it may have been one: of their ending, or, where they have none, empty or of zeros.
std::optional<fs::path> lostFileOf(const Series& series, const std::vector<fs::path>& strangers) {
    std::set<std::pair<fs::path, std::string>> named;  // folders, and endings in them
    for (const ImageHeader& image : series.images)
        named.emplace(image.file.parent_path(), endingOf(image.file));
    for (const fs::path& stranger : strangers) {
        if (stranger.filename().string().starts_with('.')) continue;  // another program's
        const std::string ending = endingOf(stranger);
        if (named.contains({stranger.parent_path(), ending}) &&
            (!ending.empty() || holdsNothing(stranger)))
            return stranger;
    }
    return std::nullopt;
}

/// Fails where a file of the series may be lost, or images are not of one examination.
Result<void> checkWhole(const Series& series, const std::vector<fs::path>& strangers) {
    if (const auto lost = lostFileOf(series, strangers))
        return fail(ErrorKind::badInput,
                    "this is not a DICOM file, though it is named as those of the series beside it "
                    "are: it may be a slice that has lost its content",
                    lost->string());
    const ImageHeader& first = series.images.front();
    const auto another = [](const char* what, const ImageHeader& image, const ImageHeader& than) {
        return fail(ErrorKind::badInput,
                    std::string("it is of the series, but of another ") + what + " than " +
                        than.file.string(),
                    image.file.string());
    };
    const ImageHeader* placed = nullptr;  // whose position is known
    for (const ImageHeader& image : series.images) {
        if (!image.studyUid.empty() && !first.studyUid.empty() && image.studyUid != first.studyUid)
            return another("study", image, first);
        if (image.position == PatientPosition::unknown) continue;
        if (placed && image.position != placed->position)
            return another("patient position", image, *placed);
        if (!placed) placed = &image;
    }
    return {};
}

/// What a reader should know of a series that is read all the same.
std::vector<std::string> notesOn(const Series& series) {
    std::vector<std::string> notes;
    std::set<std::string> frames;
    for (const ImageHeader& image : series.images)
        frames.insert(image.frameOfReferenceUid);
    if (frames.size() > 1)
        notes.push_back("warning: the images name " + std::to_string(frames.size()) +
                        " frames of reference, and were taken to lie in one");
    const auto lossy = std::ranges::count_if(series.images, &ImageHeader::isLossy);
    if (lossy > 0)
        notes.push_back("the pixels of " + std::to_string(lossy) +
                        " images were compressed with loss");
    return notes;
}

}  // namespace

Result<FoundSeries> findSeries(const fs::path& path, int threads, const Progress& progress) {
    const auto files = TRY(filesBelow(path));
    std::vector<DicomFile> read(files.size());
    const std::thread::id caller = std::this_thread::get_id();
    parallelFor(files.size(), 4, threads, [&](std::size_t begin, std::size_t end) {
        for (std::size_t n = begin; n < end; ++n)
            read[n] = readHeader(files[n]);
        if (progress && std::this_thread::get_id() == caller)
            progress(double(end) / double(files.size()));
    });

    FoundSeries found;
    std::map<std::string, Series> byUid;
    for (DicomFile& file : read) {
        const std::string& uid = file.image.seriesUid;
        switch (file.kind) {
            case DicomFile::Kind::ctImage:
                byUid[uid].images.push_back(std::move(file.image));
                break;
            case DicomFile::Kind::damaged:
                (uid.empty() ? found.damaged : byUid[uid].damaged)
                    .push_back(std::move(file.reason));
                break;
            case DicomFile::Kind::otherObject:
                found.others.push_back(std::move(file.reason));
                break;
            case DicomFile::Kind::notDicom:
                if (files.size() == 1)
                    found.others.push_back(std::move(file.reason));
                else
                    found.strangers.emplace_back(file.reason.place);
                break;
        }
    }
    for (auto& [uid, series] : byUid) {
        series.summary.seriesUid = uid;
        dropLocalizers(series);
        summarise(series);
        found.series.push_back(std::move(series));
    }
    return found;
}

Result<Series> chooseSeries(FoundSeries found, const std::string& seriesUid, const fs::path& path) {
    std::vector<Series*> candidates;
    for (Series& series : found.series) {
        const bool holds = !series.images.empty() || !series.damaged.empty();
        if (seriesUid.empty() ? holds : series.summary.seriesUid == seriesUid)
            candidates.push_back(&series);
    }
    const bool anyImage = std::any_of(candidates.begin(), candidates.end(),
                                      [](Series* s) { return !s->images.empty(); });
    if (anyImage) std::erase_if(candidates, [](Series* s) { return s->images.empty(); });
    if (candidates.size() > 1) {
        std::vector<Series*> volumes;
        std::copy_if(candidates.begin(), candidates.end(), std::back_inserter(volumes),
                     [](Series* s) { return s->summary.images >= fewestSlicesOfAVolume; });
        if (volumes.size() == 1) candidates = volumes;
    }
    if (candidates.size() > 1) {
        std::string message = "there are " + std::to_string(candidates.size()) +
                              " CT series here; choose one by its UID (--series): ";
        for (std::size_t n = 0; n < candidates.size(); ++n)
            message += (n ? "; " : "") + line(candidates[n]->summary);
        return fail(ErrorKind::badInput, std::move(message), path.string());
    }
    if (candidates.empty()) {
        if (!found.damaged.empty()) return tl::make_unexpected(found.damaged.front());
        if (!seriesUid.empty())
            return fail(ErrorKind::notFound, "there is no CT series " + seriesUid, path.string());
        if (!found.others.empty()) {
            if (found.others.front().place == path.string())
                return tl::make_unexpected(found.others.front());
            return fail(ErrorKind::noResult,
                        "there is no CT image here; " + describe(found.others.front()),
                        path.string());
        }
        return fail(ErrorKind::noResult,
                    found.series.empty() ? "there is no DICOM file here"
                                         : "there are only scout views here",
                    path.string());
    }
    Series& chosen = *candidates.front();
    if (!chosen.damaged.empty()) return tl::make_unexpected(chosen.damaged.front());
    // It may be a slice of this series: a volume that lacks its end must not pass unnoticed.
    if (!found.damaged.empty()) return tl::make_unexpected(found.damaged.front());
    if (chosen.images.empty())
        return fail(ErrorKind::noResult, "the series holds only scout views", path.string());
    TRY(checkWhole(chosen, found.strangers));
    chosen.notes = notesOn(chosen);
    return std::move(chosen);
}

}  // namespace haustra::dicom
