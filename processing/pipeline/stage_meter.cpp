#include "pipeline/stage_meter.h"

#include <fstream>
#include <string>

namespace haustra::pipeline {

StageMeter::StageMeter() : start_(std::chrono::steady_clock::now()) {
    std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets VmHWM
}

double StageMeter::wallSeconds() const {
    return besideSeconds_ +
           std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double StageMeter::peakMemoryMib() const {
    std::ifstream status("/proc/self/status");
    for (std::string field; status >> field;) {
        double kib = 0.0;
        if (field == "VmHWM:" && status >> kib) return kib / 1024.0;
    }
    return 0.0;
}

}  // namespace haustra::pipeline
