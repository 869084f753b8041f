// razor-sim: who shares a kd-tree, and what machines and options it refuses: exit code 2, one line, no file.
#include "tests/program/simulator.h"
#include "razor/image/exr.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <map>
#include <optional>
#include <set>

namespace razor {
namespace {

TEST_F(Simulator, SharesTreesAsAsked) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = std::string("run --quiet --scene s.toml --size 33x33 --spp 1 --sky-samples 1 "
                                          "--light-samples 1 --edge-pixels 4 --machine ") +
                              tiny + " ";
    struct Case {
        const char *options, *share;
        int trees;
        bool twice = false;
    };
    // tiny has 4 cores of 2 threads.
    const Case cases[] = {
        {"", "chip", 1},
        {"--share tile", "tile", 1},
        {"--share core", "core", 4},
        {"--share core --workers 5", "core", 4, true},
        {"--share core --workers 5 -g chip.placement=pack", "core", 3},
        {"--share worker", "worker", 8},
        {"--share worker -g chip.placement=pack", "worker", 8},
        {"--share 3", "3", 3, true},
        {"--share 3 -g chip.placement=pack", "3", 3},
        {"-g kdtree.share=2", "2", 4},
        {"-g kdtree.share=worker --share core", "core", 4, true},
    };
    std::optional<Film> first;
    for (const Case& c : cases) {
        SCOPED_TRACE(c.options);
        const Outcome result = simulator(start + c.options + " -o a.exr --json a.json");
        ASSERT_EQ(result.code, 0) << result.err;
        const nlohmann::json a = report("a.json");
        EXPECT_EQ(a.at("options").at("share"), c.share);
        EXPECT_EQ(a.at("renderer").at("trees"), c.trees);
        EXPECT_EQ(a.at("renderer").at("tree_of_worker").size(), a.at("workers"));
        const Film picture = read_exr(folder_ / "a.exr");
        if (!first)
            first = picture;
        for (const Plane& plane : first->planes)
            EXPECT_EQ(picture.find(plane.name)->values, plane.values) << plane.name;
        if (c.twice) {
            ASSERT_EQ(simulator(start + c.options + " --json b.json").code, 0);
            EXPECT_EQ(report("b.json"), a);
        }
    }
    EXPECT_EQ(report("a.json").at("renderer").at("tree_of_worker"),
              nlohmann::json::parse("[0, 1, 2, 3, 0, 1, 2, 3]"));
}

// What is estimated comes with its error, and nothing is told that a sampled run does not know.
TEST_F(Simulator, EstimatesFromSamples) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"box\"\n");
    const std::string start =
        std::string("run --quiet --no-native --scene s.toml --size 48x48 --spp 1 --machine ") + tiny + " ";
    const Outcome result = simulator(start + "--estimate sample:0.2 --estimate-seed 3 --json a.json");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_NE(result.out.find("estimate               sampled: "), std::string::npos) << result.out;
    EXPECT_EQ(result.out.find("where the threads' cycles went"), std::string::npos);
    const nlohmann::json a = report("a.json");
    const nlohmann::json& e = a.at("estimate");
    EXPECT_EQ(e.at("seed"), 3);
    EXPECT_FALSE(a.contains("threads"));
    for (const auto& [name, figure] : e.at("figures").items()) {
        EXPECT_LE(figure.at("low"), figure.at("value")) << name;
        EXPECT_LE(figure.at("value"), figure.at("high")) << name;
    }
    const std::pair<const char*, const char*> wrong[] = {
        {"--estimate half", "give sample:FRACTION"},
        {"--estimate sample:0", "from 0.001 to 1"},
        {"--estimate-seed 1", "of no use without --estimate"},
        {"--estimate sample:0.1 --frames 2", "leave out --frames"},
        {"--estimate sample:0.1 --host-threads 2", "leave out --host-threads"},
    };
    for (const auto& [options, says] : wrong) {
        SCOPED_TRACE(options);
        const Outcome outcome = simulator(start + options + " --json wrong.json");
        EXPECT_EQ(outcome.code, 2);
        EXPECT_NE(outcome.err.find(says), std::string::npos) << outcome.err;
        EXPECT_EQ(std::count(outcome.err.begin(), outcome.err.end(), '\n'), 1);
        EXPECT_FALSE(std::filesystem::exists(folder_ / "wrong.json"));
    }
    const Outcome coherent =
        simulator("run --quiet --scene s.toml --size 8x8 --estimate sample:0.1 --machine " +
                  quoted_argument(RAZOR_SOURCE_DIR "/configs/machines/xeon-x5355-2s.toml"));
    EXPECT_EQ(coherent.code, 2);
    EXPECT_NE(coherent.err.find("coherent"), std::string::npos) << coherent.err;
}

