// A line of progress on a terminal; nothing in a pipe.
#pragma once

#include <atomic>

namespace razor {

class Progress {
public:
    /// Shows nothing unless `wanted` and the error stream is a terminal.
    explicit Progress(bool wanted, const char* doing = "rendering");
    /// Clears the line.
    ~Progress();
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;

    bool shown() const { return shown_; }
    /// Shows how much is done, in [0, 1]; from any thread.
    void show(double fraction);

private:
    bool shown_;
    const char* doing_;
    std::atomic<int> percent_{-1};
};

} // namespace razor
