// razor-sim sweep: designs of the machine for tests, planned, run, gone on with, ranked; mistakes.
#include "tests/program/simulator.h"

#include <chrono>
#include <map>
#include <thread>

namespace razor {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

/// Four designs, of three runs each.
const std::string small_sweep = R"(
kind = "sweep"
title = "Caches of a box"
seeds = 3
[settings]
machine = "tiny.toml"
scene = "box.toml"
size = "16x16"
samples = 1
workers = 2
[knobs]
l2.size_bytes = ["4 KiB", "128 KiB"]
core.lanes = [4, 8]
)";

class DesignSweep : public Simulator {
protected:
    DesignSweep() {
        folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
        fs::copy_file(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml", folder_ / "tiny.toml");
        folder_.file("sweep.toml", small_sweep);
    }
    Outcome sweep(const std::string& arguments) const { return simulator("sweep " + arguments); }
    /// The small sweep, with something else in place of a part of it.
    void edited(const std::string& name, const std::string& part, const std::string& by) const {
        std::string out = small_sweep;
        out.replace(out.find(part), part.size(), by);
        folder_.file(name, out);
    }
    /// What is in results/, by name, without what stands behind "host".
    std::map<std::string, std::string> results(const std::string& folder) const {
        std::map<std::string, std::string> out;
        for (const auto& entry : fs::directory_iterator(folder_ / (folder + "/results"))) {
            const std::string name = entry.path().filename().string();
            const std::string all = text(folder + "/results/" + name);
            out[name] = all.substr(0, all.find("\"host\""));
        }
        return out;
    }
    static std::size_t lines(const std::string& text) {
        return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
    }
    nlohmann::json collected(const std::string& folder) const {
        return nlohmann::json::parse(text(folder + "/study.json"));
    }
};

TEST_F(DesignSweep, PlansRunsAndCollects) {
    const Outcome plan = sweep("sweep.toml plan -o s");
    ASSERT_EQ(plan.code, 0) << plan.err;
    EXPECT_EQ(lines(plan.out), 4U);
    EXPECT_TRUE(results("s").empty());
    const std::string first = plan.out.substr(0, 32);
    EXPECT_NE(text("s/points/" + first + ".toml").find("size_bytes = 4096"), std::string::npos);
    // Another order of keys, sizes as numbers: the same points.
    edited("same.toml", "l2.size_bytes = [\"4 KiB\", \"128 KiB\"]\ncore.lanes = [4, 8]",
           "core.lanes = [8, 4]\nl2.size_bytes = [131072, 4096]");
    ASSERT_EQ(sweep("same.toml plan -o s").code, 0);
    EXPECT_EQ(std::distance(fs::directory_iterator(folder_ / "s/points"), {}), 4);

    const Outcome one = sweep("sweep.toml run -o s --point " + first);
    EXPECT_EQ(one.code, 0) << one.err;
    EXPECT_EQ(one.out, "1 measured, 0 of them failed; 0 were there\n");
    EXPECT_EQ(results("s").count(first + ".json"), 1U);
    const Outcome part = sweep("sweep.toml run -o s --part 2/4 --jobs 1");
    EXPECT_EQ(part.out, "1 measured, 0 of them failed; 0 were there\n") << part.err;
    EXPECT_FALSE(fs::exists(folder_ / "s/study.csv"));
    const Outcome rest = sweep("sweep.toml -o s --jobs 2");
    ASSERT_EQ(rest.code, 0) << rest.err;
    EXPECT_EQ(rest.err, ""); // no progress in a pipe
    EXPECT_NE(rest.out.find("4 points: 4 measured, 0 failed, 0 missing"), std::string::npos) << rest.out;

    // Figures are those of the runs.
    const nlohmann::json all = collected("s");
    std::vector<double> cycles;
    for (const char* seed : {"1", "2", "3"}) {
        ASSERT_EQ(
            simulator(std::string("run --quiet --no-native --machine tiny.toml --scene box.toml --size 16x16 "
                                  "--spp 1 --workers 2 -g l2.size_bytes=4096 -g core.lanes=4 --json a.json "
                                  "--jitter ") +
                      seed)
                .code,
            0);
        cycles.push_back(report("a.json").at("cycles").get<double>());
    }
    std::sort(cycles.begin(), cycles.end());
    const nlohmann::json figures = all["points"][0]["figures"];
    EXPECT_EQ(all["points"][0]["point"], first);
    EXPECT_EQ(figures["cycles"]["least"], cycles[0]);
    EXPECT_EQ(figures["cycles"]["median"], cycles[1]);
    EXPECT_EQ(figures["cycles"]["most"], cycles[2]);
    const nlohmann::json last = report("a.json");
    const double dram = 64 * (last["memory"]["reads"].get<double>() + last["memory"]["writes"].get<double>());
    EXPECT_GE(figures["dram_bytes"]["most"], dram);
    EXPECT_LE(figures["dram_bytes"]["least"], dram);
    for (const char* figure :
         {"seconds", "rays_per_second", "l1_misses", "l2_misses", "energy_joules", "watts", "l1_utilisation",
          "l2_utilisation", "memory_utilisation", "built_megabytes"})
        EXPECT_GT(figures[figure]["median"], 0) << figure;
    EXPECT_FALSE(all["points"][0]["words"]["limited_by"].get<std::string>().empty());
    // Fewer lanes take longer, at either cache, and smaller caches ask more of DRAM.
    const auto ratio = [&](const char* figure, const char* knob) {
        for (const auto& one : all["sensitivity"][figure])
            if (one["knob"] == knob)
                return one;
        return nlohmann::json();
    };
    EXPECT_LT(ratio("cycles", "core.lanes")["ratio"]["most"], 0.9);
    EXPECT_EQ(ratio("cycles", "core.lanes")["sure_pairs"], 2);
    EXPECT_LT(ratio("dram_bytes", "l2.size_bytes")["ratio"]["most"], 0.9);
    for (const char* file : {"s/study.csv", "s/sensitivity-cycles.svg", "s/energy_joules-seconds.svg"})
        EXPECT_FALSE(text(file).empty()) << file;
    EXPECT_NE(text("s/study.html").find("<svg"), std::string::npos);
    EXPECT_NE(text("s/study.csv").find("cycles_place"), std::string::npos);

    // All is kept, and elsewhere the same bytes come of the same points.
    const auto before = results("s");
    EXPECT_EQ(sweep("sweep.toml run -o s").out, "0 measured, 0 of them failed; 4 were there\n");
    ASSERT_EQ(sweep("same.toml run -o t").code, 0);
    EXPECT_EQ(results("t"), before);
}

// Every level that a machine may have has its figures.
TEST_F(DesignSweep, KnowsFiveLevels) {
    edited("five.toml", "[\"4 KiB\", \"128 KiB\"]\ncore.lanes = [4, 8]",
           "[\"4 KiB\"]\nl3.size_bytes = [\"16 KiB\"]\nl4.size_bytes = [\"32 KiB\"]\n"
           "l5.size_bytes = [\"64 KiB\"]\nl3.share = [\"tile\"]\nl4.share = [\"tile\"]");
    const Outcome five = sweep("five.toml -o s");
    ASSERT_EQ(five.code, 0) << five.err << five.out;
    const nlohmann::json figures = collected("s")["points"][0]["figures"];
    for (const char* level : {"l1", "l2", "l3", "l4", "l5"})
        for (const char* figure : {"_misses", "_miss_rate", "_utilisation"})
            EXPECT_GT(figures[level + std::string(figure)]["median"], 0) << level << figure;
}

TEST_F(DesignSweep, RanksNothingWithinNoise) {
    // Power moves no cycle: designs are equal by cycles, and by energy they are not.
    edited("power.toml", "core.lanes = [4, 8]", "energy.core_mw = [20, 500]");
    ASSERT_EQ(sweep("power.toml -o s").code, 0);
    const nlohmann::json all = collected("s");
    for (const auto& point : all["points"])
        EXPECT_EQ(
            point["places"]["cycles"]["worst"].get<int>() - point["places"]["cycles"]["best"].get<int>(), 1);
    EXPECT_EQ(all["points"][0]["places"]["energy_joules"]["worst"], 2) << all["points"][0];
    for (const auto& one : all["sensitivity"]["cycles"])
        EXPECT_EQ(one["sure_pairs"], one["knob"] == "energy.core_mw" ? 0 : 2);
    // One run of each says nothing of noise.
    edited("once.toml", "seeds = 3", "seeds = 1");
    const Outcome once = sweep("once.toml -o t");
    ASSERT_EQ(once.code, 0) << once.err;
    EXPECT_NE(once.out.find("not ranked by cycles: none has 3 runs"), std::string::npos) << once.out;
    EXPECT_FALSE(collected("t")["points"][0].contains("places"));
}

// What cannot be built, and what cannot be run, is said; all else is measured.
TEST_F(DesignSweep, FailingDesignsStopNoOther) {
    edited("odd.toml", "[\"4 KiB\", \"128 KiB\"]\ncore.lanes = [4, 8]", "[5000, 131072]\nworkers = [2, 100]");
    const Outcome odd = sweep("odd.toml -o s");
    EXPECT_EQ(odd.code, 0) << odd.err;
    EXPECT_NE(odd.out.find("4 points: 1 measured, 3 failed, 0 missing"), std::string::npos) << odd.out;
    EXPECT_NE(odd.out.find("do not divide"), std::string::npos) << odd.out;
    EXPECT_NE(odd.out.find("failed: l2.size_bytes 131072, workers 100: razor-sim run failed (exit code 2): "
                           "razor-sim: --workers '100'"),
              std::string::npos)
        << odd.out;
    EXPECT_NE(text("s/study.csv").find("failed: "), std::string::npos);
    const auto quiet = sweep("odd.toml -o s --quiet");
    EXPECT_EQ(quiet.code, 0);
    EXPECT_EQ(quiet.out, "");
    EXPECT_EQ(quiet.err.find("razor-sim: 3 of 4 points failed; razor-sim run failed"), 0U) << quiet.err;
    // They stay so until it is asked for.
    EXPECT_EQ(
        sweep("odd.toml run -o s").out,
        "0 measured, 0 of them failed; 4 were there, 3 of them failed (--again measures what failed anew)\n");
    EXPECT_EQ(sweep("odd.toml run -o s --again").out,
              "3 measured, 3 of them failed; 1 were there (--again measures what failed anew)\n");
}

TEST_F(DesignSweep, TwoAtOnceAndAKillAreSafe) {
    edited("long.toml", "core.lanes = [4, 8]", "core.lanes = [1, 2, 4, 8]");
    // One is killed at its work, and two go on together.
    const std::string program = quoted_argument(RAZOR_SIMULATOR) + " sweep long.toml run -o s --jobs 2";
    const Outcome killed =
        run("bash -c " + quoted_argument(program + " & pid=$!; while [ ! -e s/claims ]; do sleep "
                                                   "0.01; done; sleep 0.3; kill -9 $pid"),
            folder_.path());
    const Outcome both = run("bash -c " + quoted_argument(program + " > a & pid=$!; " + program +
                                                          " > b; rc=$?; wait $pid && exit $rc"),
                             folder_.path());
    EXPECT_EQ(both.code, 0) << both.err;
    int measured = 0, kept = 0;
    for (const char* name : {"a", "b"}) {
        int now = 0, failed = 0, there = 0;
        ASSERT_EQ(std::sscanf(text(name).c_str(), "%d measured, %d of them failed; %d were there", &now,
                              &failed, &there),
                  3)
            << text(name);
        EXPECT_EQ(failed, 0);
        EXPECT_EQ(now + there, 8);
        measured += now;
        kept += there;
    }
    EXPECT_GE(kept, 8); // none was measured by both
    EXPECT_LE(measured, 8);
    EXPECT_EQ(results("s").size(), 8U);
    ASSERT_EQ(sweep("long.toml run -o t").code, 0);
    EXPECT_EQ(results("t"), results("s"));
    for (const auto& entry : fs::recursive_directory_iterator(folder_ / "s"))
        EXPECT_TRUE(entry.is_directory() || entry.path().extension() == ".toml" ||
                    entry.path().extension() == ".json")
            << entry.path();
}

// Settings that the study does not make are as the machine's file, or what the point chooses of it, has them.
TEST_F(DesignSweep, ConstraintsKnowTheMachine) {
    const auto points = [&](const std::string& where) {
        folder_.file("where.toml", "kind = \"sweep\"\nwhere = [" + where +
                                       "]\n[settings]\nmachine = \"tiny.toml\"\n[knobs]\n"
                                       "memory.preset = [\"ddr3-1600k\", \"hbm2\"]\ncore.lanes = [4, 8]\n");
        const Outcome plan = sweep("where.toml plan -o w");
        EXPECT_EQ(plan.code, 0) << plan.err;
        return plan.out;
    };
    const std::string all = points("\"core.lanes >= 1\"");
    EXPECT_EQ(lines(all), 4U);
    EXPECT_EQ(points("\"chip.threads == 2 and chip.cores * chip.threads == 8\""), all) << "tiny's";
    const std::string wide = points("\"core.lanes * chip.threads > 8\"");
    EXPECT_EQ(lines(wide), 2U);
    EXPECT_EQ(wide.find("lanes 4"), std::string::npos);
    const std::string both = points("\"memory.row_bytes == 8 KiB\", \"core.lanes == 4\"");
    EXPECT_EQ(lines(both), 1U) << "the preset's";
    EXPECT_NE(both.find("ddr3"), std::string::npos);
}

TEST_F(DesignSweep, RefusesMistakesWithOneLine) {
    const std::string knobs = "[settings]\nmachine = \"tiny.toml\"\n[knobs]\ncore.lanes = [4, 8]\n";
    const auto where = [&](const std::string& text) {
        return "kind = \"sweep\"\nwhere = [\"" + text + "\"]\n" + knobs;
    };
    const std::string begin = "kind = \"sweep\"\n[settings]\nmachine = \"tiny.toml\"\n[knobs]\n";
    const std::pair<std::string, const char*> files[] = {
        {begin + "l2.size = [1]\n", "bad.toml:5:12: unknown setting l2.size; did you mean l2.size_bytes?"},
        {where("core.threads <= 4"),
         "bad.toml:2:9: unknown setting core.threads; did you mean chip.threads?"},
        {where("core.gather <= 4"), "bad.toml:2:9: core.gather is no number"},
        {where("workers <= 4"), "bad.toml:2:9: the study does not say workers"},
        {where("core.lanes < 2 < 4"), "bad.toml:2:9: \"core.lanes < 2 < 4\", character 16: a second"},
        {where("core.lanes > 8"), "all points are left out; mend where or [[exclude]]"},
        {begin + "l2.size_bytes = [\"4 KB\"]\n", "bad.toml:5:18: l2.size_bytes is \"4 KB\""},
        {begin + "workers = [0]\n", "bad.toml:5:12: workers = 0 is not possible"},
        {begin + "tiles = [\"3..1\"]\n", "bad.toml:5:10: "},
        {begin + "memory = [\"many\"]\n", "bad.toml:5:11: "},
        {begin + "share = [\"chip\"]\n", "bad.toml:5:10: share is kdtree.share"},
        {begin + "sim.jitter = [1]\n", "write seeds = N"},
        {begin + "core.lanes = [4, 8]\n[[exclude]]\ncore.lane = 4\n",
         "bad.toml:7:13: unknown setting core.lane;"},
        {begin + "core.lanes = [4, 8]\n[[exclude]]\ncore.lanes = { below = 4 }\n",
         "bad.toml:7:14: core.lanes has other bounds"},
        {begin + "core.lanes = [4, 8]\n[[exclude]]\ncore.lanes = { most = 8 }\n", "all points are left out"},
        {begin + "core.lanes = [4, 8]\n[[curve]]\nx = \"core.threads\"\ny = \"cycles\"\n",
         "bad.toml:7:5: in core.threads no points differ; they do in core.lanes"},
        {begin + "kdtree.share = [\"chip\", \"core\"]\n[[curve]]\nx = \"kdtree.share\"\ny = \"cycles\"\n",
         "bad.toml:7:5: kdtree.share = \"chip\" is no number"},
        {"rank = [\"cycle\"]\n" + begin + "core.lanes = [4]\n",
         "bad.toml:1:8: there is no figure cycle; there are"},
        {begin + "spp = [1]\n", "bad.toml:5:8: spp is samples among the settings of studies"},
        {begin + "zzzzzzz = [1]\n", "unknown setting zzzzzzz; there are machine, workers"},
        {begin + "size = [\"16x8\", \"0x0\"]\n", "bad.toml:5:17: the width of size '0' is not possible"},
        {begin + "scene = [\"box.toml\", \"none.toml\"]\n",
         "bad.toml:5:22: scene = \"none.toml\": there is no file none.toml"},
        {begin + "l1.ways = [3]\n", "which l1.ways (3) of 64-byte lines do not divide"},
        {begin + "l1.ways = [3]\n", "the first: bad.toml:5:12: "},
        {begin + "l1.ways = [3]\n", "l1.ways from bad.toml:5:12"},
        {begin + "core.lanes = [4]\n[reference]\nsim.mode = \"reference\"\n", "leave out [reference]"},
        {"kind = \"machine\"\n[knobs]\ncore.lanes = [4]\n", "razor-sim sweep: sweep"},
    };
    for (const auto& [content, says] : files) {
        SCOPED_TRACE(content);
        folder_.file("bad.toml", content);
        const std::size_t before = folder_.count();
        const Outcome result = sweep("bad.toml -o s");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before);
    }
    const std::pair<const char*, const char*> options[] = {
        {"sweep.toml walk", "walk is no step of a sweep"},
        {"sweep.toml --jobs 0", "--jobs '0'"},
        {"sweep.toml --part 3/2", "--part"},
        {"sweep.toml --point 0123", "write run"},
        {"sweep.toml run --point 0 --part 1/2", "give one"},
        {"sweep.toml run -o u --point 0123", "no point 0123"},
        {"sweep.toml --full", "sweep.toml: has no [full]"},
        {"none.toml", "none.toml"},
    };
    for (const auto& [arguments, says] : options) {
        const Outcome result = sweep(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
    }
}

// What changes while it is measured is no result of what was planned; nor is anything kept of it.
TEST_F(DesignSweep, KeepsNothingOfFilesThatChange) {
    const std::pair<const char*, const char*> edits[] = {{"tiny.toml", "[core]\nlanes = 16\n"},
                                                         {"box.toml", "[[mesh]]\nshape = \"sphere\"\n"}};
    for (const auto& [file, change] : edits) {
        SCOPED_TRACE(file);
        const std::string before = text(file);
        ASSERT_EQ(sweep("sweep.toml plan -o s").code, 0);
        std::thread editor([&, name = std::string(file), text = std::string(change)] {
            while (!fs::exists(folder_ / "s/claims"))
                std::this_thread::sleep_for(1ms);
            folder_.file(name, text);
        });
        const Outcome result = sweep("sweep.toml run -o s --jobs 1");
        editor.join();
        EXPECT_EQ(result.code, 2) << result.out;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(std::string(file) + ": was changed while the study ran"), std::string::npos)
            << result.err;
        folder_.file(file, before);
        fs::remove_all(folder_ / "s/claims");
        // What is there is right, and the rest is measured now.
        ASSERT_EQ(sweep("sweep.toml run -o s").code, 0);
        ASSERT_EQ(sweep("sweep.toml run -o t").code, 0);
        EXPECT_EQ(results("s"), results("t"));
        fs::remove_all(folder_ / "s");
    }
}

