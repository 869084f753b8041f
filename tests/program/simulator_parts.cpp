// razor-sim: what a run counts: a frame of several, screen tiles, a part of the picture, dead memory, over
// time.
#include "razor/image/exr.h"
#include "tests/program/simulator.h"

#include <map>
#include <sstream>

namespace razor {
namespace {

// Of the machine, the frame, the command and the host; and of the frame nothing else is explained.
TEST_F(Simulator, ExplainsEveryFigureOfARun) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = "run --quiet --scene s.toml --size 16x8 --spp 1 --machine ";
    const std::string calibrated = quoted_argument(RAZOR_SOURCE_DIR "/configs/machines/zen4-2c-avx2.toml");
    std::set<std::string> used;
    for (const std::string& run :
         {tiny, tiny + " --memory 1MiB --share 2 --sharing -o a.exr --costs", calibrated + " --no-native",
          tiny + " --no-native --estimate sample:0.5", tiny + " --fidelity auto --error 0.5"}) {
        const Outcome result = simulator(start + run + " --json a.json");
        ASSERT_EQ(result.code, 0) << result.err;
        SCOPED_TRACE(run);
        expect_explained(nlohmann::json::parse(text("a.json")), &used);
    }
    std::istringstream lines(simulator("explain renderer").out);
    std::size_t count = 0;
    for (std::string line; std::getline(lines, line); ++count) {
        const std::string path = line.substr(0, line.find_first_of(": "));
        EXPECT_TRUE(used.contains(path) || path.starts_with("machine.")) << path << " is in no report";
    }
    EXPECT_GT(count, 80U);
    for (const char* name : {"node_visits", "renderer.counters_by_kind.light.rays", "tree_of_worker",
                             "code_bytes.sse4.traverse", "machine_provenance.l1.ways.from"})
        EXPECT_EQ(simulator(std::string("explain ") + name).code, 0) << name;
}

// A time series whose sums are the report's, on any number of host threads; whole or not there.
TEST_F(Simulator, WritesATimeSeries) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start =
        std::string("run --quiet --no-native --scene s.toml --spp 1 --sky-samples 1 --light-samples "
                    "0 --edge-pixels 4 -g chip.tiles=2 -g chip.cores=2 -g sim.quantum=100 --machine ") +
        tiny + " ";
    const auto series = [&](const char* threads) {
        const Outcome result = simulator(
            start + "--size 16x16 --json a.json --intervals i.csv --interval 20000 --host-threads " +
            threads);
        EXPECT_EQ(result.code, 0) << result.err;
        return text("i.csv");
    };
    const std::string csv = series("1");
    EXPECT_EQ(series("2"), csv);
    const nlohmann::json a = report("a.json");
    std::istringstream lines(csv);
    std::string line, cell;
    std::vector<std::string> names;
    std::getline(lines, line);
    for (std::istringstream head(line); std::getline(head, cell, ',');)
        names.push_back(cell);
    std::map<std::string, std::uint64_t> sums;
    std::size_t rows = 0;
    for (; std::getline(lines, line); ++rows) {
        std::istringstream row(line);
        for (const std::string& name : names) {
            ASSERT_TRUE(std::getline(row, cell, ',')) << line;
            if (name != "ipc")
                sums[name] = (name == "end" ? 0 : sums[name]) + std::stoull(cell);
        }
    }
    EXPECT_GT(rows, 10U);
    EXPECT_EQ(a.at("intervals").at("rows"), rows);
    EXPECT_GE(a.at("intervals").at("cycles"), 20000);
    EXPECT_EQ(sums["end"], a.at("drained_cycles"));
    for (const char* name : {"vops", "instructions"})
        EXPECT_EQ(sums[name], a.at("core").at(name)) << name;
    for (const char* level : {"l1", "l2"})
        EXPECT_EQ(sums[std::string(level) + "_misses"], a.at(level).at("misses"));
    EXPECT_EQ(sums["memory_reads"], a.at("memory").at("reads"));
    for (const auto& [cause, cycles] : a.at("stack").items())
        EXPECT_EQ(sums["stack_" + cause], cycles) << cause;
    for (const std::string& name : names)
        EXPECT_EQ(simulator("explain intervals." + name).code, 0) << name;
    for (const char* name : {"bandwidth.L1.utilisation", "cores.0.stack.idle", "dram_bytes", "l1_miss_rate",
                             "binding_share", "built_megabytes", "cycles_error", "estimate.confidence",
                             "estimate.figures.cycles.low", "fidelity.ways.0.state"})
        EXPECT_EQ(simulator(std::string("explain ") + name).code, 0) << name;
    EXPECT_NE(simulator("explain l1.hit").err.find("did you mean 'l1.hits'?"), std::string::npos);
    for (const char* name : {"nothing", "nothing.idle.l1", "L1"})
        EXPECT_EQ(simulator(std::string("explain ") + name).code, 2) << name;

