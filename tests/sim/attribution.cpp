// Traffic by kind of work, phase and level, and which lines were touched by whom.
#include "tests/sim/machines.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <numeric>
#include <random>

namespace sim::test {
namespace {

const Labels labels{{"one", "two"}, {"none", "left", "right"}};

Traffic sum(const Report& r, std::size_t structure, std::size_t kind, std::size_t phase) {
    Traffic t;
    for (const TrafficRow& row : r.traffic)
        if (row.structure == structure && r.labels.kind(row.column) == kind &&
            r.labels.phase(row.column) == phase)
            for (const TrafficColumn& c : traffic_columns)
                t.*c.count += row.traffic.*c.count;
    return t;
}

TEST(Attribution, KindsAndPhasesAreSetApart) {
    Memory memory;
    Report r = Machine(simple()).run(memory.space, 1, labels, [&](int) {
        load(here, memory.data, 4, stamp{});
        EXPECT_EQ(set_kind(2), 0);
        load(here, memory.data, 4, stamp{});
        load(here, memory.data + 64, 4, stamp{});
        EXPECT_EQ(set_phase(1), 0);
        load(here, memory.data + 128, 4, stamp{});
        EXPECT_EQ(set_kind(1), 2);
        store(here, memory.more, 4, stamp{}, stamp{});
        EXPECT_EQ(set_phase(0), 1);
        EXPECT_EQ(set_kind(0), 1);
    });
    ASSERT_EQ(r.labels.phases, (std::vector<std::string>{"one", "two", "frame end"}));
    EXPECT_EQ(sum(r, 0, 0, 0).l1_reads, 1U);
    EXPECT_EQ(sum(r, 0, 0, 0).l1_misses, 1U);
    EXPECT_EQ(sum(r, 0, 2, 0).l1_reads, 2U);
    EXPECT_EQ(sum(r, 0, 2, 0).memory_reads, 1U);
    EXPECT_EQ(sum(r, 0, 2, 1).l1_misses, 1U);
    EXPECT_EQ(sum(r, 1, 1, 1).l1_writes, 1U);
    EXPECT_EQ(sum(r, 1, 1, 1).memory_reads, 1U);
    EXPECT_EQ(r.work[0].vops, 1U);     // none, one
    EXPECT_EQ(r.work[2 * 3].vops, 2U); // right, one
    // The first line of `data` was touched by none and right, its second and third by right alone.
    std::uint64_t shared = 0, alone = 0;
    for (const TouchedLines& t : r.touched)
        if (t.structure == 0)
            (t.columns == (1U | 1U << 6U) ? shared : alone) += t.lines;
    EXPECT_EQ(shared, 1U);
    EXPECT_EQ(alone, 2U);
}

TEST(Attribution, SetsAndNotesTakeNoTime) {
    Memory memory;
    auto cycles = [&](bool set) {
        return Machine(simple())
            .run(memory.space, 1, labels,
                 [&](int) {
                     stamp s;
                     for (int i = 0; i < 100; ++i) {
                         if (set) {
                             set_kind(i % 3);
                             note_level(memory.data + i * 64, 64, i % 5);
                         }
                         s = load(here, memory.data + i * 64, 4, s);
                     }
                 })
            .cycles;
    };
    EXPECT_EQ(cycles(true), cycles(false));
}

// Each line against a table kept here: notes, copies and accesses in random order.
TEST(Attribution, LinesHaveTheLevelNotedLast) {
    Memory memory;
    constexpr int lines = 3000; // of three granules
    constexpr int unknown = 99;
    std::vector<int> level(lines, unknown);
    std::vector<std::vector<std::uint64_t>> expected(3, std::vector<std::uint64_t>(100));
    std::vector<std::uint64_t> touched(lines);
    Config machine = simple();
    machine.l2.line_bytes = 256;
    Report r = Machine(machine).run(memory.space, 1, labels, [&](int) {
        std::mt19937 random(5);
        auto below = [&](int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); };
        for (int i = 0; i < 5000; ++i) {
            int first = below(lines - 40);
            int last = first + below(40);
            // Any part of a line stands for it.
            std::byte* begin = memory.data + first * 64 + below(64);
            auto bytes = static_cast<std::uint64_t>(memory.data + last * 64 + 64 - begin);
            switch (below(5)) {
            case 0: {
                int l = below(9) - 4;
                note_level(begin, bytes, l);
                std::fill(level.begin() + first, level.begin() + last + 1, l);
                break;
            }
            case 1: {
                int other = below(lines);
                note_level_of(begin, bytes, memory.data + other * 64);
                std::fill(level.begin() + first, level.begin() + last + 1,
                          level[static_cast<std::size_t>(other)]);
                break;
            }
            default: {
                int kind = below(3);
                set_kind(kind);
                load(here, memory.data + first * 64, 4, stamp{});
                auto line = static_cast<std::size_t>(first);
                ++expected[static_cast<std::size_t>(kind)][static_cast<std::size_t>(level[line] + 4) % 100];
                touched[line] |= 1U << (3 * kind);
            }
            }
        }
    });
    std::vector<std::vector<std::uint64_t>> found(3, std::vector<std::uint64_t>(100));
    for (const TrafficRow& row : r.traffic) {
        EXPECT_EQ(row.structure, 0U);
        found[r.labels.kind(row.column)][static_cast<std::size_t>(row.level.value_or(unknown) + 4) % 100] +=
            row.traffic.l1_reads;
    }
    EXPECT_EQ(found, expected);
    for (const TouchedLines& t : r.touched)
        EXPECT_EQ(t.lines, u(std::count(touched.begin(), touched.end(), t.columns)));
    EXPECT_EQ(std::count(touched.begin(), touched.end(), 0U) +
                  std::accumulate(r.touched.begin(), r.touched.end(), std::ptrdiff_t{0},
                                  [](std::ptrdiff_t n, const TouchedLines& t) {
                                      return n + static_cast<std::ptrdiff_t>(t.lines);
                                  }),
              lines);
    // The last cache's lines are of four.
    std::vector<std::uint64_t> longer(lines / 4);
    for (std::size_t line = 0; line < lines; ++line)
        longer[line / 4] |= touched[line];
    EXPECT_GT(std::count(longer.begin(), longer.end(), 0U), 0);
    std::ptrdiff_t any = 0;
    for (const TouchedLines& t : r.touched_last) {
        EXPECT_EQ(t.lines, u(std::count(longer.begin(), longer.end(), t.columns)));
        any += static_cast<std::ptrdiff_t>(t.lines);
    }
    EXPECT_EQ(any + std::count(longer.begin(), longer.end(), 0U), lines / 4);
}

// The report for programs says the same in words.
TEST(Attribution, IsWrittenByName) {
    Memory memory;
    Report r = Machine(simple()).run(memory.space, 1, labels, [&](int) {
        set_kind(1);
        note_level(memory.data, 64, -3);
        load(here, memory.data, 4, stamp{});
        load(here, memory.data + 64, 4, stamp{});
    });
    const nlohmann::json all = nlohmann::json::parse(print_json(r));
    const nlohmann::json& traffic = all.at("traffic");
    ASSERT_EQ(traffic.size(), 2U);
    EXPECT_EQ(traffic[0].at("level"), nullptr);
    EXPECT_EQ(traffic[1].at("level"), -3);
    for (const nlohmann::json& row : traffic) {
        EXPECT_EQ(row.at("structure"), "data");
        EXPECT_EQ(row.at("kind"), "left");
        EXPECT_EQ(row.at("phase"), "one");
        EXPECT_EQ(row.at("l1_misses"), 1);
    }
    const nlohmann::json touched =
        nlohmann::json::parse("[{\"structure\": \"data\", \"lines\": 2, \"by\": {\"left\": [\"one\"]}}]");
    EXPECT_EQ(all.at("touched_lines"), touched);
    ASSERT_EQ(all.at("kinds").size(), 3U);
    EXPECT_EQ(all.at("kinds")[1].at("vops"), 2);
    EXPECT_NE(print_text(r).find("data -3"), std::string::npos);
}

} // namespace
} // namespace sim::test
