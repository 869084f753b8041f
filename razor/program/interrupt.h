// Ctrl-C (and termination): rendering stops, and no output is left half-written.
#pragma once

#include <atomic>

namespace razor {

/// Makes SIGINT and SIGTERM set the flag that is returned. A second signal ends the process at once, except
/// while an OutputGuard lives.
std::atomic<bool>& watch_interrupts();

/// While one lives, output is being written and a second signal does not end the process.
class OutputGuard {
public:
    OutputGuard();
    ~OutputGuard();
    OutputGuard(const OutputGuard&) = delete;
    OutputGuard& operator=(const OutputGuard&) = delete;
};

/// The exit code of an interrupted program.
inline constexpr int interrupted_exit = 130;

} // namespace razor
