// The reference mode: what lies beyond the tiles in order of time, with the queued controller. First requests
// by hand, in exact cycles (a memory clock is a cycle, no refreshes if not asked for); then whole machines.
#include "sim/machine/beyond.h"
#include "sim/machine/tile.h"
#include "sim/validation/reference_forms.h"
#include "tests/sim/unchanging.h"

#include <fmt/core.h>

#include <map>

namespace sim::test {
namespace {

Config reference(const std::function<void(Config&)>& change = {}) {
    Config c = plain_reference();
    if (change)
        change(c);
    check_consistency(c, "test");
    return c;
}

/// What lies beyond two tiles, without these.
class Bench {
public:
    explicit Bench(const Config& config)
        : config_(config), space_(1 << 26), lines_(space_, 6),
          beyond_(Beyond::make(
              config, [this](std::uint32_t, cycle ticket, const Answer& a) { answers_[ticket] = a.ready; })) {
        for (std::uint32_t t = 0; t < u(config.chip.tiles); ++t)
            tiles_.emplace_back(config_, t, 1000, lines_, 1);
        beyond_->connect(tiles_);
    }
    /// A line read, by the name of its answer; a line written; from tile 0.
    void read(cycle name, std::uint64_t address, cycle t, std::uint32_t tile = 0) {
        send(Request::nothing, address, name, t, tile);
    }
    void write(std::uint64_t address, cycle t) { send(address, Request::nothing, 0, t, 0); }
    void write_then_read(std::uint64_t written, cycle name, std::uint64_t address, cycle t) {
        send(written, address, name, t, 0);
    }
    /// All answers, by name; windows of so many cycles.
    const std::map<cycle, cycle>& answers(cycle window = 20) {
        for (cycle t = window; beyond_->next() != Beyond::everything; t += window)
            beyond_->serve(t);
        beyond_->finish();
        return answers_;
    }
    MemoryCounters counters() const { return beyond_->counters(); }

private:
    void send(std::uint64_t written, std::uint64_t address, cycle name, cycle t, std::uint32_t tile) {
        Request r{};
        r.at = t;
        r.tile = tile;
        r.sequence = ++sequence_;
        r.write = written;
        r.read = address;
        r.ticket = name;
        r.bytes = 64;
        r.whole = true;
        std::vector<Request> one = {r};
        beyond_->accept(one);
    }

