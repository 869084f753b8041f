// razor-trace study: its figures beside those of razor-trace curve, what goes on where it was stopped, and
// mistakes.
#include "tests/program/run.h"

#include <nlohmann/json.hpp>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <map>
#include <thread>

namespace razor {
namespace {

class TraceStudy : public ::testing::Test {
protected:
    TraceStudy() {
        std::string din;
        std::uint32_t state = 1;
        for (int i = 0; i < 60000; ++i) {
            state = state * 1664525U + 1013904223U;
            const std::uint32_t most = 1U << (state >> 28U); // near lines far more often
            char line[32];
            std::snprintf(line, sizeof line, "0 %x 4\n", (state >> 8U) % (most * 16) * 4);
            din += line;
        }
        folder_.file("a.din", din);
        folder_.file("study.toml", R"(
kind = "trace"
seeds = 2
[settings]
trace = "a.din"
sizes = "1KiB..256KiB"
[[points]]
method = "exact"
[[points]]
method = "lines"
share = [0.1, 0.9]
[[points]]
method = "sets"
ways = 4
share = 0.5
)");
    }
    Outcome tool(const std::string& arguments) const {
        return run(quoted_argument(RAZOR_TRACE) + " " + arguments, folder_.path());
    }
    nlohmann::json json(const std::string& name) const {
        std::ifstream file(folder_ / name);
        return nlohmann::json::parse(file);
    }
    TemporaryFolder folder_;
};

TEST_F(TraceStudy, ComparesWithExactCurves) {
    const Outcome outcome = tool("study study.toml -o s");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_NE(outcome.out.find("4 points: 4 measured, 0 failed"), std::string::npos) << outcome.out;
    const nlohmann::json points = json("s/study.json")["points"];
    const auto figure = [&](std::size_t point, const char* name, const char* part) {
        return points.at(point)["figures"][name][part].get<double>();
    };
    EXPECT_EQ(figure(0, "largest_error", "most"), 0);
    EXPECT_EQ(figure(0, "looked_at", "median"), 1);
    EXPECT_NE(figure(1, "mean_error", "least"), figure(1, "mean_error", "most"));
    EXPECT_LT(figure(2, "mean_error", "mean"), figure(1, "mean_error", "mean"));
    EXPECT_GT(figure(3, "mean_error", "median"), 0);
    EXPECT_NEAR(figure(3, "looked_at", "median"), 0.5, 0.2);
    // Seed 1 is the sample of razor-trace curve.
    ASSERT_EQ(tool("curve a.din --sizes 1KiB..256KiB --json exact.json").code, 0);
    ASSERT_EQ(tool("curve a.din --sizes 1KiB..256KiB --rate 0.1 --json some.json").code, 0);
    const nlohmann::json exact = json("exact.json")["rows"], some = json("some.json")["rows"];
    std::vector<double> ratios;
    for (const nlohmann::json& row : exact)
        ratios.push_back(row["ratio"]);
    double mean = 0, largest = 0;
    std::size_t sizes = 0;
    while (sizes < ratios.size()) {
        const double off = std::abs(some.at(sizes)["ratio"].get<double>() - ratios[sizes]);
        mean += off;
        largest = std::max(largest, off);
        if (ratios[sizes++] == ratios.back())
            break;
    }
    mean /= static_cast<double>(sizes);
    EXPECT_EQ(figure(1, "sizes", "median"), static_cast<double>(sizes));
    const auto near = [&](const char* name, double value) {
        return std::min(std::abs(figure(1, name, "least") - value),
                        std::abs(figure(1, name, "most") - value));
    };
    EXPECT_LT(near("mean_error", mean), 1e-12);
    EXPECT_LT(near("largest_error", largest), 1e-12);

    // What is measured stays, wherever the trace lies.
    const auto results = [&] {
        std::map<std::string, std::filesystem::file_time_type> out;
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "s/results"))
            out[entry.path().filename().string()] = entry.last_write_time();
        return out;
    };
    const auto before = results();
    EXPECT_EQ(before.size(), 6U); // with two references
    std::filesystem::rename(folder_ / "a.din", folder_ / "b.din");
    std::ifstream in(folder_ / "study.toml");
    std::string study{std::istreambuf_iterator<char>(in), {}};
    folder_.file("moved.toml", study.replace(study.find("a.din"), 5, "b.din"));
    EXPECT_EQ(tool("study moved.toml -o s").code, 0);
    EXPECT_EQ(results(), before);
    folder_.file("b.din", "0 10 4\n0 20 4\n0 10 4\n"); // another trace
    EXPECT_EQ(tool("study moved.toml -o s").code, 0);
    EXPECT_EQ(results().size(), 12U);
}

