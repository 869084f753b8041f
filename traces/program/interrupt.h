// Whether somebody has asked the program to end.
#pragma once

#include <csignal>

namespace traces {

inline volatile std::sig_atomic_t interrupt_signal = 0;

inline void listen_for_interrupts() {
    for (const int signal : {SIGINT, SIGTERM})
        std::signal(signal, [](int) { interrupt_signal = 1; });
}
inline bool interrupted() {
    return interrupt_signal != 0;
}

/// Thrown where work ends early.
struct Interrupted {};

} // namespace traces
