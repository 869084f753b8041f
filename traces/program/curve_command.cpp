#include "analysis/plots/table_chart.h"
#include "analysis/traces/lru_curve.h"
#include "analysis/traces/optimum.h"
#include "analysis/traces/sampled_curve.h"
#include "analysis/traces/set_curve.h"
#include "traces/error.h"
#include "traces/io/interrupt.h"
#include "traces/program/analyses.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>
#include <map>

namespace traces {

using analysis::Table;
using analysis::Touch;

namespace {

double parse_rate(const std::string& text) {
    double rate = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), rate);
    if (error != std::errc() || end != text.data() + text.size() || !(rate > 0) || !(rate <= 1))
        throw Error(fmt::format("--rate '{}': no fraction; give one above 0, at most 1", text));
    return rate;
}

std::vector<std::uint64_t> parse_ways(const std::string& text) {
    std::vector<std::uint64_t> out;
    for (const std::string& ways : text.empty() ? std::vector<std::string>() : split("--ways", text))
        out.push_back(parse_count("--ways", ways, 1, 1024));
    std::sort(out.begin(), out.end());
    out.erase(std::unique(out.begin(), out.end()), out.end());
    return out;
}

/// Of caches if none are given: doubling from one that holds a line.
std::string usual_sizes(std::uint64_t line_bytes, std::uint64_t most) {
    return fmt::format("{}..{}", std::max<std::uint64_t>(1024, line_bytes), std::max(most, line_bytes));
}

constexpr std::uint64_t usual_most = std::uint64_t{1} << 40U, usual_most_of_sets = std::uint64_t{1} << 24U;
constexpr std::uint64_t least_sample = 256, most_sample = std::uint64_t{1} << 32; // lines

class CurveCommand final : public AnalysisCommand {
public:
    CurveCommand() : AnalysisCommand("curve", "misses by the size of a cache", "all") {}
    void run() override;

private:
    bool draws() const override { return true; }
    void add_options(CLI::App& app) override;
    Table exact();
    Table sampled(double rate, std::uint64_t most);

    std::string sizes_, ways_, rate_, most_, heading_;
    bool optimum_ = false;
};

void CurveCommand::add_options(CLI::App& app) {
    app.add_option("--sizes", sizes_,
                   "of caches, as 1KiB..64MiB (doubling) or 32KiB,48KiB; without it, from 1KiB until "
                   "nothing changes")
        ->type_name("SIZES");
    app.add_option("--ways", ways_, "also set-associative caches of so many ways, with commas between")
        ->type_name("WAYS");
    app.add_flag("--optimum", optimum_,
                 "also the least misses that any replacement can have (Belady); takes 8 bytes a reference");
    app.add_option("--rate", rate_, "estimate from this fraction of all lines (SHARDS), with its error")
        ->type_name("FRACTION");
    app.add_option("--sample-lines", most_,
                   "estimate from at most so many lines, at least 256: the fraction falls as more are met "
                   "(SHARDS of a fixed size)")
        ->type_name("N");
}

void CurveCommand::run() {
    const bool samples = !rate_.empty() || !most_.empty();
    if (samples && (!ways_.empty() || optimum_))
        throw Error("--rate, --sample-lines: of fully associative LRU caches alone; leave out --ways and "
                    "--optimum");
    const std::uint64_t most =
        most_.empty() ? 0 : parse_count("--sample-lines", most_, least_sample, most_sample);
    const double rate = rate_.empty() ? 1 : parse_rate(rate_);
    options_.prepare();
    const double sample = options_.description().sample;
    if (sample < 1 && (!ways_.empty() || optimum_))
        throw Error(
            "--ways, --optimum: the trace is of a sample of lines, which tells of fully associative LRU "
            "caches alone; leave them out");
    const Table table = samples || sample < 1 ? sampled(rate, most) : exact();
    options_.give("curve", table, heading_, [&] {
        return analysis::lines_of(table, options_.by_columns(), "bytes", {"ratio"},
                                  {"size", analysis::Unit::bytes, true},
                                  {"misses a reference", analysis::Unit::percent});
    });
}

