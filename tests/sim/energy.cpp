// Energy is counters times what the machine states: closed forms of short programs.
#include "sim/machine/energy.h"
#include "tests/sim/machines.h"

#include <algorithm>

namespace sim::test {
namespace {

double joules(const Report& r, std::string_view part) {
    const std::vector<EnergyPart> parts = energy_parts(r);
    const auto found =
        std::find_if(parts.begin(), parts.end(), [&](const EnergyPart& p) { return p.part == part; });
    EXPECT_NE(found, parts.end()) << part;
    return found == parts.end() ? -1 : found->joules;
}

Config without_energy() {
    Config c = simple();
    c.memory.activate_pj = c.memory.read_pj = c.memory.write_pj = c.memory.refresh_pj =
        c.memory.background_mw = 0;
    return c;
}

TEST(Energy, OfComputationIsItsInstructionsAndLanes) {
    constexpr int n = 100;
    for (const integer lanes : {1, 4, 64}) {
        Config c = without_energy();
        c.core.lanes = lanes;
        c.energy.instruction_pj = 70;
        c.energy.logic_pj = 0.5;
        c.energy.add_pj = 1;
        c.energy.multiply_pj = 3;
        c.energy.fused_pj = 4;
        c.energy.divide_pj = 16;
        const Report r = run(c, [](int) {
            for (int i = 0; i < n; ++i) {
                vector_op(operation::add, stamp{}, stamp{});
                vector_op(operation::multiply, stamp{}, stamp{});
                vector_op(operation::fused, stamp{}, stamp{}, stamp{});
                vector_op(operation::select, stamp{}, stamp{}, stamp{});
                scalar_op(operation::square_root, stamp{});
                scalar_op(operation::integer_multiply, stamp{}, stamp{});
                branch(here, stamp{}, true);
            }
        });
        const double pieces = std::max(1.0, ISA_WIDTH / static_cast<double>(lanes));
        EXPECT_DOUBLE_EQ(joules(r, "instructions"), n * (4 * pieces + 3) * 70e-12) << lanes;
        EXPECT_DOUBLE_EQ(joules(r, "add lanes"), n * ISA_WIDTH * 1e-12);
        EXPECT_DOUBLE_EQ(joules(r, "multiply lanes"), n * (ISA_WIDTH + 1) * 3e-12);
        EXPECT_DOUBLE_EQ(joules(r, "fused lanes"), n * ISA_WIDTH * 4e-12);
        EXPECT_DOUBLE_EQ(joules(r, "logic lanes"), n * (ISA_WIDTH + 1) * 0.5e-12);
        EXPECT_DOUBLE_EQ(joules(r, "divide lanes"), n * 16e-12);
        EXPECT_DOUBLE_EQ(joules(r, "memory at rest") + joules(r, "cores at rest"), 0);
        check_laws(r);
    }
}

// Lines read once each, in one row of memory: the row opens once.
TEST(Energy, OfMemoryIsItsRowsBurstsAndLines) {
    constexpr int lines = 64;
    Config c = without_energy();
    c.l1.port_bytes = 16;
    c.energy.l1_access_pj = 10;
    c.energy.l1_line_pj = 50;
    c.energy.l2_line_pj = 300;
    c.memory.activate_pj = 20000;
    c.memory.read_pj = 9000;
    c.memory.write_pj = 11000;
    const Report r = run_on(c, [](std::byte* base, int) {
        for (int i = 0; i < lines; ++i)
            load(here, base + i * 64, 4, stamp{});
    });
    ASSERT_EQ(r.memory.activates, 1U);
    EXPECT_DOUBLE_EQ(joules(r, "L1 accesses"), lines * 10e-12);
    EXPECT_DOUBLE_EQ(joules(r, "L1 lines"), lines * 50e-12);
    EXPECT_DOUBLE_EQ(joules(r, "L2 lines"), 2 * lines * 300e-12); // asked for, and filled
    EXPECT_DOUBLE_EQ(joules(r, "memory rows"), 20000e-12);
    EXPECT_DOUBLE_EQ(joules(r, "memory reads"), lines * 9000e-12);
    EXPECT_DOUBLE_EQ(joules(r, "memory writes"), 0);
}

TEST(Energy, AtRestIsPowerTimesTime) {
    Config c = without_energy();
    c.chip.tiles = 2;
    c.chip.cores = 4;
    c.chip.clock_ps = 250;
    c.memory.channels = 2;
    c.memory.ranks = 2;
    c.energy.core_mw = 60;
    c.energy.tile_mw = 300;
    c.memory.background_mw = 500;
    const Report r = run(c, [](int) {
        stamp s;
        for (int i = 0; i < 1000; ++i)
            s = scalar_op(operation::add, s);
    });
    const double seconds = static_cast<double>(r.drained) * 250e-12;
    EXPECT_DOUBLE_EQ(joules(r, "cores at rest"), 8 * 0.06 * seconds);
    EXPECT_DOUBLE_EQ(joules(r, "tiles at rest"), 2 * 0.3 * seconds);
    EXPECT_DOUBLE_EQ(joules(r, "memory at rest"), 4 * 0.5 * seconds);
    const EnergyTotal all = total(r, energy_parts(r));
    EXPECT_NEAR(all.watts(), 8 * 0.06 + 2 * 0.3 + 4 * 0.5, 1e-12);
    EXPECT_DOUBLE_EQ(all.joule_seconds(), all.joules * seconds);
}

} // namespace
} // namespace sim::test