// The machine compares its picture with a native one without a budget, and fails if they differ.
TEST_F(Simulator, StaysWithinItsMemory) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start = std::string("run --quiet --scene s.toml --size 48x48 --spp 1 --sky-samples 1 "
                                          "--light-samples 1 --edge-pixels 2 --machine ") +
                              tiny + " ";
    for (const char* how : {"--memory 400KiB", "--memory 3MiB --share worker", "--memory 1400KiB --share 2",
                            "--memory 400KiB --workers 1"}) {
        SCOPED_TRACE(how);
        ASSERT_EQ(simulator(start + how + " -o a.exr --json a.json").code, 0);
        const nlohmann::json a = report("a.json");
        const nlohmann::json& memory = a.at("renderer").at("memory");
        EXPECT_GT(memory.at("drops"), 0);
        EXPECT_GT(memory.at("regenerated").at("blocks"), 0);
        EXPECT_LE(memory.at("peak_bytes"), memory.at("budget_bytes"));
    }
    const nlohmann::json last = report("a.json");
    ASSERT_EQ(simulator(start + "--memory 400KiB --workers 1 --json b.json").code, 0);
    EXPECT_EQ(report("b.json"), last);
    const std::size_t before = folder_.count();
    const Outcome small = simulator(start + "--memory 64KiB -o c.exr --json c.json");
    EXPECT_EQ(small.code, 2);
    EXPECT_NE(small.err.find("raise --memory"), std::string::npos) << small.err;
    EXPECT_EQ(folder_.count(), before);
}

// Threads are in the middle of their screen tiles, which take a minute.
TEST_F(Simulator, OutputsAreNoInputs) {
    std::ifstream file(std::filesystem::path(RAZOR_SOURCE_DIR) / "configs/machines/tiny.toml");
    const std::string scene = "[[mesh]]\nshape = \"box\"\n",
                      machine(std::istreambuf_iterator<char>(file), {});
    folder_.file("s.toml", scene);
    folder_.file("m.toml", machine);
    const std::string run =
        "run --quiet --machine m.toml --scene s.toml --size 8x8 --spp 1 --light-samples 1 "
        "--sky-samples 1 ";
    ASSERT_EQ(simulator(run + "--json a.json").code, 0);
    const std::string report = text("a.json");
    const std::size_t before = folder_.count();
    for (const std::string& arguments :
         {run + "--json s.toml", run + "--report m.toml", run + "-o b.exr --json b.exr",
          run + "--json b --report ./b", run + "--trace s.toml", run + "--estimate closed-form --json m.toml",
          std::string("compare a.json a.json --json a.json")}) {
        const Outcome result = simulator(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << arguments << result.err;
        EXPECT_EQ(text("s.toml"), scene) << arguments;
        EXPECT_EQ(text("m.toml"), machine) << arguments;
        EXPECT_EQ(text("a.json"), report) << arguments;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
}

TEST_F(Simulator, InterruptEndsTheRun) {
    const std::size_t before = folder_.count();
    for (const char* more : {"", " --host-threads 2 -g chip.tiles=2 -g sim.mode=reference"}) {
        const auto start = std::chrono::steady_clock::now();
        const Outcome result =
            run("timeout --foreground --preserve-status -s INT -k 100 2 " + quoted_argument(RAZOR_SIMULATOR) +
                    " run --size 512x512 --spp 4096 -o a.exr --json a.json --machine " + tiny + more,
                folder_.path());
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        EXPECT_EQ(result.code, 130) << result.err;
        EXPECT_EQ(result.err, "razor-sim: interrupted; nothing written\n");
        EXPECT_LT(seconds, 30);
        EXPECT_EQ(folder_.count(), before);
    }
}

// Traffic by kind of ray and by level of what is read. At one fixed level rays meet blocks of no other.
TEST_F(Simulator, HostThreadsChangeNoDigit) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n[[mesh]]\nshape = \"knot\"\n");
    const std::string start = std::string("run --quiet --no-native --scene s.toml --size 40x40 --spp 1 "
                                          "--sky-samples 0 --light-samples 1 --edge-pixels 8 --machine ") +
                              tiny +
                              " -g chip.tiles=4 -g chip.cores=1 -g sim.quantum=100 -g sim.window=5000 ";
    for (const std::string share : {"chip", "tile", "worker", "3"}) {
        nlohmann::json serial;
        for (const char* threads : {"1", "2", "3"}) {
            SCOPED_TRACE(share + ", " + threads);
            const Outcome result =
                simulator(start + "--share " + share + " --host-threads " + threads + " --json a.json");
            ASSERT_EQ(result.code, 0) << result.err;
            if (serial.is_null())
                serial = report("a.json");
            else
                EXPECT_EQ(report("a.json"), serial);
        }
    }
}

