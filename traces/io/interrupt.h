// Whether somebody has asked the program to end. Who reads or writes looks, and so does other long work.
#pragma once

#include <csignal>
#include <cstddef>
#include <initializer_list>

namespace traces {

inline volatile std::sig_atomic_t interrupt_signal = 0;

/// Calls that wait for a file, a pipe or a terminal end with EINTR.
inline void listen_for_interrupts() {
    struct sigaction action {};
    action.sa_handler = [](int) { interrupt_signal = 1; };
    for (const int signal : {SIGINT, SIGTERM})
        sigaction(signal, &action, nullptr);
}
inline bool interrupted() {
    return interrupt_signal != 0;
}

/// Thrown where work ends early.
struct Interrupted {};
inline void check_interrupts() {
    if (interrupted())
        throw Interrupted();
}

/// The same at some of many steps, by their numbers: the others cost nothing.
inline void check_interrupts(std::size_t step) {
    if (step % 256 == 0)
        check_interrupts();
}

} // namespace traces
