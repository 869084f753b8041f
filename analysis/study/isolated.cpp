#include "analysis/study/isolated.h"

#include "analysis/study/error.h"

#include <fmt/format.h>

#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <sys/prctl.h>
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

} // namespace analysis
