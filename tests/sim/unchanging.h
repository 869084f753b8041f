// What no report may depend on: host threads, and windows up to the shortest way to memory and back.
#pragma once

#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

namespace sim::test {

/// A frame memory of shared words in lines of their own, and of plain data.
struct Shared {
    Memory memory;
    word* at(int i) const { return reinterpret_cast<word*>(memory.data) + i * 16; }
    std::int32_t* plain() const { return reinterpret_cast<std::int32_t*>(memory.more); }
    Report run(const Config& c, int workers, const std::function<void(int)>& worker, int host_threads = 1,
               const RunOptions& options = {}) const {
        return Machine(c).run(memory.space, workers, {{"work"}}, worker, host_threads, options);
    }
};

/// Six tiles of two cores, small L2s of their own, windows long enough that a busy host switches in them.
inline Config busy_tiles() {
    Config c;
    c.chip.tiles = 6;
    c.chip.cores = 2;
    c.core.window = 8;
    c.sim.quantum = 1000;
    c.sim.window = 200;
    c.l2.share = "core";
    c.l2.size_bytes = 4096;
    return c;
}
/// 24 workers on them, three by three on the same data and on words shared by all tiles.
inline Report run_busy_tiles(const Config& c, int host_threads, const RunOptions& options = {}) {
    const Shared s;
    return s.run(
        c, 24, [&](int w) { mixed_work(s.plain() + 4096 * (w / 3), s.at(w % 3), w, 10); }, host_threads,
        options);
}

/// report(number of host threads) is the same for 1, 2, 3 and 8.
inline void expect_equal_on_host_threads(const std::function<Report(int)>& report, const std::string& what) {
    const std::string serial = print_json(report(1), false);
    for (const int host_threads : {2, 3, 8})
        EXPECT_EQ(print_json(report(host_threads), false), serial)
            << what << ", " << host_threads << " host threads";
}

/// All but what the machine says of windows, and lines that come while their bank is busy, which may count as
/// in flight or not.
inline std::string print_without_window(Report r) {
    r.window = 0;
    r.config.sim.window = 0;
    for (CacheCounters& l2 : r.l2)
        l2.hits_in_flight = 0;
    return print_json(r, false);
}

/// report(RunOptions::host_order) is the same for several.
inline void expect_equal_in_any_order(const std::function<Report(std::uint32_t)>& report,
                                      const std::string& what) {
    const std::string plain = print_json(report(0), false);
    for (const std::uint32_t order : {1U, 2U, 3U})
        EXPECT_EQ(print_json(report(order), false), plain) << what << ", order " << order;
}

/// report(cycles of a window, 0: the longest) is the same.
inline void expect_equal_in_windows(const std::function<Report(integer)>& report, const std::string& what,
                                    const std::function<std::string(Report)>& print = print_without_window) {
    const std::string longest = print(report(0));
    for (const integer window : {1, 7, 20})
        EXPECT_EQ(print(report(window)), longest) << what << ", window " << window;
}

} // namespace sim::test
