// The whole simulator beside a host, and its machines' characteristics beside published ones: what the
// programs make of times and counts, with a renderer and a simulator whose figures are formulas.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <tuple>

namespace razor {
namespace {

// A frame of side n takes n ms, a model's 10 ms more; the first frame of a run ten times as long, later ones
// lie about their median, and runs take turns of 1, 1.1 and 0.9 times as long. Two workers take 0.6 times as
// long, and their processors the whole of it.
constexpr const char* renderer = R"(#!/usr/bin/python3
import json, sys
words = sys.argv[1:]
def option(name, default=None):
    return words[words.index(name) + 1] if name in words else default
side, workers = int(option("--size").split("x")[0]), int(option("--threads"))
scene = words[1] if not words[1].startswith("-") else ""
try:
    turns = json.load(open("turns.json"))
except FileNotFoundError:
    turns = {}
key = " ".join(w for w in words if "/" not in w)
turns[key] = turns.get(key, -1) + 1
json.dump(turns, open("turns.json", "w"))
processor = (side + 10 * bool(scene)) / 1000 * [1, 1.1, 0.9][turns[key] % 3]
wall = processor * (0.6 if workers > 1 else 7)
parts = [10] + [1.02, 1, 0.8][:int(option("--repeat")) - 1]
json.dump({"scene": f"{scene} {side}",
           "statistics": {"target": {"isa": option("--isa")}, "counters": {"rays": side * side, "camera_hits": side},
                          "host": {"frames": [{"render_processor_seconds": processor * p, "render_seconds": wall * p}
                                              for p in parts]}}}, open(option("--stats"), "w"))
)";

// Takes three times as long, with noise 3 + 0.3 seeds; 9 times with --size 50x50. The machine "odd" renders
// something else: by its settings another picture, another scene, or other rays. "slow" takes twice as long
// again.
constexpr const char* simulator = R"(#!/usr/bin/python3
import json, sys
words = sys.argv[1:]
def option(name, default=None):
    return words[words.index(name) + 1] if name in words else default
machine = option("--machine")
settings = dict(w.split("=", 1) for before, w in zip(words, words[1:]) if before == "-g")
if not machine.endswith(".toml"):
    sys.exit("razor-sim: no such machine")
if words[0] == "print-config":
    print('calibration = "sse4.json"' if "sse" in machine else "")
    print("[chip]\ntiles = 2\ncores = 1\nthreads = 3 # assumed\n[other]\nthreads = 7")
    sys.exit()
side, scene = int(option("--size").split("x")[0]), option("--scene", "")
if "whole" in machine:
    assert option("--frames") == "2" and option("--share") == "chip"
seconds = (side + 10 * bool(scene)) / 1000 * (9 if side == 50 else 3 + 0.3 * int(settings.get("sim.jitter", 0)))
seconds *= (2 if "slow" in machine else 1) * (0.6 if option("--workers") == "2" else 1)
lanes, window = int(settings.get("core.lanes", 4)), int(settings.get("core.window", 96))
workers = int(option("--workers"))
niagara = "niagara" in machine
cycles = int((1000 + 4000 / lanes + 960 / window) * (2 if scene else 1) * (10 if niagara else 1))
instructions = 2010
report = {"scene": "?" if "scene" in settings.get("odd", "") else f"{scene} {side}", "seconds": seconds, "cycles": cycles,
          "renderer": {"counters": {"rays": side * side + (settings.get("odd") == "rays"), "camera_hits": side}},
          "core": {"instructions": instructions, "forwarded_loads": 50}, "host": {},
          "traffic": [{"l1_reads": 200, "l1_writes": 50}, {"l1_reads": 50, "l1_writes": 100}],
          "instructions_by_class": {"branch": {"scalar": 60, "vector": 0},
                                    "add": {"scalar": 1000, "vector": instructions - 1060}},
          # Two cores of three threads, the second one done in half of the time.
          "threads": [{"tile": w % 2, "core": 0, "instructions": (w < workers) * instructions,
                       "finish": (w < workers) * cycles // (1 + w % 2)} for w in range(6)]}
if "--no-native" not in words:
    report["host"]["native"] = {"isa": "sse4" if "sse" in machine else "avx512",
                                "picture_equal": settings.get("odd") != "picture" and "sse" not in machine}
json.dump(report, open(option("--json"), "w"))
)";

constexpr const char* points = R"([[point]]
name = "ten"
options = ["--size", "10x10"]
[[point]]
name = "twenty"
options = ["--size", "20x20"]
[[point]]
name = "model"
model = "sub/m.obj"
options = ["--size", "20x20"]
[[point]]
name = "fifty"
options = ["--size", "50x50"]
[[point]]
name = "pair"
options = ["--size", "90x90"]
workers = 2
[[point]]
name = "crowded"
workers = 3
options = ["--size", "9x9"]
)";

class Whole : public ::testing::Test {
protected:
    Whole() {
        for (const auto& [name, text] : {std::pair("razor.py", renderer), std::pair("sim.py", simulator)})
            std::filesystem::permissions(folder_.file(name, text), std::filesystem::perms::owner_all);
        folder_.file("points.toml", points);
        folder_.file("sse4.json", R"({"target": "sse4"})");
        std::filesystem::create_directories(folder_ / "models/sub");
        folder_.file("models/sub/m.obj", "");
        // The host has two processors, whatever it has.
        folder_.file("two.py", "import os, runpy, sys\n"
                               "os.sched_getaffinity = lambda _: {0, 1}\n"
                               "sys.dont_write_bytecode = True\n"
                               "sys.argv = sys.argv[1:]\n"
                               "sys.path[0] = os.path.dirname(sys.argv[0])\n"
                               "runpy.run_path(sys.argv[0], run_name='__main__')\n");
    }
    Outcome script(const std::string& name, const std::string& arguments) const {
        std::filesystem::remove(folder_ / "turns.json");
        return run("python3 two.py " + quoted_argument(RAZOR_SOURCE_DIR "/analysis/whole/" + name) +
                       " --simulator ./sim.py " + arguments,
                   folder_.path());
    }
    Outcome whole(const std::string& arguments) const {
        return script("whole.py",
                      "--razor ./razor.py --points points.toml --scenes models --frames 3 " + arguments);
    }
    nlohmann::json read(const std::string& name) const {
        std::ifstream file(folder_ / name);
        return nlohmann::json::parse(file);
    }
    TemporaryFolder folder_;
};

TEST_F(Whole, PointsRatiosAndOrder) {
    const Outcome result = whole("--machine whole.toml --repeat 3 --seeds 3 --json w.json");
    ASSERT_EQ(result.code, 0) << result.err;
    EXPECT_EQ(result.err, "skipped: crowded: 3 workers on 2 processors\n");
    const nlohmann::json all = read("w.json"), machine = all.at("machines").at(0);
    EXPECT_EQ(all.at("isa"), "auto");
    ASSERT_EQ(machine.at("points").size(), 5U);
    // Milliseconds: medians of frames after the first, of turns; processors' of one worker, else the wall's.
    const double native[] = {10, 20, 30, 50, 54}, factor[] = {3.3, 3.3, 3.3, 9, 3.3};
    double product = 1;
    for (std::size_t i = 0; i < 5; ++i) {
        const auto& p = machine.at("points").at(i);
        const double ms = native[i] / 1000;
        EXPECT_NEAR(p.at("native_seconds").at("median").get<double>(), ms, 1e-12) << i;
        EXPECT_NEAR(p.at("native_seconds").at("least").get<double>(), 0.9 * ms, 1e-12) << i;
        EXPECT_NEAR(p.at("native_seconds").at("largest").get<double>(), 1.1 * ms, 1e-12) << i;
        EXPECT_NEAR(p.at("simulated_seconds").at("median").get<double>(), factor[i] * ms, 1e-12) << i;
        EXPECT_NEAR(p.at("simulated_seconds").at("least").get<double>(), (i == 3 ? 9 : 3) * ms, 1e-12) << i;
        EXPECT_NEAR(p.at("ratio").get<double>(), factor[i], 1e-9) << i;
        product *= factor[i];
    }
    const double common = std::pow(product, 0.2);
    EXPECT_NEAR(machine.at("common_factor").get<double>(), common, 1e-9);
    EXPECT_NEAR(machine.at("before").at("largest").get<double>(), 8, 1e-9);
    EXPECT_NEAR(machine.at("before").at("mean").get<double>(), (4 * 2.3 + 8) / 5, 1e-9);
    EXPECT_NEAR(machine.at("after").at("largest").get<double>(), 9 / common - 1, 1e-9);
    EXPECT_NEAR(machine.at("after").at("mean").get<double>(), (4 * (common / 3.3 - 1) + 9 / common - 1) / 5,
                1e-9);
    // Of the five, 50 and 54 ms are simulated in the other order: one pair of ten, two ranks that are one
    // off.
    const auto& order = machine.at("order").at("seconds");
    EXPECT_NEAR(order.at("kendall").at("value").get<double>(), 0.8, 1e-12);
    EXPECT_NEAR(order.at("spearman").at("value").get<double>(), 0.9, 1e-12);
    EXPECT_LT(order.at("spearman").at("interval").at(0).get<double>(), 0.9);
    // Microseconds a ray: 100, 50, 75, 20 and 6.7 natively; fifty's 180 simulated lie above twenty's 165.
    const auto& by_ray = machine.at("order").at("seconds a ray");
    EXPECT_NEAR(by_ray.at("kendall").at("value").get<double>(), 0.8, 1e-12);
    // 50 and 54 lie within native spreads: no disagreement that means anything.
    EXPECT_EQ(machine.at("pairs"), 10);
    EXPECT_EQ(machine.at("disagreements").size(), 0U);
    EXPECT_NE(
        result.out.find("| fifty | 1 | 50.00 [45.00 .. 55.00] | 450.00 [450.00 .. 450.00] | 9.00 | 2.23 |"),
        std::string::npos)
        << result.out;
    EXPECT_NE(result.out.find("Kendall's tau-b of seconds: 0.800 ["), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("ratios from 1: 344.0% off on average, 800.0% at most"), std::string::npos)
        << result.out;
    EXPECT_EQ(std::filesystem::exists(folder_ / "w.json.tmp"), false);
}

TEST_F(Whole, DisagreementsBeyondSpreads) {
    // One turn has no spread: the pair whose order differs is named.
    const Outcome result = whole("--machine whole.toml --repeat 1 --json w.json");
    ASSERT_EQ(result.code, 0) << result.err;
    const nlohmann::json pairs = read("w.json").at("machines").at(0).at("disagreements");
    EXPECT_EQ(pairs, nlohmann::json::parse(R"([["fifty", "pair"]])"));
    EXPECT_NE(result.out.find("1 of 10 pairs\n  fifty | pair\n"), std::string::npos) << result.out;
}

TEST_F(Whole, SeveralMachinesBesideTheSameNativeFrames) {
    const Outcome result = whole("--machine whole.toml slow.toml --repeat 2 --only ten twenty --json w.json");
    ASSERT_EQ(result.code, 0) << result.err;
    const nlohmann::json machines = read("w.json").at("machines");
    EXPECT_NEAR(machines.at(0).at("common_factor").get<double>() * 2,
                machines.at(1).at("common_factor").get<double>(), 1e-9);
    EXPECT_EQ(machines.at(0).at("points").at(0).at("native_seconds"),
              machines.at(1).at("points").at(0).at("native_seconds"));
    EXPECT_EQ(read("turns.json").begin().value(), 1); // two turns, not four
}

TEST_F(Whole, TargetOfTheMachine) {
    const Outcome result = whole("--machine sse.toml --repeat 1 --only ten twenty --json w.json");
    ASSERT_EQ(result.code, 0) << result.err; // its picture may differ in last bits
    EXPECT_EQ(read("w.json").at("isa"), "sse4");
    const Outcome given =
        whole("--machine sse.toml whole.toml --isa plain --repeat 1 --only ten twenty --json w.json");
    ASSERT_EQ(given.code, 0) << given.err;
    EXPECT_EQ(read("w.json").at("isa"), "plain");
}

TEST_F(Whole, RefusesMistakes) {
    folder_.file("same.toml", "[[point]]\nname = \"a\"\n[[point]]\nname = \"a\"\n");
    folder_.file("key.toml", "[[point]]\nname = \"a\"\nmodels = \"m\"\n");
    folder_.file("kind.toml", "[[point]]\nname = \"a\"\nworkers = true\n");
    folder_.file("none.toml", "[[point]]\nname = \"a\"\nworkers = 0\n");
    folder_.file("words.toml", "[[point]]\nname = \"a\"\noptions = [1]\n");
    folder_.file("both.toml", "[[point]]\nname = \"a\"\nmodel = \"m\"\nscene = \"s\"\n");
    folder_.file("list.toml", "point = 3\n");
    folder_.file("broken.toml", "[[point\n");
    const std::string good = "--machine whole.toml --repeat 1 ";
    const std::pair<std::string, const char*> cases[] = {
        {good + "--points same.toml", "point 2: give it a name"},
        {good + "--points key.toml", "models: no such key"},
        {good + "--points kind.toml", "workers: give a whole number"},
        {good + "--points none.toml", "workers: give a number from 1"},
        {good + "--points words.toml", "options: give words in quotes"},
        {good + "--points both.toml", "not both"},
        {good + "--points list.toml", "no list of tables"},
        {good + "--points broken.toml", "broken.toml: "},
        {good + "--points nothing.toml", "--points nothing.toml: "},
        {good + "--only eleven", "--only eleven: no such point; there are ten, twenty"},
        {good + "--only ten", "fewer than two points"},
        {good + "--scenes nowhere", "--scenes nowhere: no such folder"},
        {good + "--frames 0", "--frames 0"},
        {good + "--seeds 0", "--seeds 0"},
        {good + "--json none/w.json", "none/w.json"},
        {good + "--razor none", "--razor none: no program"},
        {good + "--simulator none", "--simulator none: no program"},
        {good + "--nothing", "--nothing"},
        {"--repeat 0 --machine whole.toml", "--repeat 0"},
        {"--repeat 1", "required: --machine"},
        {"--machine none", "none: razor-sim: no such machine"},
        {"--machine sse.toml whole.toml", "different instruction sets: sse.toml sse4, whole.toml auto"},
        {good + "-g odd=picture", "ten: the simulated picture differs from that of avx512"},
        {good + "-g odd=scene", "ten: the native frame and the simulated one are not of the same scene"},
        {good + "-g odd=rays", "ten: 100 rays natively, 101 simulated"},
    };
    for (const auto& [arguments, says] : cases) {
        SCOPED_TRACE(arguments);
        const Outcome result = whole(arguments);
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.out, "");
        EXPECT_TRUE(result.err.ends_with('\n')) << result.err;
        const std::string last = result.err.substr(result.err.rfind('\n', result.err.size() - 2) + 1);
        EXPECT_TRUE(last.starts_with("whole.py: ")) << result.err;
        EXPECT_NE(last.find(says), std::string::npos) << result.err;
        EXPECT_LE(result.error_lines(), 2) << result.err; // beside the point that is skipped
    }
}

TEST_F(Whole, PointsThatAreShipped) {
    // At least twenty, of which those with models are named where there are none.
    const Outcome result =
        script("whole.py", "--razor ./razor.py --machine whole.toml --repeat 1 --frames 1 --json w.json");
    ASSERT_EQ(result.code, 0) << result.err;
    const std::ptrdiff_t here = std::ptrdiff_t(read("w.json").at("machines").at(0).at("points").size());
    EXPECT_GE(here + result.error_lines(), 20);
    EXPECT_GT(result.error_lines(), 0);
    EXPECT_NE(result.err.find("osd/catmark_car.obj is not there; give --scenes\n"), std::string::npos)
        << result.err;
}

TEST_F(Whole, CharacteristicsBesidePublishedOnes) {
    const std::string machines = "--xeon xeon.toml --niagara niagara.toml --json c.json ";
    const Outcome result = script("characterise.py", machines + "models/sub/m.obj -- --size 30x30");
    ASSERT_EQ(result.code, 0) << result.err;
    const nlohmann::json rows = read("c.json").at("figures");
    // Cycles: 1000 + 4000 / lanes + 960 / window, the same factor for all runs of a scene.
    const std::tuple<const char*, double, const char*> expected[] = {
        {"loads and stores", 450 / 2010.0, "within"},
        {"branches", 60 / 2010.0, "within"},
        {"four lanes against one", 5010 / 2010.0, "below"},
        {"out of order against in order", 2960 / 2010.0, "below"},
        {"out of order against a window of 8", 2120 / 2010.0, "-"},
        {"instructions a cycle, Xeon", 1, "within"},
        {"instructions a cycle, Niagara", 6 * 2010 / (1.5 * 20100), "within"}, // all threads
    };
    ASSERT_EQ(rows.size(), std::size(expected));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        const auto& [what, value, verdict] = expected[i];
        EXPECT_EQ(rows.at(i).at("what"), what);
        const auto& here = rows.at(i).at("scenes").at("built-in scene");
        EXPECT_NEAR(here.at("value").get<double>(), value, 1e-9) << what;
        EXPECT_EQ(here.at("verdict"), verdict) << what;
    }
    EXPECT_NEAR(rows.at(5).at("scenes").at("m").at("value").get<double>(), 0.5, 1e-9); // twice the cycles
    EXPECT_EQ(rows.at(5).at("scenes").at("m").at("verdict"), "below");
    EXPECT_NE(result.out.find("| loads and stores | 20.0% to 27.0% | 22.4% within | 22.4% within |"),
              std::string::npos)
        << result.out;
    for (const char* wrong :
         {"none.obj", "--json none/c.json", "--nothing", "--xeon none", "--niagara none"}) {
        const Outcome refused = script("characterise.py", machines + wrong);
        EXPECT_EQ(refused.code, 2) << wrong;
        EXPECT_EQ(refused.error_lines(), 1) << refused.err;
        EXPECT_TRUE(refused.err.starts_with("characterise.py: ")) << refused.err;
        EXPECT_EQ(refused.out, "") << wrong;
    }
}

} // namespace
} // namespace razor
