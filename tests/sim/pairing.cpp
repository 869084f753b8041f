// Which instructions issue together, and units that several share: exact cycles.
#include "sim/machine/limits.h"
#include "tests/sim/machines.h"

namespace sim::test {
namespace {

constexpr int n = 1000;
constexpr const char* u_and_v = "any | scalar.integer scalar.address load store branch"; // Pentium, Larrabee

std::string refused(const Config& c) {
    try {
        check_consistency(c, "m");
    } catch (const ConfigError& e) {
        return e.what();
    }
    return "";
}

void scalars(int count) {
    for (int i = 0; i < count; ++i)
        scalar_op(operation::integer, stamp{});
}
void vectors(int count, operation op = operation::add) {
    for (int i = 0; i < count; ++i)
        vector_op(op, stamp{});
}

TEST(Pairing, AVectorAndAScalarIssueTogetherTwoVectorsDoNot) {
    Config c = simple();
    c.core.issue_width = 2;
    c.core.pairing = u_and_v;
    auto pairs = [](bool scalar_first) {
        return [scalar_first](int) {
            for (int i = 0; i < n; ++i) {
                scalars(scalar_first ? 1 : 0);
                vectors(1);
                scalars(scalar_first ? 0 : 1);
            }
        };
    };
    for (bool scalar_first : {false, true}) {
        Report r = run(c, pairs(scalar_first));
        EXPECT_EQ(r.cycles, u(n - 1 + 4)) << scalar_first;
        EXPECT_EQ(r.port_instructions[0], (std::vector<std::uint64_t>{u(n), u(n)}));
    }
    EXPECT_EQ(run(c, [](int) { vectors(n); }).cycles, u(n - 1 + 4));
    EXPECT_EQ(run(c, [](int) { scalars(n); }).cycles, u(n / 2));
    Config any = c;
    any.core.pairing = "any";
    EXPECT_EQ(run(any, [](int) { vectors(n); }).cycles, u(n / 2 - 1 + 4));
    EXPECT_STREQ(binding(limits(run(c, [](int) { vectors(n); }))).resource, "issue ports");
}

// A dependent chain follows piece by piece at the rate that the ports allow.
TEST(Pairing, PiecesIssueAtTheRateOfTheirPorts) {
    Config c = simple();
    c.core.issue_width = 2;
    for (integer lanes : {1, 2, 4}) {
        c.core.lanes = lanes;
        integer pieces = ISA_WIDTH / lanes;
        auto chain = [](int) {
            stamp s;
            for (int i = 0; i < n; ++i)
                s = vector_op(operation::add, s);
        };
        c.core.pairing = u_and_v;
        EXPECT_EQ(run(c, chain).cycles, u((n - 1) * std::max<integer>(4, pieces) + pieces - 1 + 4)) << lanes;
        c.core.pairing = "vector | any";
        integer span = pieces / 2;
        EXPECT_EQ(run(c, chain).cycles, u((n - 1) * std::max<integer>(4, span) + span - 1 + 4)) << lanes;
    }
}

// Four wide, with a multiplier, an adder, a port for shuffles and branches, loads and stores.
TEST(Pairing, PortsOfClassesBoundEachClass) {
    Config c = simple();
    c.core.issue_width = 4;
    c.core.window = 96;
    c.core.pairing =
        "vector.multiply vector.fused vector.divide vector.square_root scalar | "
        "vector.add vector.compare vector.convert vector.integer vector.integer_multiply scalar | "
        "vector.shuffle vector.broadcast vector.select vector.mask vector.reduce "
        "vector.mask_to_scalar vector.address branch scalar | load | store";
    ASSERT_EQ(refused(c), "");
    EXPECT_EQ(run(c, [](int) { vectors(n, operation::multiply); }).cycles, u(n - 1 + 4));
    EXPECT_EQ(run(c,
                  [](int) {
                      for (int i = 0; i < n; ++i) {
                          vectors(1, operation::multiply);
                          vectors(1, operation::add);
                      }
                  })
                  .cycles,
              u(n - 1 + 4));
    EXPECT_EQ(run(c, [](int) { scalars(3 * n); }).cycles, u(n)); // three ports, though four slots
    c.core.issue_width = 2;
    EXPECT_EQ(run(c, [](int) { scalars(3 * n); }).cycles, u(3 * n / 2));
}

TEST(Pairing, AUnitAndAPortAreTakenInTheSameCycle) {
    Config c = simple();
    c.core.issue_width = 2;
    c.core.pairing = u_and_v;
    Report r = run(c, [](int) {
        for (int i = 0; i < n; ++i) {
            vectors(1, operation::divide); // every eighth cycle
            vectors(7);
        }
    });
    EXPECT_EQ(r.cycles, u((n - 1) * 8 + 16)); // the last divide ends after the adds behind it
}

// In a window a divide that could begin early does so only where the unit stays free for as long as it needs
// it.
TEST(Pairing, AGapOfAUnitIsTakenOnlyByWhatFitsIntoIt) {
    Config c = simple();
    c.core.issue_width = 2;
    c.core.window = 64;
    c.core.pairing = u_and_v;
    constexpr int port_taken = 1; // by the first add, in cycle 0
    for (int adds : {1, 2, 3}) {
        Report r = run(c, [adds](int) {
            stamp s;
            for (int i = 0; i < adds; ++i)
                s = vector_op(operation::add, s);
            vector_op(operation::divide, s);
            vectors(1, operation::divide);
        });
        int waits = 4 * adds;
        EXPECT_EQ(r.cycles, u((waits < port_taken + 8 ? waits + 8 : waits) + 16)) << adds;
    }
}

TEST(Pairing, MistakesAreNamed) {
    auto with = [](const char* pairing) {
        Config c = simple();
        c.core.pairing = pairing;
        return refused(c);
    };
    EXPECT_EQ(with("any"), "");
    EXPECT_EQ(with("any | scalar"), "");
    EXPECT_EQ(with("vector | scalar"),
              "m: core.pairing \"vector | scalar\" has no port for branch; add it to one");
    EXPECT_NE(with("any | scaler").find("names \"scaler\""), std::string::npos);
    EXPECT_NE(with("any | vector.branch").find("names \"vector.branch\""), std::string::npos);
    EXPECT_NE(with("any |").find("has a port that takes nothing"), std::string::npos);
    EXPECT_NE(with("").find("has a port that takes nothing"), std::string::npos);
    EXPECT_NE(
        with("any|any|any|any|any|any|any|any|any|any|any|any|any|any|any|any|any").find("has 17 ports"),
        std::string::npos);
    EXPECT_NE(with("scalar vector memory").find("no port for branch"), std::string::npos);
    EXPECT_NE(with("scalar vector branch load").find("no port for scalar.store"), std::string::npos);
}

TEST(SharedUnits, CoresTakeTurns) {
    for (integer cores : {1, 2, 4, 8})
        for (integer interval : {1, 5}) {
            Config c = simple();
            c.chip.cores = 8;
            c.core.shared_classes = "add multiply fused divide square_root";
            c.core.shared_cores = cores;
            c.interval[static_cast<std::size_t>(operation::add)] = interval;
            c.latency[static_cast<std::size_t>(operation::add)] = 40;
            Report r = run(
                c, [](int) { vectors(n); }, 8);
            EXPECT_EQ(r.cycles, u((n * cores - 1) * interval + 40)) << cores << " " << interval;
            EXPECT_EQ(r.shared_unit_cycles,
                      std::vector<std::uint64_t>(u(8 / cores), u(n * cores * interval)));
            EXPECT_STREQ(binding(limits(r)).resource, cores * interval > 1 ? "shared units" : "issue slots");
            // What does not go through the unit does not wait for it.
            EXPECT_EQ(run(
                          c, [](int) { scalars(n); }, 8)
                          .cycles,
                      u(n));
        }
}

TEST(SharedUnits, ClassesOfACoreMayShareOne) {
    Config c = simple();
    c.core.issue_width = 2;
    auto both = [](int) {
        for (int i = 0; i < n; ++i) {
            vectors(1);
            vectors(1, operation::multiply);
        }
    };
    EXPECT_EQ(run(c, both).cycles, u(n - 1 + 4));
    c.core.shared_classes = "multiply add";
    EXPECT_EQ(run(c, both).cycles, u(2 * n - 1 + 4));
}

TEST(SharedUnits, MistakesAreNamed) {
    Config c = simple();
    c.chip.cores = 8;
    c.core.shared_classes = "add mul";
    EXPECT_NE(refused(c).find("names \"mul\""), std::string::npos);
    c.core.shared_classes = "add";
    c.core.shared_cores = 3;
    EXPECT_NE(refused(c).find("within a tile"), std::string::npos);
    c.core.shared_cores = 16;
    EXPECT_NE(refused(c).find("within a tile"), std::string::npos);
    c.core.shared_cores = 4;
    EXPECT_EQ(refused(c), "");
}

TEST(Stacks, CoresAndThreadsSumUp) {
    Config c = simple();
    c.chip.cores = 3;
    c.chip.threads = 2;
    Report r = run(
        c, [](int w) { scalars(100 * (w + 1)); }, 4); // workers go to different cores first
    std::vector<Stack> cores = r.core_stacks();
    auto busy = static_cast<std::size_t>(Cause::busy);
    ASSERT_EQ(cores.size(), 3U);
    EXPECT_EQ(cores[0][busy], 100U + 400U);
    EXPECT_EQ(cores[1][busy], 200U);
    EXPECT_EQ(cores[2][busy], 300U);
    EXPECT_EQ(r.threads[2].stack()[busy], 200U);
    EXPECT_NE(print_text(r).find("% of cycles by core"), std::string::npos);
    EXPECT_NE(print_json(r).find("\"cores\""), std::string::npos);
}

TEST(SkipIdle, MaskedAccessesIssueActiveSubvectorsOnly) {
    Config c = simple();
    c.core.lanes = 4;
    c.l1.port_bytes = 16;
    integer pieces = ISA_WIDTH / 4;
    std::array<std::int32_t, 64> index{};
    constexpr std::uint64_t last_lane = std::uint64_t{1} << (ISA_WIDTH - 1);
    for (std::uint64_t lanes :
         {all_lanes, std::uint64_t{1}, std::uint64_t{0}, last_lane | 1U, all_lanes & 0x0f0f0f0fU})
        for (bool skip : {false, true}) {
            integer active = 0;
            for (int piece = 0; piece < pieces; ++piece)
                active += (lanes >> (4 * piece) & 15U) != 0 ? 1 : 0;
            c.core.skip_idle = skip ? "on" : "off";
            auto instructions = u(skip ? std::max<integer>(1, active) : pieces);
            EXPECT_EQ(run_on(c,
                             [&](std::byte* base, int) {
                                 for (int i = 0; i < n; ++i)
                                     load_vector(here, base, lanes, stamp{}, stamp{});
                             })
                          .core.instructions,
                      instructions * n);
            Report r = run_on(c, [&](std::byte* base, int) {
                store_vector(here, base, lanes, stamp{}, stamp{}, stamp{});
                gather(here, base, index.data(), lanes, stamp{}, stamp{}, stamp{});
                scatter(here, base, index.data(), lanes, stamp{}, stamp{}, stamp{}, stamp{});
            });
            EXPECT_EQ(r.core.instructions, 3 * instructions);
            EXPECT_EQ(r.core.lane_slots, 3 * instructions * 4);
        }
}

// n instructions of a store follow an operand of more pieces no earlier than its last piece allows.
TEST(SkipIdle, AFewInstructionsWaitForTheLastPiece) {
    Config c = simple();
    c.core.lanes = 4;
    c.core.skip_idle = "on";
    cycle issued = 0;
    run_on(c, [&](std::byte* base, int) {
        stamp data = vector_op(operation::add, stamp{});
        store_vector(here, base, 1, stamp{}, data, stamp{});
        issued = running_hart->issued;
    });
    EXPECT_EQ(issued, u(ISA_WIDTH / 4 - 1 + 4)); // its one instruction, when the last piece is there
}

} // namespace
} // namespace sim::test
