// How fast curves of misses are made of a trace, from memory, and how near those of a sample come to the
// exact one; and how fast with the trace read meanwhile, bytes, checksums, decoding and merging by time.
//   trace_curves FILE [--rate R] [--sample-lines N] [--millions N] [--runs N] [--seeds N]
#include "analysis/traces/lru_curve.h"
#include "analysis/traces/optimum.h"
#include "analysis/traces/sampled_curve.h"
#include "analysis/traces/set_curve.h"
#include "analysis/traces/touches.h"
#include "traces/error.h"
#include "traces/formats/format.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <ctime>
#include <vector>

namespace {

/// visit(lines) for the touches of each block.
template <class Visit> void each_block(const std::string& file, std::size_t most, Visit visit) {
    auto source = traces::open_source(file);
    const traces::Format& format = traces::format_of_input("", file, *source);
    const auto input = format.read(std::move(source));
    analysis::Touches touches(6, analysis::Touches::demand, analysis::By::all);
    std::vector<std::uint64_t> lines;
    std::size_t all = 0;
    for (traces::Block block; all < most && input->next(block); all += lines.size()) {
        lines.clear();
        touches.each(block, [&](const analysis::Touch& t) { lines.push_back(t.line); });
        visit(lines);
    }
}

std::vector<std::uint64_t> lines_of(const std::string& file, std::size_t most) {
    std::vector<std::uint64_t> out;
    each_block(file, most, [&](const std::vector<std::uint64_t>& lines) {
        out.insert(out.end(), lines.begin(), lines.end());
    });
    return out;
}

/// Million touches a second of processor time, which others on the machine take less from: median of some
/// runs.
template <class Work> double speed(std::size_t touches, int runs, Work work) {
    std::vector<double> all;
    for (int run = 0; run < runs; ++run) {
        const std::clock_t begin = std::clock();
        work();
        const double seconds = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
        all.push_back(static_cast<double>(touches) * 1e-6 / seconds);
    }
    std::sort(all.begin(), all.end());
    return all[all.size() / 2];
}

struct Sampled {
    double speed = 0, mean = 0, largest = 0; // million touches a second; errors of ratios
    std::size_t sizes = 0;
    std::uint64_t lines = 0;          // in the sample
    std::size_t told = 0, within = 0; // sizes whose error is told, and is not larger
};

/// Against the ratios of all sizes up to the first that holds all `different` lines.
Sampled errors_of(const analysis::SampledCurve& curve, const std::vector<std::uint64_t>& sizes,
                  const std::vector<double>& truth, std::uint64_t different) {
    Sampled out;
    out.lines = curve.lines().lines();
    while (out.sizes < sizes.size()) {
        const analysis::SampledCurve::Estimate e = curve.estimate(0, out.sizes);
        const double error = std::abs(e.ratio - truth[out.sizes]);
        out.mean += error;
        out.largest = std::max(out.largest, error);
        out.told += std::isnan(e.error) ? 0 : 1;
        out.within += error <= e.error ? 1 : 0;
        if (sizes[out.sizes++] > different)
            break;
    }
    out.mean /= static_cast<double>(out.sizes);
    return out;
}

/// Other samples of as many lines: chance says which popular ones are in.
void print_seeds(const std::vector<std::uint64_t>& lines, const std::vector<std::uint64_t>& sizes,
                 const std::vector<double>& truth, std::uint64_t different, double rate, int seeds) {
    std::vector<double> means;
    double largest = 0;
    std::size_t all = 0, told = 0, within = 0;
    for (int seed = 0; seed < seeds; ++seed) {
        analysis::SampledCurve curve(sizes, rate, 1, 0, static_cast<std::uint64_t>(seed));
        curve.touch(lines, 0);
        const Sampled s = errors_of(curve, sizes, truth, different);
        means.push_back(s.mean);
        largest = std::max(largest, s.largest);
        all += s.sizes;
        told += s.told;
        within += s.within;
    }
    std::sort(means.begin(), means.end());
    fmt::print(
        "{} samples of {:g} of all lines: mean error {:.4f} in the median, {:.4f} at most; of any size "
        "{:.4f} at most; told of {} sizes of {}, and no larger than told of {}\n",
        seeds, rate, means[means.size() / 2], means.back(), largest, told, all, within);
}

int run(const std::string& file, double rate, std::uint64_t sample_lines, std::size_t most, int runs,
        int seeds) {
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
    Sampled fixed_rate, fixed_size;
    const auto sampled = [&](Sampled& out, double part, std::uint64_t most_lines) {
        out.speed = speed(lines.size(), runs, [&] {
            analysis::SampledCurve curve(sizes, part, 1, most_lines);
            curve.touch(lines, 0);
            out = errors_of(curve, sizes, truth, different);
        });
    };
    sampled(fixed_rate, rate, 0);
    sampled(fixed_size, 1, sample_lines);
    const double exact_read = speed(lines.size(), runs, [&] {
        analysis::LruCurve curve(sizes);
        each_block(file, most, [&](const std::vector<std::uint64_t>& some) {
            for (const std::uint64_t line : some)
                curve.touch(line, 0);
        });
    });
    const double rate_read = speed(lines.size(), runs, [&] {
        analysis::SampledCurve curve(sizes, rate, 1, 0);
        each_block(file, most, [&](const std::vector<std::uint64_t>& some) { curve.touch(some, 0); });
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
    fmt::print("{}: {} touches of {} lines of 64 bytes; million touches a second of processor time, median "
               "of {} runs\n",
               file, lines.size(), different, runs);
    fmt::print("LRU of all sizes, exact                {:10.1f}\n", exact);
    for (const auto& [text, s] : {std::pair{fmt::format("{:g} of all lines", rate), &fixed_rate},
                                  {fmt::format("at most {} lines", sample_lines), &fixed_size}})
        fmt::print(
            "LRU of all sizes, {:<21}{:10.1f}, {:.1f} times as fast; {} lines, {} sizes, error {:.4f} in the "
            "mean, {:.4f} at most\n",
            text, s->speed, s->speed / exact, s->lines, s->sizes, s->mean, s->largest);
    if (seeds != 0)
        print_seeds(lines, sizes, truth, different, rate, seeds);
    fmt::print("with reading, exact                    {:10.1f}\n", exact_read);
    fmt::print("with reading, {:<25}{:10.1f}, {:.1f} times as fast\n", fmt::format("{:g} of all lines", rate),
               rate_read, rate_read / exact_read);
    fmt::print("64 sets of 8 ways                      {:10.1f}\n", sets);
    fmt::print("Belady's optimum of 512 lines          {:10.1f}\n", optimum);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures how fast curves of misses are made of a trace.", "trace_curves");
    std::string file;
    double rate = 0.01;
    std::uint64_t sample_lines = 8192;
    std::size_t millions = 100;
    int runs = 3, seeds = 0;
    app.add_option("file", file, "a trace of any format")->required();
    app.add_option("--rate", rate, "of a sample of lines")->check(CLI::Range(1e-6, 1.0));
    app.add_option("--sample-lines", sample_lines, "at most, of a sample of a fixed size")
        ->check(CLI::Range(256, 1 << 24));
    app.add_option("--millions", millions, "the first references, at most")->check(CLI::Range(1, 4000));
    app.add_option("--runs", runs, "so often; medians are printed")->check(CLI::PositiveNumber);
    app.add_option("--seeds", seeds, "so many samples of a fraction of lines, and how far off they are")
        ->check(CLI::NonNegativeNumber);
    CLI11_PARSE(app, argc, argv);
    try {
        return run(file, rate, sample_lines, millions * 1000000, runs, seeds);
    } catch (const traces::Error& e) {
        fmt::print(stderr, "trace_curves: {}\n", e.what());
        return 2;
    }
}
