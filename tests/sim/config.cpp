// Machine files: what is refused, and how it is said; layers; printing back.
#include "sim/config/parameters.h"
#include "tests/sim/machines.h"

#include <filesystem>
#include <fstream>

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
        {"[chip]\ncores = true\n", "m.toml:2:9:", "must be a number or a word"},
        {"[chip]\ncores = [1]\n", "m.toml:2:9:", "must be a number or a word"},
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
        {"[l2]\nline_bytes = 32\n", "m.toml:", "less than l1.line_bytes"},
        {"[memory]\nbus_bytes = 16\n", "m.toml:", "more than l2.line_bytes"},
        {"[memory]\nrow_bytes = 1\n", "m.toml:2:13:", "must be from 64"},
        {"[memory]\ntREFI = 100\ntRFC = 90\n", "m.toml:", "between refreshes"},
        {"[memory]\nmapping = \"row\"\n", "m.toml:2:11:", "must be one of"},
        {"[chip\n", "m.toml:", "not TOML"},
        {"\x01\x02\xff", "m.toml:", "not TOML"},
        {"inherit = 3\n", "m.toml:1:11:", "in quotes"},
        {"inherit = \"no-such-file.toml\"\n", "no-such-file.toml:", "cannot be read"},
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
    EXPECT_EQ(parse_machine("[chip]\ncores = 2\n", "m", {"chip.cores=8", "core.gather=lane"}).chip.cores, 8);
    EXPECT_EQ(parse_machine("", "m", {"core.scalar_overhead=2"}).core.scalar_overhead, 2.0);
}

TEST(MachineFile, LayersInherit) {
    auto folder = std::filesystem::temp_directory_path() / "razor-sim-test-layers";
    std::filesystem::create_directories(folder);
    std::ofstream(folder / "base.toml") << "[chip]\ncores = 16\nthreads = 4\n";
    std::ofstream(folder / "top.toml") << "inherit = \"base.toml\"\n[chip]\nthreads = 8\n";
    std::ofstream(folder / "circle.toml") << "inherit = \"circle.toml\"\n";
    Config c = read_machine((folder / "top.toml").string());
    EXPECT_EQ(c.chip.cores, 16);
    EXPECT_EQ(c.chip.threads, 8);
    EXPECT_THROW(read_machine((folder / "circle.toml").string()), ConfigError);
    EXPECT_THROW(read_machine(folder.string()), ConfigError);
    std::filesystem::remove_all(folder);
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

TEST(MachineFile, ShippedMachinesLoad) {
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/machines"))
        EXPECT_NO_THROW(read_machine(entry.path().string())) << entry.path();
}

} // namespace
} // namespace sim::test
