// Which lines of a frame's memory tracing packets touches: the simulated kernels trace them on the host, and
// the timing port notes what they load and store. Packets, their steps and hits are those of the native
// kernels, whose vectors are as long.
#pragma once

#include "razor/frame/ray_kinds.h"
#include "razor/survey/survey.h"

#include <array>
#include <cstdint>
#include <unordered_set>

namespace razor {

/// Lines of memory, each once.
class LineSet {
public:
    void add(const void* p, std::uint32_t bytes);
    void clear();
    /// By address / 64.
    const std::unordered_set<std::uintptr_t>& lines() const { return lines_; }

private:
    /// Lines seen lately, one for each value of their lowest bits: most references are to these.
    static constexpr std::size_t recent_lines = 4096;

    std::unordered_set<std::uintptr_t> lines_;
    std::array<std::uintptr_t, recent_lines> recent_{};
};

/// Of one thread at a time.
class TouchedLines {
public:
    /// A TouchMeter: what loads and stores of a ray kind's tracing touch, not what comes before (the kernel's
    /// call) or after (opacity of what textures cut out). Lines of scratch memory are among them.
    TouchedBytes measure(Frame& frame, const SeeArguments& packet);

    // By the port, in the thread that measures.
    void note(const void* p, std::uint32_t bytes) {
        if (kind != kind_none)
            lines_.add(p, bytes);
    }
    std::int32_t kind = kind_none;

private:
    LineSet lines_;
};

/// The one that this thread measures with; null else.
extern constinit thread_local TouchedLines* measured_lines;

} // namespace razor
