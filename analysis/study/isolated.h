// Work in a process of its own: whatever it does to its memory, and if it crashes, the caller goes on.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace analysis {

struct Ended {
    int code = 0;       // exit code, where no signal ended it
    std::string signal; // that ended it: "Segmentation fault"; or empty
};

/// Work that is done beside this process: several at a time make use of several processors.
class Isolated {
public:
    /// Runs `work` in a copy of this process, which must have no other threads. The copy ends with the number
    /// that `work` returns, without running destructors of what it copied; where this process ends first, the
    /// copy is asked to end. Throws StudyError where no process can be made.
    explicit Isolated(const std::function<int()>& work);
    /// Whether the copy has ended, and then how. Does not wait; not to be asked again once it has. Throws
    /// StudyError.
    bool has_ended(Ended& how);
    /// Asks the copy to end (SIGTERM), as by a terminal that has told both; only once.
    void ask_to_end();
    pid_t process() const { return child_; }

private:
    pid_t child_;
    bool asked_ = false;
};

/// Waits for the first of some children of this process to end, and takes no processor time for it.
class ChildrenEnd {
public:
    explicit ChildrenEnd(const std::vector<pid_t>& children);
    ~ChildrenEnd();
    ChildrenEnd(const ChildrenEnd&) = delete;
    ChildrenEnd& operator=(const ChildrenEnd&) = delete;

    /// Until one has ended, a signal has come, or so many milliseconds have passed. Where the system cannot
    /// tell, a few milliseconds.
    void wait(int most_ms) const;

private:
    std::vector<int> files_; // of children, by pidfd_open(2)
    bool all_ = true;        // have one
};

} // namespace analysis