TEST_F(Simulator, AttributesTrafficToRaysAndLevels) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start =
        "run --quiet --no-native --scene s.toml --size 16x16 --spp 1 --edge-pixels 0.5 --json "
        "a.json --machine " +
        tiny + " ";
    const auto traffic = [&](const std::string& options) {
        const Outcome result = simulator(start + options);
        EXPECT_EQ(result.code, 0) << result.err;
        return report("a.json").at("traffic");
    };
    // Of reads, by `key`.
    const auto reads = [](const nlohmann::json& rows, const char* key, const std::string& structure,
                          const std::string& phase) {
        std::map<nlohmann::json, std::int64_t> sum;
        for (const nlohmann::json& row : rows)
            if ((structure.empty() || row.at("structure") == structure) &&
                (phase.empty() || row.at("phase") == phase) && row.at("l1_reads") > 0)
                sum[row.at(key)] += row.at("l1_reads").get<std::int64_t>();
        return sum;
    };
    const nlohmann::json all = traffic("--lod fixed --light-samples 1 --sky-samples 1");
    const nlohmann::json sky = traffic("--lod fixed --light-samples 0 --sky-samples 2");
    const nlohmann::json coarser = traffic("--lod fixed:1 --light-samples 0 --sky-samples 1");
    const nlohmann::json own = traffic("--lod recursive --light-samples 0 --sky-samples 1");
    const auto kinds = [&](const nlohmann::json& rows, const char* phase) {
        std::vector<std::string> names;
        for (const auto& [name, n] : reads(rows, "kind", "", phase))
            names.push_back(name);
        return names;
    };
    using Names = std::vector<std::string>;
    EXPECT_EQ(kinds(all, "intersect"), (Names{"camera", "light", "sky"}));
    EXPECT_EQ(kinds(sky, "intersect"), (Names{"camera", "sky"}));
    EXPECT_EQ(kinds(sky, "animate"), Names{"none"});
    // Chords of blocks are measured where hits are shaded.
    EXPECT_EQ(kinds(sky, "tessellate"), (Names{"camera", "none", "sky"}));

    const auto finest = reads(sky, "level", "grids", "intersect");
    const auto next = reads(coarser, "level", "grids", "intersect");
    ASSERT_EQ(finest.size(), 1U);
    ASSERT_EQ(next.size(), 1U);
    EXPECT_EQ(next.begin()->first.get<int>(), finest.begin()->first.get<int>() + 1);
    EXPECT_GT(reads(own, "level", "grids", "intersect").size(), 1U);
    for (const char* structure : {"kd nodes", "item lists"}) { // nodes at the top of the tree have no level
        const auto read = reads(own, "level", structure, "traverse");
        if (structure == std::string("kd nodes")) {
            EXPECT_EQ(read.count(nullptr), 1U);
        }
        EXPECT_GT(read.size(), 2U) << structure;
        for (const auto& [level, n] : read)
            EXPECT_TRUE(level.is_null() || level >= finest.begin()->first) << structure << ' ' << level;
    }
}

