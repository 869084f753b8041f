// razor-sim run --sharing: beside the trace of the same run, by sets of lines and by razor-trace's own
// analysis.
#include "analysis/traces/line_use.h"
#include "tests/program/simulator.h"
#include "traces/reader.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <sstream>

namespace razor {
namespace {

class LineSharing : public Simulator {
protected:
    LineSharing() { folder_.file("s.toml", "[[mesh]]\nshape = \"urchin\"\n"); }
    const std::string frame_ = "run --scene s.toml --quiet --no-native --no-calibration --size 24x16 --spp 1 "
                               "--light-samples 1 --machine " +
                               tiny + " -g chip.threads=1 -g chip.tiles=2 ";

    /// What is known of a line by the trace.
    struct Line {
        std::string structure;
        std::set<std::uint32_t> cores, early; // ... before a cycle
        bool written = false;
        std::map<std::uint64_t, std::set<std::uint32_t>> readers; // of each byte
    };
    std::map<std::uint64_t, Line> lines(std::uint64_t before, std::set<std::string>& shared) const {
        traces::Reader reader(traces::open_source(folder_ / "a.rzt"));
        std::map<std::uint64_t, Line> out;
        std::map<std::uint64_t, std::uint64_t> first;
        traces::Block block;
        while (reader.next(block)) {
            const traces::Description& d = reader.description();
            for (const traces::Segment& s : block.segments)
                for (std::size_t i = s.begin; i < s.end; ++i) {
                    const traces::Class& c = block.what(i);
                    const bool modifies = c.kind == traces::Kind::modify;
                    // Of shared words, writes take copies away.
                    if (modifies || c.kind == traces::Kind::invalidate ||
                        c.kind == traces::Kind::invalidate_all)
                        shared.insert(d.structures[c.structure]);
                    if (!modifies && c.kind != traces::Kind::read && c.kind != traces::Kind::write)
                        continue;
                    for (std::uint64_t at = block.addresses[i]; at < block.addresses[i] + c.size; ++at) {
                        Line& line = out[at / 64];
                        line.structure = d.structures[c.structure];
                        line.cores.insert(s.stream);
                        if (block.times[i] < before)
                            line.early.insert(s.stream);
                        line.written |= c.kind != traces::Kind::read;
                        if (c.kind != traces::Kind::write)
                            line.readers[at].insert(s.stream);
                    }
                }
        }
        EXPECT_TRUE(reader.complete()) << reader.note();
        return out;
    }
};

void add(std::vector<std::uint64_t>& by, std::size_t n, std::uint64_t one) {
    if (by.size() < n)
        by.resize(n);
    by[n - 1] += one;
}

TEST_F(LineSharing, SaysWhatTheTraceOfTheRunSays) {
    // L1s that lose nothing but lines of shared words, looked at once, late in the run.
    const std::string large = frame_ + "-g l1.size_bytes=4194304 -g l2.size_bytes=8388608 ";
    ASSERT_EQ(simulator(large + "--trace a.rzt --json t.json").code, 0);
    const nlohmann::json traced = report("t.json");
    const auto interval = static_cast<std::uint64_t>(0.9 * traced.at("cycles").get<double>());
    const Outcome outcome =
        simulator(large + "--sharing --sharing-interval " + std::to_string(interval) + " --json a.json");
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    nlohmann::json r = report("a.json");
    const nlohmann::json sharing = r.at("sharing");
    r.erase("sharing");
    EXPECT_EQ(r, traced) << "looking changes nothing";
    ASSERT_EQ(sharing.at("looks"), 1);
    EXPECT_NE(outcome.out.find("shared lines"), std::string::npos);

    const auto window = r.at("window_cycles").get<std::uint64_t>();
    std::set<std::string> words; // structures with shared words
    const auto all = lines((interval + window - 1) / window * window, words);
    struct Structure {
        std::vector<std::uint64_t> by, written, held;
        std::uint64_t lines = 0, read = 0, several = 0;
    };
    std::map<std::string, Structure> expected;
    std::map<std::uint32_t, std::array<std::uint64_t, 2>> cores;
    for (const auto& [number, line] : all) {
        Structure& s = expected[line.structure];
        ++s.lines;
        add(s.by, line.cores.size(), 1);
        add(s.written, line.cores.size(), line.written ? 1 : 0);
        if (!line.early.empty())
            add(s.held, line.early.size(), 1);
        s.read += line.readers.size();
        for (const auto& [byte, readers] : line.readers)
            s.several += readers.size() > 1 ? 1 : 0;
        for (const std::uint32_t core : line.cores) {
            ++cores[core][0];
            cores[core][1] += line.cores.size() == 1 ? 1 : 0;
        }
    }
    std::uint64_t shared = 0;
    ASSERT_EQ(sharing.at("structures").size(), expected.size());
    for (const nlohmann::json& row : sharing.at("structures")) {
        const std::string name = row.at("structure");
        SCOPED_TRACE(name);
        const Structure& s = expected[name];
        EXPECT_EQ(row.at("lines"), s.lines);
        EXPECT_EQ(row.at("by_cores"), nlohmann::json(s.by));
        EXPECT_EQ(row.at("written_by_cores"), nlohmann::json(s.written));
        EXPECT_EQ(row.at("bytes_read"), s.read);
        EXPECT_EQ(row.at("bytes_read_by_several"), s.several);
        shared += s.several;
    }
    EXPECT_GT(shared, 1000U) << "nothing is shared here";
    std::map<std::string, std::uint64_t> touched;
    for (const nlohmann::json& row : r.at("touched_lines"))
        touched[row.at("structure")] += row.at("lines").get<std::uint64_t>();
    for (const auto& [name, lines] : touched)
        if (!words.contains(name)) {
            EXPECT_EQ(expected[name].lines, lines) << name;
        }
    for (const nlohmann::json& row : sharing.at("cores")) {
        EXPECT_EQ(row.at("lines"), cores[row.at("core")][0]);
        EXPECT_EQ(row.at("alone"), cores[row.at("core")][1]);
    }
    std::size_t compared = 0;
    for (const nlohmann::json& row : sharing.at("held")) {
        const std::string name = row.at("structure");
        if (row.at("level") != "l1" || words.contains(name))
            continue;
        SCOPED_TRACE(name);
        const std::vector<double> held(expected[name].held.begin(), expected[name].held.end());
        EXPECT_EQ(row.at("by_caches"), nlohmann::json(held));
        ++compared;
    }
    EXPECT_GE(compared, 3U);
}

// ... and razor-trace's analysis, which counts threads: one a core here.
TEST_F(LineSharing, AgreesWithFootprintsOfTraces) {
    ASSERT_EQ(simulator(frame_ + "--trace a.rzt").code, 0);
    ASSERT_EQ(simulator(frame_ + "--sharing --json a.json").code, 0);
    traces::Reader reader(traces::open_source(folder_ / "a.rzt"));
    analysis::LineUse use(64);
    analysis::Touches touches(6, {true, true, true}, analysis::By::structure);
    std::map<std::string, std::map<std::uint64_t, std::array<std::uint64_t, 2>>> expected, found;
    traces::Block block;
    while (reader.next(block))
        touches.each(block, [&](const analysis::Touch& t) { use.touch(t); });
    for (const analysis::LineUse::Shared& s : use.shared())
        expected[touches.name(s.group, reader.description())][s.threads] = {s.lines, s.written};
    const nlohmann::json r = report("a.json");
    for (const nlohmann::json& row : r.at("sharing").at("structures"))
        for (std::size_t k = 0; k < row.at("by_cores").size(); ++k)
            if (row.at("by_cores")[k] != 0)
                found[row.at("structure")][k + 1] = {row.at("by_cores")[k], row.at("written_by_cores")[k]};
    EXPECT_EQ(found, expected);
}

TEST_F(LineSharing, RefusesMistakesWithOneLine) {
    const std::pair<const char*, const char*> wrong[] = {
        {"--sharing-interval 5000", "of no use without --sharing"},
        {"--sharing --sharing-interval 5", "from 1000"},
        {"--sharing --trace a.rzt", "give them to runs of their own"},
        {"--sharing --estimate sample:0.1", "leave out --sharing"},
        {"--sharing --estimate closed-form", "leave out --sharing"},
    };
    for (const auto& [options, says] : wrong) {
        SCOPED_TRACE(options);
        const Outcome result = simulator(frame_ + options + " --json b.json");
        EXPECT_EQ(result.code, 2);
        EXPECT_EQ(result.error_lines(), 1) << result.err;
        EXPECT_NE(result.err.find(says), std::string::npos) << result.err;
        EXPECT_FALSE(std::filesystem::exists(folder_ / "b.json"));
    }
}

// Every figure of the report's object has its line of meaning, and no other has.
TEST_F(LineSharing, ExplainsItsFigures) {
    ASSERT_EQ(simulator(frame_ + "--sharing --sharing-interval 10000 --json a.json").code, 0);
    std::set<std::string> figures;
    const std::function<void(const nlohmann::json&, const std::string&)> collect =
        [&](const nlohmann::json& node, const std::string& path) {
            if (node.is_object())
                for (const auto& [name, value] : node.items())
                    collect(value, path + "." + name);
            else if (node.is_array())
                for (const nlohmann::json& value : node)
                    collect(value, path + "[]");
            else
                figures.insert(path);
        };
    collect(report("a.json").at("sharing"), "sharing");
    const Outcome explained = simulator("explain sharing");
    ASSERT_EQ(explained.code, 0) << explained.err;
    std::set<std::string> told;
    std::istringstream rows(explained.out);
    for (std::string row; std::getline(rows, row);)
        told.insert(row.substr(0, row.find_first_of(" :")));
    EXPECT_EQ(told, figures);
}

} // namespace
} // namespace razor