// What changes while it is measured is no result of what was planned; what is written as it was is the same.
TEST_F(TraceStudy, KeepsNothingOfTracesThatChange) {
    std::ifstream in(folder_ / "a.din");
    const std::string before{std::istreambuf_iterator<char>(in), {}};
    for (const bool changes : {true, false}) {
        SCOPED_TRACE(changes);
        const std::string store = changes ? "s" : "t";
        std::thread editor([&] {
            while (!std::filesystem::exists(folder_ / store / "claims"))
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
            folder_.file("other.din", before + (changes ? "0 10 4\n" : ""));
            std::filesystem::rename(folder_ / "other.din", folder_ / "a.din"); // at once
        });
        const Outcome result = tool("study study.toml --quiet -o " + store);
        editor.join();
        EXPECT_EQ(result.code, changes ? 2 : 0) << result.err;
        EXPECT_EQ(result.err, changes ? "razor-trace: a.din: was changed while the study ran, and what was "
                                        "measured of it is not kept; run the same command again\n"
                                      : "");
        EXPECT_EQ(tool("study study.toml --quiet -o " + store).code, 0); // goes on
        folder_.file("a.din", before);
    }
}

TEST_F(TraceStudy, SaysWhatIsImpossible) {
    folder_.file("odd.toml", "kind = \"trace\"\n[settings]\ntrace = \"a.din\"\nshare = 0.5\n[knobs]\n"
                             "method = [\"exact\", \"lines\", \"sets\"]\nways = [0, 4]\n");
    EXPECT_EQ(tool("study odd.toml -o s --quiet").code, 0);
    int failed = 0;
    const nlohmann::json study = json("s/study.json");
    for (const nlohmann::json& point : study["points"])
        failed += point["state"] == "failed" ? 1 : 0;
    EXPECT_EQ(failed, 2); // lines of four ways, sets of a fully associative cache
    const std::pair<const char*, const char*> cases[] = {
        {"kind = \"trace\"\n[settings]\ntrace = \"a.din\"\n[knobs]\nshar = [1]\n",
         "bad.toml:5:9: unknown setting shar; did you mean share?"},
        {"kind = \"trace\"\n[knobs]\nshare = [2]\n", "share = 2.0 is not possible"},
        {"kind = \"trace\"\n[knobs]\nmethod = [\"exact\"]\n", "a point has no trace; write trace"},
        {"kind = \"trace\"\n[settings]\ntrace = \"none\"\n[knobs]\nmethod = [\"exact\"]\n",
         "bad.toml:3:9: there is no trace none"},
        {"kind = \"trace\"\n[settings]\ntrace = \"a.din\"\n[knobs]\nmethod = [\"exact\"]\n[reference]\nways "
         "= 4\n",
         "leave out [reference]"},
        {"kind = \"image\"\n[knobs]\nsamples = [1]\n", "use the program that measures others"},
    };
    for (const auto& [bad, says] : cases) {
        SCOPED_TRACE(bad);
        folder_.file("bad.toml", bad);
        const Outcome result = tool("study bad.toml -o b");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "b"));
    }
}

/// Of a trace that stands in for theirs.
TEST_F(TraceStudy, ShippedOnesCanBeMeasured) {
    std::filesystem::create_directories(folder_ / "configs/studies");
    std::filesystem::create_directories(folder_ / "out");
    ASSERT_EQ(tool("convert a.din out/frame.rzt").code, 0);
    ASSERT_EQ(tool("convert a.din out/frame-full.rzt").code, 0);
    int found = 0;
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/studies")) {
        std::ifstream in(entry.path());
        const std::string shipped{std::istreambuf_iterator<char>(in), {}};
        if (shipped.find("kind = \"trace\"") == std::string::npos)
            continue;
        ++found;
        const std::string name = "configs/studies/" + entry.path().filename().string();
        folder_.file(name.c_str(), shipped);
        for (const char* size : {"", " --full"}) {
            const Outcome plan = tool("study " + name + " --plan -o p" + size);
            EXPECT_EQ(plan.code, 0) << plan.err;
            EXPECT_EQ(plan.out.find("impossible"), std::string::npos) << plan.out;
        }
    }
    EXPECT_GT(found, 0);
}

} // namespace
} // namespace razor