TEST_F(DesignSweep, CollectsNothingWhereNothingIs) {
    const Outcome result = sweep("sweep.toml collect -o nothere");
    EXPECT_EQ(result.code, 2);
    EXPECT_EQ(result.err, "razor-sim: nothere: nothing measured there; run the step run first, or mend -o\n");
    EXPECT_FALSE(fs::exists(folder_ / "nothere"));
}

// As they are shipped: their designs are possible.
TEST_F(DesignSweep, ShippedSweepsArePossible) {
    int sweeps = 0;
    for (const auto& entry : fs::directory_iterator(RAZOR_SOURCE_DIR "/configs/studies")) {
        std::ifstream in(entry.path());
        const std::string content{std::istreambuf_iterator<char>(in), {}};
        if (content.find("kind = \"sweep\"") == std::string::npos)
            continue;
        ++sweeps;
        for (const char* size : {"", " --full"}) {
            const Outcome plan = sweep(quoted_argument(entry.path().string()) + " plan -o s" + size);
            EXPECT_EQ(plan.code, 0) << plan.err;
            EXPECT_EQ(plan.out.find("impossible"), std::string::npos) << plan.out;
            EXPECT_GE(lines(plan.out), 8U);
        }
    }
    EXPECT_GE(sweeps, 3);
}

} // namespace
} // namespace razor
