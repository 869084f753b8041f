// How fast curves of misses are made of a trace, from memory, and how near those of a sample come to the
// exact one.
//   trace_curves FILE [--rate R] [--millions N] [--runs N]
#include "analysis/traces/lru_curve.h"
#include "analysis/traces/optimum.h"
#include "analysis/traces/set_curve.h"
#include "analysis/traces/shards.h"
#include "analysis/traces/touches.h"
#include "traces/error.h"
#include "traces/formats/format.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <vector>

namespace {

std::vector<std::uint64_t> lines_of(const std::string& file, std::size_t most) {
    auto source = traces::open_source(file);
    const traces::Format& format = traces::format_of_input("", file, *source);
    const auto input = format.read(std::move(source));
    analysis::Touches touches(6, analysis::Touches::demand, analysis::By::all);
    std::vector<std::uint64_t> out;
    for (traces::Block block; out.size() < most && input->next(block);)
        touches.each(block, [&](const analysis::Touch& t) { out.push_back(t.line); });
    return out;
}

/// Million touches a second: median of some runs.
template <class Work> double speed(std::size_t touches, int runs, Work work) {
    std::vector<double> all;
    for (int run = 0; run < runs; ++run) {
        const auto begin = std::chrono::steady_clock::now();
        work();
        const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - begin;
        all.push_back(static_cast<double>(touches) * 1e-6 / seconds.count());
    }
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
}

int run(const std::string& file, double rate, std::size_t most, int runs) {
    const std::vector<std::uint64_t> lines = lines_of(file, most);
    if (lines.empty())
        throw traces::Error(file + ": holds no reads, writes or fetches");
    std::vector<std::uint64_t> sizes;
    for (unsigned shift = 4; shift < 30; ++shift)
        sizes.push_back(std::uint64_t{1} << shift);
    std::vector<double> truth;
    std::uint64_t different = 0;
    const double exact = speed(lines.size(), runs, [&] {
        analysis::LruCurve curve(sizes);
        for (const std::uint64_t line : lines)
            curve.touch(line, 0);
        different = curve.lines();
        truth.clear();
        for (std::size_t s = 0; s < sizes.size(); ++s)
            truth.push_back(static_cast<double>(curve.counts().misses(0, s)) /
                            static_cast<double>(lines.size()));
    });
    double mean = 0, largest = 0;
    std::size_t counted = 0;
    const double sampled = speed(lines.size(), runs, [&] {
        analysis::Shards shards(sizes, rate);
        for (const std::uint64_t line : lines)
            shards.touch(line, 0);
        mean = largest = 0;
        for (counted = 0; counted < sizes.size(); ++counted) {
            const double error = std::abs(shards.estimate(0, counted).ratio - truth[counted]);
            mean += error;
            largest = std::max(largest, error);
            if (sizes[counted] > different)
                break;
        }
        mean /= static_cast<double>(++counted);
    });
    const double sets = speed(lines.size(), runs, [&] {
        analysis::SetCurve curve(64, {8});
        for (const std::uint64_t line : lines)
            curve.touch(line, 0);
    });
    const double optimum = speed(lines.size(), 1, [&] {
        analysis::Optimum least;
        for (const std::uint64_t line : lines)
            least.touch(line, 0);
        least.misses(512, 1);
    });
    fmt::print("{}: {} touches of {} lines of 64 bytes; million touches a second, median of {} runs\n", file,
               lines.size(), different, runs);
    fmt::print("LRU of all sizes, exact                {:10.1f}\n", exact);
    fmt::print("LRU of all sizes, {:g} of all lines    {:10.1f}, {:.1f} times as fast; {} sizes, error "
               "{:.4f} in the mean, {:.4f} at most\n",
               rate, sampled, sampled / exact, counted, mean, largest);
    fmt::print("64 sets of 8 ways                      {:10.1f}\n", sets);
    fmt::print("Belady's optimum of 512 lines          {:10.1f}\n", optimum);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures how fast curves of misses are made of a trace.", "trace_curves");
    std::string file;
    double rate = 0.01;
    std::size_t millions = 100;
    int runs = 3;
    app.add_option("file", file, "a trace of any format")->required();
    app.add_option("--rate", rate, "of a sample of lines")->check(CLI::Range(1e-6, 1.0));
    app.add_option("--millions", millions, "the first references, at most")->check(CLI::Range(1, 4000));
    app.add_option("--runs", runs, "so often; medians are printed")->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);
    try {
        return run(file, rate, millions * 1000000, runs);
    } catch (const traces::Error& e) {
        fmt::print(stderr, "trace_curves: {}\n", e.what());
        return 2;
    }
}
