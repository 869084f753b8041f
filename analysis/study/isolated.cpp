#include "analysis/study/isolated.h"

#include "analysis/study/error.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <poll.h>
#include <sys/prctl.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace analysis {

Isolated::Isolated(const std::function<int()>& work) {
    std::fflush(nullptr); // or both would write what is waiting
    const pid_t parent = getpid();
    child_ = fork();
    if (child_ < 0)
        throw StudyError(fmt::format("no process can be made ({}); end others", std::strerror(errno)));
    if (child_ != 0)
        return;
    // Who kills the parent means the work too, and another may begin it anew.
    prctl(PR_SET_PDEATHSIG, SIGTERM);
    if (getppid() != parent)
        _exit(128 + SIGTERM);
    const int code = work();
    std::fflush(nullptr);
    _exit(code);
}

bool Isolated::has_ended(Ended& how) {
    int status = 0;
    const pid_t ended = waitpid(child_, &status, WNOHANG);
    if (ended < 0 && errno != EINTR)
        throw StudyError(fmt::format("a process cannot be waited for ({})", std::strerror(errno)));
    if (ended != child_)
        return false;
    if (WIFSIGNALED(status))
        how.signal = strsignal(WTERMSIG(status));
    else
        how.code = WEXITSTATUS(status);
    return true;
}

void Isolated::ask_to_end() {
    if (!asked_)
        kill(child_, SIGTERM);
    asked_ = true;
}

ChildrenEnd::ChildrenEnd(const std::vector<pid_t>& children) {
    for (const pid_t child : children) {
        // By its number: older C libraries lack the function.
        const long file = ::syscall(SYS_pidfd_open, child, 0);
        if (file < 0)
            all_ = false;
        else
            files_.push_back(static_cast<int>(file));
    }
}

ChildrenEnd::~ChildrenEnd() {
    for (const int file : files_)
        ::close(file);
}

void ChildrenEnd::wait(int most_ms) const {
    constexpr int nap_ms = 3;
    std::vector<pollfd> polled;
    for (const int file : files_)
        polled.push_back({file, POLLIN, 0});
    ::poll(polled.data(), polled.size(), all_ ? most_ms : std::min(most_ms, nap_ms));
}

} // namespace analysis
