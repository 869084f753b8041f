// Every command of random traffic keeps every rule of the data sheet, and the checker that says so notices
// each rule when it is broken.
#include "sim/memory/dram_load.h"
#include "sim/memory/dram_slots.h"
#include "tests/sim/dram_checker.h"
#include "tests/sim/dram_traffic.h"
#include "tests/sim/machines.h"

#include <gtest/gtest.h>

namespace sim::test {
namespace {

using M = MemoryConfig;
constexpr std::uint64_t far = std::uint64_t{1} << 24; // lines

/// Random and sequential parts, few rows and many, bursts of writes.
DramStream mixed(unsigned seed) {
    return [random = std::mt19937_64(seed), next = std::uint64_t{0}, left = 0U, kind = 0U,
            spread = far]() mutable {
        if (left == 0) {
            left = 1 + static_cast<unsigned>(random() % 200);
            kind = static_cast<unsigned>(random() % 5);
            spread = std::uint64_t{1} << (4 + random() % 21);
            next = random() % far;
        }
        --left;
        next = kind < 2 ? next + 1 : random() % spread;
        return DramRequest{next * 64, kind == 0 || kind == 3 || (kind == 4 && random() % 2 == 0)};
    };
}

std::string names(const std::map<std::string, int>& broken) {
    std::string out;
    for (const auto& [name, count] : broken)
        out += name + " x " + std::to_string(count) + "  ";
    return out;
}

Config variant(const std::string& preset, unsigned seed) {
    std::mt19937 random(seed);
    return memory_of(preset, [&](M& m) {
        m.channels = integer{1} << random() % 3;
        m.ranks = integer{1} << random() % 3;
        m.page_policy = std::array{"open", "closed", "timeout"}[random() % 3];
        m.page_timeout = 1 + random() % 300;
        m.bank_xor = random() % 2 == 0 ? "on" : "off";
        m.write_queue = 4 + random() % 60;
        m.write_high = 1 + random() % static_cast<unsigned>(m.write_queue);
        m.write_low = random() % static_cast<unsigned>(m.write_high);
        m.command_buses = 1 + random() % 2;
        if (random() % 2 == 0) // as another device might have it
            for (integer M::*t : {&M::tRCD, &M::tRP, &M::tRAS, &M::tRC, &M::tCL, &M::tCWL, &M::tRTP, &M::tWR,
                                  &M::tFAW, &M::tRRD_L, &M::tWTR_L, &M::tCCD_L, &M::tRTW, &M::tRTRS})
                m.*t += random() % 12;
    });
}

TEST(DramRules, RandomTrafficKeepsThem) {
    for (const char* preset : {"ddr3-1600k", "ddr4-2400r", "hbm2"})
        for (unsigned seed = 0; seed < 12; ++seed) {
            Config c = variant(preset, seed);
            auto in_flight = std::uint64_t{1} << seed % 9;
            Outcome r = seed % 3 == 0 ? open_loop(c, 20, 8000, mixed(seed), seed, true)
                                      : closed_loop(c, in_flight, 8000, mixed(seed), true);
            auto broken = broken_rules(c.memory, r.log);
            EXPECT_TRUE(broken.empty()) << preset << " " << seed << ": " << names(broken);
            std::uint64_t bursts = 0, activates = 0;
            for (const DramCommand& x : r.log) {
                bursts += x.kind == DramCommand::Kind::read || x.kind == DramCommand::Kind::write ? 1 : 0;
                activates += x.kind == DramCommand::Kind::activate ? 1 : 0;
            }
            EXPECT_EQ(bursts, r.counters.read_bursts + r.counters.write_bursts);
            EXPECT_EQ(activates, r.counters.activates);
        }
}

/// What only the controller with queues heeds.
Config queued_variant(const std::string& preset, unsigned seed) {
    Config c = variant(preset, seed);
    std::mt19937 random(seed + 1000);
    MemoryConfig& m = c.memory;
    m.scheduler = random() % 4 == 0 ? "fcfs" : "fr-fcfs";
    m.age_cap = random() % 2 == 0 ? 0 : 50 + random() % 500;
    m.read_queue = 2 + random() % 64;
    m.refresh = random() % 3 == 0 ? "per-bank" : "all-bank";
    m.refresh_postponed = m.refresh == "per-bank" ? 0 : random() % 9;
    m.tRREFD = 1 + random() % 20;
    check_consistency(c, "test");
    return c;
}

TEST(DramRules, RandomTrafficKeepsThemWithQueues) {
    std::uint64_t refreshes = 0, of_banks = 0, postponed = 0;
    for (const char* preset : {"ddr3-1600k", "ddr4-2400r", "hbm2"})
        for (unsigned seed = 0; seed < 30; ++seed) {
            Config c = queued_variant(preset, seed);
            DramLoad load{seed % 3 == 0 ? 20.0 : 0.0, std::uint64_t{1} << seed % 9, 8000, seed};
            DramOutcome r = run_dram_queued(c, mixed(seed), load, true);
            auto broken = broken_rules(c.memory, r.log);
            EXPECT_TRUE(broken.empty()) << preset << " " << seed << ": " << names(broken);
            std::uint64_t bursts = 0, activates = 0;
            for (const DramCommand& x : r.log) {
                bursts += x.kind == DramCommand::Kind::read || x.kind == DramCommand::Kind::write ? 1 : 0;
                activates += x.kind == DramCommand::Kind::activate ? 1 : 0;
                refreshes += x.kind == DramCommand::Kind::refresh ? 1 : 0;
                of_banks += x.kind == DramCommand::Kind::refresh_bank ? 1 : 0;
                postponed += x.kind == DramCommand::Kind::refresh &&
                                     x.at % u(c.memory.tREFI) != u(c.memory.tREFI * x.rank / c.memory.ranks)
                                 ? 1
                                 : 0;
            }
            const MemoryCounters& n = r.counters;
            EXPECT_EQ(bursts, n.read_bursts + n.write_bursts);
            EXPECT_EQ(activates, n.activates);
            EXPECT_EQ(n.row_hits + n.row_empties + n.row_conflicts, bursts);
            EXPECT_EQ(activates, n.row_empties + n.row_conflicts + n.reopened);
            EXPECT_EQ((n.reads + n.writes) * 64,
                      (bursts + n.forwarded + n.merged) * u(c.memory.bus_bytes * c.memory.burst_length));
            EXPECT_EQ(n.reads, r.reads);
        }
    EXPECT_GT(refreshes, 100U);
    EXPECT_GT(of_banks, 100U);
    EXPECT_GT(postponed, 20U);
}

// A memory that takes a shorter time than the data sheet says is caught under the name of that time.
TEST(DramRules, EachBrokenRuleIsNoticed) {
    struct Rule {
        const char* name;
        integer M::*member;
    };
    for (const Rule& rule : {Rule{"tRCD", &M::tRCD},
                             {"tRP", &M::tRP},
                             {"tRAS", &M::tRAS},
                             {"tRC", &M::tRC},
                             {"tCCD_S", &M::tCCD_S},
                             {"tCCD_L", &M::tCCD_L},
                             {"tRRD_S", &M::tRRD_S},
                             {"tRRD_L", &M::tRRD_L},
                             {"tFAW", &M::tFAW},
                             {"tRTP", &M::tRTP},
                             {"tWR", &M::tWR},
                             {"tWTR_S", &M::tWTR_S},
                             {"tWTR_L", &M::tWTR_L},
                             {"tRTW", &M::tRTW},
                             {"tRTRS", &M::tRTRS},
                             {"tRFC", &M::tRFC}}) {
        auto base = [](M& m) {
            m.ranks = 2;
            m.tRC = 62;   // longer than tRAS + tRP, so that each matters
            m.tCCD_S = 5; // longer than a burst
            m.tRTP = 20;
            m.tWTR_S = 8;
            m.tRRD_S = 5;
            m.tFAW = 30;
        };
        Config sheet = memory_of("ddr4-2400r", base);
        Config wrong = memory_of("ddr4-2400r", [&](M& m) {
            base(m);
            --(m.*rule.member);
        });
        Outcome r = closed_loop(wrong, 32, 12000, mixed(3), true);
        auto broken = broken_rules(sheet.memory, r.log);
        EXPECT_EQ(broken.count(rule.name), 1U) << rule.name << " noticed as " << names(broken);
        EXPECT_EQ(broken_rules(wrong.memory, r.log).size(), 0U);
    }
}

// A command marks clocks before its own, which time may have left: however far ahead others are booked.
TEST(DramRules, CommandsMayComeAtOnceWhereOthersAreBookedFarAhead) {
    for (const MemoryConfig& preset : memory_presets())
        for (Clock ahead = 0; ahead < 40; ++ahead) {
            Config c = memory_of(preset.preset);
            DramTiming timing(c.memory);
            DramSlots slots(c.memory, timing, 0);
            const Clock now = 64 * 1000;
            slots.set_now(now);
            const Clock later = slots.find_column(now + 64 * ahead + 63, now, Column::read, 0, 0);
            slots.take_column(later, Column::read, 0, 0);
            const Clock write = slots.find_column(now, now, Column::write, 0, 0);
            slots.take_column(write, Column::write, 0, 0);
            const Clock activate = slots.find_activate(now, now, 0, 0);
            slots.take_activate(activate, 0, 0);
            const Clock read = slots.find_column(now, now, Column::read, 0, 0);
            const Clock apart = timing.column[at(Column::write)][at(Column::read)][at(Near::group)];
            EXPECT_TRUE(read >= write + apart || read < write) << preset.preset << ", " << ahead;
        }
}

// Rules that are no parameters: single commands moved by hand.
TEST(DramRules, OtherBrokenRulesAreNoticed) {
    Config c = memory_of("ddr4-2400r");
    Outcome r = closed_loop(c, 32, 5000, mixed(5), true);
    using Kind = DramCommand::Kind;
    auto first = [&](Kind kind) {
        return static_cast<std::size_t>(
            std::find_if(r.log.begin(), r.log.end(), [&](const DramCommand& x) { return x.kind == kind; }) -
            r.log.begin());
    };
    auto broken = [&](std::size_t i, const DramCommand& changed) {
        auto log = r.log;
        log[i] = changed;
        return broken_rules(c.memory, log);
    };
    DramCommand x = r.log[first(Kind::read)];
    ++x.row;
    EXPECT_EQ(broken(first(Kind::read), x).count("state"), 1U);
    x = r.log[first(Kind::refresh)];
    ++x.at;
    EXPECT_EQ(broken(first(Kind::refresh), x).count("refresh time"), 1U);
    x = r.log[first(Kind::read)];
    x.at = r.log[first(Kind::activate) + 2].at;
    EXPECT_EQ(broken(first(Kind::read), x).count("command bus"), 1U);
    x = r.log[first(Kind::read)];
    for (const DramCommand& other : r.log)
        if (other.kind == Kind::read && other.at > x.at + 40) {
            x.at = other.at - 2;
            break;
        }
    EXPECT_EQ(broken(first(Kind::read), x).count("data bus"), 1U);
}

} // namespace
} // namespace sim::test
