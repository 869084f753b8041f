// The figures of a chip, against what the simulated machine really does.
#include "sim/machine/describe.h"
#include "tests/sim/machines.h"

namespace sim::test {
namespace {

TEST(Describe, LatenciesAreThoseOfLoads) {
    Config c = simple();
    c.chip.clock_ps = 500;
    const ChipFigures f = chip_figures(c);
    run_on(c, [&](std::byte* data, int) {
        stamp s = load(here, data, 4, stamp{}); // nobody has opened a row
        const double cycle_ns = 0.5;
        const cycle start = 0;
        EXPECT_NEAR(static_cast<double>(when(s) - start) * cycle_ns, f.memory_closed_ns, 2 * cycle_ns + 2);
        s = load(here, data, 4, s);
        const cycle from = when(s);
        s = load(here, data, 4, s);
        EXPECT_DOUBLE_EQ(static_cast<double>(when(s) - from) * cycle_ns, f.l1_ns);
    });
}

TEST(Describe, RatesAreProductsOfTheParts) {
    Config c;
    c.chip.clock_ps = 250;
    c.chip.tiles = 16;
    c.chip.cores = 8;
    c.core.issue_width = 1;
    c.core.lanes = 4;
    const ChipFigures f = chip_figures(c);
    EXPECT_DOUBLE_EQ(f.instructions_per_second, 128 * 4e9);
    EXPECT_DOUBLE_EQ(f.flops_per_second, 128 * 4e9 * 4 * 2);
    c.interval[static_cast<std::size_t>(operation::fused)] = 4;
    EXPECT_DOUBLE_EQ(chip_figures(c).flops_per_second, 128 * 4e9 * 4 * 2 / 4);
    c.interval[static_cast<std::size_t>(operation::fused)] = 1;
    c.core.issue_width = 4;
    EXPECT_DOUBLE_EQ(chip_figures(c).flops_per_second, 4 * 128 * 4e9 * 4 * 2);
    c.core.pairing = "any | any | scalar load store branch | scalar";
    EXPECT_DOUBLE_EQ(chip_figures(c).flops_per_second, 2 * 128 * 4e9 * 4 * 2) << "two ports take it";
    c.core.shared_classes = "add fused";
    c.core.shared_cores = 8;
    EXPECT_DOUBLE_EQ(chip_figures(c).flops_per_second, 16 * 4e9 * 4 * 2) << "a unit of eight cores";
    EXPECT_DOUBLE_EQ(f.memory_bytes_per_second, static_cast<double>(c.memory.channels * c.memory.bus_bytes) *
                                                    2e12 / static_cast<double>(c.memory.clock_ps));
    EXPECT_NE(chip_text(c).find("128 cores"), std::string::npos);
}

} // namespace
} // namespace sim::test
