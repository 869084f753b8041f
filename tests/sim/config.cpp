// Machine files: what is refused, and how it is said; printing back.
#include "sim/config/parameters.h"
#include "tests/sim/machines.h"

namespace sim::test {
namespace {

std::string error_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
    try {
        parse_machine(text, "m.toml", overrides);
    } catch (const ConfigError& e) {
        return e.what();
    }
    return "";
}

TEST(MachineFile, MistakesAreOneClearLine) {
    struct Case {
        const char *text, *where, *says;
    };
    const Case cases[] = {
        {"[chip]\ncores = 0\n", "m.toml:2:9:", "must be from 1 to 1024"},
        {"[chip]\ncores = -3\n", "m.toml:2:9:", "must be from 1"},
        {"[chip]\ncores = 1.5\n", "m.toml:2:9:", "whole number"},
        {"[chip]\ncores = \"four\"\n", "m.toml:2:9:", "must be a number"},
        {"[chip]\ncores = true\n", "m.toml:2:9:", "chip.cores must be a number"},
        {"[chip]\ncores = [1]\n", "m.toml:2:9:", "chip.cores must be a number"},
        {"[core]\ngather = true\n", "m.toml:2:10:", "core.gather must be a word in quotes"},
        {"[l1]\nsize_bytes = \"9999999999 GiB\"\n",
         "m.toml:2:14:", "l1.size_bytes is \"9999999999 GiB\"; it must be from "},
        {"[chip]\ncors = 4\n", "m.toml:2:1:", "nearest known one is chip.cores"},
        {"[l1]\nsze = 4\n", "m.toml:2:1:", "nearest known one is l1.size_bytes"},
        {"[chipp]\ncores = 4\n", "m.toml:2:1:", "nearest known one is chip.cores"},
        {"cores = 4\n", "m.toml:1:1:", "keys stand in sections"},
        {"[core]\nlanes = 3\n", "m.toml:2:9:", "power of two"},
        {"[core]\npredictor = \"magic\"\n", "m.toml:2:13:", "must be one of \"counters\""},
        {"[core]\npredictor = 3\n", "m.toml:2:13:", "not a number"},
        {"[core]\nscalar_overhead = nan\n", "m.toml:2:19:", "must be from 0"},
        {"[l1]\nsize_bytes = 1000\n", "m.toml:", "do not divide"},
        {"[l1]\nsize_bytes = 12288\n", "m.toml:", "power of two"},
        {"[chip]\ncores = 1024\n[l1]\nsize_bytes = \"64MiB\"\n", "m.toml:", "lines together"},
        {"[l2]\nways = 12\nsize_bytes = 98304\nreplacement = \"plru\"\n", "m.toml:", "make it 8 or 16"},
        {"[l2]\nline_bytes = 32\n", "m.toml:", "(l1.line_bytes from default, l2.line_bytes from m.toml:2)"},
        {"[memory]\nbus_bytes = 16\n", "m.toml:", "more than l2.line_bytes"},
        {"[memory]\nrow_bytes = 1\n", "m.toml:2:13:", "must be from 64"},
        {"[memory]\ntREFI = 100\ntRFC = 90\n", "m.toml:", "between refreshes"},
        {"[memory]\nmapping = \"row\"\n", "m.toml:", "names rank without a number 0 times"},
        {"[chip\n", "m.toml:", "not TOML"},
        {"\x01\x02\xff", "m.toml:", "not TOML"},
        {"inherit = 3\n", "m.toml:1:11:", "in quotes"},
        {"inherit = \"no-such-file.toml\"\n",
         "m.toml:1:11:", "inherits no-such-file.toml, which cannot be read"},
        {"inherit = \"\"\n", "m.toml:1:11:", "name of a machine file"},
        {"inherit = [3, \"a.toml\"]\n", "m.toml:1:12:", "in quotes"},
        {"[core]\npredictor = \"a\\nb\"\n", "m.toml:2:13:", "a?b"},
        {"[chip]\ncores = 4\ncores = 5\n", "m.toml:3:9:", "not TOML"},
        {"[chip]\n[l1]\n[chip]\n", "m.toml:3:1:", "not TOML"},
        {"[chip]\ncores = 99999999999999999999999\n", "m.toml:2:", "not TOML"},
        {"[chip]\ncores = 9223372036854775807\n", "m.toml:2:9:", "must be from 1 to 1024"},
        {"[chip]\ncores = inf\n", "m.toml:2:9:", "whole number"},
        {"[chip]\ncores =\n", "m.toml:2:", "not TOML"},
        {"[chip.cores]\nx = 4\n", "m.toml:1:1:", "must be a number"},
        {"[[chip]]\ncores = 4\n", "m.toml:1:3:", "is a section; write [chip]"},
        {"chip = 4\n", "m.toml:1:1:", "is a section; write [chip]"},
        {"l2.size_bytes = 1000\n", "m.toml:", "(l2.size_bytes from m.toml:1, l2.ways from default)"},
    };
    for (const Case& c : cases) {
        std::string e = error_of(c.text);
        EXPECT_EQ(e.rfind(c.where, 0), 0U) << c.text << e;
        EXPECT_NE(e.find(c.says), std::string::npos) << c.text << e;
        EXPECT_EQ(e.find('\n'), std::string::npos) << e;
    }
}

TEST(MachineFile, OverridesAreCheckedTheSame) {
    EXPECT_NE(error_of("", {"chip.cores=0"}).find("-g chip.cores=0: chip.cores is 0"), std::string::npos);
    EXPECT_NE(error_of("", {"chip.coers=2"}).find("nearest known one is chip.cores"), std::string::npos);
    EXPECT_NE(error_of("", {"chip.cores"}).find("section.key=value"), std::string::npos);
    EXPECT_NE(error_of("", {"chip.cores=two"}).find("must be a number"), std::string::npos);
    EXPECT_NE(error_of("", {"l1.size_bytes=100"}).find("do not divide"), std::string::npos);
    EXPECT_NE(error_of("", {"l1.size_bytes=100"}).find("l1.size_bytes from -g"), std::string::npos);
    for (const char* bad :
         {"", "=", "=4", "chip.cores=", "chip.cores=[1]", "chip.cores=2\nx=3\n[", "chip.cores=nan",
          "chip.cores=1e99", "chip.cores==2", "chip=4", ".=4", "inherit=tiny.toml", "chip.cores=\xff"}) {
        const std::string e = error_of("", {bad});
        EXPECT_EQ(e.rfind("-g ", 0), 0U) << bad << ": " << e;
        EXPECT_EQ(e.find('\n'), std::string::npos) << e;
    }
    EXPECT_EQ(parse_machine("", "m", {"l2.size_bytes=2MiB"}).l2.size_bytes, 2 << 20);
    EXPECT_EQ(parse_machine("", "m", {"l2.size_bytes=256 KiB"}).l2.size_bytes, 256 << 10);
    EXPECT_EQ(parse_machine("[l2]\nsize_bytes = \"1 GiB\"\n", "m").l2.size_bytes, 1 << 30);
    EXPECT_EQ(parse_machine("", "m", {"sim.quantum=1e3"}).sim.quantum, 1000);
    for (const char* bad : {"l2.size_bytes=2MB", "l2.size_bytes=MiB", "l2.size_bytes=-1MiB",
                            "l2.size_bytes=1.5MiB", "chip.cores=1KiB", "core.scalar_overhead=1KiB"})
        EXPECT_NE(error_of("", {bad}).find("must be a number"), std::string::npos)
            << bad << error_of("", {bad});
    for (const char* large : {"l2.size_bytes=4096GiB", "l2.size_bytes=9223372036854775807GiB",
                              "l2.size_bytes=99999999999999999999KiB"})
        EXPECT_NE(error_of("", {large}).find("must be from"), std::string::npos) << large;
    EXPECT_NE(error_of("", {"l2.size_bytes=3000000"}).find("make it 2097152 or 4194304"), std::string::npos);
    EXPECT_NE(error_of("", {"l2.size_bytes=500"}).find("make it 512"), std::string::npos);
    EXPECT_EQ(parse_machine("", "m", {" chip.cores = 8 ", "core.gather=\"lane\""}).chip.cores, 8);
    EXPECT_EQ(parse_machine("[chip]\ncores = 2\n", "m", {"chip.cores=8", "core.gather=lane"}).chip.cores, 8);
    EXPECT_EQ(parse_machine("", "m", {"core.scalar_overhead=2"}).core.scalar_overhead, 2.0);
}

TEST(MachineFile, PrintedMachinesReadBack) {
    Config c = parse_machine("", "m", {"chip.cores=7", "core.scalar_overhead=0.25", "core.predictor=none"});
    std::string printed = print_machine(c);
    EXPECT_EQ(print_machine(parse_machine(printed, "printed")), printed);
    for (const Parameter& p : parameters()) {
        EXPECT_FALSE(p.meaning.empty()) << p.key;
        EXPECT_EQ(&p, find_parameter(p.key)) << p.key;
    }
}

// What applies to neither machine is no difference.
TEST(MachineFile, AlikeInWhatApplies) {
    const auto with = [](std::vector<std::string> settings) { return parse_machine("", "m.toml", settings); };
    const Config plain = with({});
    EXPECT_TRUE(alike(plain, plain));
    EXPECT_TRUE(alike(plain, parse_machine(print_machine(plain), "printed")));
    EXPECT_FALSE(alike(plain, with({"memory.tRCD=15"})));
    EXPECT_FALSE(alike(plain, with({"energy.add_pj=0.125"})));
    EXPECT_TRUE(
        alike(with({"network.topology=ideal"}), with({"network.topology=ideal", "network.hop_cycles=7"})));
    EXPECT_FALSE(alike(with({"network.topology=crossbar"}), with({"network.topology=ideal"})));
}

} // namespace
} // namespace sim::test
