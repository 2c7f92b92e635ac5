#include "cli/progress_bar.h"

#include <algorithm>
#include <cstdio>

#include <unistd.h>

namespace haustra::cli {
namespace {

std::string timeText(double seconds) {
    const int whole = int(seconds + 0.5);
    if (whole < 60) return std::to_string(whole) + " s";
    return std::to_string(whole / 60) + " min " + std::to_string(whole % 60) + " s";
}

}  // namespace

ProgressBar::ProgressBar() : terminal_(::isatty(STDERR_FILENO)) {}

ProgressBar::~ProgressBar() {
    clear();
}

void ProgressBar::clear() {
    if (drawn_) std::fputs("\r\033[K", stderr);
    drawn_ = false;
}

void ProgressBar::say(const std::string& line) {
    clear();
    std::fprintf(stderr, "%s\n", line.c_str());
}

void ProgressBar::show(const std::string& stage, double fraction) {
    const auto now = Clock::now();
    const bool begins = stage != stage_;
    if (begins) {
        stage_ = stage;
        stageStart_ = now;
        if (!terminal_ && fraction < 1.0) say(stage + " ...");
    }
    if (!terminal_ || (!begins && now - lastDrawn_ < std::chrono::milliseconds(100))) return;
    lastDrawn_ = now;

    constexpr int width = 30;
    const int filled = int(std::clamp(fraction, 0.0, 1.0) * width);
    const double elapsed = std::chrono::duration<double>(now - stageStart_).count();
    // A guess from the first few percent would jump about.
    const std::string left =
        fraction > 0.03 ? timeText(elapsed / fraction * (1.0 - fraction)) + " left" : "";
    std::fprintf(stderr, "\r\033[K%-12s [%s%s] %3d %%  %s", stage.c_str(),
                 std::string(filled, '#').c_str(), std::string(width - filled, ' ').c_str(),
                 int(100 * fraction), left.c_str());
    std::fflush(stderr);
    drawn_ = true;
}

}  // namespace haustra::cli
