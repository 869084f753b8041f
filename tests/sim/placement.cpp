// Which hardware thread a worker takes and which kd-tree it uses, against plain enumeration.
#include "sim/config/placement.h"
#include "sim/config/parameters.h"
#include "tests/sim/machines.h"

#include <fmt/core.h>

#include <algorithm>
#include <map>
#include <set>

namespace sim::test {
namespace {

struct Shape {
    integer tiles, cores, threads;
    bool packed;
    Placement placement() const { return {tiles, cores, threads, packed}; }
    std::string name() const {
        return fmt::format("{} x {} x {} {}", tiles, cores, threads, packed ? "pack" : "spread");
    }
};

std::vector<Shape> shapes() {
    std::vector<Shape> all;
    for (integer tiles : {1, 2, 3, 16})
        for (integer cores : {1, 2, 5, 8})
            for (integer threads : {1, 2, 4})
                for (bool packed : {false, true})
                    all.push_back({tiles, cores, threads, packed});
    return all;
}

/// All places in the order in which workers take them, by nested loops.
std::vector<Place> enumerate(const Shape& s) {
    std::vector<Place> all;
    if (s.packed) {
        for (integer tile = 0; tile < s.tiles; ++tile)
            for (integer core = 0; core < s.cores; ++core)
                for (integer thread = 0; thread < s.threads; ++thread)
                    all.push_back({tile, core, thread});
    } else {
        for (integer thread = 0; thread < s.threads; ++thread)
            for (integer core = 0; core < s.cores; ++core)
                for (integer tile = 0; tile < s.tiles; ++tile)
                    all.push_back({tile, core, thread});
    }
    return all;
}

TEST(Placement, IsTheLoopsOrder) {
    for (const Shape& s : shapes()) {
        const Placement p = s.placement();
        const std::vector<Place> expected = enumerate(s);
        std::set<integer> taken;
        ASSERT_EQ(p.threads(), static_cast<integer>(expected.size()));
        for (std::size_t w = 0; w < expected.size(); ++w) {
            const Place got = p.of(static_cast<integer>(w));
            EXPECT_EQ(got, expected[w]) << s.name() << ", worker " << w;
            EXPECT_TRUE(taken.insert(p.number(got)).second) << s.name();
        }
        EXPECT_EQ(*taken.begin(), 0);
        EXPECT_EQ(*taken.rbegin(), p.threads() - 1);
    }
}

/// Whether two workers share a tree, from the definition alone.
bool together(const Placement& p, int workers, int a, int b, const std::string& share) {
    const Place x = p.of(a), y = p.of(b);
    if (share == "chip")
        return true;
    if (share == "tile")
        return x.tile == y.tile;
    if (share == "core")
        return x.tile == y.tile && x.core == y.core;
    if (share == "worker")
        return a == b;
    const auto rank = [&](const Place& place) { // workers on hardware threads before this one
        integer before = 0;
        for (int w = 0; w < workers; ++w)
            before += p.number(p.of(w)) < p.number(place) ? 1 : 0;
        return before;
    };
    return rank(x) / std::stoll(share) == rank(y) / std::stoll(share);
}

TEST(TreeSharing, TreesAreThoseOfTheDefinition) {
    for (const Shape& s : shapes()) {
        const Placement p = s.placement();
        const int most = static_cast<int>(p.threads());
        if (most > 64)
            continue; // comparing all pairs
        for (int workers : {1, most / 2, most - 1, most}) {
            if (workers < 1)
                continue;
            for (const char* share : {"chip", "tile", "core", "worker", "1", "2", "3", "7", "1000"}) {
                SCOPED_TRACE(fmt::format("{}, {} workers, share {}", s.name(), workers, share));
                const std::vector<int> trees = p.trees(workers, share);
                ASSERT_EQ(trees.size(), static_cast<std::size_t>(workers));
                int wrong = 0;
                for (int a = 0; a < workers; ++a)
                    for (int b = 0; b < workers; ++b)
                        wrong += (trees[static_cast<std::size_t>(a)] == trees[static_cast<std::size_t>(b)]) !=
                                 together(p, workers, a, b, share);
                EXPECT_EQ(wrong, 0);
                const std::set<int> used(trees.begin(), trees.end());
                EXPECT_EQ(*used.begin(), 0);
                EXPECT_EQ(*used.rbegin(), static_cast<int>(used.size()) - 1) << "a tree without workers";
            }
        }
    }
}

TEST(TreeSharing, OfAFullMachineByNumberAndByName) {
    for (const Shape& s : shapes()) {
        const Placement p = s.placement();
        const int all = static_cast<int>(p.threads());
        EXPECT_EQ(p.trees(all, "core"), p.trees(all, std::to_string(s.threads))) << s.name();
        EXPECT_EQ(p.trees(all, "tile"), p.trees(all, std::to_string(s.threads * s.cores))) << s.name();
        EXPECT_EQ(p.trees(all, "worker"), p.trees(all, "1")) << s.name();
        EXPECT_EQ(p.trees(all, "chip"), p.trees(all, std::to_string(all))) << s.name();
    }
}

TEST(TreeSharing, OfTinyByHand) {
    Config c;
    c.chip.cores = 4;
    c.chip.threads = 2;
    c.chip.placement = "spread";
    EXPECT_EQ(Placement(c.chip).trees(8, "core"), (std::vector<int>{0, 1, 2, 3, 0, 1, 2, 3}));
    EXPECT_EQ(Placement(c.chip).trees(8, "4"), (std::vector<int>{0, 0, 1, 1, 0, 0, 1, 1}));
    EXPECT_EQ(Placement(c.chip).trees(3, "2"), (std::vector<int>{0, 0, 1}));
    c.chip.placement = "pack";
    EXPECT_EQ(Placement(c.chip).trees(8, "core"), (std::vector<int>{0, 0, 1, 1, 2, 2, 3, 3}));
    EXPECT_EQ(Placement(c.chip).trees(8, "tile"), (std::vector<int>(8, 0)));
    EXPECT_EQ(Placement(c.chip).trees(8, "worker"), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    for (const char* bad : {"", "0", "-1", "cores", "2x", " 2", "99999999999999999999"})
        EXPECT_THROW(Placement(c.chip).trees(8, bad), std::invalid_argument) << bad;
}

TEST(Placement, PlacesAreHardwareThreads) {
    Config c;
    c.chip.tiles = 2;
    c.chip.cores = 2;
    c.chip.threads = 2;
    c.chip.placement = "pack";
    EXPECT_EQ(Placement(c.chip).places(8), (std::vector<int>{0, 1, 2, 3, 4, 5, 6, 7}));
    c.chip.placement = "spread";
    EXPECT_EQ(Placement(c.chip).places(6), (std::vector<int>{0, 4, 2, 6, 1, 5}));
}

TEST(TreeSharing, IsAWordOrANumberInAMachineFile) {
    EXPECT_EQ(parse_machine("", "m").kdtree.share, "chip");
    EXPECT_EQ(parse_machine("[kdtree]\nshare = \"tile\"\n", "m").kdtree.share, "tile");
    EXPECT_EQ(parse_machine("[kdtree]\nshare = 12\n", "m").kdtree.share, "12");
    EXPECT_EQ(parse_machine("", "m", {"kdtree.share=12"}).kdtree.share, "12");
    EXPECT_EQ(parse_machine("", "m", {"kdtree.share=worker"}).kdtree.share, "worker");
    const Parameter& p = *find_parameter("kdtree.share");
    EXPECT_EQ(print_value(p, parse_machine("[kdtree]\nshare = 12\n", "m")), "12");
    EXPECT_EQ(print_value(p, parse_machine("[kdtree]\nshare = \"core\"\n", "m")), "\"core\"");
    for (const char* bad : {"0", "-4", "1.5", "\"all\"", "9999999999", "\"\"", "true", "\"+3\""}) {
        try {
            parse_machine(fmt::format("[kdtree]\nshare = {}\n", bad), "m");
            ADD_FAILURE() << bad;
        } catch (const ConfigError& e) {
            EXPECT_EQ(std::string(e.what()).rfind("m:2:9: kdtree.share ", 0), 0U) << e.what();
        }
    }
}

} // namespace
} // namespace sim::test
