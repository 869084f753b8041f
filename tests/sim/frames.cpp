// Several frames in one run: the last one counts alone, or its second part, and finds what the others left.
#include "sim/machine/intervals.h"
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <cstdlib>

namespace sim::test {
namespace {

Report run_frames(const Config& c, int frames, const std::function<void(std::byte*, int)>& worker,
                  int workers = 1, int host_threads = 1, std::uint64_t interval = 0, bool split = false) {
    Memory memory;
    RunOptions options;
    options.frames = frames;
    options.interval = interval;
    if (split)
        options.next_part = [] {};
    return Machine(c).run(
        memory.space, workers, {{"work"}}, [&](int w) { worker(memory.data, w); }, host_threads, options);
}

constexpr int lines = 32;
void chase(std::byte* p, int) {
    stamp s;
    for (int i = 0; i < lines; ++i)
        s = load(here, p + i * 64, 4, s);
}

// A chain of loads: from memory in the first frame, from the L1 in the second.
TEST(Frames, TheSecondFindsItsLines) {
    const Config c = simple();
    const Report cold = run_frames(c, 1, chase), warm = run_frames(c, 2, chase),
                 third = run_frames(c, 3, chase);
    EXPECT_EQ(cold.warm_up, 0U);
    EXPECT_EQ(cold.l1_total().misses, u(lines));
    EXPECT_EQ(cold.memory.reads, u(lines));
    EXPECT_GE(warm.warm_up, cold.cycles);
    EXPECT_LT(warm.warm_up, cold.drained + warm.window) << "the second begins with the next window";
    for (const Report* r : {&warm, &third}) {
        EXPECT_EQ(r->cycles, u(lines * c.l1.latency));
        EXPECT_EQ(r->core.loads, u(lines));
        EXPECT_EQ(r->l1_total().hits, u(lines));
        EXPECT_EQ(r->l1_total().misses, 0U);
        EXPECT_EQ(r->l2_total().reads, 0U);
        EXPECT_EQ(r->memory.reads, 0U);
        EXPECT_EQ(cause(*r, Cause::memory), 0U);
        EXPECT_EQ(r->touched.at(0).lines, u(lines));
    }
    EXPECT_EQ(cold.all_vops, u(lines));
    EXPECT_EQ(third.all_vops, u(3 * lines));
}

// Work that leaves nothing behind takes the same time in every frame.
TEST(Frames, WithoutMemoryAllAreEqual) {
    for (integer latency : {1, 5}) {
        Config c = simple();
        c.latency[static_cast<std::size_t>(operation::add)] = latency;
        const auto chain = [](std::byte*, int) {
            stamp s;
            for (int i = 0; i < 1000; ++i)
                s = scalar_op(operation::add, s);
        };
        for (int frames : {1, 2, 4}) {
            const Report r = run_frames(c, frames, chain);
            EXPECT_EQ(r.cycles, u(1000 * latency));
            EXPECT_EQ(r.drained, r.cycles);
            EXPECT_EQ(cause(r, Cause::busy), 1000U);
        }
    }
}

// What a frame leaves dirty is written in its own time if it outlives the frame.
TEST(Frames, EachWritesWhatItLeaves) {
    for (int frames : {1, 2, 3}) {
        isa::address_space space{std::uint64_t{1} << 26};
        std::byte* film = space.add("film", -1, std::uint64_t{1} << 20, false);
        std::byte* scratch = space.add("scratch", -1, std::uint64_t{1} << 20, true);
        RunOptions options;
        options.frames = frames;
        std::vector<int> before;
        options.next_frame = [&](int n) { before.push_back(n); };
        const Report r = Machine(simple()).run(
            space, 1, {{"work"}},
            [&](int) {
                for (int i = 0; i < lines; ++i) {
                    store(here, film + i * 64, 4, stamp{}, stamp{});
                    store(here, scratch + i * 64, 4, stamp{}, stamp{});
                }
            },
            1, options);
        EXPECT_EQ(r.memory.writes, u(lines));
        EXPECT_EQ(r.l1_total().dropped + r.l2_total().dropped, u(lines));
        EXPECT_EQ(r.memory.reads, frames == 1 ? u(2 * lines) : 0U);
        EXPECT_EQ(r.memory.write_bursts + r.memory.merged, u(lines)) << "none of an earlier frame's";
        EXPECT_EQ(before, frames == 1   ? std::vector<int>{}
                          : frames == 2 ? std::vector{1}
                                        : std::vector({1, 2}));
    }
}

// What was prefetched before a part counts was useless to what came before it, whoever uses it then.
TEST(Frames, APartCountsItsOwnPrefetches) {
    Config c = simple();
    c.l1.prefetcher = "next";
    c.l1.prefetch_degree = 1;
    int parts = 0;
    Memory memory;
    RunOptions options;
    options.next_part = [&] { ++parts; };
    const Report r = Machine(c).run(
        memory.space, 1, {{"work"}}, [&](int) { load(here, memory.data + parts * 64, 4, stamp{}); }, 1,
        options);
    EXPECT_EQ(r.l1_total().hits, 1U) << "the line is there";
    EXPECT_EQ(r.l1_total().prefetches_useful, 0U);
    EXPECT_EQ(r.l1_total().prefetches, r.l1_total().prefetches_useless);
}

// A second part of a frame finds the first one's lines as they were left, and what nobody has written back
// is written when the frame ends.
TEST(Frames, APartGoesOnWithDirtyLines) {
    for (int frames : {1, 2}) {
        isa::address_space space{std::uint64_t{1} << 26};
        std::byte* film = space.add("film", -1, std::uint64_t{1} << 20, false);
        std::byte* scratch = space.add("scratch", -1, std::uint64_t{1} << 20, true);
        RunOptions options;
        options.frames = frames;
        std::vector<int> before;
        options.next_frame = [&](int n) { before.push_back(n); };
        options.next_part = [&] { before.push_back(-1); };
        const Report r = Machine(simple()).run(
            space, 1, {{"work"}},
            [&](int) {
                const bool second = !before.empty() && before.back() < 0;
                for (int i = 0; i < lines; ++i) {
                    if (second) {
                        load(here, film + i * 64, 4, stamp{});
                    } else {
                        store(here, film + i * 64, 4, stamp{}, stamp{});
                        store(here, scratch + i * 64, 4, stamp{}, stamp{});
                    }
                }
            },
            1, options);
        EXPECT_EQ(before, frames == 1 ? std::vector{-1} : std::vector({1, -1}));
        EXPECT_EQ(r.core.loads, u(lines));
        EXPECT_EQ(r.core.stores, 0U);
        EXPECT_EQ(r.l1_total().hits, u(lines));
        EXPECT_EQ(r.memory.reads, 0U);
        EXPECT_EQ(r.memory.writes, u(lines)) << "at the frame's end";
        EXPECT_EQ(r.l1_total().dropped + r.l2_total().dropped, u(lines));
        EXPECT_EQ(r.all_vops, u((2 * frames + 1) * lines));
    }
}

Config everything() {
    Config c;
    c.chip.tiles = 3;
    c.chip.cores = 2;
    c.core.issue_width = 2;
    c.core.pairing = "any | any";
    c.core.shared_classes = "divide";
    c.core.store_buffer = 4;
    c.l1.size_bytes = 2048;
    c.l1.prefetcher = "next";
    c.l2.size_bytes = 16384;
    c.memory.preset = "ddr4-2400r-2r";
    c.memory.ranks = 2;
    c.sim.jitter = 3;
    c.sim.miss_causes = "on";
    return c;
}
Report mixed(const Config& c, int frames, int host_threads, std::uint64_t interval, bool split = false) {
    return run_frames(
        c, frames,
        [](std::byte* p, int w) {
            mixed_work(reinterpret_cast<std::int32_t*>(p + (1 << 20)), reinterpret_cast<word*>(p), w,
                       40 + 10 * w);
        },
        12, host_threads, interval, split);
}

// All laws hold on what counts (each run checks them), with every feature on.
TEST(Frames, LawsHoldOnTheLast) {
    for (integer window : {0, 3000})
        for (integer quantum : {1, 100}) {
            Config c = everything();
            c.sim.window = window;
            c.sim.quantum = quantum;
            const Report cold = mixed(c, 1, 1, 2000);
            for (int parts : {2, 5, -1, -2}) { // frames; or frames of which the last is split
                const Report r = mixed(c, std::abs(parts), 1, 2000, parts < 0);
                EXPECT_GT(r.warm_up, 0U);
                EXPECT_EQ(r.intervals.front().begin, 0U);
                EXPECT_GT(r.intervals.size(), 3U);
                EXPECT_LE(r.core.mispredicts, cold.core.mispredicts);
                EXPECT_LT(r.l2_total().compulsory, cold.l2_total().compulsory);
                EXPECT_GT(r.memory.refreshes, 0U);
                Report broken = r;
                ++broken.memory.refreshes;
                ++broken.memory_by_rank[0].refreshes;
                EXPECT_THROW(check_laws(broken), std::logic_error);
            }
        }
}

TEST(Frames, HostThreadsChangeNothing) {
    for (bool split : {false, true}) {
        const Report serial = mixed(everything(), 3, 1, 1000, split);
        for (int host_threads : {2, 3}) {
            const Report r = mixed(everything(), 3, host_threads, 1000, split);
            EXPECT_EQ(print_json(r, false), print_json(serial, false));
            EXPECT_EQ(print_intervals(r), print_intervals(serial));
        }
    }
}

} // namespace
} // namespace sim::test
