// razor-trace: files and pipes, exit codes, one line for each mistake, and nothing half-written.
#include "tests/program/run.h"
#include "traces/block_builder.h"
#include "traces/writer.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace razor {
namespace {

class TraceTool : public ::testing::Test {
protected:
    Outcome tool(const std::string& arguments) const {
        return run(program + " " + arguments, folder_.path());
    }
    std::string text(const std::string& name) const {
        std::ifstream file(folder_ / name, std::ios::binary);
        return {std::istreambuf_iterator<char>(file), {}};
    }

    const std::string program = quoted_argument(RAZOR_TRACE);
    TemporaryFolder folder_;
};

TEST_F(TraceTool, ConvertsThroughFilesPipesAndCompression) {
    const std::string din = "2 401000 3\n0 7fff0010 8\n1 7fff0010 8\n0 20 4\n";
    folder_.file("a.din", din);
    for (const char* format : {"rzt", "csv", "lackey"}) {
        SCOPED_TRACE(format);
        const std::string f(format);
        Outcome result = tool("convert a.din b." + f + ".xz");
        EXPECT_EQ(result.code, 0);
        EXPECT_EQ(result.err, "");
        result = tool("convert b." + f + ".xz - --to din");
        EXPECT_EQ(result.code, 0) << result.err;
        EXPECT_EQ(result.out, din);
        result = tool("convert - - --from din --to " + f + " < a.din | " + program +
                      " convert - c.din.gz --from " + f + " && " + program + " convert c.din.gz -  --to din");
        EXPECT_EQ(result.out, din) << result.err;
    }
    const Outcome lossy = tool("convert a.din d.ramulator");
    EXPECT_EQ(lossy.code, 0);
    EXPECT_EQ(lossy.err,
              "razor-trace: ramulator does not hold all of din: sizes are lost; 1 fetch references are "
              "left out\n");
    EXPECT_EQ(text("d.ramulator"), "0x7fff0010 R\n0x7fff0010 W\n0x20 R\n");
}

/// Address 0 is no operand there; what takes times for clocks of memory is told that they are not.
TEST_F(TraceTool, SaysWhatOtherFormatsCannotHold) {
    folder_.file("a.csv", "cycles,kind,address\n1,read,0x0\n5,read,0x40\n9,write,0x0\n");
    Outcome result = tool("convert a.csv a.champsim");
    EXPECT_NE(result.err.find("2 references to address 0 are left out"), std::string::npos) << result.err;
    EXPECT_EQ(text("a.champsim").size(), 64U);
    result = tool("convert a.csv a.dramsim3");
    EXPECT_NE(result.err.find("times are cycles, which pass for clocks of memory"), std::string::npos);
    result = tool("convert a.csv a.oracleGeneral");
    EXPECT_NE(result.err.find("times are cycles, which pass for seconds"), std::string::npos) << result.err;
    result = tool("convert a.dramsim3 a.csv.gz");
    EXPECT_NE(result.err.find("level are lost"), std::string::npos) << result.err;
    EXPECT_EQ(tool("convert a.dramsim3 a.rzt").err, "");
    result = tool("convert a.dramsim3 b.dramsim3");
    EXPECT_EQ(result.code, 0);
    EXPECT_EQ(result.err, "");
}

/// Two outputs are two files; what cannot be printed was not done.
TEST_F(TraceTool, LosesNoOutput) {
    folder_.file("a.din", "0 7fff0010 8\n1 7fff0010 8\n");
    folder_.file("empty.csv", "address\n"); // of no references
    for (const char* arguments :
         {"lines a.din --csv x --json ./x", "lines a.din --csv - --json -",
          "report a.din -o x.html --json x.html", "picture a.din -o x.svg --csv x.svg",
          "report a.din -o x.pdf", "causes a.din --sizes 1KiB --svg x.png", "picture empty.csv -o x.svg",
          "strides a.din --top 1 --histogram"}) {
        SCOPED_TRACE(arguments);
        const Outcome result = tool(arguments);
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(std::count(result.err.begin(), result.err.end(), '\n'), 1) << result.err;
        EXPECT_EQ(result.out, "");
        for (const char* name : {"x", "x.html", "x.svg", "x.pdf", "x.png"})
            EXPECT_FALSE(std::filesystem::exists(folder_ / name)) << name;
    }
    for (const char* arguments : {"info a.din", "lines a.din", "curve a.din --sizes 1KiB"}) {
        SCOPED_TRACE(arguments);
        const Outcome result = run("(" + program + " " + arguments + " > /dev/full)", folder_.path());
        EXPECT_EQ(result.code, 2);
        EXPECT_NE(result.err.find("standard output: cannot be written"), std::string::npos) << result.err;
    }
    // Of two that are one behind the other, the second is not read.
    ASSERT_EQ(tool("convert a.din a.rzt").code, 0);
    folder_.file("two.rzt", text("a.rzt") + text("a.rzt"));
    EXPECT_NE(tool("lines two.rzt").err.find("more bytes"), std::string::npos);
}

TEST_F(TraceTool, SaysWhatIsInATrace) {
    folder_.file("a.din", "2 401000 3\n0 7fff0010 8\n1 7fff0010 8\n0 20 4\n");
    ASSERT_EQ(tool("convert a.din a.rzt").code, 0);
    const nlohmann::json j = nlohmann::json::parse(tool("info a.rzt --json").out);
    EXPECT_EQ(j.at("references"), 4);
    EXPECT_EQ(j.at("referenced_bytes"), 23);
    EXPECT_EQ(j.at("complete"), true);
    EXPECT_EQ(j.at("bytes"), text("a.rzt").size());
    EXPECT_EQ(j.at("kinds").at(0), nlohmann::json::parse(R"({"name": "read", "references": 2})"));
    EXPECT_NE(tool("info a.rzt").out.find("4 references"), std::string::npos);

    const std::string whole = text("a.rzt");
    folder_.file("cut.rzt", whole.substr(0, whole.size() - 10));
    const nlohmann::json cut = nlohmann::json::parse(tool("info cut.rzt --json").out);
    EXPECT_EQ(cut.at("complete"), false);
    EXPECT_EQ(cut.at("references"), 4);
    EXPECT_NE(tool("info cut.rzt").out.find("cut off"), std::string::npos);
    const Outcome saved = tool("convert cut.rzt saved.din");
    EXPECT_EQ(saved.code, 0);
    EXPECT_NE(saved.err.find("cut off"), std::string::npos);
}

// Columns of what is predicted by itself, and the other way round.
TEST_F(TraceTool, CodesBlocksAsItIsAsked) {
    std::string din;
    std::uint32_t state = 1;
    for (int i = 0; i < 5000; ++i) {
        state = state * 1664525U + 1013904223U;
        din += fmt::format("{} {:x} 4\n", state >> 31U, (state >> 20U) * 64);
    }
    folder_.file("a.din", din);
    for (const char* step :
         {"a.din columns.rzt", "a.din predicted.rzt --coding predicted",
          "predicted.rzt again.rzt --coding columns", "columns.rzt a.csv", "predicted.rzt b.csv"})
        ASSERT_EQ(tool(std::string("convert ") + step).code, 0) << step;
    EXPECT_EQ(text("a.csv"), text("b.csv"));
    EXPECT_EQ(text("again.rzt"), text("columns.rzt"));
    EXPECT_LT(text("predicted.rzt").size(), text("columns.rzt").size());
}

TEST_F(TraceTool, MistakesAreALineAndLeaveNothing) {
    folder_.file("a.din", "0 10 4\n0 xy 4\n");
    folder_.file("unknown", "0 10 4\n");
    folder_.file("bad.rzt", "no trace\n");
    const std::size_t before = folder_.count();
    for (const auto& [arguments, cause] : std::vector<std::pair<std::string, std::string>>{
             {"", "required"},
             {"inform", "inform: there is no such command"},
             {"info", "TRACE"},
             {"info none", "none: cannot be opened"},
             {"info .", "is a folder"},
             {"info unknown", "--from"},
             {"info bad.rzt", "bad.rzt"},
             {"info a.din", "a.din, line 2: 'xy' is no address"},
             {"convert a.din b.rzt", "a.din, line 2"},
             {"convert a.din b.csv.gz", "a.din, line 2"},
             {"convert a.din b", "--to"},
             {"convert a.din b.rzt --from dim", "--from dim"},
             {"convert a.din b.csv --coding columns", "--coding is of rzt; csv has none, leave it out"},
             {"convert a.din b.rzt --coding small", "--coding small: give columns or predicted"},
             {"convert unknown no/b.rzt --from din", "no/b.rzt: cannot be written"},
             {"convert unknown b.rzt --from champsim", "7 of 64 bytes"}}) {
        const Outcome result = tool(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
    // Not even where one is asked to stop.
    const Outcome stopped = run("((while echo 0 10 4; do :; done) 2>/dev/null | timeout -s INT 0.5 " +
                                    program + " convert - b.rzt --from din)",
                                folder_.path());
    EXPECT_NE(stopped.err.find("interrupted; nothing written"), std::string::npos) << stopped.err;
    EXPECT_EQ(folder_.count(), before);
}

/// Whatever it waits for, and however long nothing comes that it could count.
TEST_F(TraceTool, EndsWhereItIsAskedTo) {
    std::string din;
    for (int i = 0; i < 100000; ++i)
        din += "0 10 4\n";
    folder_.file("a.din", din);
    ASSERT_EQ(run("mkfifo pipe", folder_.path()).code, 0);
    const std::size_t before = folder_.count();
    const std::string soon = "timeout --preserve-status -k 5 -s TERM 0.5 " + program + " ",
                      silent = "exec 3<>pipe; " + soon;
    for (const std::string& command :
         {soon + "info /dev/zero --from champsim", "yes '' | " + soon + "info - --from din",
          "yes '' | " + soon + "curve - --from lackey --json b.json", soon + "info pipe --from din",
          silent + "info - --from din <&3", silent + "convert - b.csv --from din <&3",
          silent + "convert a.din pipe --to csv", silent + "convert a.din - --to csv >&3"}) {
        const Outcome result = run("(" + command + ")", folder_.path());
        EXPECT_EQ(result.code, 130) << command;
        EXPECT_EQ(result.err, "razor-trace: interrupted; nothing written\n") << command;
        EXPECT_EQ(result.out, "") << command;
        EXPECT_EQ(folder_.count(), before) << command;
    }
}

TEST_F(TraceTool, OutputsAreNoInputs) {
    folder_.file("a.din", "0 10 4\n1 20 4\n");
    ASSERT_EQ(tool("convert a.din a.rzt").code, 0);
    const std::string trace = text("a.rzt");
    const std::size_t before = folder_.count();
    for (const char* arguments :
         {"curve a.rzt --json a.rzt", "curve a.rzt --csv ./a.rzt", "replay a.rzt --json a.rzt"}) {
        const Outcome result = tool(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << arguments << result.err;
        EXPECT_EQ(text("a.rzt"), trace) << arguments;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
}

TEST_F(TraceTool, KeepsWhatWasThereBefore) {
    folder_.file("a.din", "0 10 4\nx\n");
    folder_.file("b.csv", "mine");
    EXPECT_EQ(tool("convert a.din b.csv").code, 2);
    EXPECT_EQ(text("b.csv"), "mine");
    EXPECT_EQ(tool("--version").code, 0);
    EXPECT_NE(tool("--help").out.find("ramulator"), std::string::npos);
}

// Three lines of 16 bytes in turns, the third written: a cache of two misses all, one of four the first
// touches.
TEST_F(TraceTool, AnswersQuestionsAboutCaches) {
    std::string din;
    for (int i = 0; i < 5; ++i)
        din += "0 100 4\n0 110 4\n1 128 8\n";
    folder_.file("a.din", din);
    const auto rows = [&](const std::string& arguments) {
        const Outcome result = tool(arguments + " a.din --json -");
        EXPECT_EQ(result.code, 0) << result.err;
        const nlohmann::json j = nlohmann::json::parse(result.out);
        EXPECT_EQ(j.at("complete"), true);
        return j.at("rows");
    };
    const nlohmann::json curve = rows("curve --line 16 --sizes 32,64 --ways 1,2,4 --optimum");
    ASSERT_EQ(curve.size(), 2U);
    EXPECT_EQ(curve.at(0).at("misses"), 15);
    EXPECT_EQ(curve.at(0).at("misses of 1 ways"), 1 + 10);  // the second line has a set of its own
    EXPECT_EQ(curve.at(0).at("misses of 4 ways"), nullptr); // two lines have no four ways
    EXPECT_EQ(curve.at(0).at("least misses"), 3 + 12 / 2);
    EXPECT_EQ(curve.at(1).at("misses"), 3);
    EXPECT_EQ(curve.at(1).at("misses of 4 ways"), 3);
    const nlohmann::json by_kind = rows("curve --line 16 --sizes 32 --by kind --kinds write");
    ASSERT_EQ(by_kind.size(), 1U);
    EXPECT_EQ(by_kind.at(0).at("kind"), "write");
    EXPECT_EQ(by_kind.at(0).at("references"), 5);
    EXPECT_EQ(by_kind.at(0).at("misses"), 1);
    EXPECT_EQ(rows("curve --line 16 --sizes 32 --rate 0.999999").at(0).at("references"), 15);
    const nlohmann::json reuse = rows("reuse --line 16"); // others between two touches: two
    EXPECT_EQ(reuse.at(2).at("others from"), 2);
    EXPECT_EQ(reuse.at(2).at("to"), 3);
    EXPECT_EQ(reuse.at(2).at("references"), 12);
    EXPECT_EQ(reuse.back().at("references"), 3);
    const nlohmann::json windows = rows("windows --line 16 --window 10 --sizes 32");
    ASSERT_EQ(windows.size(), 2U);
    EXPECT_EQ(windows.at(1).at("begins"), 10);
    EXPECT_EQ(windows.at(1).at("references"), 5);
    EXPECT_EQ(windows.at(1).at("new lines"), 0);
    EXPECT_EQ(windows.at(1).at("misses of 32 bytes"), 5);
    EXPECT_EQ(rows("lines --line 16").at(0).at("bytes used"), 16);
    EXPECT_EQ(rows("lines --line 16 --hottest 1").at(0).at("address"), "0x100");
    EXPECT_EQ(rows("objects --sizes 16B").at(0).at("misses"), 3);
    EXPECT_EQ(tool("curve a.din --line 16 --sizes 32 --csv -").out,
              "bytes,references,first,misses,ratio\n32,15,3,15,1\n");
    EXPECT_NE(tool("curve a.din").out.find("15 touches of 1 lines of 64 bytes"), std::string::npos);
}

/// Two threads of two structures: what one writes, the other reads.
TEST_F(TraceTool, SaysWhyCachesMissAndWhatLinesAreUsedFor) {
    std::string csv = "cycles,stream,kind,address,size,structure\n";
    for (int i = 0; i < 10; ++i)
        csv += std::to_string(10 * i) + ",0,write,0x100,8,queue\n" + std::to_string(10 * i + 5) +
               ",1,read,0x" + (i % 2 == 0 ? "100" : "120") + ",8,queue\n" + std::to_string(10 * i + 6) +
               ",1,read," + std::to_string(1000 + 100 * i) + ",16,nodes\n"; // hexadecimal: 256 apart
    folder_.file("a.csv", csv);
    const auto rows = [&](const std::string& arguments) {
        const Outcome result = tool(arguments + " --json -");
        EXPECT_EQ(result.code, 0) << result.err;
        return nlohmann::json::parse(result.out).at("rows");
    };
    const nlohmann::json causes = rows("causes a.csv --sizes 1KiB --share 1 --by structure,thread");
    ASSERT_EQ(causes.size(), 3U);
    for (const nlohmann::json& row : causes) {
        EXPECT_EQ(row.at("compulsory").get<int>() + row.at("capacity").get<int>() +
                      row.at("conflict").get<int>() + row.at("true sharing").get<int>() +
                      row.at("false sharing").get<int>(),
                  row.at("misses").get<int>());
        if (row.at("structure") == "queue" && row.at("thread") == "thread 1") {
            EXPECT_EQ(row.at("misses"), 10);
            EXPECT_EQ(row.at("true sharing"), 4); // at 0x100, the first time it is compulsory
            EXPECT_EQ(row.at("false sharing"), 5);
        }
    }
    EXPECT_EQ(rows("causes a.csv --sizes 1KiB").at(0).at("true sharing"), 0); // one cache for all
    const nlohmann::json windows = rows("causes a.csv --sizes 1KiB --by window --window 50");
    ASSERT_EQ(windows.size(), 2U);
    EXPECT_EQ(windows.at(1).at("window"), 50);
    EXPECT_EQ(windows.at(0).at("references").get<int>() + windows.at(1).at("references").get<int>(), 30);
    const nlohmann::json use = rows("use a.csv --sizes 1KiB --share 1");
    EXPECT_EQ(use.at(0).at("structure"), "queue");
    EXPECT_EQ(use.at(0).at("dropped"), 9); // by each write but the first
    const nlohmann::json replicas = rows("replicas a.csv --sizes 1KiB,4KiB");
    ASSERT_EQ(replicas.size(), 4U);
    EXPECT_GT(replicas.at(0).at("copies a line").get<double>(), 1);
    EXPECT_EQ(replicas.at(3).at("duplicates"), 0); // the nodes are one thread's
    EXPECT_EQ(rows("footprint a.csv").at(0).at("touched by"), 2);
    EXPECT_EQ(rows("footprint a.csv --threads").at(0).at("lines alone"), 0);
    const nlohmann::json strides = rows("strides a.csv");
    EXPECT_EQ(strides.at(0).at("same"), 9);    // of the writer
    EXPECT_EQ(strides.at(1).at("strided"), 8); // after the first step
    EXPECT_EQ(strides.at(1).at("most frequent"), 256);
    EXPECT_EQ(rows("strides a.csv --top 1").at(1).at("stride"), 256);
    EXPECT_EQ(rows("strides a.csv --histogram").back().at("forwards"), 9);

    for (const char* command :
         {"curve a.csv --by structure", "windows a.csv --window 10 --sizes 1KiB", "strides a.csv",
          "strides a.csv --top 3", "strides a.csv --histogram", "causes a.csv --sizes 1KiB,2KiB",
          "use a.csv --sizes 1KiB", "replicas a.csv --sizes 1KiB,2KiB"}) {
        EXPECT_EQ(tool(std::string(command) + " --svg chart.svg").code, 0) << command;
        EXPECT_NE(text("chart.svg").find("</svg>"), std::string::npos) << command;
        std::filesystem::remove(folder_ / "chart.svg");
    }
    EXPECT_EQ(tool("picture a.csv -o a.svg").code, 0);
    EXPECT_NE(text("a.svg").find("queue"), std::string::npos);
    EXPECT_EQ(tool("picture a.csv -o a.png").code, 0);
    EXPECT_EQ(text("a.png").substr(1, 3), "PNG");
    const Outcome report = tool("report a.csv -o a.html");
    EXPECT_EQ(report.code, 0) << report.err;
    const std::string html = text("a.html");
    for (const char* heading : {"Why caches miss", "Strides", "Addresses over time", "Working set over time",
                                "Lines and who shares them", "Misses by the size of a cache"})
        EXPECT_NE(html.find(heading), std::string::npos) << heading;
    EXPECT_EQ(html.find("nan"), std::string::npos);
    tool("report a.csv -o b.html");
    EXPECT_EQ(text("b.html"), html);
}

/// What no line of the sample belongs to is not known.
TEST_F(TraceTool, AnEstimateFromNothingIsNone) {
    std::string csv = "address,structure\n100000000,queue\n";
    for (int i = 0; i < 20000; ++i)
        csv += std::to_string(1000000 + 100 * i) + ",nodes\n"; // hexadecimal: 256 apart
    folder_.file("a.csv", csv);
    const Outcome result = tool("curve a.csv --rate 0.01 --by structure --sizes 1MiB --json -");
    ASSERT_EQ(result.code, 0) << result.err;
    const nlohmann::json rows = nlohmann::json::parse(result.out).at("rows");
    ASSERT_EQ(rows.size(), 2U);
    EXPECT_EQ(rows.at(0).at("references"), 1);
    for (const char* column : {"misses", "ratio", "error"})
        EXPECT_TRUE(rows.at(0).at(column).is_null()) << column;
    EXPECT_EQ(rows.at(0).at("sample of"), "none");
    EXPECT_NEAR(rows.at(1).at("ratio").get<double>(), 1, 0.2);
}

TEST_F(TraceTool, CountsObjectsOfSomeKindsAndBursts) {
    folder_.file("a.csv", "kind,address,size\nread,0x100,8\nwrite,0x100,8\nread,0x200,8\nread,0x100,8\n"
                          "write_back,0x100,8\nread,0x180,0\n");
    const auto json = [&](const std::string& arguments) {
        const Outcome result = tool(arguments + " --json -");
        EXPECT_EQ(result.code, 0) << result.err;
        return nlohmann::json::parse(result.out);
    };
    const nlohmann::json objects = json("objects a.csv --sizes 8B");
    EXPECT_EQ(objects.at("rows").at(0).at("references"), 5) << "that are demanded";
    EXPECT_EQ(objects.at("rows").at(0).at("misses"), 4);
    EXPECT_FALSE(objects.contains("line_bytes"));
    const nlohmann::json reads = json("objects a.csv --sizes 8B --kinds read");
    EXPECT_EQ(reads.at("rows").at(0).at("references"), 4);
    EXPECT_EQ(reads.at("rows").at(0).at("misses"), 4);
    for (const char* command : {"objects a.csv --sizes 8B", "rows a.csv", "picture a.csv -o a.png"}) {
        const Outcome result = tool(std::string(command) + " --line 128");
        EXPECT_EQ(result.code, 2) << command;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find("--line"), std::string::npos) << result.err;
    }
    if (tool("--help").out.find("\n  rows") != std::string::npos) { // builds with the machine
        EXPECT_EQ(json("rows a.csv -g memory.bus_bytes=8 -g memory.burst_length=4").at("line_bytes"), 32);
        EXPECT_EQ(json("rows a.csv -g memory.bus_bytes=8 -g memory.burst_length=8").at("line_bytes"), 64);
    }
}

/// Distances and misses of a sample are not those of all lines; counts are told to be the sample's.
TEST_F(TraceTool, TellsOfASampleWhatItCan) {
    for (const double sample : {0.25, 1.0}) {
        std::string bytes;
        traces::Description description;
        description.line_bytes = 64;
        description.sample = sample;
        traces::Writer writer(traces::memory_sink(bytes), description);
        traces::BlockBuilder builder;
        for (std::uint64_t time = 0; time < 100; ++time) {
            traces::Reference r{time, time % 10 * 64, 0, {}};
            r.what.size = 4;
            builder.add(r);
        }
        traces::Block block;
        builder.take(block);
        writer.write(block);
        writer.finish();
        folder_.file("s.rzt", bytes);
        for (const char* arguments :
             {"reuse s.rzt", "objects s.rzt --sizes 1KiB", "windows s.rzt --window 10 --sizes 1KiB",
              "causes s.rzt --sizes 1KiB", "use s.rzt --sizes 1KiB", "strides s.rzt"}) {
            const Outcome result = tool(arguments);
            EXPECT_EQ(result.code, sample < 1 ? 2 : 0) << arguments;
            EXPECT_EQ(result.error_lines(), sample < 1 ? 1 : 0) << result.err;
            EXPECT_EQ(result.err.find("s.rzt: is a sample of 0.25 of all lines") != std::string::npos,
                      sample < 1)
                << result.err;
        }
        for (const char* arguments :
             {"lines s.rzt", "lines s.rzt --by structure", "footprint s.rzt", "footprint s.rzt --threads",
              "windows s.rzt --window 10", "picture s.rzt -o s.svg"}) {
            const Outcome result = tool(arguments);
            EXPECT_EQ(result.code, 0) << result.err;
            EXPECT_EQ(result.out.find("a sample of 0.25 of all lines") != std::string::npos, sample < 1)
                << result.out;
        }
    }
}

/// Whatever ends the program: where the file system can have files without names, nothing is left.
TEST_F(TraceTool, LeavesNothingBehindWhereItIsKilled) {
    folder_.file("a.din", "0 10 4\n");
    const std::size_t before = folder_.count();
    run("((while echo 0 10 4; do :; done) 2>/dev/null | timeout -s KILL 0.5 " + program +
            " convert - b.rzt --from din)",
        folder_.path());
    EXPECT_EQ(folder_.count(), before);
}

// Whatever is asked of it, and however its format is known.
TEST_F(TraceTool, AnEmptyFileIsNoTrace) {
    for (const char* name : {"e.csv", "e.din", "e.rzt", "e"})
        folder_.file(name, "");
    ASSERT_EQ(run("gzip -c e >e.din.gz", folder_.path()).code, 0);
    const std::size_t before = folder_.count();
    for (const char* command :
         {"info", "info --json", "convert", "curve", "lines", "windows --window 9", "reuse", "strides",
          "footprint", "objects --sizes 1KiB", "causes --sizes 1KiB", "use --sizes 1KiB"})
        for (const char* file : {"e.csv --from csv", "e.csv", "e.din", "e.din.gz", "e.rzt", "e",
                                 "e --from champsim", "- --from din"}) {
            const std::string arguments = std::string(command) + " " + file,
                              more = std::string_view(command) == "convert" ? " out.csv" : "";
            SCOPED_TRACE(arguments);
            const Outcome result = tool(arguments + more);
            EXPECT_EQ(result.code, 2);
            EXPECT_EQ(result.out, "");
            const std::string name =
                file[0] == '-' ? "standard input" : arguments.substr(arguments.find(" e") + 1);
            EXPECT_EQ(result.err, "razor-trace: " + name.substr(0, name.find(" --")) +
                                      ": is empty; record the trace again\n");
        }
    EXPECT_EQ(folder_.count(), before);
}

TEST_F(TraceTool, RefusesQuestionsThatHaveNoAnswer) {
    folder_.file("a.din", "0 10 4\n");
    folder_.file("empty.csv", "address\n"); // of no references
    const std::size_t before = folder_.count();
    for (const auto& [arguments, cause] : std::vector<std::pair<std::string, std::string>>{
             {"curve", "TRACE"},
             {"curve b.din", "b.din"},
             {"curve a.din --line 48", "no power of two"},
             {"curve a.din --line 4611686018427387904", "--line 4611686018427387904: lines have at most"},
             {"curve a.din --line 2TiB --rate 0.5", "--line 2TiB: lines have at most"},
             {"curve a.din --sizes 1KB", "no size"},
             {"curve a.din --sizes 4KiB..1KiB", "ends before it begins"},
             {"curve a.din --sizes 100", "give multiples"},
             {"curve a.din --sizes ,", "a part is empty"},
             {"curve a.din --sizes 32KiB,", "a part is empty"},
             {"curve a.din --ways 1,8,", "a part is empty"},
             {"curve a.din --kinds read,", "a part is empty"},
             {"curve a.din --by structure,", "a part is empty"},
             {"curve a.din --rate ''", "--rate: is empty"},
             {"curve a.din --sizes ''", "--sizes: is empty"},
             {"curve a.din --kinds ''", "--kinds: is empty"},
             {"curve a.din --by ''", "--by: is empty"},
             {"curve a.din --tile ''", "--tile: is empty"},
             {"curve a.din --ways all", "--ways 'all': give a whole number from 1 to 1024"},
             {"curve a.din --ways 0", "--ways '0': give a whole number"},
             {"curve a.din --ways 1e3", "--ways '1e3': give a whole number"},
             {"curve a.din --sample-lines 1e6", "--sample-lines '1e6': give a whole number from 256"},
             {"curve a.din --sizes 32KiB --ways 3",
              "give other --ways, or --sizes that are multiples of 192"},
             {"curve a.din --sizes 32KiB --rate 1e-30", "give a larger --rate"},
             {"footprint a.din --threads --by structure", "excludes"},
             {"report empty.csv -o a.html", "record some"},
             {"picture empty.csv -o a.svg", "record some"},
             {"curve a.din --ways 2000", "from 1 to 1024"},
             {"curve a.din --by colour", "there is no such thing; give all, structure"},
             {"curve a.din --kinds read,nothing", "there is no such thing; give read, write"},
             {"curve a.din --rate 0", "no fraction"},
             {"curve a.din --rate 0.1 --optimum", "leave out"},
             {"curve a.din --json no/a.json", "no/a.json: cannot be written"},
             {"windows a.din", "--window"},
             {"windows a.din --window 5 --sizes 100", "give multiples"},
             {"windows a.din --window 0", "no length"},
             {"lines a.din --hottest 0", "--hottest"},
             {"curve a.din --sample-lines 10", "from 256"},
             {"curve a.din --sample-lines 1024 --ways 2", "leave out"},
             {"causes a.din", "--sizes"},
             {"causes a.din --sizes 64KiB --ways 3", "no sets of 3 ways"},
             {"causes a.din --sizes 64KiB --share none", "or all"},
             {"use a.din --sizes 100", "give multiples"},
             {"strides a.din --by window", "give --window N"},
             {"strides a.din --window 5", "add --by window"},
             {"strides a.din --by structure,structure", "twice"},
             {"strides a.din --top 0", "--top"},
             {"picture a.din", "--output"},
             {"picture a.din -o a.jpg", "name a .png file"},
             {"picture a.din -o no/a.png", "no/a.png: cannot be written"},
             {"report a.din -o a.html --sizes 1KiB,2KiB", "give one"},
             {"objects a.din", "--sizes"},
             {"tiles a.din", "does not say for which screen tile"},
             {"causes a.din --sizes 1KiB --by tile", "does not say for which screen tile"},
             {"strides a.din --tile 0,0", "does not say for which screen tile"},
             {"report a.din -o a.html --over a.png", "does not say for which screen tile"},
             {"tiles a.din --figure colour", "there is no such thing; give references"},
             {"tiles a.din --over a.png", "give both"},
             {"tiles a.din --over a.png -o a.jpg", "name a .png file"},
             {"tiles a.din --linear", "--over"}}) {
        const Outcome result = tool(arguments);
        EXPECT_EQ(result.code, 2) << arguments;
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_EQ(result.out, "") << arguments;
        EXPECT_NE(result.err.find(cause), std::string::npos) << result.err;
        EXPECT_EQ(folder_.count(), before) << arguments;
    }
    const Outcome pipe = run("(cat a.din | " + program + " report - --from din -o a.html)", folder_.path());
    EXPECT_EQ(pipe.code, 2);
    EXPECT_NE(pipe.err.find("write it into a file first"), std::string::npos) << pipe.err;
    EXPECT_EQ(tool("curve empty.csv").code, 0);
}

} // namespace
} // namespace razor
