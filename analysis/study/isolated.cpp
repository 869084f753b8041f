#include "analysis/study/isolated.h"

#include "analysis/study/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <sys/wait.h>
#include <unistd.h>

namespace analysis {
namespace {

constexpr timespec nap{0, 5'000'000}; // 5 ms

} // namespace

Ended run_isolated(const std::function<int()>& work, const std::atomic<bool>& stop) {
    std::fflush(nullptr); // or both would write what is waiting
    const pid_t child = fork();
    if (child < 0)
        throw StudyError(fmt::format("no process can be made ({}); end others", std::strerror(errno)));
    if (child == 0) {
        const int code = work();
        std::fflush(nullptr);
        _exit(code);
    }
    int status = 0;
    bool asked = false;
    for (;;) {
        const pid_t ended = waitpid(child, &status, WNOHANG);
        if (ended == child)
            break;
        if (ended < 0 && errno != EINTR)
            throw StudyError(fmt::format("a process cannot be waited for ({})", std::strerror(errno)));
        if (stop.load() && !asked) {
            asked = true;
            kill(child, SIGTERM);
        }
        nanosleep(&nap, nullptr);
    }
    Ended out;
    if (WIFSIGNALED(status))
        out.signal = strsignal(WTERMSIG(status));
    else
        out.code = WEXITSTATUS(status);
    return out;
}

} // namespace analysis
