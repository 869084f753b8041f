// Closed forms of the core: exact cycles.
#include "sim/validation/core_forms.h"
#include "tests/sim/machines.h"

namespace sim::test {
namespace {

constexpr int n = 1000;
constexpr auto add_class = static_cast<std::size_t>(operation::add);

TEST(Core, FormsTakeTheirCycles) {
    const std::vector<CoreForm> forms = core_forms();
    EXPECT_EQ(forms.size(), 22U);
    for (const CoreForm& form : forms) {
        const Report r = form.run();
        EXPECT_EQ(r.cycles, form.cycles) << form.name;
        EXPECT_EQ(r.core.instructions, form.instructions) << form.name;
    }
}

TEST(Core, DependentChainTakesItsLatencies) {
    for (integer latency : {1, 4, 7}) {
        Config c = simple();
        c.latency[add_class] = latency;
        Report r = run(c, [](int) {
            stamp s;
            for (int i = 0; i < n; ++i)
                s = scalar_op(operation::add, s);
        });
        EXPECT_EQ(r.cycles, u(n * latency));
        EXPECT_EQ(r.core.instructions, u(n));
        EXPECT_EQ(cause(r, Cause::busy), u(n));
        EXPECT_EQ(cause(r, Cause::compute), u(n * (latency - 1)));
    }
}

TEST(Core, VectorOperationsTakeASlotForEachPiece) {
    for (integer lanes : {1, 2, 4, 8, 64}) {
        Config c = simple();
        c.core.lanes = lanes;
        integer pieces = std::max<integer>(1, ISA_WIDTH / lanes);
        Report r = run(c, [](int) {
            for (int i = 0; i < n; ++i)
                vector_op(operation::multiply, stamp{});
        });
        EXPECT_EQ(r.cycles, u(n * pieces - 1 + 4)) << lanes;
        EXPECT_EQ(r.core.instructions, u(n * pieces));
        EXPECT_EQ(r.core.lane_slots, u(n) * ISA_WIDTH);
    }
}

TEST(Core, ReductionsWaitForTheLastPiece) {
    Config c = simple();
    c.core.lanes = 4;
    auto pieces = u(ISA_WIDTH / 4);
    stamp vector, scalar;
    run(c, [&](int) {
        vector = vector_op(operation::add, stamp{});
        scalar = cross_to_scalar(operation::reduce, vector, stamp{});
    });
    EXPECT_EQ(vector.first, 4U);
    EXPECT_EQ(vector.last, pieces - 1 + 4);
    EXPECT_EQ(scalar.last, vector.last + pieces - 1 + 6);
    EXPECT_EQ(scalar.first, scalar.last);
}

TEST(Core, ThreadsShareTheSlotsAndHideLatency) {
    for (integer threads : {1, 2, 3, 4, 8}) {
        Config c = simple();
        c.chip.threads = threads;
        Report r = run(
            c,
            [](int) {
                stamp s;
                for (int i = 0; i < n; ++i)
                    s = scalar_op(operation::add, s);
            },
            static_cast<int>(threads));
        // Up to 4 threads each fill a slot of the latency of 4; more share the issue slots.
        cycle expected = threads <= 4 ? u((n - 1) * 4 + threads - 1 + 4) : u(n * threads - 1 + 4);
        EXPECT_NEAR(static_cast<double>(r.cycles), static_cast<double>(expected), 8.0) << threads;
        EXPECT_EQ(r.core.instructions, u(n * threads));
    }
}

TEST(Core, PolicyStallKeepsTheCoreAndChargesSwitches) {
    Config c = simple();
    c.chip.threads = 2;
    c.core.switch_policy = "stall";
    c.core.switch_cycles = 3;
    auto busy = [](int) {
        for (int i = 0; i < n; ++i)
            scalar_op(operation::integer, stamp{});
    };
    Report r = run(c, busy, 2);
    EXPECT_EQ(r.core.switches, 1U); // nobody stalls: one after the other
    EXPECT_NEAR(static_cast<double>(r.cycles), 2.0 * n + 4, 4.0);
    Report stalling = run(
        c,
        [](int) {
            stamp s;
            for (int i = 0; i < n; ++i)
                s = scalar_op(operation::divide, s);
        },
        2);
    EXPECT_GT(stalling.core.switches, u(n));
}

TEST(Core, RegistersSpillThroughTheL1) {
    Config c = simple();
    c.core.vector_registers = 2;
    Report r = run(c, [](int) {
        stamp a = vector_op(operation::add, stamp{});
        stamp b = vector_op(operation::add, stamp{});
        stamp d = vector_op(operation::add, stamp{}); // a is out
        vector_op(operation::add, b, d);              // both there; the result pushes b out
        vector_op(operation::add, a);                 // stored and reloaded
        vector_op(operation::add, b);                 // stored and reloaded
        vector_op(operation::add, a);                 // the result of the last two and b: reloaded only
    });
    EXPECT_EQ(r.core.spill_stores, 2U);
    EXPECT_EQ(r.core.spill_loads, 3U);
    std::size_t spill = r.structures.size() - 1;
    EXPECT_EQ(r.structures[spill], "spill");
    auto lines = u(std::max(1, ISA_WIDTH * 4 / 64));
    ASSERT_EQ(r.traffic.size(), 1U);
    EXPECT_EQ(r.traffic[0].structure, spill);
    EXPECT_EQ(r.traffic[0].traffic.l1_reads, 3 * lines);
    EXPECT_EQ(r.traffic[0].traffic.l1_writes, 2 * lines);
    EXPECT_EQ(r.core.vops, 7U);
    c.core.vector_registers = 3;
    Report enough = run(c, [](int) {
        stamp a = vector_op(operation::add, stamp{});
        stamp b = vector_op(operation::add, stamp{});
        stamp d = vector_op(operation::add, a, b);
        vector_op(operation::add, d, a);
    });
    EXPECT_EQ(enough.core.spill_loads, 0U);
}

TEST(Core, RegistersKeepTheLastUsed) {
    Config c = simple();
    c.core.vector_registers = 2;
    Report r = run(c, [](int) {
        stamp a = vector_op(operation::add, stamp{});
        stamp b = vector_op(operation::add, stamp{});
        cross_to_scalar(operation::reduce, a, stamp{}); // a is younger than b now
        vector_op(operation::add, stamp{});             // pushes b out
        cross_to_scalar(operation::reduce, a, stamp{});
        EXPECT_NE(b.value, 0U);
    });
    EXPECT_EQ(r.core.spill_loads, 0U);
}

// A value that is the same in all lanes, kept in a machine register of its own: beside one value of full
// width, as many as the other's registers are.
TEST(Core, BroadcastValuesMayTakeOneMachineRegister) {
    Config c = simple();
    c.core.vector_registers = 2;
    c.core.lanes = ISA_WIDTH / 4; // four machine registers a value
    const auto work = [](std::byte* p, int) {
        stamp a = vector_op(operation::add, stamp{});
        std::array<stamp, 4> same;
        for (stamp& s : same)
            s = vector_op(operation::broadcast, stamp{});
        cross_to_scalar(operation::reduce, a, stamp{});
        for (const stamp& s : same)
            cross_to_scalar(operation::reduce, s, stamp{});
        stamp b = load_broadcast(here, p, 4, stamp{}); // the fifth
        cross_to_scalar(operation::reduce, a, stamp{});
        EXPECT_NE(b.value, 0U);
    };
    const Report whole = run_on(c, work);
    EXPECT_GT(whole.core.spill_loads, 3U);
    c.core.broadcasts = "register";
    const Report one = run_on(c, work);
    EXPECT_EQ(one.core.spill_loads, 1U); // `a` alone, of the fifth
    const auto work_of_one = [](int) {
        stamp same = vector_op(operation::broadcast, stamp{});
        vector_op(operation::add, stamp{});
        vector_op(operation::add, stamp{});
        cross_to_scalar(operation::reduce, same, stamp{}); // gone: a store and a load of one register
    };
    const Report back = run(c, work_of_one);
    EXPECT_EQ(back.core.spill_stores, 1U);
    EXPECT_EQ(back.core.spill_loads, 1U);
    EXPECT_EQ(back.core.instructions, 1U + 2 * 4 + 4 + 2);
    const std::size_t spill = back.structures.size() - 1;
    ASSERT_EQ(back.traffic.size(), 1U);
    EXPECT_EQ(back.traffic[0].structure, spill);
    EXPECT_EQ(back.traffic[0].traffic.l1_reads, 1U);
    EXPECT_EQ(back.traffic[0].traffic.l1_writes, 1U);
}

TEST(Core, OperandsFromTheStackMayTakeNoInstruction) {
    Config c = simple();
    c.core.vector_registers = 2;
    c.core.lanes = ISA_WIDTH / 4;
    const auto work = [](std::byte* p, int) {
        stamp a = vector_op(operation::add, stamp{});
        stamp b = vector_op(operation::add, stamp{});
        for (int i = 0; i < 2; ++i)
            vector_op(operation::add, stamp{}); // a and b are out
        vector_op(operation::add, a, b);
        store_vector(here, p, all_lanes, stamp{}, b, stamp{}); // still there
        for (int i = 0; i < 2; ++i)
            vector_op(operation::add, stamp{});
        store_vector(here, p, all_lanes, stamp{}, b, stamp{}); // by an instruction of its own
    };
    std::array<Report, 3> r;
    for (std::size_t operands = 0; operands < r.size(); ++operands) {
        c.core.memory_operands = static_cast<integer>(operands);
        r[operands] = run_on(c, work);
        EXPECT_EQ(r[operands].core.spill_loads, 3U);
        EXPECT_EQ(r[operands].core.memory_operands, operands);
        EXPECT_EQ(r[operands].core.instructions + 4 * operands, r[0].core.instructions);
        EXPECT_EQ(r[operands].l1_total().reads, r[0].l1_total().reads);
    }
    EXPECT_LE(r[2].cycles, r[0].cycles);
}

// What was used since the last branch, permutation or lane by lane stays, as many values as are interleaved.
TEST(Core, StretchesAreTakenAPieceAtATime) {
    Config c = simple();
    c.core.lanes = ISA_WIDTH / 4;
    c.core.vector_registers = 1;
    c.core.broadcasts = "register";
    const auto spilled = [&](integer interleaved, const std::function<void(std::byte*)>& between) {
        c.core.interleaved_values = interleaved;
        return run_on(c,
                      [&](std::byte* p, int) {
                          stamp a = vector_op(operation::add, stamp{});
                          stamp b = vector_op(operation::add, stamp{}); // a is out
                          between(p);
                          vector_op(operation::add, a, b);
                      })
            .core.spill_loads;
    };
    const auto nothing = [](std::byte*) {};
    EXPECT_EQ(spilled(0, nothing), 2U); // b too, once a is back
    EXPECT_EQ(spilled(1, nothing), 2U);
    EXPECT_EQ(spilled(2, nothing), 0U);
    EXPECT_EQ(spilled(2, [](std::byte*) { isa::timing::branch(here, stamp{}, true); }), 2U);
    EXPECT_EQ(spilled(2, [](std::byte*) { isa::timing::cross_op(operation::shuffle, stamp{}, stamp{}); }),
              2U);
    EXPECT_EQ(spilled(8, [](std::byte*) { isa::timing::cross_op(operation::shuffle, stamp{}, stamp{}); }),
              2U);
    EXPECT_EQ(
        spilled(2, [](std::byte*) { isa::timing::cross_to_scalar(operation::reduce, stamp{}, stamp{}); }),
        0U);
    // Of gathers only those that go lane by lane.
    const auto gathers = [](std::byte* p) {
        const std::array<std::int32_t, ISA_WIDTH> index{};
        isa::timing::gather(here, p, index.data(), all_lanes, stamp{}, stamp{}, stamp{});
    };
    EXPECT_EQ(spilled(8, gathers), 0U);
    c.core.gather = "lane";
    c.lanes.piece_instructions = 4;
    EXPECT_EQ(spilled(8, gathers), 2U);
}

TEST(Core, MispredictsCostTheirPenalty) {
    Config c = simple();
    c.core.predictor = "counters";
    c.core.mispredict_cycles = 20;
    auto loop = [](int) {
        for (int i = 0; i < n; ++i)
            isa::timing::branch(here, stamp{}, i + 1 < n);
    };
    Report r = run(c, loop);
    EXPECT_EQ(r.core.mispredicts, 1U);
    EXPECT_EQ(r.cycles, u(n)); // nothing follows the wrong one
    // Alternating: a two-bit counter that begins at weakly taken is wrong every other time, one bit of
    // history is not.
    auto alternate = [](int) {
        for (int i = 0; i < n; ++i)
            isa::timing::branch(here, stamp{}, i % 2 == 0);
    };
    Report wrong = run(c, alternate);
    EXPECT_EQ(wrong.core.mispredicts, u(n / 2));
    // Each pair: right, wrong; the next branch issues at the outcome (1 cycle) and the penalty.
    EXPECT_EQ(wrong.cycles, u(n / 2 * 2 + (n / 2 - 1) * 20));
    c.core.predictor_history = 1;
    EXPECT_LE(run(c, alternate).core.mispredicts, 2U);
    c.core.predictor = "none";
    c.latency[branch_class] = 3;
    EXPECT_EQ(run(c, loop).cycles, u(3 * n));
}

TEST(Core, SitesDoNotShareCounters) {
    Config c = simple();
    c.core.predictor = "counters";
    Report r = run(c, [](int) {
        for (int i = 0; i < 100; ++i)
            for (std::uint32_t line = 0; line < 5000; ++line)
                isa::timing::branch({"many", line}, stamp{}, line % 2 == 0);
    });
    EXPECT_EQ(r.core.mispredicts, 2500U); // the first look at each site that is never taken
}

TEST(Core, ScalarOverheadAddsInstructions) {
    Config c = simple();
    c.core.scalar_overhead = 1.5;
    Report r = run(c, [](int) {
        for (int i = 0; i < n; ++i)
            isa::timing::branch(here, stamp{}, true);
    });
    EXPECT_EQ(r.core.overhead_instructions, u(n * 3 / 2));
    EXPECT_EQ(r.core.instructions, u(n + n * 3 / 2));
}

TEST(Core, MovesAddInstructions) {
    Config c = simple();
    c.core.lanes = ISA_WIDTH / 4;
    c.core.scalar_moves = 0.5;
    c.core.vector_moves = 0.25;
    const Report r = run(c, [](int) {
        for (int i = 0; i < n; ++i) {
            scalar_op(operation::add, stamp{});
            isa::timing::branch(here, stamp{}, true); // no computation
            vector_op(operation::add, stamp{});       // four instructions
        }
    });
    EXPECT_EQ(r.core.overhead_instructions, u(n / 2 + n));
    EXPECT_EQ(r.core.instructions, u(n * 6 + n / 2 + n));
}

// As far ahead as an issue window of operations can book a unit.
TEST(Core, ABacklogMayBeAsLongAsTheIssueWindow) {
    Config c = simple();
    c.core.window = 1024;
    c.interval[static_cast<std::size_t>(operation::divide)] = 50;
    c.latency[static_cast<std::size_t>(operation::divide)] = 50;
    Report r = run(c, [](int) {
        for (int i = 0; i < 3000; ++i)
            scalar_op(operation::divide, stamp{});
    });
    EXPECT_EQ(r.cycles, 3000U * 50);
}

// Looks at a word count, but take no slots, where nobody does anything for long.
TEST(Core, AThreadMayWaitWhileTimeJumps) {
    Config c = simple();
    c.chip.threads = 2;
    c.core.spin_period = 10;
    c.coherence.atomic_cycles = 30000;
    Report r = run_on(
        c,
        [](std::byte* base, int w) {
            auto* words = reinterpret_cast<std::int32_t*>(base);
            if (w == 1) {
                wait_while(here, words, 0, stamp{}, stamp{});
                return;
            }
            before_atomic(here, atomic::fetch_add, words + 32, stamp{}, stamp{});
            stamp s = after_atomic(here, atomic::fetch_add, words + 32, true);
            before_atomic(here, atomic::store_release, words, stamp{}, s);
            *words = 1;
            after_atomic(here, atomic::store_release, words, true);
        },
        2);
    EXPECT_NEAR(static_cast<double>(r.core.spins), 3000, 20);
}

// What is independent of a word issues no earlier than others' bookings are remembered.
TEST(Core, AfterALongWaitForAWordTimeHasPassed) {
    Config c = simple();
    c.chip.threads = 2;
    c.core.window = 64;
    c.coherence.atomic_cycles = 30000;
    Report r = run_on(
        c,
        [](std::byte* base, int w) {
            before_atomic(here, atomic::fetch_add, base, stamp{}, stamp{});
            after_atomic(here, atomic::fetch_add, base, true);
            for (int i = 0; i < (w == 0 ? 60000 : 10); ++i)
                scalar_op(operation::integer, stamp{});
        },
        2);
    EXPECT_GT(r.threads[1].finish, 30000U);
    EXPECT_LT(r.threads[1].finish, 30000U * 2 + 1000);
}

} // namespace
} // namespace sim::test
