// Progress of a long run, on a terminal; nothing in a pipe.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <cstdio>
#include <unistd.h>

namespace traces {

class Progress {
public:
    void add(std::size_t references) {
        references_ += references;
        if (on_ && references_ - shown_ >= 4000000) {
            shown_ = references_;
            fmt::print(stderr, "\r{} million references ", references_ / 1000000);
        }
    }
    Progress() = default;
    Progress(const Progress&) = delete;
    Progress& operator=(const Progress&) = delete;
    ~Progress() {
        if (on_ && shown_ != 0)
            fmt::print(stderr, "\r\x1b[K");
    }

private:
    bool on_ = isatty(STDERR_FILENO) != 0;
    std::uint64_t references_ = 0, shown_ = 0;
};

} // namespace traces
