// Mappings, presets, the write queue, row look-back: one request after the other.
#include "sim/config/machine_file.h"
#include "sim/memory/dram_mapping.h"
#include "tests/sim/dram_traffic.h"
#include "tests/sim/machines.h"

#include <set>

namespace sim::test {
namespace {

std::uint64_t ring(const Config& c) {
    return 64 + sim::Memory::longest_service(c, 1024);
}
Config ddr4(const std::function<void(MemoryConfig&)>& change = {}) {
    return memory_of("ddr4-2400r", [&](MemoryConfig& m) {
        m.tREFI = 0;
        if (change)
            change(m);
    });
}
std::uint64_t row_stride(const Config& c) { // to the next row of a bank
    return u(c.memory.row_bytes * c.memory.channels * c.memory.ranks * c.memory.bank_groups * c.memory.banks);
}

TEST(DramMapping, FieldsAreWhereTheTextSays) {
    Config c = ddr4([](MemoryConfig& m) {
        m.channels = 2;
        m.ranks = 2;
        m.rows = 16;
        m.mapping = "rank:row:bank.1:column:bank:channel:group:column.2";
    });
    DramMapping map(c.memory);
    // From below: 6 bits of a burst, 2 column, 2 group, 1 channel, 1 bank, 5 column, 1 bank, 4 row, 1 rank.
    EXPECT_EQ(map.locate(std::uint64_t{3} << 8).group, 3U);
    EXPECT_EQ(map.locate(std::uint64_t{1} << 10).channel, 1U);
    EXPECT_EQ(map.locate(std::uint64_t{1} << 11).bank, 1U);
    EXPECT_EQ(map.locate(std::uint64_t{1} << 17).bank, 2U);
    EXPECT_EQ(map.locate(std::uint64_t{5} << 18).row, 5U);
    EXPECT_EQ(map.locate(std::uint64_t{1} << 22).rank, 1U);
    EXPECT_EQ(map.locate((std::uint64_t{1} << 23) + 64).row, 16U); // beyond the memory: further rows
    EXPECT_EQ(map.locate(std::uint64_t{31} << 12).bank, 0U);
}

TEST(DramMapping, PlacesAreDistinct) {
    for (const char* bank_xor : {"off", "on"})
        for (const MemoryConfig& preset : memory_presets()) {
            Config c = memory_of(preset.preset, [&](MemoryConfig& m) {
                m.rows = 4;
                m.ranks = 2;
                m.bank_xor = bank_xor;
            });
            const MemoryConfig& m = c.memory;
            DramMapping map(m);
            std::map<std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t, std::uint64_t>,
                     integer>
                bursts;
            integer burst = m.bus_bytes * m.burst_length;
            integer rows = m.channels * m.ranks * m.bank_groups * m.banks * m.rows;
            for (integer a = 0; a < rows * m.row_bytes; a += burst) {
                DramPlace p = map.locate(u(a));
                ++bursts[{p.channel, p.rank, p.group, p.bank, p.row}];
            }
            EXPECT_EQ(static_cast<integer>(bursts.size()), rows);
            for (const auto& [place, count] : bursts)
                ASSERT_EQ(count, m.row_bytes / burst);
        }
}

TEST(DramMapping, MistakesAreOneClearLine) {
    for (auto [mapping, says] :
         {std::pair{"row:bank:column", "names rank without a number 0 times"},
          {"row:rank:bank:group:column:channel:row", "names row without a number 2 times"},
          {"row:rank:bonk:group:column:channel", "a field \"bonk\""},
          {"row:rank:bank:group:column:channel:column.9", "more than its 7 bits"},
          {"row:rank:bank:group:column:channel:column.x", "write its bits as in column.2"}}) {
        try {
            parse_machine("", "m.toml", {std::string("memory.mapping=") + mapping});
            ADD_FAILURE() << mapping;
        } catch (const ConfigError& e) {
            EXPECT_NE(std::string(e.what()).find(says), std::string::npos) << e.what();
        }
    }
}

TEST(DramPresets, SetWhatTheirLayerDoesNot) {
    Config c = parse_machine("[memory]\nchannels = 2\npreset = \"hbm2\"\ncontroller_cycles = 7\n", "m");
    EXPECT_EQ(c.memory.channels, 2);
    EXPECT_EQ(c.memory.burst_length, 4);
    EXPECT_EQ(c.memory.controller_cycles, 7);
    c = parse_machine("[memory]\ntCL = 40\n", "m", {"memory.tFAW=99", "memory.preset=ddr4-2400r"});
    EXPECT_EQ(c.memory.tCL, 16);
    EXPECT_EQ(c.memory.tFAW, 99);
    EXPECT_EQ(print_machine(parse_machine(print_machine(c), "m")), print_machine(c));
    EXPECT_THROW(parse_machine("[memory]\npreset = \"ddr9\"\n", "m"), ConfigError);
    for (const MemoryConfig& preset : memory_presets())
        EXPECT_NO_THROW(parse_machine("", "m", {"memory.preset=" + preset.preset}));
}

TEST(DramPresets, PeaksAreTheDataSheets) {
    EXPECT_NEAR(peak(memory_of("ddr3-1600k")) / 1.25, 12.8, 0.01);
    EXPECT_NEAR(peak(memory_of("ddr4-2400r")) / 0.833, 19.2, 0.01);
    EXPECT_NEAR(peak(memory_of("ddr4-2400r-2r")) / 0.833, 19.2, 0.01);
    EXPECT_NEAR(peak(memory_of("ddr5-4800b")) / 0.416, 38.4, 0.1);
    EXPECT_NEAR(peak(memory_of("gddr5-4000")), 128.0, 0.01);
    EXPECT_NEAR(peak(memory_of("gddr6-14000")) / 0.571, 448.0, 0.5);
    EXPECT_NEAR(peak(memory_of("hbm2")), 256.0, 0.01);
    EXPECT_NEAR(peak(memory_of("hbm3-6400")) / 0.625, 819.2, 0.01);
}

TEST(DramWrites, WaitForTheWatermark) {
    Config c = ddr4([](MemoryConfig& m) { m.write_queue = 8, m.write_high = 4, m.write_low = 1; });
    sim::Memory memory(c, ring(c));
    for (std::uint64_t i = 0; i < 3; ++i)
        EXPECT_EQ(memory.write(i * 64, 10), 10U);
    EXPECT_EQ(memory.counters().write_bursts, 0U);
    EXPECT_EQ(memory.write(3 * 64, 10), 10U);
    EXPECT_EQ(memory.counters().write_bursts, 3U);
    EXPECT_EQ(memory.counters().batches, 1U);
    memory.finish();
    EXPECT_EQ(memory.counters().write_bursts, 4U);
}

TEST(DramWrites, AreForwardedAndMerged) {
    Config c = ddr4();
    sim::Memory memory(c, ring(c));
    memory.write(4096, 10);
    EXPECT_EQ(memory.read(4096, 20), 20 + sim::Memory::shortest_read(c)); // no sooner than the shortest
    memory.write(4096, 30);
    memory.finish();
    EXPECT_EQ(memory.counters().forwarded, 1U);
    EXPECT_EQ(memory.counters().merged, 1U);
    EXPECT_EQ(memory.counters().write_bursts, 1U);
    EXPECT_EQ(memory.counters().read_bursts, 0U);
}

TEST(DramWrites, AFullQueueMakesThemWait) {
    Config c = ddr4([](MemoryConfig& m) { m.write_queue = 2, m.write_high = 2, m.write_low = 0; });
    sim::Memory memory(c, ring(c));
    memory.write(0, 0);
    memory.write(64, 0); // both are sent: activate at 0 and at tRRD_S, data tRCD + tCWL later
    const MemoryConfig& m = c.memory;
    EXPECT_EQ(memory.write(128, 0), u(m.tRCD + m.tCWL + 4));
    EXPECT_EQ(memory.write(192, 0), u(m.tRCD + m.tCWL + 4 + 4));
    EXPECT_EQ(memory.counters().write_wait_clocks, u(2 * (m.tRCD + m.tCWL + 4) + 4));
}

// A batch of n writes to open rows between reads, by hand: n bursts and two turnarounds.
TEST(DramWrites, TurnaroundIsPaidOncePerBatch) {
    for (integer n : {1, 4, 16}) {
        Config c = ddr4([n](MemoryConfig& m) { m.write_queue = 32, m.write_high = n, m.write_low = 0; });
        const MemoryConfig& m = c.memory;
        sim::Memory memory(c, ring(c));
        for (std::uint64_t i = 0; i < 4; ++i)
            memory.read(i * 64, 0); // opens a row in each group
        cycle read = memory.read(0, 500);
        EXPECT_EQ(read, u(500 + m.tCL + 4));
        for (integer i = 1; i <= n; ++i)
            memory.write(u(i) * 64, 500);
        // The first write goes to another group than the last read, the next read to another than the last
        // write.
        integer first = 500 + m.tCL + 4 + m.tRTW - m.tCWL, last = first + 4 * (n - 1);
        cycle again = memory.read(u(n + 1) * 64, u(first));
        EXPECT_EQ(again, u(last + m.tCWL + 4 + m.tWTR_S + m.tCL + 4)) << n;
        EXPECT_EQ(memory.counters().turnarounds, 2U);
    }
}

// What is booked far ahead makes the calendar grow; nothing is forgotten.
TEST(DramRows, TheCalendarGrowsWithWhatIsBooked) {
    for (const char* preset : {"ddr4-2400r", "hbm2"}) {
        Config c = memory_of(preset, [](MemoryConfig& m) { m.channels = 1, m.ranks = 2; });
        sim::Memory small(c, 0), large(c, ring(c));
        auto a = random_lines(1 << 20, 0.3), b = random_lines(1 << 20, 0.3);
        for (cycle t = 0; t < 8000; ++t) {
            Request r = a(), same = b();
            cycle at = t < 2000 ? 0 : 20 * t;
            ASSERT_EQ(detail::request(small, r, at), detail::request(large, same, at)) << t;
        }
    }
}

// No stretch between two refreshes has room for all writes that are sent together.
TEST(DramRows, WritesOfManyRefreshesAreSent) {
    const Config c = memory_of("ddr4-2400r", [](MemoryConfig& m) {
        m.channels = 1, m.row_bytes = 65536, m.write_queue = m.write_high = 4096, m.write_low = 0;
    });
    sim::Memory memory(c, 0);
    cycle t = 0;
    for (std::uint64_t line = 0; line < 6000; ++line)
        t = std::max(t, memory.write(64 * line, 2 * line));
    EXPECT_GT(memory.counters().write_bursts, 4000U);
    EXPECT_GT(t, 2 * u(c.memory.tREFI));
}

TEST(DramRows, LookBackGoesBeforeTheClosing) {
    Config c = ddr4();
    const MemoryConfig& m = c.memory;
    sim::Memory memory(c, ring(c));
    std::uint64_t other = row_stride(c);
    cycle first = memory.read(0, 0);
    EXPECT_EQ(first, u(m.tRCD + m.tCL + 4));
    cycle conflict = memory.read(other, 1); // closes the row at tRAS
    EXPECT_EQ(conflict, u(m.tRC + m.tRCD + m.tCL + 4));
    EXPECT_EQ(memory.read(256, 2), first + u(m.tCCD_L)); // the old row, still open
    EXPECT_EQ(memory.counters().row_hits, 1U);
}

TEST(DramRows, ClosedPagesCloseThemselves) {
    Config c = ddr4([](MemoryConfig& m) { m.page_policy = "closed"; });
    const MemoryConfig& m = c.memory;
    sim::Memory memory(c, ring(c));
    memory.read(0, 0);
    EXPECT_EQ(memory.read(row_stride(c), 1000), u(1000 + m.tRCD + m.tCL + 4)); // no precharge to wait for
    EXPECT_EQ(memory.counters().row_empties, 2U);
    EXPECT_EQ(memory.counters().precharges, 2U);
}

} // namespace
} // namespace sim::test
