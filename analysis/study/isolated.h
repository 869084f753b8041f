// Work in a process of its own: whatever it does to its memory, and if it crashes, the caller goes on.
#pragma once

#include <atomic>
#include <functional>
#include <string>

namespace analysis {

struct Ended {
    int code = 0;       // exit code, where no signal ended it
    std::string signal; // that ended it: "Segmentation fault"; or empty
};

/// Runs `work` in a copy of this process, which must have no other threads, and waits for it. The copy ends
/// with the number that `work` returns, without running destructors of what it copied. Where `stop` becomes
/// true the copy is asked to end (SIGTERM), as by a terminal that has told both. Throws StudyError where no
/// process can be made.
Ended run_isolated(const std::function<int()>& work, const std::atomic<bool>& stop);

} // namespace analysis
