// razor-sim run --trace: the file holds what the report counts, at every level; recording changes nothing;
// the host's threads neither; what is filtered is what a filter of the whole trace gives; mistakes leave no
// file.
#include "razor/image/exr.h"
#include "tests/program/simulator.h"
#include "traces/reader.h"
#include "traces/sample.h"

#include <functional>
#include <map>
#include <set>
#include <sstream>
#include <tuple>

namespace razor {
namespace {

using traces::Kind;
/// By structure, kind of work and phase, by kind of reference.
using Counts = std::map<std::tuple<std::string, std::string, std::string>, std::map<Kind, std::uint64_t>>;

class Recording : public Simulator {
protected:
    Recording() { folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n"); }

    std::string start(const std::string& more, const std::string& size = "16x16") const {
        return "run --quiet --no-native --no-calibration --scene s.toml --spp 1 --sky-samples 1 "
               "--light-samples 0 --edge-pixels 4 --report r.txt --size " +
               size + " --machine " + tiny + " " + more + " ";
    }
    void succeed(const std::string& arguments) const {
        const Outcome result = simulator(arguments);
        ASSERT_EQ(result.code, 0) << result.err;
    }
    /// By stream, in its order, each as text that has names for numbers.
    std::vector<std::string> references(const std::string& file) const {
        traces::Reader reader(traces::open_source(folder_ / file));
        std::map<std::uint32_t, std::vector<std::string>> by_stream;
        traces::Block block;
        while (reader.next(block)) {
            const traces::Description& d = reader.description();
            for (const traces::Segment& s : block.segments)
                for (std::size_t i = s.begin; i < s.end; ++i) {
                    const traces::Class& c = block.what(i);
                    std::ostringstream text;
                    text << block.times[i] << ' ' << block.addresses[i] << ' ' << c.size << ' '
                         << traces::kind_names[static_cast<std::size_t>(c.kind)] << " at "
                         << (c.site == 0 ? "?" : d.sites[c.site - 1]) << ", " << d.streams[s.stream] << ", "
                         << d.structures[c.structure] << ", phase " << d.phases[c.phase] << ", "
                         << d.work[c.work];
                    by_stream[s.stream].push_back(text.str());
                }
        }
        EXPECT_TRUE(reader.complete()) << reader.note();
        std::vector<std::string> out;
        for (const auto& [stream, all] : by_stream)
            out.insert(out.end(), all.begin(), all.end());
        return out;
    }
    Counts counts(const std::string& file) const {
        traces::Reader reader(traces::open_source(folder_ / file));
        Counts out;
        traces::Block block;
        while (reader.next(block))
            for (std::size_t i = 0; i < block.size(); ++i) {
                const traces::Class& c = block.what(i);
                const traces::Description& d = reader.description();
                ++out[{d.structures[c.structure], d.work[c.work], d.phases[c.phase]}][c.kind];
            }
        EXPECT_TRUE(reader.complete()) << reader.note();
        return out;
    }
    static std::uint64_t sum(const Counts& counts, std::set<Kind> kinds) {
        std::uint64_t n = 0;
        for (const auto& [row, by_kind] : counts)
            for (const auto& [kind, count] : by_kind)
                n += kinds.contains(kind) ? count : 0;
        return n;
    }
};

const std::set<Kind> demand = {Kind::read, Kind::write, Kind::modify};

TEST_F(Recording, CountsWhatTheReportCountsAndChangesNothing) {
    for (const char* machine :
         {"",
          "-g chip.tiles=2 -g chip.cores=2 -g coherence.plain=directory -g l2.inclusion=inclusive -g "
          "l1.prefetcher=stride -g core.store_buffer=4 -g sim.mode=reference",
          "-g chip.tiles=2 -g chip.cores=2 -g l3.size_bytes=262144 -g l3.share=chip -g l3.prefetcher=next",
          "-g l1.write_policy=through -g l1.write_miss=around -g l2.share=2 -g l3.size_bytes=262144 -g "
          "tlb.entries=8 -g renderer.discard=on"}) {
        SCOPED_TRACE(machine);
        succeed(start(machine) + "--json a.json");
        const nlohmann::json a = report("a.json");
        const bool third = std::string(machine).find("l3.") != std::string::npos;
        for (const std::string level : {"core", "l1", "l2", "l3", "dram"}) {
            SCOPED_TRACE(level);
            if (level == "l3" && !third)
                continue;
            succeed(start(machine) + "--json b.json --trace t.rzt --trace-level " + level);
            EXPECT_EQ(report("b.json"), a);
            Counts noted = counts("t.rzt");
            std::uint64_t rows = 0;
            std::map<std::tuple<std::string, std::string, std::string>,
                     std::pair<std::uint64_t, std::uint64_t>>
                expected; // those that are read or missed; those that are written or written back
            for (const nlohmann::json& row : a.at("traffic")) {
                const auto at = [&](const std::string& name) { return row.at(name).get<std::uint64_t>(); };
                auto& [first, second] = expected[{row.at("structure"), row.at("kind"), row.at("phase")}];
                const bool outside = level == "core" || level == "dram";
                const std::string name = level == "core" ? "l1" : level == "dram" ? "memory" : level;
                first += at(name + (outside ? "_reads" : "_misses"));
                second += at(name + (outside ? "_writes" : "_write_backs"));
            }
            for (const auto& [row, pair] : expected) {
                auto& by_kind = noted[row];
                const bool outside = level == "core" || level == "dram";
                const std::uint64_t first =
                    outside ? by_kind[Kind::read]
                            : by_kind[Kind::read] + by_kind[Kind::write] + by_kind[Kind::modify];
                EXPECT_EQ(first, pair.first) << std::get<0>(row) << ' ' << std::get<2>(row);
                EXPECT_EQ(by_kind[outside ? Kind::write : Kind::write_back], pair.second)
                    << std::get<0>(row) << ' ' << std::get<2>(row);
                rows += pair.first + pair.second;
            }
            EXPECT_GT(rows, 0U);
            if (level == "core") {
                EXPECT_EQ(sum(noted, {Kind::modify}), a.at("core").at("modifications"));
                EXPECT_EQ(sum(noted, {Kind::write_through}), a.at("core").at("releases"));
                EXPECT_EQ(sum(noted, {Kind::read, Kind::write}) + sum(noted, {Kind::prefetch}) >= rows, true);
            } else if (level == "dram") {
                EXPECT_EQ(sum(noted, demand), rows);
            } else {
                EXPECT_EQ(sum(noted, demand), a.at(level).at("misses"));
                EXPECT_EQ(sum(noted, {Kind::write_back}), a.at(level).at("write_backs"));
                EXPECT_EQ(sum(noted, {Kind::prefetch}),
                          a.at(level).at("prefetches").get<std::uint64_t>() +
                              a.at(level).at("hardware_prefetches").get<std::uint64_t>());
                EXPECT_EQ(sum(noted, {Kind::write_through}), a.at(level).at("written_through"));
            }
        }
    }
}

/// Lines that memory is asked for, by screen tile: what pixels cost (--costs) sums to the same over each
/// tile, and what is nobody's is for none. Tiles are the same without costs.
TEST_F(Recording, KnowsForWhichScreenTile) {
    for (const std::string level : {"l1", "dram"}) {
        const std::string more = start("-g chip.tiles=2 -g chip.cores=2 -g l2.size_bytes=16384", "20x12") +
                                 "--trace-level " + level;
        succeed(more + " --trace plain.rzt");
        succeed(more + " --trace costs.rzt --costs -o c.exr --json c.json");
        EXPECT_TRUE(text("plain.rzt") == text("costs.rzt"));
        traces::Reader reader(traces::open_source(folder_ / "plain.rzt"));
        const traces::Picture picture = reader.description().picture;
        ASSERT_EQ(picture, (traces::Picture{20, 12, 8}));
        std::vector<std::uint64_t> asked(picture.tiles() + 1, 0), expected(asked);
        for (traces::Block block; reader.next(block);)
            for (std::size_t i = 0; i < block.size(); ++i)
                asked[block.tile(i)] += demand.contains(block.what(i).kind) ? 1 : 0;
        const Film film = read_exr(folder_ / "c.exr");
        for (const char* layer : {"cost.l1_misses", "cost.dram_reads", "cost.dram_writes"}) {
            if (std::string(layer).starts_with("cost.l1") != (level == "l1"))
                continue;
            const Plane* plane = film.find(layer);
            ASSERT_NE(plane, nullptr) << layer;
            for (std::uint32_t y = 0; y < picture.height; ++y)
                for (std::uint32_t x = 0; x < picture.width; ++x)
                    expected[picture.tile_of(x, y)] +=
                        static_cast<std::uint64_t>(plane->values[std::size_t{y} * picture.width + x]);
        }
        for (std::uint32_t tile = 1; tile <= picture.tiles(); ++tile) {
            EXPECT_EQ(asked[tile], expected[tile]) << level << ' ' << tile;
            EXPECT_GT(asked[tile], 20U) << level << ' ' << tile;
        }
        EXPECT_GT(asked[0], 0U);
    }
}

TEST_F(Recording, TheFileHasTheSameBytesOnAnyNumberOfHostThreads) {
    for (const char* level : {"core", "l2", "dram"}) {
        const std::string more =
            start("-g chip.tiles=2 -g chip.cores=2 -g sim.quantum=100") + "--trace-level " + level;
        succeed(more + " --trace one.rzt");
        succeed(more + " --trace two.rzt --host-threads 2");
        const std::string one = text("one.rzt");
        EXPECT_GT(one.size(), 5000U);
        EXPECT_TRUE(one == text("two.rzt")) << level;
    }
}

TEST_F(Recording, FiltersGiveWhatIsLeftOfTheWhole) {
    const std::string more = start("-g chip.tiles=2 -g chip.cores=2");
    succeed(more + "--trace all.rzt");
    const std::vector<std::string> all = references("all.rzt");
    struct Case {
        const char* options;
        std::function<bool(const std::string&)> in;
    };
    const auto has = [](const char* part) {
        return [part](const std::string& r) { return r.find(part) != std::string::npos; };
    };
    const std::vector<Case> cases = {
        {"--trace-tiles 1..1", has(", tile 1 ")},
        {"--trace-cores 2..2", has(" core 2 ")},
        {"--trace-phase traverse", has(", phase traverse,")},
        {"--trace-structure 'kd nodes'", has(", kd nodes,")},
        {"--trace-window 20000:30000",
         [](const std::string& r) { return std::stoull(r) >= 20000 && std::stoull(r) < 30000; }},
        {"--trace-sample 0.25",
         [](const std::string& r) {
             return traces::hash_of_line(std::stoull(r.substr(r.find(' '))) / 64) < 0.25;
         }},
    };
    succeed(more +
            "--trace part.rzt --trace-window 0:9223372036854775807"); // of more cycles than 32 bits hold
    EXPECT_TRUE(references("part.rzt") == all);
    for (const Case& c : cases) {
        SCOPED_TRACE(c.options);
        succeed(more + "--trace part.rzt " + c.options);
        std::vector<std::string> expected;
        std::copy_if(all.begin(), all.end(), std::back_inserter(expected), c.in);
        EXPECT_GT(expected.size(), 100U);
        EXPECT_LT(expected.size(), all.size());
        EXPECT_TRUE(references("part.rzt") == expected);
    }
}

TEST_F(Recording, MistakesLeaveNoFile) {
    const std::size_t before = folder_.count();
    for (const auto& [options, cause] : std::vector<std::pair<std::string, std::string>>{
             {"--trace-level l1", "without --trace FILE"},
             {"--trace-window 1:2", "without --trace FILE"},
             {"--trace t.rzt --trace-level l3", "this machine has core, l1 to l2, dram"},
             {"--trace t.rzt --trace-level L1", "there is no such level"},
             {"--trace t.rzt --trace-structure nothing", "there is no such name; this run has "},
             {"--trace t.rzt --trace-phase nothing", "there is no such name; this run has "},
             {"--trace t.rzt --trace-tiles 1..1", "the machine has 1"},
             {"--trace t.rzt --trace-cores 0..4", "the machine has 4"},
             {"--trace t.rzt --trace-cores 0..1 --trace-level l2", "use --trace-tiles"},
             {"--trace t.rzt --trace-window 5:5", "holds no cycle"},
             {"--trace t.rzt --trace-window 5", "'5' is not possible; give BEGIN:END"},
             {"--trace t.rzt --trace-window 5:x", "'5:x' is not possible; give BEGIN:END"},
             {"--trace t.rzt --trace-window -1:5", "give BEGIN:END"},
             {"--trace t.rzt --trace-window 6:5", "ends before it begins; give BEGIN:END"},
             {"--trace t.rzt --trace-window 0:9223372036854775808", "from 0 to 9223372036854775807"},
             {"--trace t.rzt --trace-sample 2", "--trace-sample"},
             {"--trace no/t.rzt", "no folder"},
             {"--trace .", "is a directory"}}) {
        const Outcome result = simulator(start("") + options);
        EXPECT_EQ(result.code, 2) << options;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << options;
    }
}

TEST_F(Recording, AFullDiskIsALineAndLeavesNoTrace) {
    const std::size_t before = folder_.count();
    for (const std::string& command :
         {quoted_argument(RAZOR_SIMULATOR) + ' ' + start("--trace t.rzt", "24x24"),
          quoted_argument(RAZOR_PROGRAM) + " render s.toml --size 100x100 --spp 1 --quiet --trace t.rzt"}) {
        const Outcome result =
            run("bash -c " + quoted_argument("trap '' XFSZ; ulimit -f 30; " + command), folder_.path());
        EXPECT_EQ(result.code, 2) << result.err;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find("t.rzt: cannot be written"), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before);
    }
}

TEST_F(Recording, AnInterruptedRunLeavesNoTrace) {
    const std::size_t before = folder_.count();
    const Outcome result =
        run("timeout --foreground --preserve-status -s INT -k 100 2 " + quoted_argument(RAZOR_SIMULATOR) +
                ' ' + start("--trace t.rzt", "2000x2000"),
            folder_.path());
    EXPECT_EQ(result.code, 130);
    EXPECT_EQ(result.err, "razor-sim: interrupted; nothing written\n");
    EXPECT_EQ(folder_.count(), before);
}

} // namespace
} // namespace razor