// What a scene is stated in changes the names of levels alone, which are powers of two of its own unit.
TEST_F(Simulator, CountsTheSameInAllUnits) {
    const auto simulated = [&](const std::string& scale) {
        folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\nscale = " + scale + "\n");
        const Outcome result = simulator(
            "run --quiet --scene s.toml --size 24x24 --spp 1 --light-samples 1 --sky-samples 1 --edge-pixels "
            "4 --lod recursive --json a.json --machine " +
            tiny);
        EXPECT_EQ(result.code, 0) << result.err;
        nlohmann::json all = report("a.json");
        all.erase("scene");
        return all;
    };
    nlohmann::json small = simulated("9.094947017729282e-13"); // 2^-40
    const nlohmann::json usual = simulated("1");
    int levels = 0;
    for (nlohmann::json& row : small.at("traffic"))
        if (!row.at("level").is_null()) {
            row.at("level") = row.at("level").get<int>() + 40;
            ++levels;
        }
    EXPECT_GT(levels, 10);
    EXPECT_EQ(small, usual);
}

// 512 threads on 16 tiles: the native picture, the same report twice, and what the report says of limits and
// the host.
TEST_F(Simulator, RunsCopernicus) {
    const std::string start =
        "run --quiet --size 40x24 --spp 1 --light-samples 1 --sky-samples 1 --machine " +
        quoted_argument(RAZOR_SOURCE_DIR "/configs/machines/copernicus.toml") + " ";
    const Outcome first = simulator(start + "--json a.json");
    ASSERT_EQ(first.code, 0) << first.err;
    EXPECT_NE(first.out.find("\nlimited by "), std::string::npos);
    EXPECT_NE(first.out.find("the same picture, bit for bit"), std::string::npos) << first.out;
    const nlohmann::json all = nlohmann::json::parse(text("a.json"));
    const nlohmann::json& native = all.at("host").at("native");
    EXPECT_EQ(native.at("picture_equal"), true);
    EXPECT_GT(native.at("slowdown"), 1.0);
    ASSERT_EQ(all.at("limits").size(), 5U);
    for (const nlohmann::json& l : all.at("limits"))
        EXPECT_LE(l.at("cycles"), all.at("drained_cycles"));
    EXPECT_EQ(all.at("l2_by_tile").size(), 16U);
    EXPECT_EQ(all.at("threads").size(), 512U);
    EXPECT_EQ(all.at("renderer").at("trees"), 16);
    ASSERT_EQ(simulator(start + "--no-native --json b.json").code, 0);
    EXPECT_EQ(report("b.json"), report("a.json"));
}

