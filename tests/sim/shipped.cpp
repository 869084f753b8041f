// The machines of configs/machines: every line says how well it is known, and nothing is left to the code.
#include "sim/config/origin.h"
#include "sim/config/parameters.h"
#include "tests/scene/temporary_folder.h"
#include "tests/sim/kernels.h"
#include "tests/sim/machines.h"

#include <fstream>
#include <iterator>

namespace sim::test {
namespace {

/// What is missing in a file, one line each.
std::string missing(const std::string& file) {
    const MachineDescription machine = describe_machine(file);
    std::ifstream in(file);
    const std::string text((std::istreambuf_iterator<char>(in)), {});
    const bool inherits = text.find("\ninherit") != std::string::npos || text.rfind("inherit", 0) == 0;
    std::string out;
    for (std::size_t i = 0; i < parameters().size(); ++i) {
        const Origin& origin = machine.origins[i];
        const std::string& key = parameters()[i].key;
        if (!applies(parameters()[i], machine.config))
            continue;
        const bool of_this_file = origin.layer == Origin::file && origin.file_name == machine.name;
        if (origin.layer == Origin::preset && !inherits)
            out += key + " is left to a default\n";
        else if (of_this_file && read_mark(origin.comment).kind == Mark::none)
            out += origin.place() + ": " + key + " is marked neither `known (source)` nor `assumed`\n";
    }
    return out;
}

TEST(Shipped, MachinesSayOfEveryLineHowWellItIsKnown) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/machines")) {
        EXPECT_EQ(entry.path().extension(), ".toml");
        EXPECT_EQ(missing(entry.path().string()), "");
        const MachineDescription machine = describe_machine(entry.path().string());
        const std::string printed = print_machine(machine);
        const MachineDescription again = describe_machine_text(printed, "printed.toml");
        EXPECT_EQ(print_machine(again.config), print_machine(machine.config)) << entry.path();
        ++files;
    }
    EXPECT_GT(files, 0);
}

TEST(Shipped, MachinesRunInBothModes) {
    for (const auto& entry : std::filesystem::directory_iterator(RAZOR_SOURCE_DIR "/configs/machines"))
        for (const std::string mode : {"fast", "reference"}) {
            SCOPED_TRACE(entry.path().filename().string() + ", " + mode);
            Config c;
            ASSERT_NO_THROW(c = read_machine(entry.path().string(), {"sim.mode=" + mode}));
            Report r;
            ASSERT_NO_THROW(r = run_on(
                                c,
                                [](std::byte* base, int worker) {
                                    for (int i = 0; i < 200; ++i) {
                                        std::byte* p = base + (i * 7 + worker) % 300 * 64;
                                        if ((i + worker) % 3 == 0)
                                            store(here, p, 4, stamp{}, stamp{});
                                        else
                                            load(here, p, 4, stamp{});
                                    }
                                },
                                static_cast<int>(std::min<integer>(c.all_threads(), 16))));
            EXPECT_GT(r.l1_total().misses, 0U);
        }
}

TEST(Shipped, WhatIsMissingIsFound) {
    const razor::TemporaryFolder folder;
    std::string all;
    for (std::string line; const char c : print_machine(Config())) {
        line += c;
        if (c != '\n')
            continue;
        const bool value = line.find(" = ") != std::string::npos && line.front() != '#';
        all += value ? line.substr(0, line.size() - 1) + " # assumed\n" : line;
        line.clear();
    }
    const auto of = [&](const std::string& text) { return missing(folder.file("m.toml", text).string()); };
    const auto edited = [&](const std::string& from, const std::string& to) {
        std::string text = all;
        const std::size_t at = text.find(from);
        EXPECT_NE(at, std::string::npos);
        return text.replace(at, from.size(), to);
    };
    EXPECT_EQ(of(all), "");
    EXPECT_NE(of(edited("threads = 2 # assumed", "threads = 2")).find("chip.threads is marked neither"),
              std::string::npos);
    EXPECT_NE(
        of(edited("threads = 2 # assumed", "threads = 2 # known")).find("chip.threads is marked neither"),
        std::string::npos);
    EXPECT_EQ(of(edited("threads = 2 # assumed", "threads = 2 # known (somebody)")), "");
    EXPECT_EQ(of(edited("threads = 2 # assumed", "")), "chip.threads is left to a default\n");
    folder.file("all.toml", all);
    EXPECT_EQ(of("inherit = \"all.toml\"\n[chip]\nthreads = 4 # assumed\n"), "");
}

} // namespace
} // namespace sim::test
