// Store buffers and folded addresses: exact cycles.
#include "tests/sim/machines.h"

namespace sim::test {
namespace {

constexpr int n = 1000;
constexpr cycle l1_latency = 2, line = 64;

Config buffered(integer entries) {
    Config c = simple();
    c.core.store_buffer = entries;
    return c;
}

/// Loads a line and lets no later operation issue before it is there.
void warm(std::byte* p) {
    scalar_op(operation::integer, load(here, p, 4, stamp{}));
}

// An entry is taken for the L1's latency: one entry halves what two or more keep up with.
TEST(StoreBuffer, HitsFlowAtEntriesPerLatency) {
    auto cycles = [](integer entries) {
        return run_on(buffered(entries), [](std::byte* base, int) {
            warm(base);
            for (int i = 0; i < n; ++i)
                store(here, base, 4, stamp{}, stamp{});
        });
    };
    cycle unlimited = cycles(0).cycles;
    Report one = cycles(1);
    EXPECT_EQ(one.cycles, unlimited + n - 1);
    EXPECT_EQ(cause(one, Cause::stores), u(n - 3)); // the first three issue without a gap
    EXPECT_EQ(one.core.buffered_stores, u(n));
    EXPECT_EQ(one.l1_total().writes, u(n));
    EXPECT_EQ(cycles(2).cycles, unlimited);
    EXPECT_EQ(cause(cycles(2), Cause::stores), 0U);
}

// Entries end in order: hits behind a miss keep theirs until it is there.
TEST(StoreBuffer, EntriesEndInOrder) {
    constexpr int count = 60;
    for (std::size_t entries : {1U, 2U, 3U, 5U, 16U, 100U}) {
        cycle begun = 0, behind = 0, miss = 0;
        auto misses = [](int i) { return i % 7 == 0 || i % 11 == 3; };
        run_on(buffered(static_cast<integer>(entries)), [&](std::byte* base, int) {
            std::byte* hit = base + 32768; // of a set of its own
            auto missing = [&](int i) { return base + 16384 + static_cast<std::ptrdiff_t>(line) * (1 + i); };
            for (int i = 0; i <= count; ++i) // into the L2 ...
                warm(missing(i < count ? i : count));
            for (int way = 0; way < 4; ++way) // ... and out of the L1
                for (int i = 0; i < 128; ++i)
                    warm(base + (1 << 17) + 8192 * way + 64 * i);
            warm(hit);
            cycle before = running_hart->issued;
            stamp s = load(here, missing(count), 4, stamp{});
            miss = s.last - before - 1;
            scalar_op(operation::integer, s);
            scalar_op(operation::integer, stamp{});
            begun = running_hart->issued;
            for (int i = 0; i < count; ++i)
                store(here, misses(i) ? missing(i) : hit, 4, stamp{}, stamp{});
            scalar_op(operation::integer, stamp{});
            behind = running_hart->issued;
        });
        ASSERT_GT(miss, 10U);
        std::vector<cycle> ends;
        cycle issue = begun, granted = 0, start = begun, end = 0;
        for (int i = 0; i < count; ++i) {
            issue = std::max(issue + 1, granted);
            granted = issue;
            if (ends.size() >= entries)
                granted = std::max(granted, ends[ends.size() - entries]);
            start = std::max(granted, start + 1);
            end = std::max(end, start + (misses(i) ? miss : l1_latency));
            ends.push_back(end);
        }
        EXPECT_EQ(behind, std::max(issue + 1, granted)) << entries;
    }
}

// With one entry, stores that go to memory are a chain like loads that each need the one before.
TEST(StoreBuffer, WaitsForWhatIsNotAnsweredYet) {
    Report stores = run_on(buffered(1), [](std::byte* base, int) {
        for (int i = 0; i < 50; ++i)
            store(here, base + i * 4160, 4, stamp{}, stamp{});
    });
    Report loads = run_on(simple(), [](std::byte* base, int) {
        stamp s;
        for (int i = 0; i < 50; ++i)
            s = load(here, base + i * 4160, 4, s);
    });
    EXPECT_EQ(stores.cycles, loads.cycles);
    EXPECT_GT(cause(stores, Cause::stores), stores.cycles * 9 / 10);
}

struct Forwarded {
    cycle latency; // from issue
    Report report;
};
/// A program that begins with a store or more; how long its load takes.
template <class Program> Forwarded forwarded(const Config& c, Program program) {
    Forwarded f{};
    f.report = run_on(c, [&](std::byte* base, int) {
        stamp s = program(base);
        cycle issued = running_hart->issued;
        f.latency = when(s) - issued;
    });
    return f;
}

TEST(StoreBuffer, LoadsAreForwardedFromWhatHoldsAllOfThem) {
    auto same = [](std::byte* base) {
        store(here, base, 8, stamp{}, stamp{});
        return load(here, base + 4, 4, stamp{});
    };
    Forwarded f = forwarded(buffered(8), same);
    EXPECT_EQ(f.latency, l1_latency);
    EXPECT_EQ(f.report.core.forwarded_loads, 1U);
    EXPECT_EQ(f.report.l1_total().reads, 0U);
    Forwarded plain = forwarded(buffered(0), same); // waits for the line
    EXPECT_GT(plain.latency, 20U);
    EXPECT_EQ(plain.report.core.forwarded_loads, 0U);
    // Part of it: the line first, then the L1.
    auto part = [](std::byte* base) {
        store(here, base, 4, stamp{}, stamp{});
        return load(here, base, 8, stamp{});
    };
    f = forwarded(buffered(8), part);
    EXPECT_EQ(f.latency, plain.latency + l1_latency);
    EXPECT_EQ(f.report.core.blocked_loads, 1U);
    EXPECT_EQ(f.report.core.forwarded_loads, 0U);
}

TEST(StoreBuffer, TheYoungestStoreCounts) {
    auto small_last = [](std::byte* base) {
        store(here, base, 8, stamp{}, stamp{});
        store(here, base, 4, stamp{}, stamp{});
        return load(here, base, 8, stamp{});
    };
    EXPECT_EQ(forwarded(buffered(8), small_last).report.core.blocked_loads, 1U);
    auto large_last = [](std::byte* base) {
        store(here, base, 4, stamp{}, stamp{});
        store(here, base, 8, stamp{}, stamp{});
        return load(here, base, 4, stamp{});
    };
    EXPECT_EQ(forwarded(buffered(8), large_last).report.core.forwarded_loads, 1U);
    auto ended = [](std::byte* base) {
        store(here, base, 4, stamp{}, stamp{});
        stamp s;
        for (int i = 0; i < 100; ++i)
            s = scalar_op(operation::divide, s); // 1600 cycles
        return load(here, base, 4, s);
    };
    Forwarded f = forwarded(buffered(8), ended);
    EXPECT_EQ(f.report.core.forwarded_loads, 0U);
    EXPECT_EQ(f.report.l1_total().reads, 1U);
}

// A store that hits has not ended before the one in front of it, which misses.
TEST(StoreBuffer, LoadsSeeEntriesEndInOrder) {
    auto behind_a_miss = [](bool part) {
        return [part](std::byte* base) {
            warm(base);
            store(here, base + 4096, 4, stamp{}, stamp{});
            store(here, base, 4, stamp{}, stamp{});
            stamp later = scalar_op(operation::divide, stamp{}); // 16 cycles
            return load(here, base, part ? 8 : 4, later);
        };
    };
    auto the_miss = [](std::byte* base) {
        warm(base);
        store(here, base + 4096, 4, stamp{}, stamp{});
        scalar_op(operation::integer, stamp{});
        stamp later = scalar_op(operation::divide, stamp{});
        return load(here, base + 4096, 4, later);
    };
    Forwarded f = forwarded(buffered(8), behind_a_miss(false));
    EXPECT_EQ(f.report.core.forwarded_loads, 1U);
    EXPECT_EQ(f.latency, l1_latency);
    EXPECT_EQ(forwarded(buffered(8), behind_a_miss(true)).latency,
              forwarded(buffered(0), the_miss).latency + l1_latency);
}

TEST(StoreBuffer, RowsAreForwardedPieceByPiece) {
    Config c = buffered(64);
    c.core.lanes = 4;
    auto pieces = u(ISA_WIDTH / 4);
    auto row = [](std::byte* base) {
        store_vector(here, base, all_lanes, stamp{}, stamp{}, stamp{});
        return load_vector(here, base, all_lanes, stamp{}, stamp{});
    };
    Forwarded f = forwarded(c, row);
    EXPECT_EQ(f.report.core.forwarded_loads, pieces);
    EXPECT_EQ(f.report.core.buffered_stores, pieces);
    auto holes = [](std::byte* base) { // lanes 0 and 2 of the first piece
        store_vector(here, base, 5, stamp{}, stamp{}, stamp{});
        return load_vector(here, base, 1, stamp{}, stamp{});
    };
    EXPECT_EQ(forwarded(c, holes).report.core.blocked_loads, 1U);
    std::array<std::int32_t, 64> index{};
    auto gathered = [&](std::byte* base) {
        store(here, base, 4, stamp{}, stamp{});
        return gather(here, base, index.data(), 1, stamp{}, stamp{}, stamp{});
    };
    EXPECT_EQ(forwarded(c, gathered).report.core.blocked_loads, 1U);
    auto scattered = [&](std::byte* base) { // all lanes to one line: an entry a piece
        scatter(here, base, index.data(), all_lanes, stamp{}, stamp{}, stamp{}, stamp{});
        return load(here, base + 4096, 4, stamp{});
    };
    EXPECT_EQ(forwarded(c, scattered).report.core.buffered_stores, pieces);
    c.core.store_buffer = 3; // fewer than one operation takes
    EXPECT_EQ(forwarded(c, row).report.core.buffered_stores, pieces);
    EXPECT_EQ(forwarded(c, row).report.core.forwarded_loads, 1U); // the last; the others went with their line
}

TEST(StoreBuffer, EachThreadHasItsOwn) {
    Config c = buffered(8);
    c.chip.threads = 2;
    Report r = run_on(
        c,
        [](std::byte* base, int w) {
            if (w == 0)
                store(here, base, 4, stamp{}, stamp{});
            else
                load(here, base, 4, stamp{});
        },
        2);
    EXPECT_EQ(r.core.forwarded_loads + r.core.blocked_loads, 0U);
}

// A load or store across two lines is an access of each.
TEST(Split, AccessesTakeBothLines) {
    for (bool split : {false, true}) {
        Report r = run_on(simple(), [&](std::byte* base, int) {
            warm(base);
            warm(base + 64);
            for (int i = 0; i < n; ++i)
                load(here, base + (split ? 60 : 56), 8, stamp{});
        });
        EXPECT_EQ(r.l1_total().reads, u(2 + n * (split ? 2 : 1)));
        EXPECT_EQ(r.l1_total().busy_cycles, u(2 + n * (split ? 2 : 1)));
    }
}

// Bytes take slots of a port in the line where they lie.
TEST(Split, PortsMoveEachByteOnce) {
    for (integer entries : {0, 64})
        for (int offset : {0, 32, 60}) {
            Config c = buffered(entries);
            c.core.lanes = 16;
            c.l1.port_bytes = 4;
            auto pieces = u(ISA_WIDTH / 16);
            Report r = run_on(c, [&](std::byte* base, int) {
                load_vector(here, base + offset, all_lanes, stamp{}, stamp{});
                store_vector(here, base + 4096 + offset, all_lanes, stamp{}, stamp{}, stamp{});
                load(here, base + 8192 + offset, 8, stamp{});
            });
            EXPECT_EQ(r.l1_total().busy_cycles, 2 * pieces * 16 + 2) << offset;
            EXPECT_EQ(r.l1_total().reads + r.l1_total().writes,
                      2 * pieces * (offset == 0 ? 1U : 2U) + (offset == 60 ? 2U : 1U));
        }
}

// --- folded addresses

Config folding(bool on) {
    Config c = simple();
    c.core.address_folding = on ? "on" : "off";
    return c;
}

TEST(Folding, LoadsAddTheirAddressesThemselves) {
    auto chase = [](std::byte* base, int) {
        warm(base);
        stamp s;
        for (int i = 0; i < n; ++i)
            s = load(here, base, 4, scalar_op(operation::address, stamp{}, s));
    };
    Report off = run_on(folding(false), chase);
    Report on = run_on(folding(true), chase);
    EXPECT_EQ(off.cycles, on.cycles + n); // an addition less between each load and the next
    EXPECT_EQ(off.core.instructions, on.core.instructions + n);
    EXPECT_EQ(on.core.folded, u(n));
    EXPECT_EQ(on.core.unfolded, 0U);
    EXPECT_EQ(on.core.vops, off.core.vops);
}

TEST(Folding, OtherUsesMakeItAnInstructionOnce) {
    Report r = run(folding(true), [](int) {
        stamp a = scalar_op(operation::address, stamp{}, stamp{});
        stamp b = scalar_op(operation::integer, a); // after it: at 1
        EXPECT_EQ(b.last, 2U);
        EXPECT_EQ(scalar_op(operation::integer, a).last, 3U);
        EXPECT_EQ(vector_op(operation::broadcast, a).last, 5U); // issues at 3
    });
    EXPECT_EQ(r.core.unfolded, 1U);
    EXPECT_EQ(r.core.instructions, 4U);
    Report chain = run(folding(true), [](int) {
        stamp a = scalar_op(operation::address, stamp{}, stamp{});
        scalar_op(operation::address, a, stamp{}); // a sum of three needs an instruction
    });
    EXPECT_EQ(chain.core.unfolded, 1U);
    EXPECT_EQ(chain.core.folded, 2U);
    EXPECT_EQ(chain.core.instructions, 1U);
}

TEST(Folding, WaitsForOperandsThatAreNotAnsweredYet) {
    for (integer window : {1, 8}) {
        std::array<cycle, 2> after{};
        for (bool on : {false, true}) {
            Config c = folding(on);
            c.core.window = window;
            run_on(c, [&](std::byte* base, int) {
                warm(base);
                stamp x = load(here, base + 4096, 4, stamp{});
                stamp y = load(here, base + 65536, 4, stamp{});
                stamp a = scalar_op(operation::address, x, y);
                stamp s = load(here, base, 4, a);
                after[on ? 1 : 0] = when(s) - std::max(when(x), when(y));
            });
        }
        EXPECT_EQ(after[0], 1 + l1_latency) << window;
        EXPECT_EQ(after[1], l1_latency) << window;
    }
}

} // namespace
} // namespace sim::test