    std::filesystem::remove(folder_ / "i.csv");
    std::filesystem::remove(folder_ / "a.json");
    const std::size_t before = folder_.count();
    // ulimit counts blocks of 512 or 1024 bytes; the series needs more than two of either.
    Outcome stopped = run("ulimit -f 2; trap '' XFSZ; " + quoted_argument(RAZOR_SIMULATOR) + " " + start +
                              "--size 16x16 --intervals i.csv --interval 1000",
                          folder_.path());
    EXPECT_EQ(stopped.code, 2);
    EXPECT_NE(stopped.err.find("i.csv"), std::string::npos) << stopped.err;
    EXPECT_EQ(stopped.error_lines(), 1) << stopped.err;
    EXPECT_EQ(folder_.count(), before) << "a file was left";
    stopped = run("timeout -s INT 0.7 " + quoted_argument(RAZOR_SIMULATOR) + " " + start +
                      "--size 200x200 --intervals i.csv --interval 1000",
                  folder_.path());
    EXPECT_EQ(folder_.count(), before) << "a file was left";
}

// The last of several frames: the same picture and rays, with pages, caches and predictors that are there.
TEST_F(Simulator, CountsTheLastFrameAlone) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = std::string("run --quiet --scene s.toml --size 24x24 --spp 1 --sky-samples 1 "
                                          "--light-samples 0 --edge-pixels 4 --workers 1 -g chip.tiles=1 "
                                          "-o a.exr --json a.json --machine ") +
                              tiny + " ";
    ASSERT_EQ(simulator(start).code, 0);
    const nlohmann::json once = report("a.json");
    const Film picture = read_exr(folder_ / "a.exr");
    ASSERT_EQ(simulator(start + "--frames 1").code, 0);
    EXPECT_EQ(report("a.json"), once);
    for (const char* frames : {"2", "3"}) {
        const Outcome result = simulator(start + "--frames " + frames);
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find("\nwarm-up "), std::string::npos);
        EXPECT_NE(result.out.find("the same picture, bit for bit"), std::string::npos);
        const nlohmann::json a = report("a.json");
        EXPECT_GE(a.at("warm_up_cycles"), once.at("cycles"));
        EXPECT_LT(a.at("cycles"), once.at("cycles"));
        EXPECT_GT(once.at("core").at("pages"), 0);
        EXPECT_EQ(a.at("core").at("pages"), 0);
        EXPECT_LT(a.at("core").at("mispredicts"), once.at("core").at("mispredicts"));
        EXPECT_LT(a.at("l2").at("misses"), once.at("l2").at("misses"));
        nlohmann::json counters = a.at("renderer").at("counters"), cold = once.at("renderer").at("counters");
        EXPECT_EQ(counters.at("pages_requested"), 0);
        cold["pages_requested"] = 0;
        EXPECT_EQ(counters, cold);
        for (const Plane& plane : picture.planes)
            EXPECT_EQ(read_exr(folder_ / "a.exr").find(plane.name)->values, plane.values) << plane.name;
    }
}

