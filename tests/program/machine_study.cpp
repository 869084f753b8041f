// razor-sim study: machines beside a reference; what goes on where it was stopped, and mistakes.
#include "tests/program/simulator.h"

#include <cmath>
#include <filesystem>
#include <map>

namespace razor {
namespace {

class MachineStudy : public Simulator {
protected:
    MachineStudy() {
        folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
        std::filesystem::copy_file(RAZOR_SOURCE_DIR "/configs/machines/tiny.toml", folder_ / "tiny.toml");
        folder_.file("study.toml", R"(
kind = "machine"
[settings]
machine = "tiny.toml"
scene = "box.toml"
size = "16x16"
samples = 1
workers = 2
[knobs]
sim.quantum = [1, 1000]
l2.size_bytes = [8192, 16384]
[reference]
seeds = 1
sim.mode = "reference"
sim.quantum = 0
[[plot]]
x = "host_seconds"
y = "cycles_error"
)");
    }
    nlohmann::json points(const char* folder) const {
        return nlohmann::json::parse(text(std::string(folder) + "/study.json"))["points"];
    }
};

TEST_F(MachineStudy, ComparesWithRunsOfTheReference) {
    const Outcome outcome = simulator("study study.toml -o s");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out.find("4 points: 4 measured, 0 failed"), std::string::npos) << outcome.out;
    const nlohmann::json all = points("s");
    // The figures are those of the runs.
    const std::string run =
        "run --quiet --no-native --machine tiny.toml --scene box.toml --size 16x16 --spp 1 --workers 2 "
        "-g l2.size_bytes=16384 ";
    ASSERT_EQ(simulator(run + "-g sim.quantum=1000 --json a.json").code, 0);
    ASSERT_EQ(simulator(run + "-g sim.mode=reference -g sim.quantum=0 --json b.json").code, 0);
    const nlohmann::json a = report("a.json"), b = report("b.json");
    const nlohmann::json& last = all.at(3);
    ASSERT_EQ(last["settings"]["sim.quantum"], 1000);
    ASSERT_EQ(last["settings"]["l2.size_bytes"], 16384);
    const auto figure = [&](const char* name) { return last["figures"][name]["median"].get<double>(); };
    const double cycles = a["cycles"], truth = b["cycles"];
    ASSERT_NE(cycles, truth);
    EXPECT_EQ(figure("cycles"), cycles);
    EXPECT_NEAR(figure("cycles_error"), std::abs(cycles / truth - 1), 1e-12);
    EXPECT_NEAR(figure("cycles_deviation"), cycles / truth - 1, 1e-12);
    const auto bytes = [](const nlohmann::json& r) {
        return 64 * (r["memory"]["reads"].get<double>() + r["memory"]["writes"].get<double>());
    };
    EXPECT_EQ(figure("dram_bytes"), bytes(a));
    EXPECT_NEAR(figure("dram_bytes_error"), std::abs(bytes(a) / bytes(b) - 1), 1e-12);
    const auto rate = [](const nlohmann::json& r) {
        return r["l1"]["misses"].get<double>() /
               (r["l1"]["reads"].get<double>() + r["l1"]["writes"].get<double>());
    };
    EXPECT_NEAR(figure("l1_miss_rate"), rate(a), 1e-15);
    EXPECT_NEAR(figure("l1_miss_rate_error"), std::abs(rate(a) - rate(b)), 1e-15);
    EXPECT_GT(figure("instructions_per_second"), 1000);
    EXPECT_GT(figure("host_seconds"), 0);
    // Kept, and the same again elsewhere.
    const auto results = [&](const char* folder) {
        std::map<std::string, std::string> out;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / folder / "results")) {
            const std::string whole =
                text(std::string(folder) + "/results/" + entry.path().filename().string());
            out[entry.path().filename().string()] = whole.substr(0, whole.find("\"host\""));
        }
        return out;
    };
    EXPECT_EQ(results("s").size(), 6U); // with two references
    ASSERT_EQ(simulator("study study.toml -o t").code, 0);
    EXPECT_EQ(results("t"), results("s"));
}

// A sampled run is a point as any other; all in detail, it is the detailed run.
TEST_F(MachineStudy, TakesSampledRuns) {
    std::string content = text("study.toml");
    content.replace(content.find("sim.quantum = [1, 1000]"), 23,
                    "estimate = [\"none\", \"sample:0.2\", \"sample:1\"]");
    content.replace(content.find("l2.size_bytes = [8192, 16384]\n"), 30, "");
    content.replace(content.find("sim.quantum = 0"), 15, "estimate = \"none\"");
    folder_.file("estimates.toml", content);
    const Outcome outcome = simulator("study estimates.toml -o s --quiet");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json all = points("s");
    ASSERT_EQ(all.size(), 3U);
    const auto figure = [&](std::size_t point, const char* name) {
        return all.at(point)["figures"][name]["median"].get<double>();
    };
    EXPECT_EQ(figure(0, "cycles"), figure(2, "cycles"));
    EXPECT_NE(figure(0, "cycles"), figure(1, "cycles"));
    EXPECT_NEAR(figure(1, "cycles"), figure(0, "cycles"), 0.3 * figure(0, "cycles"));
    EXPECT_NEAR(figure(1, "dram_bytes"), figure(0, "dram_bytes"), 0.1 * figure(0, "dram_bytes"));
}