// Noise moves cycles, never the picture, and not the work of one worker, whom nobody else's timing reaches.
TEST_F(Simulator, NoiseMovesCyclesAlone) {
    folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n");
    const std::string start =
        std::string("run --quiet --scene s.toml --size 24x24 --spp 1 --sky-samples 1 "
                    "--light-samples 0 --edge-pixels 4 --no-native -o a.exr --json a.json --machine ") +
        tiny + " ";
    for (const char* workers : {"--workers 1", "--workers 8"}) {
        std::optional<Film> picture;
        std::set<std::uint64_t> cycles, vops;
        for (const char* seed : {"", "--jitter 1", "--jitter 2", "--jitter 3", "--jitter 4"}) {
            SCOPED_TRACE(seed);
            const Outcome result = simulator(start + workers + " " + seed);
            ASSERT_EQ(result.code, 0) << result.err;
            const nlohmann::json a = report("a.json");
            EXPECT_EQ(a.at("jitter").at("seed") != 0, *seed != 0);
            EXPECT_EQ(result.out.find("\njitter ") != std::string::npos, *seed != 0);
            cycles.insert(a.at("cycles").get<std::uint64_t>());
            vops.insert(a.at("core").at("vops").get<std::uint64_t>());
            const Film film = read_exr(folder_ / "a.exr");
            if (!picture)
                picture = film;
            for (const Plane& plane : picture->planes)
                EXPECT_EQ(film.find(plane.name)->values, plane.values) << plane.name;
        }
        // Two seeds may end alike: who waits for a refresh of DRAM goes on at its end, whatever came before.
        EXPECT_GE(cycles.size(), 4U) << workers;
        if (std::string(workers) == "--workers 1") {
            EXPECT_EQ(vops.size(), 1U);
        }
    }
    // The option is the setting by another name.
    ASSERT_EQ(simulator(start + "--workers 8 --jitter 7").code, 0);
    const nlohmann::json option = report("a.json");
    ASSERT_EQ(simulator(start + "--workers 8 -g sim.jitter=7 --host-threads 2").code, 0);
    EXPECT_EQ(report("a.json"), option);
}

// The table names every row of what must be validated, and says which are not.
TEST_F(Simulator, ValidatesItself) {
    const Outcome result = simulator("validate --json v.json");
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    const nlohmann::json all = nlohmann::json::parse(text("v.json"));
    EXPECT_EQ(all.at("missed"), 0);
    std::map<std::string, int> results;
    for (const nlohmann::json& row : all.at("rows")) {
        ++results[row.at("result").get<std::string>()];
        for (const char* column : {"what", "against", "bar"})
            EXPECT_NE(row.at(column), "") << row;
        EXPECT_NE(result.out.find(row.at("what").get<std::string>()), std::string::npos);
    }
    EXPECT_GT(results["passed"], 50);
    EXPECT_EQ(results["reported"], 13); // the noise, and the fast mode on twelve networks
    EXPECT_GT(results["tests only"], 3);
    EXPECT_EQ(results.count("not built"), 0U);
    for (const char* program : {"analysis/whole/whole.py", "analysis/whole/characterise.py"}) {
        EXPECT_NE(result.out.find(program), std::string::npos) << program;
        EXPECT_TRUE(std::filesystem::exists(std::string(RAZOR_SOURCE_DIR "/") + program)) << program;
    }
    for (const char* what : {"operations", "instruction and reference counts", "caches", "laws", "DRAM",
                             "core", "network", "coherence", "order", "noise", "assumptions", "the whole"})
        EXPECT_NE(result.out.find(what), std::string::npos) << what;
    const std::size_t before = folder_.count();
    for (const char* options : {"validate --json none/v.json", "validate --jsn v.json", "validate more"}) {
        const Outcome bad = simulator(options);
        EXPECT_EQ(bad.code, 2) << options;
        EXPECT_EQ(bad.error_lines(), 1) << bad.err;
        EXPECT_EQ(bad.out, "");
        EXPECT_EQ(folder_.count(), before);
    }
}