    Config config_;
    isa::address_space space_;
    LineMap lines_;
    std::deque<Tile> tiles_;
    std::unique_ptr<Beyond> beyond_;
    std::map<cycle, cycle> answers_;
    std::uint64_t sequence_ = 0;
};

constexpr std::uint64_t line = 64;
/// To the next row of a bank, and to the next bank.
std::uint64_t row(const Config& c) {
    return u(c.memory.row_bytes * c.memory.banks);
}
std::uint64_t bank(const Config& c) {
    return u(c.memory.row_bytes);
}
/// A read from an open row: the way there and back, the command, the data.
cycle hit(const Config& c) {
    return u(c.memory.controller_cycles + c.memory.tCL + c.memory.burst_clocks());
}
cycle empty(const Config& c) {
    return hit(c) + u(c.memory.tRCD);
}

TEST(Reference, OneReadOfAnIdleMemory) {
    const Config c = reference();
    for (const cycle window :
         {1U, 7U, 20U, 1000U}) { // its answer is decided windows later than it is asked for
        Bench b(c);
        b.read(1, 0, 3);
        EXPECT_EQ(b.answers(window).at(1), 3 + empty(c));
    }
}

TEST(Reference, CyclesAndClocksOfTheirOwn) {
    const Config c = reference([](Config& m) { m.chip.clock_ps = 400, m.memory.clock_ps = 1250; });
    Bench b(c);
    b.read(1, 0, 3);
    // 3 + 5 cycles to the controller: 3200 ps, the clock that begins at 3750; the data end there + 11 + 11 +
    // 4 clocks, at 36250 ps, 91 cycles; 5 cycles back.
    ASSERT_EQ(c.memory.controller_cycles, 10);
    ASSERT_EQ(c.memory.tRCD + c.memory.tCL + c.memory.burst_clocks(), 26);
    EXPECT_EQ(b.answers().at(1), 96U);
}

TEST(Reference, RowHitsAtTheRateOfTheBus) {
    const Config c = reference([](Config& m) { m.l2.mshrs = 64, m.memory.read_queue = 64; });
    Bench b(c);
    for (cycle i = 0; i < 64; ++i)
        b.read(i, i * line, i);
    for (const auto& [i, ready] : b.answers())
        EXPECT_EQ(ready, empty(c) + i * u(c.memory.burst_clocks())) << i;
    EXPECT_EQ(b.counters().row_hits, 63U);
}

TEST(Reference, AnOpenRowGoesFirst) {
    Config c = reference();
    for (const char* scheduler : {"fr-fcfs", "fcfs"}) {
        c.memory.scheduler = scheduler;
        Bench b(c);
        b.read(1, 0, 0);
        b.read(2, row(c), 1);
        b.read(3, line, 2);
        const auto& ready = b.answers();
        EXPECT_EQ(ready.at(3) < ready.at(2), c.memory.scheduler == "fr-fcfs");
        EXPECT_EQ(b.counters().row_conflicts, c.memory.scheduler == "fr-fcfs" ? 1U : 2U);
    }
}

TEST(Reference, AnMshrIsHeldUntilTheDataAreThere) {
    const Config c = reference([](Config& m) { m.l2.mshrs = 1; });
    Bench b(c);
    for (cycle i = 0; i < 3; ++i)
        b.read(i, i * line, i);
    const auto& ready = b.answers();
    EXPECT_EQ(ready.at(0), empty(c));
    EXPECT_EQ(ready.at(1), ready.at(0) + hit(c));
    EXPECT_EQ(ready.at(2), ready.at(1) + hit(c));
}

// The first that is free, also where the answer of another is decided later.
TEST(Reference, WhoWaitsForAnMshrGetsTheFirst) {
    const Config c = reference([](Config& m) { m.l2.mshrs = 2; });
    Bench b(c);
    b.read(0, 0, 0);
    b.read(1, row(c), 1); // waits for the other row
    b.read(2, bank(c), 2);
    const auto& ready = b.answers();
    EXPECT_EQ(ready.at(0), empty(c));
    EXPECT_GT(ready.at(1), ready.at(0) + u(c.memory.tRP));
    EXPECT_EQ(ready.at(2), ready.at(0) + empty(c));
}

TEST(Reference, AFullReadQueueDelays) {
    for (integer places : {1, 2}) {
        const Config c = reference([&](Config& m) { m.memory.read_queue = places; });
        Bench b(c);
        b.read(1, 0, 0);
        b.read(2, bank(c), 1);
        // The first's column command leaves the queue tRCD after it came; in the next cycle the second comes.
        const cycle comes = places == 1 ? u(c.memory.tRCD) + 1 : 0;
        const cycle opens = places == 1 ? comes : std::max<cycle>(1, u(c.memory.tRRD_S));
        EXPECT_EQ(b.answers().at(1), empty(c));
        EXPECT_EQ(b.answers().at(2), opens + empty(c));
        EXPECT_EQ(b.counters().read_wait_clocks, places == 1 ? comes - 1 : 0);
    }
}

TEST(Reference, AWriteDrainDelaysReads) {
    for (integer high : {1, 2}) { // the second: one write is not enough for a batch
        const Config c =
            reference([&](Config& m) { m.memory.write_high = high, m.memory.write_low = high - 1; });
        Bench b(c);
        b.write(0, 0);
        b.read(1, bank(c), 1);
        const MemoryConfig& m = c.memory;
        const cycle written = u(m.tRCD), turned = written + u(m.tCWL + m.burst_clocks() + m.tWTR_S);
        const cycle column = high == 1 ? std::max(written + 1 + u(m.tRCD), turned) : 1 + u(m.tRCD);
        EXPECT_EQ(b.answers().at(1), column + hit(c)) << high;
        EXPECT_EQ(b.counters().turnarounds, 1U); // the other way round where the write comes last
        EXPECT_EQ(b.counters().write_bursts, 1U);
    }
}

TEST(Reference, AFullWriteQueueHoldsTheBuffer) {
    for (integer buffers : {1, 2}) {
        const Config c = reference([&](Config& m) {
            m.memory.write_queue = m.memory.write_high = 1, m.memory.write_low = 0;
            m.l2.write_back_buffer = buffers;
        });
        Bench b(c);
        b.write(0, 0);
        b.write(line, 0);
        b.write_then_read(2 * line, 1, bank(c), 0);
        // The first is with the controller, and its buffer free, after the way there; its column command
        // leaves the queue tRCD after it came. With two buffers the second waits for that from its beginning
        // on, and the third, from when the first's buffer is free, for the second's. With one the second
        // waits for the buffer before, and the third until that has left the queue as well.
        const MemoryConfig& m = c.memory;
        const cycle there = u(m.controller_cycles / 2), rcd = u(m.tRCD), second = rcd + 1;
        const cycle apart = u(std::max(m.tCCD_L, m.burst_clocks()));
        const cycle waits = buffers == 2 ? second + (second + apart - there) : second - there;
        const cycle last = rcd + 2 * apart; // the third's column command; then the bus turns to the read
        const cycle column = last + std::max(1 + rcd, u(m.tCWL + m.burst_clocks() + m.tWTR_S));
        EXPECT_EQ(b.answers().at(1), column + hit(c)) << buffers;
        EXPECT_EQ(b.counters().write_wait_clocks, waits) << buffers;
    }
}

TEST(Reference, AReadOfAQueuedWriteIsAnsweredFromTheQueue) {
    const Config c = reference([](Config& m) { m.memory.write_high = 2, m.memory.write_low = 1; });
    Bench b(c);
    b.write(0, 0);
    b.read(1, 0, 1);
    EXPECT_EQ(b.answers().at(1), 1 + hit(c)); // held back as long as the shortest read
    EXPECT_EQ(b.counters().forwarded, 1U);
}

TEST(Reference, RefreshIsSeen) {
    const Config c = reference([](Config& m) { m.memory.tREFI = 5000; });
    const cycle there = u(c.memory.controller_cycles / 2), due = 5000 - there;
    for (const auto& [asked, opens] : std::map<cycle, cycle>{{due - 1000, due - 1000},
                                                             {due + 1, due + u(c.memory.tRFC)},
                                                             {due + 100, due + u(c.memory.tRFC)},
                                                             {due + 1000, due + 1000}}) {
        Bench b(c);
        b.read(1, 0, asked);
        EXPECT_EQ(b.answers().at(1), opens + empty(c)) << asked;
    }
}

// --- with a cache that tiles share

Config sharing(integer mshrs) {
    return reference([&](Config& c) {
        c.chip.tiles = 2;
        c.l3.size_bytes = 64 * 1024;
        c.l3.line_bytes = 64;
        c.l3.ways = 16;
        c.l3.share = "chip";
        c.l3.mshrs = mshrs;
        c.l3.latency = 40;
        c.l3.banks = 8;
        c.l3.bank_bytes = 64;
    });
}

TEST(Reference, ASharedCacheWaitsForItsMemory) {
    const Config c = sharing(4);
    const cycle l3 = u(c.l3.latency);
    Bench b(c);
    b.read(1, 0, 0);
    b.read(2, 0, 7, 1);    // on its way
    b.read(3, 0, 1000, 1); // there
    const auto& ready = b.answers();
    EXPECT_EQ(ready.at(1), l3 + empty(c));
    EXPECT_EQ(ready.at(2), ready.at(1));
    EXPECT_EQ(ready.at(3), 1000 + l3);
    EXPECT_EQ(b.counters().reads, 1U);
}

TEST(Reference, ASharedCachesMshrIsHeldUntilTheDataAreThere) {
    const Config c = sharing(1);
    const cycle l3 = u(c.l3.latency);
    for (const cycle window : {1U, 20U, 10000U}) {
        Bench b(c);
        b.read(1, 0, 0);
        b.read(2, line, 1, 1);
        const auto& ready = b.answers(window);
        EXPECT_EQ(ready.at(1), l3 + empty(c));
        EXPECT_EQ(ready.at(2), ready.at(1) + l3 + hit(c)) << window;
    }
}

// --- machines

TEST(Reference, ALoadFromMemoryEndToEnd) {
    for (const char* share : {"", "tile", "chip"}) {
        const Config c = reference([&](Config& m) {
            if (*share != 0)
                m.l3 = sharing(4).l3, m.l3.share = share;
        });
        const Report r = run_on(c, [](std::byte* base, int) { load(here, base, 4, stamp{}); });
        EXPECT_EQ(r.cycles, u(c.l1.latency + c.l2.latency) + (*share != 0 ? u(c.l3.latency) : 0) + empty(c))
            << share;
    }
}

TEST(Reference, IndependentLoadsAtTheRateOfTheBus) {
    constexpr int loads = 48;
    const Config c = reference([](Config& m) {
        m.l1.mshrs = m.l2.mshrs = m.memory.read_queue = loads;
        m.l2.banks = 64;
    });
    const Report r = run_on(c, [](std::byte* base, int) {
        for (int i = 0; i < loads; ++i)
            load(here, base + i * 64, 4, stamp{});
    });
    EXPECT_EQ(r.cycles, u(c.l1.latency + c.l2.latency) + empty(c) + (loads - 1) * u(c.memory.burst_clocks()));
    EXPECT_EQ(r.memory.row_hits, loads - 1U);
}

/// What windows could change, but for lines that come while their bank is busy, or with the answer, which may
/// count as in flight or not, and the cause of waiting for them.
std::string digest(const Report& r) {
    std::string out = fmt::format("{} {}", r.cycles, r.drained);
    for (const ThreadReport& t : r.threads)
        out += fmt::format(" {}", t.finish);
    for (unsigned level = 0; level < r.config.cache_levels(); ++level)
        for (const CacheCounters& c : r.caches(level))
            for (const auto& row : cache_counters)
                out += row.count != &CacheCounters::hits_in_flight ? fmt::format(" {}", c.*row.count) : "";
    for (const MemoryCounters& m : r.memory_by_rank)
        for (const auto& row : memory_counters)
            out += fmt::format(" {}", m.*row.count);
    return out;
}

// What memory decides in a later window than it was asked in depends on no window's length, as long as no
// wait is longer than operations may lie behind their turns.
TEST(Reference, WindowsUpToTheShortestRoundTripChangeNothing) {
    for (const char* share : {"tile", "chip"})
        expect_equal_in_windows(
            [&](integer window) {
                Config c = reference([&](Config& m) {
                    m.sim.mode = "fast"; // with a window of its own
                    m.chip.cores = 2, m.chip.threads = 2, m.core.window = 1;
                    m.sim.window = window;
                    m.l1.mshrs = m.l1.write_back_buffer = m.l2.mshrs = m.l2.write_back_buffer = 256;
                    m.l2.size_bytes = 4096;
                    m.memory.read_queue = 8;
                    m.memory.write_queue = m.memory.write_high = 2, m.memory.write_low = 0;
                    m.memory.tREFI = 1000;
                    if (*share == 'c')
                        m.l3 = sharing(4).l3;
                });
                const Shared s;
                const Report r = s.run(c, 4, [&](int w) { mixed_work(s.plain(), s.at(w), w, 60); });
                EXPECT_GT(r.memory.refreshes, 10U);
                if (*share == 't') {
                    EXPECT_GT(r.memory.read_wait_clocks, 0U);
                    EXPECT_GT(r.memory.write_wait_clocks, 0U);
                }
                return r;
            },
            share, digest);
}

TEST(Reference, ReportsDoNotDependOnHostThreads) {
    for (const char* share : {"tile", "chip"})
        expect_equal_on_host_threads(
            [&](int host_threads) {
                const Config c = reference([&](Config& m) {
                    m.chip.tiles = 5, m.chip.cores = 2, m.chip.threads = 2, m.core.window = 8;
                    m.memory.write_queue = m.memory.write_high = 4, m.memory.write_low = 2;
                    m.memory.tREFI = 6240;
                    if (*share == 'c')
                        m.l3 = sharing(4).l3;
                });
                const Shared s;
                const Report r = s.run(c, 20, [&](int w) { mixed_work(s.plain(), s.at(w / 4), w, 15); },
                                       host_threads, {.frames = 2});
                EXPECT_GT(r.warm_up, 0U);
                return r;
            },
            share);
}

TEST(Reference, ADeadlockIsReportedWhateverMemoryDoes) {
    Memory s;
    const Config c = reference([](Config& m) { m.memory.tREFI = 6240; });
    EXPECT_THROW(Machine(c).run(s.space, 1, {{"work"}}, [&](int) { await(reinterpret_cast<word*>(s.data)); }),
                 Deadlock);
}

TEST(Reference, TheModeSetsWhatItStandsFor) {
    const Config set =
        parse_machine("[memory]\npreset = \"hbm2\"\n[sim]\nwindow = 9\nmode = \"fast\"\n", "m");
    EXPECT_EQ(set.memory.controller, "immediate");
    EXPECT_EQ(set.sim.window, 9);
    const Config c = parse_machine("[memory]\npreset = \"hbm2\"\n[sim]\nmode = \"reference\"\n", "m");
    EXPECT_EQ(c.memory.preset, "hbm2");
    EXPECT_EQ(c.memory.controller, "queued");
    EXPECT_EQ(c.sim.quantum, 0);
    for (const char* wrong :
         {"[sim]\nmode = \"reference\"\nquantum = 10\n", "[sim]\nmode = \"reference\"\nwindow = 10\n",
          "[memory]\ncontroller = \"immediate\"\n[sim]\nmode = \"reference\"\n",
          "[memory]\ncontroller = \"queued\"\nwrite_queue = 4\nwrite_high = 4\nwrite_low = 3\n"
          "bus_bytes = 4\n",
          "[memory]\ncontroller = \"queued\"\nread_queue = 1\nbus_bytes = 4\n"})
        EXPECT_THROW(parse_machine(wrong, "m"), ConfigError) << wrong;
    for (const char* mode : {"fast", "reference"}) { // every number says which mode made it
        Config m = reference();
        m.sim.mode = mode;
        const Report r = run_on(m, [](std::byte* base, int) { load(here, base, 4, stamp{}); });
        EXPECT_NE(print_text(r).find(fmt::format("mode                  {:>14}", mode)), std::string::npos);
        EXPECT_NE(print_json(r, false).find(fmt::format("\"mode\": \"{}\"", mode)), std::string::npos);
    }
}

} // namespace
} // namespace sim::test
