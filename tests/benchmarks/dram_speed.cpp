// Host nanoseconds (of processor time) that a request to the memory takes, by preset, traffic and requests in
// flight a channel, for the controller that answers when a request comes (those of the generator alone are
// taken off) and for the one with queues (with its driver). And what the memory reached.
//   dram_speed [REQUESTS] [PRESET]
#include "sim/memory/dram_load.h"
#include "tests/sim/dram_traffic.h"

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include <cstdlib>
#include <ctime>

namespace {

using namespace sim;
using namespace sim::test;

double seconds(std::clock_t begin) {
    return static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
}

/// The generator, with a memory that always takes 100 clocks.
double generator_seconds(std::uint64_t in_flight, std::uint64_t count, const Source& source) {
    std::clock_t begin = std::clock();
    std::priority_queue<cycle, std::vector<cycle>, std::greater<>> busy;
    for (std::uint64_t i = 0; i < count; ++i) {
        cycle t = 0;
        if (busy.size() == in_flight) {
            t = busy.top();
            busy.pop();
        }
        busy.push(t + 100 + source().address % 2);
    }
    return seconds(begin);
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app{"Host time a request to the memory takes, and what the memory reached"};
    std::uint64_t count = 1000000;
    std::vector<MemoryConfig> presets = memory_presets();
    std::string preset_name;
    std::vector<std::string> known;
    for (const MemoryConfig& c : presets)
        known.push_back(c.preset);
    app.add_option("requests", count, "requests of each row")
        ->capture_default_str()
        ->check(CLI::Range(1, 1000000000));
    app.add_option("preset", preset_name, "this preset only")->check(CLI::IsMember(known));
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& e) {
        return app.exit(e) == 0 ? 0 : 2;
    }
    if (!preset_name.empty())
        std::erase_if(presets, [&](const MemoryConfig& c) { return c.preset != preset_name; });
    constexpr std::uint64_t lines = std::uint64_t{1} << 24;
    fmt::print("{:<14} {:<22} {:>9} {:<10} {:>11} {:>9} {:>9} {:>9}\n", "preset", "traffic", "in flight",
               "controller", "ns/request", "M req/s", "GB/s", "of peak");
    for (const MemoryConfig& preset : presets)
        for (std::uint64_t in_flight : {1U, 8U, 64U})
            for (int traffic = 0; traffic < 3; ++traffic) {
                Config c = memory_of(preset.preset);
                std::uint64_t all = in_flight * static_cast<std::uint64_t>(c.memory.channels);
                auto source = [&] { return traffic == 2 ? stream() : random_lines(lines, traffic * 0.25); };
                std::clock_t begin = std::clock();
                Outcome o = closed_loop(c, all, count, source());
                double own = seconds(begin) - generator_seconds(all, count, source());
                const char* const names[] = {"random reads", "random, 25 % writes", "sequential reads"};
                auto print = [&](const char* controller, double ns, double bytes_per_clock) {
                    fmt::print("{:<14} {:<22} {:>9} {:<10} {:>11.0f} {:>9.2f} {:>9.2f} {:>7.1f} %\n",
                               preset.preset, names[traffic], all, controller, ns, 1e3 / ns,
                               bytes_per_clock * 1e3 / static_cast<double>(c.memory.clock_ps),
                               100 * bytes_per_clock / peak(c));
                };
                print("immediate", 1e9 * own / o.lines, o.bytes_per_clock());
                begin = std::clock();
                DramOutcome q = run_dram_queued(c, source(), {0, all, count, 1});
                print("queued", 1e9 * seconds(begin) / static_cast<double>(count), q.bytes_per_clock);
            }
}