// Some screen tiles alone: with one worker, who takes them in order, the parts are the whole.
TEST_F(Simulator, CountsSomeTilesAlone) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = std::string("run --quiet --scene s.toml --size 40x40 --spp 1 --sky-samples 1 "
                                          "--light-samples 0 --edge-pixels 4 --workers 1 -g chip.tiles=1 "
                                          "-o a.exr --json a.json --machine ") +
                              tiny + " ";
    const auto run = [&](const std::string& options) {
        const Outcome result = simulator(start + options);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find("the same picture, bit for bit"), std::string::npos);
        return report("a.json");
    };
    const nlohmann::json whole = run("");
    const Film picture = read_exr(folder_ / "a.exr");
    EXPECT_EQ(run("--tiles 0..24").at("cycles"), whole.at("cycles"));
    const nlohmann::json first = run("--tiles 0..3"), rest = run("--tiles 4..24"), one = run("--tiles 4..4");
    EXPECT_EQ(first.at("warm_up_cycles"), 0);
    EXPECT_GE(rest.at("warm_up_cycles"), first.at("cycles"));
    EXPECT_EQ(one.at("warm_up_cycles"), rest.at("warm_up_cycles"));
    EXPECT_EQ(rest.at("options").at("tiles"), nlohmann::json({4, 24}));
    EXPECT_EQ(rest.at("renderer").at("screen_tiles"), 21);
    for (const auto& [name, count] : whole.at("renderer").at("counters").items()) {
        const auto of = [&name = name](const nlohmann::json& a) {
            return a.at("renderer").at("counters").at(name).get<std::int64_t>();
        };
        EXPECT_EQ(of(first) + of(rest), count) << name;
        EXPECT_LE(of(one), of(rest)) << name;
    }
    const auto vops = [](const nlohmann::json& a) { return a.at("core").at("vops").get<std::int64_t>(); };
    EXPECT_GT(vops(first) + vops(rest), vops(whole)) << "a worker begins twice";
    EXPECT_LT(vops(first) + vops(rest), vops(whole) + 1000);
    EXPECT_LT(vops(one), vops(rest));
    // Tiles that were rendered, the first five along the curve, and none of the others.
    const Film part = read_exr(folder_ / "a.exr");
    for (const Plane& plane : picture.planes) {
        const std::vector<float>& values = part.find(plane.name)->values;
        for (std::size_t y = 0; y < 40; ++y)
            for (std::size_t x = 0; x < 40; ++x) {
                const bool there = (x < 16 && y < 16) || (x < 8 && y < 24);
                ASSERT_EQ(values[y * 40 + x], there ? plane.values[y * 40 + x] : 0) << plane.name;
            }
    }
    // Of the last frame: pages of topology are there from the one before.
    const nlohmann::json warm = run("--frames 2 --tiles 4..24");
    EXPECT_GT(warm.at("warm_up_cycles"), whole.at("cycles"));
    nlohmann::json counters = warm.at("renderer").at("counters"), cold = rest.at("renderer").at("counters");
    EXPECT_EQ(counters.at("pages_requested"), 0);
    cold["pages_requested"] = 0;
    EXPECT_EQ(counters, cold);
}

TEST_F(Simulator, RendersAPartOfThePicture) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start =
        std::string("run --quiet --scene s.toml --size 64x48 --spp 1 --sky-samples 1 "
                    "--light-samples 1 --edge-pixels 4 -o a.exr --json a.json --machine ") +
        tiny + " ";
    ASSERT_EQ(simulator(start).code, 0);
    const Film whole = read_exr(folder_ / "a.exr");
    const Outcome part = simulator(start + "--crop 16,16,30,32");
    ASSERT_EQ(part.code, 0) << part.err;
    EXPECT_NE(part.out.find("the same picture, bit for bit"), std::string::npos);
    EXPECT_EQ(report("a.json").at("renderer").at("screen_tiles"), 16);
    const Film film = read_exr(folder_ / "a.exr");
    ASSERT_EQ(film.width, 30);
    ASSERT_EQ(film.height, 32);
    for (const Plane& plane : whole.planes)
        for (int y = 0; y < 32; ++y)
            for (int x = 0; x < 30; ++x)
                ASSERT_EQ(film.find(plane.name)->values[static_cast<std::size_t>(y * 30 + x)],
                          plane.values[static_cast<std::size_t>((16 + y) * 64 + 16 + x)])
                    << plane.name << ' ' << x << ' ' << y;
    EXPECT_EQ(simulator(start + "--crop 16,16,30,33").code, 2);
}