Table CurveCommand::exact() {
    const std::uint64_t line_bytes = options_.line_bytes();
    const std::vector<std::uint64_t> all_ways = parse_ways(ways_);
    const bool chosen = !sizes_.empty();
    const std::vector<std::uint64_t> sizes = parse_sizes(
        "--sizes",
        chosen ? sizes_ : usual_sizes(line_bytes, all_ways.empty() ? usual_most : usual_most_of_sets));
    const std::vector<std::uint64_t> lines = lines_of("--sizes", sizes, line_bytes);
    for (const std::uint64_t ways : all_ways)
        if (std::none_of(lines.begin(), lines.end(), [&](std::uint64_t n) { return n % ways == 0; }))
            throw Error(
                fmt::format("--ways {}: no size has sets of so many; give other --ways, or --sizes that "
                            "are multiples of {} bytes",
                            ways, ways * line_bytes));
    // Caches of as many sets are one pass.
    std::map<std::uint64_t, std::vector<std::uint64_t>> ways_by_sets;
    for (const std::uint64_t n : lines)
        for (const std::uint64_t ways : all_ways)
            if (n % ways == 0)
                ways_by_sets[n / ways].push_back(ways);
    std::vector<analysis::SetCurve> sets;
    for (auto& [count, ways] : ways_by_sets) {
        std::sort(ways.begin(), ways.end());
        sets.emplace_back(count, ways);
    }
    analysis::LruCurve lru(lines);
    analysis::Optimum optimum;
    analysis::Touches touches = options_.touches();
    options_.each_block([&](const Block& block) {
        touches.each(block, [&](const Touch& t) {
            lru.touch(t.line, t.group);
            for (analysis::SetCurve& s : sets)
                s.touch(t.line, t.group);
            if (optimum_)
                optimum.touch(t.line, t.group);
        });
    });

    const std::size_t groups = touches.groups();
    std::uint64_t references = 0;
    for (std::size_t g = 0; g < groups; ++g)
        references += lru.counts().references(g);
    heading_ = fmt::format("{} touches of {} lines of {} bytes", references, lru.lines(), line_bytes);
    Table table = options_.table({"bytes", "references", "first", "misses", "ratio"});
    for (const std::uint64_t ways : all_ways)
        table.columns.push_back(fmt::format("misses of {} ways", ways));
    if (optimum_)
        table.columns.emplace_back("least misses");
    std::vector<std::vector<std::uint64_t>> least; // by size and group
    std::size_t shown = 0;
    for (bool more = true; shown < lines.size() && more; ++shown) {
        if (optimum_)
            least.push_back(optimum.misses(lines[shown], groups, [] { check_interrupts(); }));
        more = chosen || lru.lines() > lines[shown]; // else all larger ones are like this one
    }
    for (std::size_t g = 0; g < groups; ++g)
        for (std::size_t size = 0; size < shown; ++size) {
            const std::uint64_t misses = lru.counts().misses(g, size), all = lru.counts().references(g);
            std::vector<Table::Cell> row = {sizes[size], all, lru.counts().firsts(g), misses,
                                            part(misses, all)};
            for (const std::uint64_t ways : all_ways) {
                Table::Cell cell = std::numeric_limits<double>::quiet_NaN(); // there is no such cache
                if (lines[size] % ways == 0)
                    for (const analysis::SetCurve& s : sets)
                        if (s.sets() == lines[size] / ways) {
                            const auto& counted = s.counts().sizes();
                            const auto at = std::find(counted.begin(), counted.end(), ways) - counted.begin();
                            cell = s.counts().misses(g, static_cast<std::size_t>(at));
                        }
                row.push_back(cell);
            }
            if (optimum_)
                row.emplace_back(least[size][g]);
            options_.add_row(table, touches, g, std::move(row));
        }
    return table;
}

Table CurveCommand::sampled(double rate, std::uint64_t most) {
    const std::uint64_t line_bytes = options_.line_bytes();
    const bool chosen = !sizes_.empty();
    const std::vector<std::uint64_t> sizes =
        parse_sizes("--sizes", chosen ? sizes_ : usual_sizes(line_bytes, usual_most));
    const double of = options_.description().sample;
    analysis::SampledCurve curve(lines_of("--sizes", sizes, line_bytes), rate * of, of, most);
    const analysis::Shards& shards = curve.lines();
    analysis::Touches touches = options_.touches();
    constexpr std::size_t most_together = 4096;
    std::vector<std::uint64_t> lines; // of one group, that are still to be touched
    std::uint32_t group = 0;
    options_.each_block([&](const Block& block) {
        touches.each(block, [&](const Touch& t) {
            if (t.group != group || lines.size() == most_together) {
                curve.touch(lines, group);
                lines.clear();
                group = t.group;
            }
            lines.push_back(t.line);
        });
    });
    curve.touch(lines, group);

    std::uint64_t references = 0;
    for (std::size_t g = 0; g < touches.groups(); ++g)
        references += shards.references(g);
    if (references != 0 && shards.sampled() == 0)
        throw Error(
            fmt::format("{}: none of {} touches is in a sample of {:g} of all lines; give a larger --rate",
                        options_.file(), references, shards.rate()));
    heading_ = fmt::format(
        "{} touches of lines of {} bytes, estimated from {} touches of a sample of {:g} of all "
        "lines ({} of them), and of caches of fewer than {:.0f} lines from stretches of the trace, as far "
        "as there are enough; errors are those of 19 samples of 20, where they can be told",
        references, line_bytes, shards.sampled(), shards.rate(), shards.lines(),
        std::ceil(analysis::SampledCurve::fewest / shards.rate()));
    Table table = options_.table({"bytes", "references", "misses", "ratio", "error", "sample of"});
    std::size_t shown = 0;
    for (bool more = true; shown < sizes.size() && more; ++shown)
        more =
            chosen || static_cast<double>(shards.lines()) / shards.rate() * static_cast<double>(line_bytes) >
                          static_cast<double>(sizes[shown]);
    for (std::size_t g = 0; g < touches.groups(); ++g)
        for (std::size_t size = 0; size < shown; ++size) {
            const auto [r, error, of_lines] = curve.estimate(g, size);
            const std::uint64_t all = shards.references(g);
            if (of_lines && !shards.knows(g)) {
                constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
                options_.add_row(table, touches, g,
                                 {sizes[size], all, unknown, unknown, unknown, std::string("none")});
                continue;
            }
            options_.add_row(table, touches, g,
                             {sizes[size], all,
                              static_cast<std::uint64_t>(std::llround(r * static_cast<double>(all))), r,
                              error, std::string(of_lines ? "lines" : "stretches")});
        }
    return table;
}

} // namespace

std::unique_ptr<AnalysisCommand> curve_command() {
    return std::make_unique<CurveCommand>();
}

} // namespace traces
