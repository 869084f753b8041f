#include "razor/program/interrupt.h"

#include <csignal>
#include <unistd.h>

namespace razor {
namespace {

std::atomic<bool> interrupted{false};
std::atomic<bool> writing{false};
static_assert(std::atomic<bool>::is_always_lock_free, "signal handlers may touch lock-free atomics only");

extern "C" void on_signal(int /*number*/) {
    if (interrupted.exchange(true) && !writing.load()) {
        ::_exit(interrupted_exit);
    }
}

} // namespace

std::atomic<bool>& watch_interrupts() {
    struct sigaction action {};
    action.sa_handler = on_signal;
    action.sa_flags = SA_RESTART;
    ::sigaction(SIGINT, &action, nullptr);
    ::sigaction(SIGTERM, &action, nullptr);
    return interrupted;
}

OutputGuard::OutputGuard() {
    writing = true;
}
OutputGuard::~OutputGuard() {
    writing = false;
}

} // namespace razor