// What kernels say to be dead is not written back: neither while the frame is rendered nor after it; and the
// picture is the same.
TEST_F(Simulator, DiscardsWhatIsDead) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = std::string("run --quiet --scene s.toml --size 40x40 --spp 1 --sky-samples 1 "
                                          "--light-samples 1 --edge-pixels 2 -g sim.frame_end=write "
                                          "--json a.json --machine ") +
                              tiny + " ";
    struct Written {
        std::int64_t during = 0, at_end = 0, dropped = 0, discarded = 0, film = 0;
    };
    const auto run = [&](const std::string& options) {
        const Outcome result = simulator(start + options);
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_NE(result.out.find("the same picture, bit for bit"), std::string::npos) << options;
        const nlohmann::json r = report("a.json");
        Written w;
        for (const nlohmann::json& row : r.at("traffic")) {
            const auto lines = row.at("memory_writes").get<std::int64_t>();
            const std::string structure = row.at("structure");
            if (structure == "frame buffer")
                w.film += lines;
            if (structure == "grids" || structure == "item lists" || structure == "kd nodes" ||
                structure == "blended blocks")
                (row.at("phase") == "frame end" ? w.at_end : w.during) += lines;
        }
        for (const char* level : {"l1", "l2"}) {
            w.dropped += r.at(level).at("dropped").get<std::int64_t>();
            w.discarded += r.at(level).at("discarded").get<std::int64_t>();
        }
        return w;
    };
    for (const std::string share : {"chip", "worker"}) {
        // A cache for all of it, and one for a little.
        for (const std::string size : {"4194304", "65536"}) {
            SCOPED_TRACE(share + " " + size);
            const std::string options = "--share " + share + " -g l2.size_bytes=" + size;
            const Written off = run(options), on = run(options + " -g renderer.discard=on"),
                          drop = run(options + " -g sim.frame_end=drop");
            EXPECT_EQ(off.discarded, 0);
            EXPECT_EQ(off.dropped, 0);
            EXPECT_GT(drop.dropped, 0);
            EXPECT_LE(drop.at_end, off.at_end);
            EXPECT_EQ(drop.during, off.during);
            EXPECT_GT(on.discarded, 500);
            EXPECT_NEAR(static_cast<double>(on.film), static_cast<double>(off.film), 0.02 * 2500);
            if (size == "4194304") { // a small one makes room for the film at the end, of whatever is there
                EXPECT_GT(off.at_end, 200);
                EXPECT_EQ(drop.at_end, 0);
                // Tables of opened patches and of curves' lengths, among the grids, stay.
                EXPECT_LT(on.at_end, off.at_end / 4);
            }
            EXPECT_LT(on.during + on.at_end, off.during + off.at_end);
        }
    }
}

// What drawings hold: tests/sim/chip_drawing.cpp.
// A choice may bring other values with it: these are no overrides of their own.
TEST_F(Simulator, CountsOverridesThatAreGiven) {
    const std::pair<const char*, const char*> counts[] = {
        {"", " assumed, 72 left to defaults"},
        {" -g core.lanes=8", " 1 overridden, 72 left"},
        {" -g sim.mode=reference", " 1 overridden, 3 set by what is overridden, 72 left"},
        {" -g sim.mode=reference -g sim.quantum=1", " 2 overridden, 2 set by what is overridden, 72 left"},
    };
    for (const auto& [settings, says] : counts) {
        const Outcome told = simulator("describe --machine " + tiny + settings);
        EXPECT_NE(told.out.find(says), std::string::npos) << settings << told.out.substr(0, 200);
    }
}

TEST_F(Simulator, DrawsAChip) {
    const std::string start = "describe --machine " + tiny + " -o ";
    const Outcome drawn = simulator(start + "chip.svg");
    ASSERT_EQ(drawn.code, 0) << drawn.err;
    EXPECT_EQ(text("chip.svg").substr(0, 5), "<?xml");
    EXPECT_NE(text("chip.svg").find("<title>core 3: 2 threads"), std::string::npos);
    ASSERT_EQ(simulator(start + "chip.PNG").code, 0);
    EXPECT_EQ(text("chip.PNG").substr(1, 3), "PNG");
    const std::size_t before = folder_.count();
    for (const char* bad : {"chip.pdf", "none/chip.svg", "a.svg -g chip.cores=0"}) {
        const Outcome refused = simulator(start + bad);
        EXPECT_EQ(refused.code, 2) << bad;
        EXPECT_EQ(refused.error_lines(), 1) << refused.err;
    }
    EXPECT_EQ(folder_.count(), before);
}

} // namespace
} // namespace razor