// A memory by itself: beside its closed forms, and what it refuses.
TEST_F(Simulator, TriesMemories) {
    const std::string few = "dram --preset ddr4-2400r --requests 20000 --json d.json ";
    const Outcome result = simulator(few + "--stream random --load 0.1 --load 0.5");
    ASSERT_EQ(result.code, 0) << result.err;
    // Four bursts of 64 bytes in tFAW, 26 clocks of 833 ps, but for refreshes.
    EXPECT_NE(
        result.out.find("random: no more than 11.29 GB/s by the four activates (tFAW) where no row is hit"),
        std::string::npos)
        << result.out;
    const nlohmann::json all = report("d.json");
    EXPECT_EQ(all.at("preset"), "ddr4-2400r");
    EXPECT_NEAR(all.at("peak_gigabytes_per_second"), 19.2, 0.02);
    const nlohmann::json& closed = all.at("closed_forms").at(0);
    ASSERT_EQ(all.at("rows").size(), 6U); // two loads and no limit, of two controllers
    for (const nlohmann::json& row : all.at("rows")) {
        const double wanted = row.at("load").is_null() ? 1 : row.at("load").get<double>();
        const double moved = row.at("gigabytes_per_second");
        EXPECT_LE(moved, closed.at("gigabytes_per_second").get<double>() * 1.001);
        EXPECT_LE(moved, wanted * 19.2 * 1.02);
        EXPECT_GE(row.at("latency_ns").at("p99"), row.at("latency_ns").at("median"));
        EXPECT_EQ(row.at("counters").at("reads"), 20000);
        if (row.at("controller") == "queued" && row.at("load").is_null()) {
            EXPECT_GT(moved, 0.98 * closed.at("gigabytes_per_second").get<double>());
        }
        if (row.at("load") == 0.1) {
            EXPECT_NEAR(row.at("latency_ns").at("mean").get<double>() /
                            closed.at("idle_latency_ns").get<double>(),
                        1, 0.4);
        }
    }
    ASSERT_EQ(simulator(few + "--stream random --load 0.1 --load 0.5").code, 0);
    EXPECT_EQ(report("d.json"), all) << "the same twice";
    ASSERT_EQ(simulator(few + "--controller queued --stream sequential --seed 2 -g memory.channels=2").code,
              0);
    EXPECT_EQ(report("d.json").at("rows").size(), 6U);
    EXPECT_NEAR(report("d.json").at("peak_gigabytes_per_second"), 38.4, 0.04);
    EXPECT_EQ(report("d.json").at("rows").at(0).at("controller"), "queued");
    ASSERT_EQ(simulator("dram --requests 1000 --controller immediate --machine " + tiny).code, 0);

    const std::size_t before = folder_.count();
    for (const auto& [options, says] : {std::pair{"--preset ddr9", "--preset: memory.preset is \"ddr9\""},
                                        {"--stream zigzag", "zigzag"},
                                        {"--load 0", "--load '0'"},
                                        {"--load 1.1", "--load '1.1'"},
                                        {"--load much", "--load 'much'"},
                                        {"--requests 0", "--requests '0'"},
                                        {"--in-flight 0", "--in-flight '0'"},
                                        {"--mebibytes 0", "--mebibytes '0'"},
                                        {"--stride -4", "--stride '-4'"},
                                        {"--stream random --stride 128", "--stride is of a strided stream"},
                                        {"--seed x", "--seed 'x'"},
                                        {"--controller other", "--controller 'other'"},
                                        {"--machine none.toml", "none.toml: cannot be read"},
                                        {"-g memory.tRCD=0", "memory.tRCD is 0"},
                                        {"-g memory.trcd=9", "the nearest known one is memory.tRCD"},
                                        {"--json nowhere/e.json", "nowhere"},
                                        {"--strem random", "did you mean --stream?"}}) {
        SCOPED_TRACE(options);
        const Outcome bad =
            simulator(std::string("dram ") + options +
                      (std::string(options).find("--json") == std::string::npos ? " --json e.json" : ""));
        EXPECT_EQ(bad.code, 2);
        EXPECT_EQ(bad.error_lines(), 1) << bad.err;
        EXPECT_NE(bad.err.find(says), std::string::npos) << bad.err;
        EXPECT_EQ(bad.out, "");
        EXPECT_EQ(folder_.count(), before) << "a file was left";
    }
}

