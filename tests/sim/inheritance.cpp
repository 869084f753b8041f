// Layers of machine files, and where every value of a machine comes from.
#include "sim/config/origin.h"
#include "sim/config/parameters.h"
#include "tests/scene/temporary_folder.h"
#include "tests/sim/machines.h"

#include <fmt/core.h>

namespace sim::test {
namespace {

using razor::TemporaryFolder;

std::string error_of(const std::string& file) {
    try {
        read_machine(file);
    } catch (const ConfigError& e) {
        EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos);
        return e.what();
    }
    return "";
}

const Origin& origin_of(const MachineDescription& machine, std::string_view key) {
    return machine.origins[static_cast<std::size_t>(find_parameter(key) - parameters().data())];
}

TEST(Inheritance, LaterLayersWin) {
    const TemporaryFolder folder;
    std::filesystem::create_directory(folder / "base");
    folder.file("base/root.toml", "[chip]\ncores = 16\nthreads = 4\n[l1]\nmshrs = 3\n");
    folder.file("base/middle.toml", "inherit = \"root.toml\"\n[chip]\nthreads = 8 # assumed: two more\n");
    folder.file("other.toml", "[l1]\nmshrs = 5\nports = 2\n");
    const std::string top =
        folder.file("top.toml", "[l1]\nports = 4\n[core]\nlanes=16\n").string(); // inherits nothing yet
    EXPECT_EQ(read_machine(top).chip.cores, Config().chip.cores);
    folder.file("top.toml", "inherit = [\"base/middle.toml\", \"other.toml\"]\n"
                            "[l1]\nports = 4\n[core]\nlanes=16\n");
    const MachineDescription m = describe_machine(top, {"core.lanes=32", "core.window=2", "core.window=3"});
    EXPECT_EQ(m.name, "top.toml");
    EXPECT_EQ(m.config.chip.cores, 16);
    EXPECT_EQ(m.config.chip.threads, 8);
    EXPECT_EQ(m.config.l1.mshrs, 5);
    EXPECT_EQ(m.config.l1.ports, 4);
    EXPECT_EQ(m.config.core.lanes, 32);
    EXPECT_EQ(m.config.core.window, 3);
    EXPECT_EQ(origin_of(m, "chip.cores").place(), "base/root.toml:2");
    EXPECT_EQ(origin_of(m, "chip.threads").place(), "base/middle.toml:3");
    EXPECT_EQ(origin_of(m, "chip.threads").comment, "assumed: two more");
    EXPECT_EQ(origin_of(m, "l1.mshrs").place(), "other.toml:2");
    EXPECT_EQ(origin_of(m, "l1.ports").place(), "top.toml:3");
    EXPECT_EQ(origin_of(m, "core.lanes").place(), "-g");
    EXPECT_EQ(origin_of(m, "core.issue_width").place(), "default");
}

TEST(Inheritance, FromOneFileTwiceIsNoCircle) {
    const TemporaryFolder folder;
    folder.file("root.toml", "[chip]\ncores = 16\n");
    folder.file("a.toml", "inherit = \"root.toml\"\n[chip]\nthreads = 8\n");
    folder.file("b.toml", "inherit = \"root.toml\"\n[l1]\nports = 2\n");
    const Config c = read_machine(folder.file("c.toml", "inherit = [\"a.toml\", \"b.toml\"]\n").string());
    EXPECT_EQ(c.chip.cores, 16);
    EXPECT_EQ(c.chip.threads, 8);
    EXPECT_EQ(c.l1.ports, 2);
}

TEST(Inheritance, MistakesAreOneClearLine) {
    const TemporaryFolder folder;
    const auto in = [&](const char* name) { return (folder / name).string(); };
    folder.file("self.toml", "\ninherit = \"self.toml\"\n");
    EXPECT_EQ(error_of(in("self.toml")),
              in("self.toml") +
                  ":2:11: files inherit from each other in a circle, self.toml -> self.toml; take "
                  "one `inherit` out");
    folder.file("a.toml", "inherit = \"b.toml\"\n");
    folder.file("b.toml", "inherit = \"../" + folder.path().filename().string() + "/c.toml\"\n");
    folder.file("c.toml", "inherit = \"./a.toml\"\n");
    EXPECT_NE(error_of(in("a.toml"))
                  .find("c.toml:1:11: files inherit from each other in a circle, a.toml -> "
                        "b.toml -> c.toml -> a.toml"),
              std::string::npos)
        << error_of(in("a.toml"));
    std::filesystem::create_directory(folder / "folder");
    folder.file("empty.toml", " \n");
    const std::pair<const char*, const char*> parents[] = {
        {"none.toml", "none.toml, which cannot be read"},
        {"folder", "folder, which is a folder"},
        {"empty.toml", "empty.toml, which is empty"},
    };
    for (const auto& [parent, says] : parents) {
        const std::string e =
            error_of(folder.file("child.toml", std::string("inherit = \"") + parent + "\"\n").string());
        EXPECT_EQ(e.rfind(in("child.toml") + ":1:11: inherits ", 0), 0U) << e;
        EXPECT_NE(e.find(says), std::string::npos) << e;
    }
    // A mistake of a parent is said of the parent.
    folder.file("wrong.toml", "[chip]\ncores = 0\n");
    EXPECT_EQ(error_of(folder.file("child.toml", "inherit = \"wrong.toml\"\n").string())
                  .rfind(in("wrong.toml") + ":2:9: chip.cores is 0", 0),
              0U);
    // A long chain, and a tree of files that are read again and again.
    for (int i = 0; i < 70; ++i)
        folder.file(fmt::format("f{}.toml", i), fmt::format("inherit = \"f{}.toml\"\n", i + 1));
    folder.file("f70.toml", "[chip]\ncores = 2\n");
    EXPECT_NE(error_of(in("f0.toml")).find("more than 64 files"), std::string::npos);
    EXPECT_EQ(read_machine(in("f30.toml")).chip.cores, 2);
    for (int i = 0; i < 12; ++i)
        folder.file(fmt::format("t{}.toml", i),
                    fmt::format("inherit = [\"t{0}.toml\", \"t{0}.toml\"]\n", i + 1));
    folder.file("t12.toml", "[chip]\ncores = 2\n");
    EXPECT_NE(error_of(in("t0.toml")).find("more than 64 files"), std::string::npos);
}

TEST(Inheritance, WhatIsNoMachineFile) {
    const TemporaryFolder folder;
    EXPECT_NE(error_of(folder.path().string()).find("is a folder"), std::string::npos);
    EXPECT_NE(error_of((folder / "none.toml").string()).find("cannot be read"), std::string::npos);
    EXPECT_NE(error_of(folder.file("a.toml", "").string()).find("is empty"), std::string::npos);
    EXPECT_NE(error_of(folder.file("b.toml", std::string(2 << 20, '#')).string()).find("is larger"),
              std::string::npos);
    EXPECT_NE(error_of(folder.file("c.toml", std::string("\0\1\2", 3)).string()).find("not TOML"),
              std::string::npos);
    EXPECT_NE(error_of("/dev/zero").find("is larger"), std::string::npos);
}

TEST(Marks, AreReadFromComments) {
    const auto is = [](const char* comment, Mark::Kind kind, const char* source, const char* remark) {
        const Mark mark = read_mark(comment);
        EXPECT_EQ(mark.kind, kind) << comment;
        EXPECT_EQ(mark.source, source) << comment;
        EXPECT_EQ(mark.remark, remark) << comment;
    };
    is("assumed", Mark::assumed, "", "");
    is("assumed: 1 GHz", Mark::assumed, "", "1 GHz");
    is("known (Nobody 1999, table 2)", Mark::known, "Nobody 1999, table 2", "");
    is("known (a (b) c): why: so", Mark::known, "a (b) c", "why: so");
    for (const char* none : {"", "known", "known: yes", "known ()", "known ( )", "known (a", "known (a) b",
                             "assumedly", "assumed 1 GHz", "unknown (a)", "Assumed"})
        is(none, Mark::none, "", none);
    EXPECT_EQ(comment_behind("a = \"#\"  # b # c ", 7), "b # c");
    EXPECT_EQ(comment_behind("a = 1", 5), "");
}

// A key that sets others stands for them until something sets them by themselves.
TEST(Inheritance, PresetsAreWhereTheirValuesComeFrom) {
    const TemporaryFolder folder;
    folder.file("root.toml", "[memory]\ntRCD = 33\nchannels = 4\n");
    const std::string top = folder
                                .file("top.toml", "inherit = \"root.toml\"\n[memory]\nchannels = 2\npreset = "
                                                  "\"hbm2\" # known (JESD235A): two words\n")
                                .string();
    const MachineDescription m = describe_machine(top, {"memory.banks=8"});
    EXPECT_EQ(m.config.memory.channels, 2);
    EXPECT_EQ(m.config.memory.banks, 8);
    EXPECT_NE(m.config.memory.tRCD, 33);
    EXPECT_EQ(origin_of(m, "memory.channels").place(), "top.toml:3");
    EXPECT_EQ(origin_of(m, "memory.tRCD").place(), "top.toml:4");
    EXPECT_EQ(origin_of(m, "memory.tRCD").comment, "known (JESD235A): two words");
    EXPECT_EQ(origin_of(m, "memory.banks").place(), "-g");
    EXPECT_EQ(origin_of(m, "memory.controller_cycles").place(), "default");
    const MachineDescription again = describe_machine_text(print_machine(m), "again.toml");
    EXPECT_EQ(print_machine(again.config), print_machine(m.config));
    EXPECT_EQ(origin_of(describe_machine(top, {"memory.banks=8", "memory.preset=ddr4-2400r"}), "memory.tRCD")
                  .place(),
              "-g");
}

// What is printed is a machine file of the same values and marks; only the places are new.
TEST(Printing, RoundTripsValuesAndMarks) {
    const TemporaryFolder folder;
    folder.file("root.toml", "[chip]\ncores = 16 # known (a, b): c\n");
    const std::string top =
        folder
            .file("top.toml",
                  "inherit = \"root.toml\"\n[chip]\nthreads = 8 # assumed: d\n[core]\npredictor = \"none\"\n")
            .string();
    const MachineDescription first =
        describe_machine(top, {"core.scalar_overhead=0.1", "l2.size_bytes=1048576", "kdtree.share=3"});
    const std::string printed = print_machine(first);
    EXPECT_NE(printed.find("from: top.toml:3\nthreads = 8 "), std::string::npos) << printed;
    EXPECT_NE(printed.find("from: -g\nsize_bytes = 1048576\n"), std::string::npos) << printed;
    EXPECT_NE(printed.find("from: default\nissue_width = 1\n"), std::string::npos) << printed;
    const MachineDescription again = describe_machine(folder.file("printed.toml", printed).string());
    for (std::size_t i = 0; i < parameters().size(); ++i) {
        const Parameter& p = parameters()[i];
        EXPECT_EQ(print_value(p, again.config), print_value(p, first.config)) << p.key;
        EXPECT_EQ(again.origins[i].comment, first.origins[i].comment) << p.key;
        if (!applies(parameters()[i], again.config))
            continue;
        EXPECT_EQ(again.origins[i].layer, Origin::file) << p.key;
    }
    EXPECT_EQ(print_machine(again.config), print_machine(first.config));
}

// What is printed may lie in another folder than the file that names its calibration.
TEST(Printing, KeepsTheCalibration) {
    const TemporaryFolder folder;
    std::filesystem::create_directories(folder / "a \"b\" \\c");
    std::filesystem::create_directories(folder / "else where");
    folder.file("root.toml", "calibration = \"a \\\"b\\\" \\\\c/counts.json\"\n[chip]\ncores = 16\n");
    const MachineDescription first =
        describe_machine(folder.file("top.toml", "inherit = \"root.toml\"\n").string());
    const MachineDescription again =
        describe_machine(folder.file("else where/printed.toml", print_machine(first)).string());
    EXPECT_EQ(again.calibration, (folder / "a \"b\" \\c/counts.json").string());
    EXPECT_EQ(print_machine(again.config), print_machine(first.config));
    EXPECT_EQ(print_machine(first.config).find("calibration ="), std::string::npos);
}

} // namespace
} // namespace sim::test
