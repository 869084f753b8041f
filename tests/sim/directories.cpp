// Directories with room for some lines alone: what they recall, when, and where their lines lie.
#include "tests/sim/coherent.h"
#include "tests/sim/networks.h"

#include <fmt/format.h>

#include <map>

namespace sim::test {
namespace {

/// A directory's sets, least recently asked for first, before a table of states that has room for all.
class SmallDirectory {
public:
    SmallDirectory(const Config& c)
        : oracle_(static_cast<int>(c.chip.tiles), static_cast<int>(c.chip.cores)),
          ways_(u(c.coherence.directory_ways)),
          homes_(static_cast<int>(c.l3.size_bytes != 0 ? c.l3.banks : c.memory.channels)),
          sets_(static_cast<int>(c.coherence.directory_entries / c.coherence.directory_ways)) {}

    void access(const Step& s) {
        CoherenceOracle after = oracle_;
        after.access(s.tile, s.core, s.line, s.write);
        if (after.counts().asked() != oracle_.counts().asked()) {
            const int home = s.line % homes_; // lines lie side by side in channels and banks
            std::vector<int>& set =
                lines_[home * sets_ + static_cast<int>(Directory::set_of(u(s.line), u(sets_)))];
            if (std::erase(set, s.line) == 0 && set.size() == ways_) {
                oracle_.recall(set.front());
                set.erase(set.begin());
            }
            set.push_back(s.line);
        }
        oracle_.access(s.tile, s.core, s.line, s.write);
    }
    const OracleCounts& counts() const { return oracle_.counts(); }

private:
    CoherenceOracle oracle_;
    std::size_t ways_;
    int homes_, sets_;
    std::map<int, std::vector<int>> lines_;
};

TEST(Coherence, SmallDirectoriesRecallWhatTheyHaveNoRoomFor) {
    std::uint64_t recalls = 0, written = 0;
    for (std::uint32_t seed = 1; seed <= 16; ++seed) {
        Config c = simple();
        c.chip.tiles = 1 + seed % 4;
        c.chip.cores = 1 + seed / 4 % 3;
        c.network.topology = std::array{"ideal", "crossbar", "ring", "mesh"}[seed % 4];
        if (seed % 3 == 0)
            c = with_l3(c, 2);
        c = coherent(c);
        c.coherence.directory_ways = 1 + seed % 3;
        c.coherence.directory_entries = c.coherence.directory_ways * (1 + seed / 3 % 2);
        EXPECT_NO_THROW(check_consistency(c, "small"));
        const std::vector<Step> steps = random_steps(seed, 500, c, 9);
        SmallDirectory small(c);
        for (const Step& s : steps)
            small.access(s);
        const Report r = act(c, steps);
        expect_equal(counts_of(r), small.counts(), fmt::format("seed {}", seed));
        EXPECT_EQ(r.coherence.recalls_stale + r.coherence.crowded, 0U);
        recalls += r.coherence.recalls;
        written += r.coherence.written_back;

        // One with room for all of them is a full map.
        const Report all = act(
            [&] {
                Config more = c;
                more.coherence.directory_ways = 9;
                more.coherence.directory_entries = 18;
                return more;
            }(),
            steps);
        c.coherence.directory_entries = 0;
        const Report full = act(c, steps);
        EXPECT_EQ(all.coherence.recalls, 0U);
        EXPECT_EQ(all.cycles, full.cycles);
        EXPECT_EQ(all.core.loads, full.core.loads);
        expect_equal(counts_of(all), counts_of(full), "full");
    }
    EXPECT_GT(recalls, 2000U);
    EXPECT_GT(written, 500U);
}

// A line gets an entry beyond its set where the only other one is just being asked for; the next that needs
// room there has both leave.
TEST(Coherence, CrowdedSetsEmptyAgain) {
    Config c = simple();
    c.chip.tiles = 3;
    c = coherent(c);
    c.chip.threads = c.chip.cores = 1;
    c.chip.placement = "pack";
    c.latency[static_cast<std::size_t>(operation::add)] = 10;
    c.coherence.directory_entries = c.coherence.directory_ways = 1;
    const Report r = run_on(
        c,
        [](std::byte* base, int worker) {
            stamp clock;
            const auto wait = [&clock](int cycles) {
                for (int i = 0; i < cycles / 10; ++i)
                    clock = scalar_op(operation::add, clock);
            };
            if (worker == 0)
                load(here, base, 4, clock);
            wait(2000);
            if (worker == 2)
                load(here, base, 4, clock);
            wait(6000);
            if (worker == 1)
                load(here, base + 64, 4, clock);
            wait(20);
            if (worker == 0)
                store(here, base, 4, clock, stamp{}); // a right, on its way when the other is looked up
            wait(8000);
            if (worker == 2)
                load(here, base + 128, 4, clock);
        },
        3);
    EXPECT_EQ(r.coherence.crowded, 1U);
    EXPECT_EQ(r.coherence.recalled_lines, 2U);
    EXPECT_EQ(r.coherence.recalls_received, 2U);
    EXPECT_EQ(r.coherence.written_back, 1U);
}

TEST(Directory, LinesOfAHomeUseAllSets) {
    // Lines whose home is the same: every k-th, or runs of them, as banks, channels and bank groups lie.
    for (const std::uint64_t sets : {16U, 64U, 100U})
        for (const auto& [run, apart] :
             {std::pair(1U, 1U), std::pair(1U, 8U), std::pair(4U, 32U), std::pair(2U, 64U)}) {
            std::vector<int> lines(sets);
            for (std::uint64_t i = 0; i < 64 * sets; ++i)
                ++lines[Directory::set_of(i / run * apart + i % run, sets)];
            EXPECT_GE(*std::min_element(lines.begin(), lines.end()), 32)
                << sets << ' ' << run << ' ' << apart;
            EXPECT_LE(*std::max_element(lines.begin(), lines.end()), 128)
                << sets << ' ' << run << ' ' << apart;
        }
}

} // namespace
} // namespace sim::test