TEST_F(Simulator, WritesOverNoFileThatItsMachineInherits) {
    const std::string base = "[chip]\ncores = 2\n";
    folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
    folder_.file("root.svg", base);
    folder_.file("base.toml", "inherit = \"root.svg\"\n" + base);
    folder_.file("own.toml", "inherit = \"base.toml\"\n[chip]\nthreads = 1\n");
    folder_.file("all.toml", "inherit = \"base.toml\"\n" + base); // no value of the others is left
    const std::string run = "run --scene box.toml --size 8x8 --spp 1 ";
    for (const std::string& arguments :
         {run + "--machine own.toml --json base.toml", run + "--machine all.toml --json base.toml",
          run + "--machine all.toml --json root.svg", std::string("dram --machine all.toml --json root.svg"),
          std::string("describe --machine all.toml -o root.svg")}) {
        const Outcome result = simulator(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_NE(result.err.find(": is one of the files that this is made of"), std::string::npos)
            << result.err;
        EXPECT_EQ(text("base.toml"), "inherit = \"root.svg\"\n" + base) << arguments;
        EXPECT_EQ(text("root.svg"), base) << arguments;
    }
}

// 32 bits of a line's number besides its set's.
TEST_F(Simulator, CachesOfFewSetsMayLackTags) {
    folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
    const Outcome result =
        simulator("run --quiet --scene box.toml --size 8x8 --spp 1 --no-native --machine " + tiny +
                  " -g l1.line_bytes=16 -g l1.size_bytes=256 -g l1.ways=16 --report r.txt");
    EXPECT_EQ(result.code, 2);
    EXPECT_NE(result.err.find("a cache of 1 set has no tag for line"), std::string::npos) << result.err;
    EXPECT_EQ(result.error_lines(), 1);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "r.txt"));
}

