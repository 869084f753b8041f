// How fast a trace is replayed on a machine, by one thread: reading and replaying apart, and beside the same
// references through the tests' simple caches (tests/sim/hierarchy_oracle.h), which know LRU and write-back
// alone, no time, structures or memory. Of a machine of two levels, one tile and write-back LRU caches the
// two count the same.
//   replay_speed FILE --machine configs/machines/tiny.toml [-g KEY=VALUE] [--runs N]
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/replay/replay.h"
#include "tests/sim/hierarchy_oracle.h"
#include "traces/error.h"
#include "traces/formats/format.h"
#include "traces/in_order.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <ctime>
#include <vector>

namespace {

/// Of the processor: this process has one thread.
template <class Work> double seconds(Work work) {
    const std::clock_t begin = std::clock();
    work();
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// Median, and least and most, of million references a second.
void print(const char* what, std::vector<double> all) {
    std::sort(all.begin(), all.end());
    fmt::print("{:<40} {:8.1f} million references a processor second ({:.1f} to {:.1f} in {} runs)\n", what,
               all[all.size() / 2], all.front(), all.back(), all.size());
}

std::vector<sim::test::HierarchyOracle::Level> levels_of(const sim::Config& config) {
    std::vector<sim::test::HierarchyOracle::Level> out;
    for (unsigned level = 0; level < config.cache_levels(); ++level) {
        const sim::CacheConfig& c = config.cache(level);
        const auto sharing = static_cast<std::uint64_t>(config.cores_sharing(level));
        out.push_back({static_cast<std::uint64_t>(c.size_bytes), static_cast<std::uint64_t>(c.ways),
                       static_cast<std::uint64_t>(c.line_bytes), sharing, level == 0 ? "" : c.inclusion,
                       config.beyond_tiles(level)});
    }
    return out;
}

int run(const std::string& file, const sim::Config& config, int runs) {
    std::vector<double> reading, replaying, both, plain;
    const std::uint64_t line = static_cast<std::uint64_t>(config.l1.line_bytes);
    const auto threads = static_cast<std::uint32_t>(config.chip.threads);
    for (int i = 0; i < runs; ++i) {
        auto source = traces::open_source(file);
        const auto input = traces::format_of_input("", file, *source).read(std::move(source));
        sim::Replay replay(config, input->description(), {});
        sim::test::HierarchyOracle simple(levels_of(config), static_cast<std::uint64_t>(config.all_cores()));
        double read = 0, replayed = 0, simply = 0;
        std::uint64_t references = 0;
        traces::Block block;
        for (bool more = true; more;) {
            read += seconds([&] { more = input->next(block); });
            if (!more)
                break;
            references += block.size();
            replayed += seconds([&] { replay.add(block); });
            simply += seconds([&] {
                traces::each_in_order(
                    block,
                    [&](const traces::Segment& s, std::size_t k) {
                        const traces::Class& c = block.what(k);
                        if (c.kind > traces::Kind::write)
                            return;
                        const std::uint64_t a = block.addresses[k], end = a + std::max(c.size, 1U);
                        for (std::uint64_t at = a; at < end; at = (at | (line - 1)) + 1)
                            simple.access(s.stream / threads, at, c.kind == traces::Kind::write);
                    },
                    [](const traces::Turn&) {});
            });
        }
        sim::ReplayResult result;
        replayed += seconds([&] { result = replay.finish(input->description()); });
        if (i == 0) {
            std::uint64_t misses = 0;
            for (std::size_t c = 0; c < simple.caches(0); ++c)
                misses += simple.counts(0, c).misses;
            fmt::print("{}: {} references; misses of the L1s {}, of the simple ones {}; waits {}\n", file,
                       references, result.report.l1_total().misses, misses, result.waits);
        }
        const double million = static_cast<double>(references) * 1e-6;
        reading.push_back(million / read);
        replaying.push_back(million / replayed);
        both.push_back(million / (read + replayed));
        plain.push_back(million / simply);
    }
    print("read", reading);
    print("replay", replaying);
    print("read and replay", both);
    print("simple caches, LRU lists", plain);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures how fast a trace is replayed.", "replay_speed");
    std::string file, machine;
    std::vector<std::string> settings;
    int runs = 3;
    app.add_option("file", file, "a trace of what cores ask for")->required();
    app.add_option("--machine", machine, "the machine")->required();
    app.add_option("-g", settings, "overrides a setting")->expected(1)->take_all();
    app.add_option("--runs", runs, "so often; medians are printed")->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);
    try {
        return run(file, sim::read_machine(machine, settings), runs);
    } catch (const traces::Error& e) {
        fmt::print(stderr, "replay_speed: {}\n", e.what());
        return 2;
    } catch (const sim::ConfigError& e) {
        fmt::print(stderr, "replay_speed: {}\n", e.what());
        return 2;
    }
}
