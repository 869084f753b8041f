// Programs that run the simulator many times: tables of a key, and conclusions beside what machines assume.
#include "tests/program/simulator.h"

namespace razor {
namespace {

class Sweep : public Simulator {
protected:
    Outcome script(const std::string& name, const std::string& simulator,
                   const std::string& arguments) const {
        return run("python3 " + quoted_argument(RAZOR_SOURCE_DIR "/analysis/sweep/" + name) +
                       " --simulator " + quoted_argument(simulator) + " --machine " + tiny + " " + arguments,
                   folder_.path());
    }
    Outcome sweep(const std::string& arguments) const {
        return script("sweep.py", RAZOR_SIMULATOR, arguments);
    }
    Outcome assumptions(const std::string& arguments) const {
        return script("assumptions.py", RAZOR_SIMULATOR, arguments);
    }
};

TEST_F(Sweep, TablesOneKey) {
    folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
    // One worker: the time does not hang on who gets the last tile of the picture.
    const std::string frame = " -- --scene box.toml --size 24x24 --spp 1 --workers 1";
    const Outcome result = sweep(
        "--key l2.size_bytes --values 4KiB..16KiB 256KiB --expect falling --csv s.csv --jobs 2" + frame);
    EXPECT_EQ(result.code, 0) << result.out << result.err;
    for (const char* word : {"\n4KiB ", "\n8KiB ", "\n16KiB ", "\n256KiB ", "monotone: falls"})
        EXPECT_NE(result.out.find(word), std::string::npos) << result.out;
    const std::string table = text("s.csv");
    EXPECT_EQ(std::count(table.begin(), table.end(), '\n'), 5) << table;
    EXPECT_EQ(table.rfind("l2.size_bytes,cycles,", 0), 0U) << table;
    // The figures are those of the runs.
    ASSERT_EQ(simulator(std::string("run --quiet --machine ") + tiny +
                        " -g l2.size_bytes=8192 --json a.json" + frame.substr(3))
                  .code,
              0);
    EXPECT_NE(table.find("\n8KiB," + report("a.json").at("cycles").dump() + ","), std::string::npos) << table;
    const Outcome wrong = sweep("--key l2.size_bytes --values 4KiB 256KiB --expect rising" + frame);
    EXPECT_EQ(wrong.code, 1);
    EXPECT_NE(wrong.out.find("NOT so"), std::string::npos);
}

TEST_F(Sweep, RefusesMistakes) {
    const std::pair<const char*, const char*> cases[] = {
        {"--key l2.size --values 1", "the nearest known one is l2.size_bytes"},
        {"--key l2.size_bytes --values 500", "do not divide"},
        {"--key l2.size_bytes", "required: --values"},
        {"--key l2.size_bytes --values 4..2", "give A..B"},
        {"--key l2.size_bytes --values 0..2", "give A..B"},
        {"--key l2.size_bytes --values 1MiB --csv none/s.csv", "none/s.csv"},
        {"--key l2.size_bytes --values 1MiB --jobs 0", "--jobs 0"},
        {"--key l2.size_bytes --values 1MiB --seeds 0", "--seeds 0"},
        {"--key l2.size_bytes --values 1MiB --tolerance nan", "--tolerance nan"},
        {"--key l2.size_bytes --values 1MiB --nothing", "--nothing"},
        {"--key l2.size_bytes --values 1MiB --simulator none", "--simulator none"},
    };
    for (const auto& [arguments, says] : cases) {
        SCOPED_TRACE(arguments);
        const std::size_t before = folder_.count();
        const Outcome result = sweep(std::string(arguments) + " -- --size 16x16");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_TRUE(result.err.starts_with("sweep.py: ")) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before);
    }
}

// Beside the reference mode: errors against its cycles, which come first.
TEST_F(Sweep, ComparesWithTheReferenceMode) {
    folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
    const std::string frame = "--scene box.toml --size 24x24 --spp 1 --workers 1";
    const Outcome result = sweep("--reference --key sim.quantum --values 1 1000 --csv s.csv -- " + frame);
    ASSERT_EQ(result.code, 0) << result.out << result.err;
    std::vector<double> cycles, errors;
    std::istringstream table(text("s.csv"));
    std::string line;
    std::getline(table, line);
    const auto column = [&line](const std::string& name) {
        return std::count(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(line.find("," + name)),
                          ',');
    };
    const auto cycles_at = column("cycles"), error_at = column("error");
    const std::string head = line;
    while (std::getline(table, line)) {
        std::vector<std::string> cells;
        std::istringstream row(line);
        for (std::string cell; std::getline(row, cell, ',');)
            cells.push_back(cell);
        cycles.push_back(std::stod(cells.at(static_cast<std::size_t>(cycles_at) + 1)));
        errors.push_back(std::stod(cells.at(static_cast<std::size_t>(error_at) + 1)));
    }
    ASSERT_EQ(cycles.size(), 3U) << head;
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_DOUBLE_EQ(errors[i], cycles[i] / cycles[0] - 1);
    const std::string reference =
        "run --quiet --machine " + tiny + " -g sim.mode=reference --json a.json " + frame;
    ASSERT_EQ(simulator(reference).code, 0);
    EXPECT_EQ(report("a.json").at("cycles").get<double>(), cycles[0]);
}

// Rows of several seeds: means, and half the width of the interval that Student's t gives for two runs.
TEST_F(Sweep, RunsSeveralSeeds) {
    folder_.file("box.toml", "[[mesh]]\nshape = \"box\"\n");
    const std::string frame = "--scene box.toml --size 24x24 --spp 1 --workers 2";
    const Outcome result = sweep("--seeds 2 --key l2.size_bytes --values 8KiB 64KiB --csv s.csv -- " + frame);
    ASSERT_EQ(result.code, 0) << result.out << result.err;
    double cycles[2];
    for (const int seed : {1, 2}) {
        const std::string one = std::string("run --quiet --machine ") + tiny +
                                " -g l2.size_bytes=8KiB -g sim.jitter=" + std::to_string(seed) +
                                " --json a.json " + frame;
        ASSERT_EQ(simulator(one).code, 0);
        cycles[seed - 1] = report("a.json").at("cycles").get<double>();
    }
    ASSERT_NE(cycles[0], cycles[1]);
    std::istringstream table(text("s.csv"));
    std::string head, row, cell;
    std::getline(table, head);
    std::getline(table, row);
    std::istringstream names(head), cells(row);
    int found = 0;
    const double mean = (cycles[0] + cycles[1]) / 2;
    for (std::string name; std::getline(names, name, ',') && std::getline(cells, cell, ',');) {
        if (name == "cycles") {
            EXPECT_DOUBLE_EQ(std::stod(cell), mean);
            ++found;
        }
        if (name.starts_with("chance")) {
            EXPECT_NEAR(std::stod(cell), 12.706 * std::abs(cycles[0] - cycles[1]) / 2 / mean, 1e-9);
            ++found;
        }
    }
    EXPECT_EQ(found, 2) << head;
}

// A machine of which everything is known: cycles are a formula of its settings.
TEST_F(Sweep, ConclusionsBesideAssumptions) {
    const std::filesystem::path program = folder_.file("formula.py", R"(#!/usr/bin/python3
import json, sys
m = {"a": {"x": 4, "y": 8, "z": 1, "w": 6, "text": "on", "x_pj": 2.0, "rate": 0.5}, "sim": {"q": 5}}
design, jitter = None, 0
for word in (w for w, before in zip(sys.argv[1:], sys.argv) if before == "-g"):
    key, value = word.split("=")
    if key == "a.design":
        design = value
        continue
    if key == "sim.jitter":
        jitter = 1 - int(value) % 2 * 2
        continue
    group, name = key.split(".")
    assert name in ("x", "z", "w", "rate"), key
    m[group][name] = float(value)
if m["a"]["w"] > 10:
    sys.exit("formula: m.toml: a.w is 12, more than 10; make it less")
x = m["a"]["x"] * m["a"]["rate"] * 2
cycles = {"first": 1000 * x, "second": (500 * x + 1600) * (1 + jitter / 100)}[design] * m["a"]["z"]
marks = {f"a.{k}": {"from": "m.toml:1", "mark": "known" if k == "y" else "assumed"} for k in m["a"]}
marks["sim.q"] = marks["b.q"] = {"from": "m.toml:2", "mark": "assumed"}
with open(sys.argv[sys.argv.index("--json") + 1], "w") as file:
    json.dump({"cycles": cycles, "machine": m, "machine_provenance": marks}, file)
)");
    std::filesystem::permissions(program, std::filesystem::perms::owner_all);
    const auto of = [&](const std::string& arguments) {
        return script("assumptions.py", program.string(),
                      "--designs a.design=first a.design=second " + arguments);
    };
    const Outcome all = of("--noise 1 --csv a.csv --jobs 2");
    EXPECT_EQ(all.code, 1) << all.err; // halved, x has the first design better
    EXPECT_NE(all.out.find("0.900 of the cycles"), std::string::npos) << all.out;
    EXPECT_EQ(text("a.csv"), "key,value,changed,first,ratio,verdict,noise\r\n"
                             ",,,1.0,0.9,unchanged,0.01\r\n"
                             "a.x,4,2,0.5,1.3,FLIPS,0.01\r\n"
                             "a.rate,0.5,0.25,0.5,1.3,FLIPS,0.01\r\n"
                             "a.x,4,8,2.0,0.7,stays,0.01\r\n"
                             "a.rate,0.5,1.0,2.0,0.7,stays,0.01\r\n"
                             "a.z,1,2,2.0,0.9,stays,0.01\r\n"
                             "a.w,6,3,1.0,0.9,stays,0.01\r\n");
    EXPECT_NE(all.out.find("a.z x 0.5 (1 is the least)"), std::string::npos) << all.out;
    EXPECT_NE(all.out.find("a.w x 2 (a.w is 12, more than 10; make it less)"), std::string::npos) << all.out;
    const Outcome some = of("--noise 1 --only a.z a.w");
    EXPECT_EQ(some.code, 0);
    EXPECT_EQ(some.out.find("a.rate"), std::string::npos) << some.out;
    const Outcome noise = of("--noise 15 --only a.x");
    EXPECT_EQ(noise.code, 0);
    EXPECT_EQ(std::count(noise.out.begin(), noise.out.end(), '\n'), 5) << noise.out;
    EXPECT_NE(noise.out.find("neither is better"), std::string::npos);
    EXPECT_NE(noise.out.find("appears in 2"), std::string::npos) << noise.out;
    EXPECT_NE(of("--noise 12 --only a.rate").out.find("appears in 2"), std::string::npos);
    // Measured, ratios of 0.891 and 0.909 in turn.
    const Outcome measured = of("--seeds 4 --only a.x");
    EXPECT_NE(
        measured.out.find("0.900 of the cycles of a.design=first: a.design=second is better (noise 2.08 %, "
                          "of 4 seeds)"),
        std::string::npos)
        << measured.out << measured.err;
}

TEST_F(Sweep, RefusesMistakesOfAssumptions) {
    const std::pair<const char*, const char*> cases[] = {
        {"", "required: --designs"},
        {"--designs l2.ways=4", "expected 2 arguments"},
        {"--designs l2.ways 4", "give KEY=VALUE"},
        {"--designs l2.way=4 l2.ways=8", "the nearest known one is l2.ways"},
        {"--designs l2.ways=4 l2.ways=8 --noise 1 --only nothing", "no assumed number is left"},
        {"--designs l2.ways=4 l2.ways=8 --noise -1", "--noise -1"},
        {"--designs l2.ways=4 l2.ways=8 --seeds 1", "--seeds 1"},
        {"--designs l2.ways=4 l2.ways=8 --csv none/s.csv", "none/s.csv"},
    };
    for (const auto& [arguments, says] : cases) {
        SCOPED_TRACE(arguments);
        const Outcome result = assumptions(std::string(arguments) + " -- --size 8x8 --spp 1 --no-native");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_TRUE(result.err.starts_with("assumptions.py: ")) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
    }
}

} // namespace
} // namespace razor