TEST_F(Simulator, RefusesBadMachinesAndOptions) {
    folder_.file("good.toml", "[chip]\ncores = 2\n");
    folder_.file("empty.toml", "");
    folder_.file("noise.toml", std::string("\0\xff\x80[chip]\n", 10));
    folder_.file("key.toml", "[chip]\ncoers = 2\n");
    folder_.file("zero.toml", "[chip]\ncores = 0\n");
    folder_.file("sets.toml", "[l2]\nsize_bytes = 3000000\n");
    folder_.file("twice.toml", "[chip]\ncores = 2\n[l1]\n[chip]\nthreads = 2\n");
    folder_.file("orphan.toml", "inherit = \"none.toml\"\n");
    folder_.file("self.toml", "inherit = \"self.toml\"\n");
    folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
    std::filesystem::create_directory(folder_ / "folder.toml");
    const std::pair<const char*, const char*> cases[] = {
        {"--machine none.toml", "none.toml: cannot be read"},
        {"--machine ''", "--machine '' is empty; give "},
        {"--machine folder.toml", "folder.toml: is a folder"},
        {"--machine empty.toml", "empty.toml: is empty"},
        {"--machine noise.toml", "noise.toml:1:1: not TOML"},
        {"--machine key.toml", "key.toml:2:1: unknown key chip.coers; the nearest known one is chip.cores"},
        {"--machine zero.toml", "zero.toml:2:9: chip.cores is 0; it must be from 1 to"},
        {"--machine sets.toml",
         "make it 2097152 or 4194304 (l2.size_bytes from sets.toml:2, l2.ways from default)"},
        {"--machine twice.toml", "twice.toml:4:1: not TOML"},
        {"--machine orphan.toml", "orphan.toml:1:11: inherits none.toml, which cannot be read"},
        {"--machine self.toml", "self.toml:1:11: files inherit from each other in a circle"},
        {"--machine good.toml -g chip.cores", "-g chip.cores: must be of the form section.key=value"},
        {"--machine good.toml -g chip.core=2", "the nearest known one is chip.cores"},
        {"--machine good.toml -g chip.cores=-2", "-g chip.cores=-2: chip.cores is -2"},
        {"--machine good.toml -g core.scalar_overhead=nan", "core.scalar_overhead is nan"},
        {"--machine good.toml -g l2.size_bytes=2MB", "KiB, MiB or GiB"},
        {"--machine good.toml --workers 0", "--workers '0'"},
        {"--machine good.toml --workers 5", "give a whole number from 1 to 4"},
        {"--machine good.toml --share all", "--share: kdtree.share is \"all\"; it must be one of"},
        {"--machine good.toml --share 0", "--share: kdtree.share is \"0\""},
        {"--machine good.toml --interval 5000", "--interval is of no use without --intervals FILE.csv"},
        {"--machine good.toml --intervals i.csv --interval 0", "give a whole number from 1000 to 1000000000"},
        {"--machine good.toml --intervals i.csv --interval 10k", "--interval '10k'"},
        {"--machine good.toml --intervals none/i.csv", "none/i.csv"},
        {"--machine good.toml --frames 0", "give a whole number from 1 to 1000"},
        {"--machine good.toml --frames two", "--frames 'two'"},
        {"--machine good.toml --size 40x17 --tiles 2", "give FIRST..LAST, for example 0..9"},
        {"--machine good.toml --size 40x17 --tiles 3..2", "--tiles '3..2' ends before it begins"},
        {"--machine good.toml --size 40x17 --tiles 2..15", "the last of --tiles '15'"},
        {"--machine good.toml --size 40x17 --tiles x..2", "the first of --tiles 'x'"},
        {"--machine good.toml --jitter -1", "--jitter '-1'"},
        {"--machine good.toml --jitter 1.5", "give a whole number from 0 to 2147483647"},
        {"--machine good.toml -g sim.jitter=x", "-g sim.jitter=x"},
        {"--machin good.toml", "did you mean --machine?"},
        {"", "--machine is required"},
        {"--machine good.toml --report \"\"", "--report '' is empty; give "},
        {"--machine good.toml --intervals \"\"", "--intervals '' is empty; give "},
        {"--machine good.toml --trace \"\"", "--trace '' is empty; give "},
        {"--machine good.toml -o \"\"", "--output '' is empty; give "},
        {"--machine good.toml --workers \"\"", "--workers '' is empty; give "},
        {"--machine good.toml --trace -", "--trace: - stands for no file here; give its name"},
        {"--machine good.toml --report -", "--report: - stands for no file here; give its name"},
    };
    const std::size_t before = folder_.count();
    for (const auto& [options, says] : cases) {
        SCOPED_TRACE(options);
        const Outcome result =
            simulator(std::string("run --scene box.toml -o a.exr --json a.json ") + options);
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_TRUE(result.err.starts_with("razor-sim: ")) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_EQ(result.out, "");
        EXPECT_EQ(folder_.count(), before) << "a file was left";
    }
    EXPECT_EQ(simulator("print-config --machine key.toml").code, 2);
}

// The configuration that is printed runs as the machine that it was printed from, to the digit.
TEST_F(Simulator, RunsItsPrintedConfiguration) {
    folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
    const std::string settings = " -g chip.cores=2 -g l2.size_bytes=64KiB -g kdtree.share=core";
    const std::string frame = " --quiet --scene box.toml --size 24x24 --spp 1";
    const Outcome printed = simulator(std::string("print-config --machine ") + tiny + settings);
    ASSERT_EQ(printed.code, 0) << printed.err;
    folder_.file("printed.toml", printed.out);
    ASSERT_EQ(simulator(std::string("run --json a.json --machine ") + tiny + settings + frame).code, 0);
    ASSERT_EQ(simulator("run --json b.json --machine printed.toml" + frame).code, 0);
    nlohmann::json a = report("a.json"), b = report("b.json");
    EXPECT_EQ(a["machine_provenance"]["chip.cores"]["from"], "-g");
    EXPECT_EQ(a["machine_provenance"]["l1.ways"]["mark"], "assumed");
    EXPECT_EQ(b["machine_provenance"]["l1.ways"]["mark"], "assumed");
    a.erase("machine_provenance");
    b.erase("machine_provenance");
    EXPECT_EQ(a, b);
}

} // namespace
} // namespace razor
