// How far long work is, for a person at a terminal or for a log.
#pragma once

#include <chrono>
#include <string>

namespace haustra::cli {

/// On a terminal one line that is redrawn, with the stage, a bar and the time left in this stage;
/// elsewhere one line for each stage that begins. Writes to stderr. Belongs to one thread.
class ProgressBar {
public:
    ProgressBar();
    ~ProgressBar();
    ProgressBar(const ProgressBar&) = delete;
    ProgressBar& operator=(const ProgressBar&) = delete;

    void show(const std::string& stage, double fraction);
    /// A line that stays, above the bar.
    void say(const std::string& line);

private:
    using Clock = std::chrono::steady_clock;
    void clear();

    bool terminal_;
    bool drawn_ = false;
    std::string stage_;
    Clock::time_point stageStart_, lastDrawn_;
};

}  // namespace haustra::cli
