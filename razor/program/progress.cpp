#include "razor/program/progress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <unistd.h>

namespace razor {

Progress::Progress(bool wanted, const char* doing)
    : shown_(wanted && ::isatty(STDERR_FILENO) == 1), doing_(doing) {}

Progress::~Progress() {
    if (shown_ && percent_ >= 0) {
        fmt::print(stderr, "\r\x1b[K");
    }
}

void Progress::show(double fraction) {
    const int percent = static_cast<int>(100 * std::clamp(fraction, 0.0, 1.0));
    if (shown_ && percent_.exchange(percent) != percent) {
        fmt::print(stderr, "\r{} {:3} %", doing_, percent);
    }
}

} // namespace razor
