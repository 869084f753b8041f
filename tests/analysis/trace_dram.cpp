// Rows of a memory against a plainly written one, its law, and patterns whose answers are known.
#include "analysis/traces/dram_rows.h"
#include "sim/config/machine_file.h"

#include <gtest/gtest.h>

#include <map>
#include <random>
#include <set>

namespace analysis {
namespace {

sim::MemoryConfig memory(const std::vector<std::string>& settings = {}) {
    return sim::describe_machine_text("", "test", settings).config.memory;
}

TEST(DramRows, AreThoseOfAPlainMemory) {
    for (const char* preset : {"ddr4-2400r-2r", "hbm2", "ddr5-4800b"}) {
        const sim::MemoryConfig config = memory({std::string("memory.preset=") + preset});
        const sim::DramMapping mapping(config);
        constexpr std::size_t reach = 16;
        DramRows rows(config, reach);
        std::mt19937_64 random(5);
        using Bank = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;
        std::map<Bank, std::uint64_t> open;
        std::set<std::pair<Bank, std::uint64_t>> met;
        std::vector<Bank> history;
        std::vector<DramRows::Group> expected(2);
        std::uint64_t address = 0;
        for (int i = 0; i < 20000; ++i) {
            address = random() % 3 == 0 ? random() % (1 << 28) : address + 64;
            const auto group = static_cast<std::uint32_t>(random() % 2);
            rows.touch(address, group);
            const sim::DramPlace p = mapping.locate(address);
            const Bank bank{p.channel, p.rank, p.group, p.bank};
            DramRows::Group& g = expected[group];
            ++g.bursts;
            const auto found = open.find(bank);
            ++(found == open.end() ? g.empties : found->second == p.row ? g.hits : g.conflicts);
            open[bank] = p.row;
            g.rows += met.insert({bank, p.row}).second ? 1 : 0;
            history.push_back(bank);
            g.banks +=
                std::set<Bank>(history.end() - static_cast<std::ptrdiff_t>(std::min(reach, history.size())),
                               history.end())
                    .size();
        }
        for (std::size_t g = 0; g < 2; ++g) {
            const DramRows::Group &got = rows.groups()[g], &e = expected[g];
            EXPECT_EQ(got.bursts, e.bursts) << preset;
            EXPECT_EQ(got.hits, e.hits) << preset;
            EXPECT_EQ(got.empties, e.empties) << preset;
            EXPECT_EQ(got.conflicts, e.conflicts) << preset;
            EXPECT_EQ(got.rows, e.rows) << preset;
            EXPECT_EQ(got.banks, e.banks) << preset;
            EXPECT_EQ(got.hits + got.activations(), got.bursts);
        }
        std::uint64_t sum = 0;
        for (const std::uint64_t n : rows.banks())
            sum += n;
        EXPECT_EQ(sum, 20000U);
    }
}

/// All of memory from its beginning: each row is opened once. Steps from a row to the next of one bank: all
/// conflicts.
TEST(DramRows, KnowSweepsAndSteps) {
    const sim::MemoryConfig config =
        memory({"memory.channels=1", "memory.ranks=1", "memory.bank_groups=1", "memory.banks=4",
                "memory.row_bytes=1024", "memory.mapping=row:rank:bank:group:channel:column",
                "memory.bank_xor=off"});
    const auto burst = static_cast<std::uint64_t>(config.bus_bytes * config.burst_length);
    DramRows sweep(config, 8);
    const std::uint64_t bursts_of_row = 1024 / burst;
    for (std::uint64_t i = 0; i < bursts_of_row * 40; ++i)
        sweep.touch(i * burst, 0);
    EXPECT_EQ(sweep.groups()[0].activations(), 40U);
    EXPECT_EQ(sweep.groups()[0].empties, 4U);
    EXPECT_EQ(sweep.groups()[0].rows, 40U);
    DramRows steps(config, 8);
    for (std::uint64_t i = 0; i < 100; ++i)
        steps.touch(i % 10 * 4096, 0);
    EXPECT_EQ(steps.groups()[0].conflicts, 99U);
    EXPECT_EQ(steps.groups()[0].rows, 10U);
    EXPECT_EQ(steps.groups()[0].banks, 100U); // always the same one
}

} // namespace
} // namespace analysis