// Points in closed form share the seed of their tile, which is kept and whose cost is told apart; what a seed
// cannot know has another one.
TEST_F(MachineStudy, ComputesPointsFromKeptSeeds) {
    const auto study = [&](const std::string& knobs) {
        std::string content = text("study.toml");
        const std::size_t begin = content.find("[knobs]"), end = content.find("[reference]");
        content.replace(begin, end - begin, "[knobs]\n" + knobs);
        content.replace(content.find("workers = 2\n"), 12, "");
        const std::string mode = "sim.mode = \"reference\"\n";
        content.replace(content.find(mode), mode.size(), "");
        content.replace(content.find("sim.quantum = 0"), 15, "estimate = \"none\"");
        folder_.file("computed.toml", content);
    };
    const auto seeds = [&] {
        std::map<std::string, std::string> out;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "s" / "seeds"))
            out[entry.path().filename().string()] = text("s/seeds/" + entry.path().filename().string());
        return out;
    };
    study("estimate = [\"closed-form\", \"none\"]\nchip.tiles = [1, 2]\n");
    const Outcome outcome = simulator("study computed.toml -o s");
    ASSERT_EQ(outcome.code, 0) << outcome.err << outcome.out;
    EXPECT_NE(outcome.out.find("4 points: 4 measured, 0 failed"), std::string::npos) << outcome.out;
    const auto kept = seeds();
    ASSERT_EQ(kept.size(), 1U);
    const nlohmann::json all = points("s");
    const auto figure = [&](std::size_t point, const char* name) {
        return all.at(point)["figures"][name]["median"].get<double>();
    };
    // What razor-sim run computes from that seed, which took what its file says.
    const std::string run =
        "run --quiet --machine tiny.toml --scene box.toml --size 16x16 --spp 1 -g chip.tiles=2 "
        "--estimate closed-form --seed-report s/seeds/" +
        kept.begin()->first + " --json a.json";
    ASSERT_EQ(simulator(run).code, 0);
    for (std::size_t i = 0; i < 2; ++i) {
        ASSERT_EQ(all.at(i)["settings"]["estimate"], "closed-form");
        EXPECT_EQ(figure(i, "seed_processor_seconds"),
                  nlohmann::json::parse(kept.begin()->second)["host"]["processor_seconds"]);
        EXPECT_NEAR(figure(i, "cycles_error"), std::abs(figure(i, "cycles") / figure(i + 2, "cycles") - 1),
                    1e-12);
        EXPECT_GT(figure(i, "cycles_error"), 0);
        EXPECT_FALSE(all.at(i + 2)["figures"].contains("seed_processor_seconds"));
    }
    ASSERT_EQ(all.at(1)["settings"]["chip.tiles"], 2);
    EXPECT_EQ(figure(1, "cycles"), report("a.json")["cycles"]);
    // Further points take the seed that is there, unless it cannot know what they differ in.
    study("estimate = [\"closed-form\"]\nchip.tiles = [1, 3]\nmemory.channels = [1, 2]\n");
    ASSERT_EQ(simulator("study computed.toml -o s --quiet").code, 0);
    EXPECT_TRUE(seeds() == kept);
    study("estimate = [\"closed-form\"]\nl2.size_bytes = [8192, 16384]\n");
    ASSERT_EQ(simulator("study computed.toml -o s --quiet").code, 0);
    EXPECT_EQ(seeds().size(), 3U);
    for (const nlohmann::json& point : points("s"))
        EXPECT_EQ(point["state"], "measured") << point;
}

