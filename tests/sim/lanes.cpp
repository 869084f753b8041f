// What goes lane by lane, and operations of several instructions: exact counts.
#include "tests/sim/machines.h"

#include <array>
#include <numeric>

namespace sim::test {
namespace {

constexpr std::uint64_t some_lanes = 0b10110; // three of the first eight
constexpr std::uint64_t active = 3, width_lanes = ISA_WIDTH;

/// Two pieces of four lanes for eight logical lanes.
Config by_lane() {
    Config c = simple();
    c.core.lanes = 4;
    c.core.gather = "lane";
    c.lanes.masked = "on";
    c.lanes.piece_instructions = 4;
    c.lanes.piece_references = 2;
    c.lanes.load_instructions = 9;
    c.lanes.load_references = 3;
    c.lanes.store_instructions = 6;
    c.lanes.store_references = 1;
    return c;
}
constexpr std::uint64_t pieces = ISA_WIDTH / 4;

std::array<std::int32_t, ISA_WIDTH> numbers() {
    std::array<std::int32_t, ISA_WIDTH> out{};
    std::iota(out.begin(), out.end(), 0);
    return out;
}

/// Instructions, and what the L1 was asked for, beyond those of making the mask.
struct Counts {
    std::uint64_t instructions, references;
    bool operator==(const Counts&) const = default;
};
template <class Work> Counts counts(const Config& c, Work work) {
    const auto of = [&c](auto body) {
        return run_on(c, [&](std::byte* base, int) { body(base, vector_op(operation::mask, stamp{})); });
    };
    const Report all = of(work), none = of([](std::byte*, const stamp&) {});
    return {all.core.instructions - none.core.instructions,
            all.l1_total().reads + all.l1_total().writes - none.l1_total().reads - none.l1_total().writes};
}
Counts masked_load(const Config& c) {
    return counts(c,
                  [](std::byte* p, const stamp& mask) { load_vector(here, p, some_lanes, stamp{}, mask); });
}
Counts masked_store(const Config& c) {
    return counts(c, [](std::byte* p, const stamp& mask) {
        store_vector(here, p, some_lanes, stamp{}, stamp{}, mask);
    });
}
Counts a_gather(const Config& c) {
    return counts(c, [](std::byte* p, const stamp& mask) {
        gather(here, p, numbers().data(), some_lanes, stamp{}, stamp{}, mask);
    });
}
Counts a_scatter(const Config& c) {
    return counts(c, [](std::byte* p, const stamp& mask) {
        scatter(here, p, numbers().data(), some_lanes, stamp{}, stamp{}, stamp{}, mask);
    });
}

TEST(Lanes, LoadsTakeWhatEachActiveLaneTakes) {
    const Counts expected{pieces * 4 + active * (9 + 1), pieces * 2 + active * (3 + 1)};
    EXPECT_EQ(masked_load(by_lane()), expected);
    EXPECT_EQ(a_gather(by_lane()), expected);
}

TEST(Lanes, IdleLanesMayTakeAllButTheLoad) {
    Config c = by_lane();
    c.lanes.idle = "test";
    const Counts expected{pieces * 4 + width_lanes * 9 + active, pieces * 2 + width_lanes * 3 + active};
    EXPECT_EQ(masked_load(c), expected);
    EXPECT_EQ(a_gather(c), expected);
}

TEST(Lanes, GathersOfASubVectorMayTakeMoreInstructions) {
    Config c = by_lane();
    c.lanes.masked = "off";
    c.core.gather = "line";
    const Counts before = a_gather(c), load = masked_load(c);
    c.lanes.gather_instructions = 5;
    EXPECT_EQ(a_gather(c), (Counts{before.instructions + 5 * pieces, before.references}));
    EXPECT_EQ(masked_load(c), load);
    c.core.gather = "lane"; // nothing is gathered by one instruction
    const Counts by_lanes = a_gather(c);
    c.lanes.gather_instructions = 0;
    EXPECT_EQ(a_gather(c), by_lanes);
}

TEST(Lanes, StoresTakeWhatEachActiveLaneTakes) {
    Config c = by_lane();
    c.lanes.idle = "test"; // of no effect on stores
    const Counts expected{pieces * 4 + active * (6 + 1), pieces * 2 + active * (1 + 1)};
    EXPECT_EQ(masked_store(c), expected);
    EXPECT_EQ(a_scatter(c), expected);
    c.core.store_buffer = 8; // what puts lanes together does not go through it: a law says how many do
    EXPECT_EQ(masked_store(c).instructions, expected.instructions);
}

TEST(Lanes, WithoutAMaskNothingGoesLaneByLane) {
    const auto plain = [](const Config& c) {
        return counts(c, [](std::byte* p, const stamp&) {
            store_vector(here, p, all_lanes, stamp{}, stamp{}, stamp{});
            load_vector(here, p, all_lanes, stamp{}, stamp{});
        });
    };
    EXPECT_EQ(plain(by_lane()), (Counts{2 * pieces, 2 * pieces}));
    Config c = by_lane();
    c.lanes.masked = "off";
    EXPECT_EQ(masked_load(c).instructions, pieces);
    EXPECT_EQ(masked_store(c).instructions, pieces);
}

TEST(Lanes, ScattersAloneMayGoLaneByLane) {
    Config c = by_lane();
    c.lanes.masked = "off";
    c.core.gather = "line";
    const Counts by_line{pieces, 2}; // the lanes lie in two pieces
    EXPECT_EQ(a_gather(c), by_line);
    EXPECT_EQ(a_scatter(c), by_line);
    c.lanes.scatter = "on";
    EXPECT_EQ(a_gather(c), by_line);
    EXPECT_EQ(a_scatter(c), (Counts{pieces * 4 + active * (6 + 1), pieces * 2 + active * (1 + 1)}));
}

TEST(Lanes, ShufflesGoThroughTheStackAsGathersOfAllLanes) {
    Config c = by_lane();
    const auto permute = [](const Config& k) {
        return counts(k, [](std::byte*, const stamp& a) { cross_op(operation::shuffle, a, a); });
    };
    const auto extract = [](const Config& k) {
        return counts(k, [](std::byte*, const stamp& a) { cross_to_scalar(operation::shuffle, a, stamp{}); });
    };
    EXPECT_EQ(permute(c), (Counts{pieces, 0}));
    c.lanes.shuffle = "on";
    EXPECT_EQ(permute(c), (Counts{pieces * (1 + 1 + 4) + width_lanes * (9 + 1),
                                  pieces * (1 + 2) + width_lanes * (3 + 1)}));
    EXPECT_EQ(extract(c), (Counts{pieces, 0}));
    c.lanes.shuffle = "off";
    c.instructions[static_cast<std::size_t>(operation::shuffle)] = 13;
    EXPECT_EQ(permute(c), (Counts{13 * pieces, 0}));
    EXPECT_EQ(extract(c), (Counts{pieces, 0})); // one lane
}

TEST(Lanes, AnOperationMayTakeSeveralInstructions) {
    for (const integer takes : {1, 2, 20}) { // more than 64 at once, too
        Config c = simple();
        c.core.lanes = 4;
        const auto fused = static_cast<std::size_t>(operation::fused);
        c.instructions[fused] = takes;
        const Report r = run(c, [](int) {
            for (int i = 0; i < 100; ++i)
                vector_op(operation::fused, stamp{}, stamp{}, stamp{});
            vector_op(operation::add, stamp{});
            scalar_op(operation::fused, stamp{});
        });
        EXPECT_EQ(r.core.instructions, u(takes) * pieces * 100 + pieces + 1);
        EXPECT_EQ(r.by_kind[vector_kind(fused)], u(takes) * pieces * 100);
        EXPECT_EQ(r.core.lane_slots, 101 * u(ISA_WIDTH)); // lanes do not multiply
    }
}

TEST(Lanes, RefusesWhatDoesNotFit) {
    EXPECT_EQ(
        mistake("[core]\ngather = \"line\"\n[lanes]\nmasked = \"on\"\n"),
        "m.toml: lanes.masked is \"on\" where core.gather is \"line\": what goes lane by lane is a gather; "
        "make core.gather \"lane\" (core.gather from m.toml:2, lanes.masked from m.toml:4)");
    EXPECT_EQ(
        mistake("[lanes]\nload_instructions = 2\nload_references = 3\n"),
        "m.toml: lanes.load_references is 3, more than lanes.load_instructions, 2, of which they are a part; "
        "make that at least 3 (lanes.load_instructions from m.toml:2, lanes.load_references from m.toml:3)");
}

} // namespace
} // namespace sim::test
