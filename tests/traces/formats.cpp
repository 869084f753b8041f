// Other formats of traces: each reads what it wrote and what its own tool writes, keeps what it holds,
// refuses what it is not by one line, and a conversion says what is lost.
#include "tests/traces/samples.h"
#include "traces/convert.h"
#include "traces/error.h"
#include "traces/in_time.h"
#include "traces/io/interrupt.h"
#include "traces/summary.h"
#include "traces/writer.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <map>

namespace traces {
namespace {

/// What a format says of bytes: all references in order of time.
std::vector<Reference> read_as(const char* format, const std::string& bytes,
                               Description* description = nullptr) {
    const auto input = format_by_name("--from", format).read(memory_source(bytes, "sample"));
    std::vector<Reference> out;
    for (Block block; input->next(block);)
        each_in_time(block, [&](const Segment& s, std::size_t i) {
            out.push_back({block.times[i], block.addresses[i], s.stream, block.what(i)});
        });
    if (description != nullptr)
        *description = input->description();
    return out;
}

struct Converted {
    std::string bytes, lost;
};
Converted converted(const char* from, const std::string& bytes, const char* to) {
    Converted out;
    const auto input = format_by_name("--from", from).read(memory_source(bytes, "sample"));
    const Format& target = format_by_name("--to", to);
    const auto output = target.write(memory_sink(out.bytes));
    Conversion conversion(*input, *output, target.holds);
    while (conversion.step()) {
    }
    output->finish();
    out.lost = conversion.lost();
    return out;
}

/// A trace of ours with all kinds, extremes, and several streams, in order of time.
std::string own_trace(std::vector<Reference>& references) {
    Description d = test::small_description();
    for (int i = 0; i < 9; ++i)
        d.sites.push_back("file " + std::to_string(i) + ", \"x\":" + std::to_string(i));
    references = test::mixed_references(3000, 5);
    std::uint64_t time = 0;
    std::string bytes;
    const auto output = write_own(memory_sink(bytes));
    output->describe(d);
    for (Reference& r : references) {
        r.time = ++time;
        output->write(r);
    }
    output->finish();
    return bytes;
}

TEST(TraceFormats, WhatAFormatHoldsComesBack) {
    std::vector<Reference> all;
    const std::string own = own_trace(all);
    for (const Format& f : formats()) {
        SCOPED_TRACE(f.name);
        const std::string name(f.name);
        const std::string there = converted("rzt", own, name.c_str()).bytes;
        Description back_description;
        const std::vector<Reference> back = read_as(name.c_str(), there, &back_description);
        std::vector<Reference> expected;
        for (Reference r : all) {
            const Holds& holds = f.holds;
            std::vector<Kind> kinds = {r.what.kind};
            if (!holds.holds(r.what.kind)) {
                const bool writes = holds.holds(Kind::write);
                if (r.what.kind == Kind::modify)
                    kinds = writes ? std::vector{Kind::read, Kind::write} : std::vector{Kind::read};
                else if (r.what.kind == Kind::write_back || r.what.kind == Kind::write_through ||
                         r.what.kind == Kind::write)
                    kinds = {writes ? Kind::write : Kind::read};
                else
                    kinds = {};
            }
            for (const Kind kind : kinds) {
                r.what.kind = kind;
                expected.push_back(r);
            }
        }
        ASSERT_EQ(back.size(), expected.size());
        for (std::size_t i = 0; i < back.size(); ++i) {
            const Reference &b = back[i], &e = expected[i];
            ASSERT_EQ(b.address, e.address) << i;
            ASSERT_EQ(b.what.kind, e.what.kind) << i;
            ASSERT_EQ(b.time, f.holds.time ? e.time : i) << i;
            ASSERT_EQ(b.stream, f.holds.streams ? e.stream : 0) << i;
            ASSERT_EQ(b.what.size, f.holds.size ? e.what.size : 0) << i;
            if (f.holds.names && name != "csv") {
                ASSERT_TRUE(b.what == e.what) << i;
            }
            ASSERT_EQ(b.what.part, f.holds.parts ? e.what.part : Part::operation) << i;
            ASSERT_EQ(b.what.detail, f.holds.parts ? e.what.detail : 0) << i;
            if (name == "csv") { // numbers as names come up
                const Description d = test::small_description();
                ASSERT_EQ(back_description.structures[b.what.structure], d.structures[e.what.structure]) << i;
                ASSERT_EQ(back_description.phases[b.what.phase], d.phases[e.what.phase]) << i;
                ASSERT_EQ(back_description.work[b.what.work], d.work[e.what.work]) << i;
            }
            if (name == "csv" && e.what.site != 0) {
                ASSERT_EQ(back_description.sites[b.what.site - 1],
                          "file " + std::to_string(e.what.site - 1) +
                              ", \"x\":" + std::to_string(e.what.site - 1));
            }
            if (name == "drmemtrace" && e.what.kind != Kind::fetch) {
                ASSERT_EQ(b.what.site, e.what.site == 0 ? 0 : 0x400000 + 4 * e.what.site) << i;
            }
            if (name == "champsim") {
                ASSERT_EQ(b.what.site, 0x400000 + 4 * e.what.site) << i;
            }
        }
        // What was lost once is not lost twice.
        const Converted again = converted(name.c_str(), there, name.c_str());
        EXPECT_TRUE(again.bytes == there);
        EXPECT_EQ(again.lost, name == "champsim" ? "times are lost" : ""); // an instruction for each
    }
}

/// In which order streams went on, in which windows, and when all was over, also where that is all that a
/// block's worth of references leaves to say.
TEST(TraceFormats, OwnTracesKeepTheirOrder) {
    const auto turns = [](const std::string& bytes) { // of references: the stream
        const auto input = read_own(memory_source(bytes, "own"));
        std::vector<Turn> out;
        for (Block block; input->next(block);)
            for (Turn t : block.order) {
                if (t.what == Turn::What::references)
                    t.segment = block.segments[t.segment].stream;
                if (!out.empty() && t.what == Turn::What::references && out.back().what == t.what &&
                    out.back().segment == t.segment)
                    out.back().count += t.count; // between two blocks
                else
                    out.push_back(t);
            }
        return out;
    };
    for (const std::size_t n : {std::size_t{3000}, std::size_t{1} << 18U}) {
        const std::vector<Reference> all = test::mixed_references(n, 6);
        std::string own;
        Description d = test::small_description();
        d.sites.clear();
        Writer writer(memory_sink(own), d);
        writer.add_sites({"1", "2", "3", "4", "5", "6", "7", "8", "9"});
        BlockBuilder builder;
        for (std::size_t i = 0; i < n; ++i) {
            if (i % 70 == 0)
                builder.mark({Turn::What::window, 0, 0, 1100 + 2 * i, 1000 + 2 * i});
            builder.add(all[i]);
        }
        builder.mark({Turn::What::end, 0, 0, 7 * n, 3 * n});
        Block block;
        builder.take(block);
        writer.write(block);
        writer.finish();
        const Converted again = converted("rzt", own, "rzt");
        EXPECT_EQ(again.lost, "");
        const std::vector<Turn> before = turns(own), after = turns(again.bytes);
        EXPECT_GT(before.size(), n / 2);
        EXPECT_EQ(after.size(), before.size());
        EXPECT_TRUE(after == before);
        EXPECT_NE(converted("rzt", own, "csv").lost.find("the order of streams and its windows, "),
                  std::string::npos);
    }
}

TEST(TraceFormats, SaysWhatATargetCannotHold) {
    std::vector<Reference> all;
    const std::string own = own_trace(all);
    std::map<Kind, int> count;
    for (const Reference& r : all)
        ++count[r.what.kind];
    const std::string lost = converted("rzt", own, "din").lost;
    EXPECT_EQ(lost.find("times, threads, sites, structures, phases and work, operations and details, "), 0U)
        << lost;
    EXPECT_NE(
        lost.find(std::to_string(count[Kind::modify]) + " modify references are a read and a write each"),
        std::string::npos)
        << lost;
    EXPECT_NE(lost.find(std::to_string(count[Kind::flush]) + " flush references are left out"),
              std::string::npos);
    EXPECT_EQ(lost.find("sizes"), std::string::npos) << lost;
    EXPECT_EQ(lost.find('\n'), std::string::npos);
    EXPECT_EQ(converted("rzt", own, "csv").lost,
              "level, line size, program, configuration, regions are lost");
    EXPECT_EQ(converted("rzt", own, "rzt").lost, "");
}

TEST(TraceFormats, ReadsWhatOtherToolsWrite) {
    struct Case {
        const char *format, *text;
        std::vector<Reference> references;
    };
    const Case cases[] = {
        {"din",
         "2 7fbb 3\n1 0x10\nr 20 4\n\nc 40 8\r\nv 80",
         {{0, 0x7fbb, 0, {.size = 3, .kind = Kind::fetch}},
          {1, 0x10, 0, {.kind = Kind::write}},
          {2, 0x20, 0, {.size = 4}},
          {3, 0x40, 0, {.size = 8, .kind = Kind::write_back}},
          {4, 0x80, 0, {.kind = Kind::flush}}}},
        {"lackey",
         "==12== Lackey\n==12== \nI  04016a80,3\n L 1ffeffe7e8,16\n S 10,8\n M 20,4\n==12== end\n",
         {{0, 0x4016a80, 0, {.size = 3, .kind = Kind::fetch}},
          {1, 0x1ffeffe7e8, 0, {.size = 16}},
          {2, 0x10, 0, {.size = 8, .kind = Kind::write}},
          {3, 0x20, 0, {.size = 4, .kind = Kind::modify}}}},
        {"csv",
         "kind,address,note,size\nwrite,0x40,\"a, \"\"b\"\"\",8\nfetch,80,,2\n",
         {{0, 0x40, 0, {.size = 8, .kind = Kind::write}}, {1, 0x80, 0, {.size = 2, .kind = Kind::fetch}}}},
        {"csv",
         "\xef\xbb\xbf"
         "address,kind\n40,write\n",
         {{0, 0x40, 0, {.kind = Kind::write}}}},
        {"csv", "\xef\xbb\xbf\"address\"\n40\n", {{0, 0x40, 0, {}}}},
        {"dramsim3",
         "0x12340 READ 5\n0x40 WRITE 17\n",
         {{5, 0x12340, 0, {}}, {17, 0x40, 0, {.kind = Kind::write}}}},
        {"drmemtrace",
         "Output format:\n"
         "<--record#-> <--instr#->: <---tid---> <record details>\n"
         "------------------------------------------------------------\n"
         "           1           0:     2765542 <marker: version 5>\n"
         "------------------------------------------------------------\n"
         "       47742       37769:     2765543 ifetch       6 byte(s) @ 0x0000000000404a78 0f 84 5b 01 00 "
         "00    "
         "jz     $0x0000000000404bd9 (untaken)\n"
         "       47744       37770:     2765543 read         8 byte(s) @ 0x00007fdf64e2adc8 by PC "
         "0x0000000000404a7e\n"
         "          69          49:     W2.T292 ifetch       9 byte(s) @ 0x0000000000401000 0f 84 5b 01 00 "
         "00 11 22\n"
         "                                   d9                jnz    $0x000000000040100b\n"
         "          70          49:     W2.T292 write       16 byte(s) @ 0x0000000000000020 by PC "
         "0x0000000000401000\n"
         "          71          49:     W2.T292 pref-r-L1    0 byte(s) @ 0x0000000000000040 by PC "
         "0x0000000000401000\n"
         "          72          49:     W2.T292 dflush      64 byte(s) @ 0x0000000000000080 by PC "
         "0x0000000000401000\n"
         "          73          49:     W2.T292 <thread 292 exited>\n"
         "View tool results:\n"
         "              49 : total disassembled instructions\n",
         {{0, 0x404a78, 2765543, {.size = 6, .kind = Kind::fetch}},
          {1, 0x7fdf64e2adc8, 2765543, {.site = 0x404a7e, .size = 8}},
          {2, 0x401000, (2U << 24U) + 292, {.size = 9, .kind = Kind::fetch}},
          {3, 0x20, (2U << 24U) + 292, {.site = 0x401000, .size = 16, .kind = Kind::write}},
          {4, 0x40, (2U << 24U) + 292, {.site = 0x401000, .kind = Kind::prefetch}}}},
        {"ramulator", "0x12340 R\n0x40 W\n", {{0, 0x12340, 0, {}}, {1, 0x40, 0, {.kind = Kind::write}}}},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.format);
        const std::vector<Reference> got = read_as(c.format, c.text);
        ASSERT_EQ(got.size(), c.references.size());
        for (std::size_t i = 0; i < got.size(); ++i)
            EXPECT_TRUE(test::equal(got[i], c.references[i])) << i;
    }
    std::string instruction(64, '\0'); // at 0x401000, reads 0x2000 and 0x3000, writes 0x4000
    instruction[1] = instruction[2] = 0x10;
    instruction[2] = 0x40;
    instruction[17] = 0x40;
    instruction[33] = 0x20;
    instruction[41] = 0x30;
    const std::vector<Reference> got = read_as("champsim", std::string(64, '\0') + instruction);
    ASSERT_EQ(got.size(), 3U);
    EXPECT_TRUE(test::equal(got[0], {1, 0x2000, 0, {.site = 0x401000}}));
    EXPECT_TRUE(test::equal(got[1], {1, 0x3000, 0, {.site = 0x401000}}));
    EXPECT_TRUE(test::equal(got[2], {1, 0x4000, 0, {.site = 0x401000, .kind = Kind::write}}));
}

/// Names that come up after the description and the first block was written.
TEST(TraceFormats, OwnTracesTakeNamesAsTheyCome) {
    std::string csv = "cycles,address,structure,phase,work,site\n";
    constexpr int rows = 300000; // of several blocks
    const auto row = [](int i) { return std::to_string(i / 1000); };
    for (int i = 0; i < rows; ++i)
        csv += std::to_string(i) + ",10,s" + row(i) + ",p" + row(i) + ",w" + row(i) + ",a" + row(i) + ":1\n";
    Description d;
    const std::vector<Reference> got = read_as("rzt", converted("csv", csv, "rzt").bytes, &d);
    ASSERT_EQ(got.size(), static_cast<std::size_t>(rows));
    for (int i = 0; i < rows; i += 997) {
        const Class& c = got[static_cast<std::size_t>(i)].what;
        ASSERT_EQ(d.structures[c.structure], "s" + row(i));
        ASSERT_EQ(d.phases[c.phase], "p" + row(i));
        ASSERT_EQ(d.work[c.work], "w" + row(i));
        ASSERT_EQ(d.sites[c.site - 1], "a" + row(i) + ":1");
    }
}

TEST(TraceFormats, OracleGeneralKnowsTheNextRequest) {
    const std::string written =
        converted("csv", "seconds,address,size\n3,5,512\n4,6,10\n9,5,512\n", "oraclegeneral").bytes;
    ASSERT_EQ(written.size(), 3 * 24U);
    const std::string first{"\3\0\0\0"
                            "\5\0\0\0\0\0\0\0"
                            "\0\2\0\0"
                            "\3\0\0\0\0\0\0\0",
                            24};
    EXPECT_EQ(written.substr(0, 24), first);
    for (const std::size_t last : {1U, 2U})
        EXPECT_EQ(written.substr(last * 24 + 16, 8), std::string(8, '\xFF'));
    EXPECT_THROW(converted("csv", "seconds,address,size\n4294967296,5,512\n", "oraclegeneral"), Error);
}

TEST(TraceFormats, RefusesByOneLineThatSaysWhere) {
    const std::string long_line(200000, 'x');
    struct Case {
        const char* format;
        std::string text, place, cause;
    };
    const Case cases[] = {
        {"din", "0 10 4\n7 10 4\n", "sample, line 2: ", "no label"},
        {"din", "0 10 4\n0 1g 4\n", "sample, line 2: ", "'1g' is no address"},
        {"din", "0 10000000000000000\n", "sample, line 1: ", "is no address"},
        {"din", "0\n", "sample, line 1: ", "'' is no address"},
        {"din", "0 10 4294967296\n", "sample, line 1: ", "is no size"},
        {"din", "0 10 -1\n", "sample, line 1: ", "'-1' is no size"},
        {"din", "0 10 4\n" + long_line, "sample, line 2: ", "64 KiB"},
        {"din", std::string("\x80\x01\n", 3), "sample, line 1: ", "no label"},
        {"lackey", "I  10,4\n X 10,4\n", "sample, line 2: ", "none of I, L, S, M"},
        {"lackey", " L 10\n", "sample, line 1: ", "'' is no size"},
        {"csv", "kind,size\nread,4\n", "sample, line 1: ", "no column address"},
        {"csv", "address,address\n", "sample, line 1: ", "twice"},
        {"csv", "cycles,address,order\n", "sample, line 1: ", "twice"},
        {"csv", "address,kind\n10,raed\n", "sample, line 2: ", "kind that there is not"},
        {"csv", "address,part\n10,half\n", "sample, line 2: ", "part that there is not"},
        {"csv", "address,detail\n10,x\n", "sample, line 2: ", "detail"},
        {"csv", "address,kind\n10\n", "sample, line 2: ", "1 fields instead of 2"},
        {"csv", "address,kind\n10,\"read\n", "sample, line 2: ", "without an end"},
        {"csv", "address,kind\n10,\"read\"s\n", "sample, line 2: ", "goes on behind a quotation"},
        {"dramsim3", "0x10 READ\n", "sample, line 1: ", "'' is no cycle"},
        {"dramsim3", "0x10 REED 3\n", "sample, line 1: ", "neither READ nor WRITE"},
        {"ramulator", "0x10\n", "sample, line 1: ", "neither READ nor WRITE"},
        {"champsim", std::string(100, '\0'), "sample, instruction 1: ", "36 of 64 bytes"},
        {"oraclegeneral", std::string(70, '\0'), "sample, request 3: ", "22 of 24 bytes"},
        {"champsim", std::string(64, '\7'), "sample, instruction 0: ", "neither that it branches"},
    };
    for (const Case& c : cases) {
        SCOPED_TRACE(c.text.substr(0, 40));
        try {
            read_as(c.format, c.text);
            ADD_FAILURE() << "was taken";
        } catch (const Error& e) {
            const std::string what = e.what();
            EXPECT_TRUE(what.starts_with(c.place)) << what;
            EXPECT_NE(what.find(c.cause), std::string::npos) << what;
            EXPECT_NE(what.find("; "), std::string::npos) << "no mend: " << what;
            EXPECT_EQ(what.find('\n'), std::string::npos);
            for (const char letter : what)
                EXPECT_TRUE(letter >= ' ' && letter <= '~');
        }
    }
}

TEST(TraceFormats, AreKnownByNameBeginningAndSuffix) {
    EXPECT_EQ(format_by_suffix("a.din.gz")->name, "din");
    EXPECT_EQ(format_by_suffix("x.champsimtrace.xz")->name, "champsim");
    EXPECT_EQ(format_by_suffix("x.oracleGeneral.bin.zst")->name, "oraclegeneral");
    EXPECT_EQ(format_by_suffix("a.gz"), nullptr);
    EXPECT_THROW(format_by_name("--from", "dine"), Error);
    std::vector<Reference> all;
    const auto own = memory_source(own_trace(all), "x.din");
    EXPECT_EQ(format_of_input("", "x.din", *own).name, "rzt");
    EXPECT_EQ(format_of_input("csv", "x.din", *own).name, "csv");
    EXPECT_EQ(format_of_input("", "x.csv", *memory_source("0 1\n", "x")).name, "csv");
    EXPECT_THROW(format_of_input("", "x", *memory_source("0 1\n", "x")), Error);
    EXPECT_THROW(format_of_output("", "-"), Error);
}

TEST(TraceFormats, ASummaryCountsEveryReferenceInEveryTable) {
    std::vector<Reference> all;
    const std::string own = own_trace(all);
    const auto input = read_own(memory_source(own, "x"));
    Summary summary;
    for (Block block; input->next(block);)
        summary.add(block);
    const nlohmann::json j =
        nlohmann::json::parse(summary.json(input->description(), {"x", "rzt", "", 6000}));
    EXPECT_EQ(j.at("references"), all.size());
    EXPECT_EQ(j.at("bytes_per_reference"), 2.0);
    EXPECT_EQ(j.at("times"), nlohmann::json::parse("[1, 3000]"));
    EXPECT_EQ(j.at("complete"), true);
    for (const char* table : {"threads", "structures", "phases", "work", "kinds"}) {
        std::uint64_t sum = 0;
        for (const auto& row : j.at(table))
            sum += row.at("references").get<std::uint64_t>();
        EXPECT_EQ(sum, all.size()) << table;
    }
    std::map<std::string, int> kinds, structures;
    const std::vector<std::string> names = test::small_description().structures;
    for (const Reference& r : all) {
        ++kinds[kind_names[static_cast<std::size_t>(r.what.kind)]];
        ++structures[names[r.what.structure]];
    }
    for (const auto& row : j.at("kinds"))
        EXPECT_EQ(row.at("references"), kinds[row.at("name")]);
    for (const auto& row : j.at("structures"))
        EXPECT_EQ(row.at("references"), structures[row.at("name")]);
}

/// Also within a block, which may take a compressor long.
TEST(TraceFormats, AConversionEndsWhereItIsAskedTo) {
    std::string din;
    for (int i = 0; i < 20000; ++i)
        din += "0 10 4\n";
    const auto input = format_by_name("--from", "din").read(memory_source(din, "sample"));
    const Format& target = format_by_name("--to", "csv");
    const std::string path = testing::TempDir() + "razor-interrupted.csv.xz";
    const auto output = target.write(open_sink(path));
    Conversion conversion(*input, *output, target.holds);
    interrupt_signal = 1;
    EXPECT_THROW(conversion.step(), Interrupted);
    interrupt_signal = 0;
    EXPECT_FALSE(std::filesystem::exists(path));
}

/// A real input, of an x86 program; through all formats that hold it.
TEST(TraceFormats, ARealTraceSurvives) {
    const std::string path = RAZOR_SHARED_SCENES "/traces/simple_app.din.gz";
    if (!std::filesystem::exists(path))
        GTEST_SKIP() << "no " << path;
    std::string text(std::size_t{1} << 23, '\0');
    text.resize(open_source(path)->read(text.data(), text.size()));
    const std::vector<Reference> original = read_as("din", text);
    EXPECT_EQ(original.size(), 179896U);
    std::string bytes = text;
    const char* at = "din";
    for (const char* next : {"rzt", "lackey", "csv", "rzt", "din"}) {
        const Converted c = converted(at, bytes, next);
        EXPECT_EQ(c.lost, "") << next;
        bytes = c.bytes;
        at = next;
        if (std::string(next) == "rzt") {
            EXPECT_LT(bytes.size(), 0.8 * static_cast<double>(original.size()));
        }
    }
    const std::vector<Reference> back = read_as("din", bytes);
    ASSERT_EQ(back.size(), original.size());
    for (std::size_t i = 0; i < back.size(); ++i)
        ASSERT_TRUE(test::equal(back[i], original[i])) << i;
}

} // namespace
} // namespace traces