// A point may leave it to the run how it is simulated: told are what it chose and the time of all it tried.
TEST_F(MachineStudy, LetsRunsChooseTheirFidelity) {
    std::string content = text("study.toml");
    const std::size_t begin = content.find("[knobs]"), end = content.find("[reference]");
    content.replace(begin, end - begin,
                    "[[points]]\nfidelity_error = [0.0, 1.0]\nestimate = \"closed-form\"\n"
                    "[[points]]\nsim.quantum = 1\n"
                    "[[points]]\nfidelity_error = 0.1\nestimate = \"sample:0.1\"\n");
    content.replace(content.find("workers = 2\n"), 12, "");
    content.replace(content.find("sim.quantum = 0"), 15,
                    "sim.quantum = 0\nmemory.controller = \"queued\"\nestimate = \"none\"");
    folder_.file("chosen.toml", content);
    const Outcome outcome = simulator("study chosen.toml -o s");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const nlohmann::json all = points("s");
    ASSERT_EQ(all.size(), 4U);
    const auto figure = [&](std::size_t point, const char* name) {
        return all.at(point)["figures"][name]["median"].get<double>();
    };
    EXPECT_EQ(all.at(0)["words"]["fidelity"], "reference mode");
    EXPECT_EQ(figure(0, "cycles_error"), 0);
    EXPECT_FALSE(all.at(0)["figures"].contains("seed_processor_seconds"));
    EXPECT_EQ(all.at(1)["words"]["fidelity"], "closed form");
    EXPECT_GT(figure(1, "cycles_error"), 0);
    EXPECT_GT(figure(1, "seed_processor_seconds"), figure(1, "host_processor_seconds"));
    EXPECT_EQ(all.at(2)["words"]["fidelity"], "-");
    EXPECT_NE(all.at(3)["failed"].get<std::string>().find("leave out estimate"), std::string::npos);
    // What no point has is no column.
    EXPECT_NE(text("s/study.csv").find(",fidelity,"), std::string::npos);
    ASSERT_EQ(simulator("study study.toml -o plain --quiet").code, 0);
    EXPECT_EQ(text("plain/study.csv").find("fidelity"), std::string::npos);
}

TEST_F(MachineStudy, SaysWhyAFrontIsEmpty) {
    std::string content = text("study.toml");
    folder_.file("plain.toml", content.substr(0, content.find("[reference]")));
    const Outcome plan = simulator("study plain.toml -o s --plan");
    EXPECT_EQ(plan.code, 0) << plan.err;
    EXPECT_FALSE(std::filesystem::exists(folder_ / "s"));
    const Outcome all = simulator("study plain.toml -o s");
    EXPECT_NE(all.out.find("(no point has cycles_error)"), std::string::npos) << all.out;
}

TEST_F(MachineStudy, SaysWhatIsImpossible) {
    std::string content = text("study.toml");
    content.replace(content.find("[8192, 16384]"), 13, "[8192, 500]");
    folder_.file("odd.toml", content);
    const Outcome odd = simulator("study odd.toml -o s --quiet");
    EXPECT_EQ(odd.code, 0) << odd.err;
    const nlohmann::json all = points("s");
    EXPECT_EQ(all.at(0)["state"], "measured");
    EXPECT_EQ(all.at(1)["state"], "failed");
    EXPECT_NE(all.at(1)["failed"].get<std::string>().find("l2"), std::string::npos) << all.at(1);
    const std::pair<const char*, const char*> cases[] = {
        {"kind = \"machine\"\n[knobs]\nl2.size = [1]\n",
         "bad.toml:3:12: unknown setting l2.size; did you mean l2.size_bytes?"},
        {"kind = \"machine\"\n[knobs]\nsim.quantum = [-1]\n", "bad.toml:3:16: "},
        {"kind = \"machine\"\n[knobs]\nworker = [1]\n", "unknown setting worker; did you mean workers?"},
        {"kind = \"machine\"\n[knobs]\nestimate = [\"half\"]\n", "sample:FRACTION"},
        {"kind = \"machine\"\n[settings]\nmachine = \"tiny.toml\"\n[knobs]\nworkers = [1]\n[[plot]]\nx = "
         "\"cycles\"\ny = \"cycles_error\"\n",
         "bad.toml:8:5: cycles_error is measured beside a reference"},
        {"kind = \"machine\"\n[settings]\nmachine = \"tiny.toml\"\n[knobs]\nworkers = [1]\n"
         "[reference]\nl1.ways = 3\n",
         "the first: bad.toml:7:11: its reference, by [reference]: "},
        {"kind = \"machine\"\n[settings]\nmachine = \"tiny.toml\"\nestimate = \"sample:0.1\"\n[knobs]\n"
         "fidelity_error = [0.1]\n",
         "the first: bad.toml:6:19: fidelity_error chooses samples itself"},
        {"kind = \"image\"\n[knobs]\nsamples = [1]\n", "use the program that measures others"},
    };
    for (const auto& [bad, says] : cases) {
        SCOPED_TRACE(bad);
        folder_.file("bad.toml", bad);
        const Outcome result = simulator("study bad.toml -o b");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "b"));
    }
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/studies")) {
        std::ifstream in(entry.path());
        const std::string shipped{std::istreambuf_iterator<char>(in), {}};
        for (const char* size : {"", " --full"})
            if (shipped.find("kind = \"machine\"") != std::string::npos) {
                const Outcome plan =
                    simulator("study " + quoted_argument(entry.path().string()) + " --plan -o p" + size);
                EXPECT_EQ(plan.code, 0) << plan.err;
                EXPECT_EQ(plan.out.find("impossible"), std::string::npos) << plan.out;
            }
    }
}

} // namespace
} // namespace razor
