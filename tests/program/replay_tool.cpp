// razor-trace replay beside razor-sim run: the same counts for a frame, on machines of all kinds; several
// machines in one pass; pipes, cut and damaged files; what another machine's memory changes; mistakes leave
// nothing.
#include "tests/program/simulator.h"

#include <cmath>
#include <map>
#include <sstream>

namespace razor {
namespace {

class ReplayTool : public Simulator {
protected:
    ReplayTool() { folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n"); }

    static std::string machine(const std::string& name) {
        return quoted_argument(RAZOR_SOURCE_DIR "/configs/machines/" + name + ".toml");
    }
    static std::string text_of_machine(const std::string& name) {
        std::ifstream file(RAZOR_SOURCE_DIR "/configs/machines/" + name + ".toml");
        return {std::istreambuf_iterator<char>(file), {}};
    }
    Outcome tool(const std::string& arguments) const {
        return run(program + " " + arguments, folder_.path());
    }
    /// A frame's trace and report.
    void record(const std::string& machine_and_more, const std::string& name) const {
        const Outcome result =
            simulator("run --quiet --no-native --no-calibration --scene s.toml --spp 1 --sky-samples 1 "
                      "--light-samples 0 --edge-pixels 4 --report r.txt --size 16x16 --machine " +
                      machine_and_more + " --json " + name + ".json --trace " + name + ".rzt");
        ASSERT_EQ(result.code, 0) << result.err;
    }
    nlohmann::json json_of(const std::string& arguments) const {
        const Outcome result = tool("replay " + arguments + " --json -");
        EXPECT_EQ(result.code, 0) << result.err;
        return result.code == 0 ? nlohmann::json::parse(result.out) : nlohmann::json();
    }

    const std::string program = quoted_argument(RAZOR_TRACE);
};

const std::string snooping_above_l3 =
    " -g chip.tiles=4 -g network.topology=bus -g network.buses=2 -g coherence.plain=snoop -g "
    "l2.inclusion=inclusive -g l3.size_bytes=65536";
const std::string reference_mode = " -g sim.mode=reference -g sim.quantum=1 -g memory.controller=queued";

TEST_F(ReplayTool, CountsWhatTheRunCounted) {
    for (const std::string& on :
         {machine("tiny"), machine("niagara-like"), machine("xeon-x5355-2s"), machine("zen4-2c"),
          machine("tiny") + " -g chip.tiles=2 -g coherence.plain=directory -g l2.inclusion=inclusive -g "
                            "l1.prefetcher=stride -g core.store_buffer=4 -g sim.quantum=1000",
          machine("tiny") + snooping_above_l3, machine("tiny") + snooping_above_l3 + reference_mode,
          machine("tiny") + " -g l2.inclusion=exclusive -g renderer.discard=on -g l3.size_bytes=65536 -g "
                            "l3.share=tile"}) {
        SCOPED_TRACE(on);
        record(on, "a");
        const nlohmann::json all = json_of("a.rzt --machine " + on + " --against a.json");
        std::size_t compared = 0;
        for (const nlohmann::json& c : all.at("against").at("counts")) {
            EXPECT_EQ(c.at("replay"), c.at("run")) << c;
            ++compared;
        }
        EXPECT_GT(compared, 300U);
        const nlohmann::json& replayed = all.at("machines").at(0);
        EXPECT_EQ(replayed.at("replay").at("windows_of_the_run"), true);
        EXPECT_EQ(replayed.at("replay").at("ended"), true);
        EXPECT_EQ(replayed.at("l1").at("misses"), report("a.json").at("l1").at("misses"));
        EXPECT_EQ(replayed.at("machine"), report("a.json").at("machine"));
        const Outcome text = tool("replay a.rzt --machine " + on + " --against a.json");
        EXPECT_NE(text.out.find("in the run's windows"), std::string::npos) << text.out;
    }
}

/// A converted trace holds what a replay needs.
TEST_F(ReplayTool, ConvertedTracesCountTheSame) {
    for (const char* level : {"core", "l2"}) {
        SCOPED_TRACE(level);
        record(machine("tiny") + " --trace-level " + level, "a");
        const Outcome result = tool("convert a.rzt b.rzt");
        ASSERT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.err, "");
        const nlohmann::json all = json_of("b.rzt --machine " + machine("tiny") + " --against a.json");
        for (const nlohmann::json& c : all.at("against").at("counts"))
            EXPECT_EQ(c.at("replay"), c.at("run")) << c;
        EXPECT_EQ(all.at("machines").at(0).at("replay").at("windows_of_the_run"), true);
    }
}

TEST_F(ReplayTool, SeveralMachinesTakeOnePass) {
    record(machine("tiny"), "a");
    const std::vector<std::string> machines = {machine("tiny"), machine("tiny") + ",l2.size_bytes=16384",
                                               machine("zen4-2c") + ",chip.threads=4"};
    std::string together = "- ";
    for (const std::string& m : machines)
        together += " --machine " + m;
    const Outcome piped =
        run("(cat a.rzt | " + program + " replay " + together + " --json -)", folder_.path());
    ASSERT_EQ(piped.code, 0) << piped.err;
    const nlohmann::json all = nlohmann::json::parse(piped.out).at("machines");
    ASSERT_EQ(all.size(), machines.size());
    for (std::size_t i = 0; i < machines.size(); ++i)
        EXPECT_EQ(all.at(i), json_of("a.rzt --threads 1 --machine " + machines[i]).at("machines").at(0));
    EXPECT_LT(all.at(0).at("l2").at("misses"), all.at(1).at("l2").at("misses"));
    // -g is for all of them.
    const nlohmann::json set = json_of("a.rzt -g l2.size_bytes=16384 --machine " + machine("tiny"));
    EXPECT_EQ(set.at("machines").at(0).at("l2"), all.at(1).at("l2"));
}

TEST_F(ReplayTool, GroupsSumToTheWhole) {
    record(machine("tiny"), "a");
    const auto sums = [&](const std::string& by) {
        std::map<std::string, std::vector<std::uint64_t>> out; // by level: reads, writes, hits, misses
        std::istringstream rows(
            tool("replay a.rzt --machine " + machine("tiny") + " --csv - --by " + by).out);
        std::string line;
        std::getline(rows, line);
        while (std::getline(rows, line)) {
            std::vector<std::string> cells;
            std::istringstream in(line);
            for (std::string cell; std::getline(in, cell, ',');)
                cells.push_back(cell);
            const std::size_t level = by == "all" ? 0 : 1;
            std::vector<std::uint64_t>& sum = out[cells[level]];
            sum.resize(4);
            for (std::size_t k = 0; k < (cells[level] == "memory" ? 2U : 4U); ++k)
                sum[k] += std::stoull(cells[level + 1 + k]);
        }
        return out;
    };
    const auto all = sums("all");
    EXPECT_EQ(all.size(), 3U);
    EXPECT_GT(all.at("L1")[0], 1000U);
    for (const char* by : {"structure", "phase", "kind"})
        EXPECT_EQ(sums(by), all) << by;
}

/// What another machine's memory does to the order of references is what replaying in the run's order leaves
/// out.
TEST_F(ReplayTool, TheErrorOfAnotherMachineIsSaid) {
    record(machine("tiny"), "a");
    const std::string other = machine("tiny") + " -g l2.size_bytes=16384 -g l2.latency=40";
    record(other, "b");
    for (const char* how : {"", "--timed "}) {
        const nlohmann::json all =
            json_of(std::string("a.rzt ") + how + "--machine " + other + " --against b.json");
        EXPECT_EQ(all.at("machines").at(0).at("replay").at("timed"), how[0] != '\0');
        double misses = -1;
        for (const nlohmann::json& c : all.at("against").at("counts")) {
            const double replayed = c.at("replay").get<double>(), ran = c.at("run").get<double>();
            EXPECT_EQ(c.at("error").is_null(), ran == 0 && replayed != 0);
            if (ran != 0) {
                EXPECT_NEAR(c.at("error").get<double>(), std::abs(replayed - ran) / ran, 1e-12);
            }
            if (c.at("of") == "l2" && c.at("counter") == "misses")
                misses = c.at("error");
        }
        EXPECT_GE(misses, 0);
        EXPECT_LT(misses, 0.2) << how;
    }
    // On its own machine a timed replay is near the run.
    const nlohmann::json timed = json_of("a.rzt --timed --machine " + machine("tiny") + " --against a.json");
    for (const nlohmann::json& c : timed.at("against").at("counts"))
        if ((c.at("of") == "l1" || c.at("of") == "l2") && c.at("counter") == "misses") {
            EXPECT_LT(c.at("error").get<double>(), 0.1) << c;
        }
}

TEST_F(ReplayTool, WhatIsLeftOfACutTraceCounts) {
    record(machine("tiny"), "a");
    const std::string whole = text("a.rzt");
    folder_.file("cut.rzt", whole.substr(0, whole.size() - 40)); // its index
    const Outcome cut = tool("replay cut.rzt --machine " + machine("tiny") + " --json c.json");
    EXPECT_EQ(cut.code, 0) << cut.err;
    EXPECT_NE(cut.err.find("cut off"), std::string::npos);
    EXPECT_EQ(cut.error_lines(), 1);
    const nlohmann::json c = nlohmann::json::parse(text("c.json"));
    EXPECT_EQ(c.at("complete"), false);
    EXPECT_GT(c.at("machines").at(0).at("l1").at("reads"), 1000);

    std::string bad = whole;
    bad[whole.size() / 2] = static_cast<char>(bad[whole.size() / 2] ^ 4);
    folder_.file("bad.rzt", bad);
    const std::size_t before = folder_.count();
    const Outcome damaged =
        tool("replay bad.rzt --machine " + machine("tiny") + " --json d.json --csv d.csv");
    EXPECT_EQ(damaged.code, 2);
    EXPECT_EQ(damaged.error_lines(), 1) << damaged.err;
    EXPECT_EQ(folder_.count(), before);
}

// As analyses have it.
TEST_F(ReplayTool, ReferencesEndWithTheLastAddress) {
    folder_.file("end.din", "0 ffffffffffffffff 4\n1 ffffffffffffffc0 300\n");
    const nlohmann::json all = json_of("end.din --machine " + machine("tiny"));
    EXPECT_EQ(all.at("machines").at(0).at("l1").at("misses"), 1);
    const Outcome curve = tool("curve end.din");
    EXPECT_NE(curve.out.find("2 touches of 1 lines"), std::string::npos) << curve.out;
}

TEST_F(ReplayTool, OutputsAreNoMachineFiles) {
    folder_.file("a.din", "0 10 4\n");
    const std::string base = text_of_machine("tiny"), over = "inherit = \"base.toml\"\n[l2]\nways = 16\n";
    folder_.file("base.toml", base);
    folder_.file("m.toml", over);
    folder_.file("same.toml", "inherit = \"base.toml\"\n" + base); // no value of the other is left
    for (const char* arguments :
         {"replay a.din --machine m.toml --json m.toml",
          "replay a.din --machine m.toml,l2.ways=8 --csv ./m.toml",
          "replay a.din --machine m.toml --csv base.toml", "replay a.din --machine same.toml --csv base.toml",
          "rows a.din --machine same.toml --csv base.toml", "rows a.din --machine m.toml --csv m.toml",
          "rows a.din --machine m.toml --json base.toml"}) {
        const Outcome result = run(program + " " + arguments, folder_.path());
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find("is read; name another output"), std::string::npos) << result.err;
        EXPECT_EQ(text("base.toml"), base) << arguments;
        EXPECT_EQ(text("m.toml"), over) << arguments;
    }
}

TEST_F(ReplayTool, MistakesAreALineAndLeaveNothing) {
    folder_.file("a.din", "0 10 4\n2 401000 3\n");
    folder_.file("t.csv", "stream,kind,address\n9,read,10\n");
    folder_.file("no.json", "{\"a\": 1}");
    const std::string on = " --machine " + machine("tiny");
    const std::size_t before = folder_.count();
    for (const auto& [arguments, cause] : std::vector<std::pair<std::string, std::string>>{
             {"a.din", "--machine"},
             {on, "TRACE"},
             {"a.din --machine none.toml", "none.toml"},
             {"a.din" + on + ",l2.siz_bytes=3", "l2.size_bytes"},
             {"a.din" + on + " -g l2.size_bytes=nothing", "l2.size_bytes"},
             {"a.din --timed" + on + " -g sim.mode=reference", "sim.mode=fast"},
             {"a.din" + on + " --by colour", "there is no such thing; give all, structure"},
             {"a.din" + on + on + " --against no.json", "give one --machine"},
             {"a.din" + on + " --against no.json", "no report of a run"},
             {"a.din" + on + " --against a.din", "no report of a run, as it is no JSON"},
             {"a.din" + on + ",", "a part is empty"},
             {"a.din" + on + ",l2.ways=none", "--machine "},
             {"a.din" + on + " --json no/a.json", "no/a.json: cannot be written"},
             {"a.din" + on + " --threads 0", "--threads"},
             {"t.csv" + on, "give a machine with more (-g chip.threads="}}) {
        const Outcome result = tool("replay " + arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
    const Outcome some = tool("replay a.din" + on);
    EXPECT_EQ(some.code, 0) << some.err;
    EXPECT_NE(some.out.find("1 references"), std::string::npos) << some.out;
    EXPECT_NE(some.err.find("a.din: does not say where references were seen"), std::string::npos) << some.err;
    EXPECT_NE(some.out.find("1 fetch references are left out"), std::string::npos) << some.out;
    EXPECT_NE(tool("replay a.din --fetches" + on).out.find("2 references"), std::string::npos);
    const Outcome stopped = run("((while echo 0 10 4; do :; done) 2>/dev/null | timeout -s INT 0.5 " +
                                    program + " replay - --json b.json --from din" + on + ")",
                                folder_.path());
    EXPECT_NE(stopped.err.find("interrupted; nothing written"), std::string::npos) << stopped.err;
    EXPECT_EQ(folder_.count(), before);
}

} // namespace
} // namespace razor
