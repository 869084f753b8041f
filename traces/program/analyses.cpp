#include "traces/program/analyses.h"

#include "analysis/traces/line_use.h"
#include "analysis/traces/lru_curve.h"
#include "analysis/traces/object_lru.h"
#include "analysis/traces/windows.h"
#include "traces/error.h"

#include <fmt/format.h>

namespace traces {

using analysis::Table;
using analysis::Touch;

void ReuseCommand::add_to(CLI::App& app) {
    app_ = app.add_subcommand("reuse", "how many other lines are touched between two touches of one");
    options_.add_to(*app_, true);
}

void ReuseCommand::run() {
    options_.prepare();
    std::vector<std::uint64_t> powers;
    for (unsigned shift = 0; shift < 40; ++shift)
        powers.push_back(std::uint64_t{1} << shift);
    analysis::LruCurve lru(powers);
    analysis::Touches touches = options_.touches();
    options_.each_block([&](const Block& block) {
        touches.each(block, [&](const Touch& t) { lru.touch(t.line, t.group); });
    });
    Table table;
    if (options_.grouped())
        table.columns.emplace_back(options_.by());
    for (const char* name : {"others from", "to", "references", "part"})
        table.columns.emplace_back(name);
    std::size_t shown = 0;
    while (shown < powers.size() && (shown == 0 || powers[shown - 1] < lru.lines()))
        ++shown;
    std::uint64_t references = 0;
    for (std::size_t g = 0; g < touches.groups(); ++g) {
        const std::uint64_t all = lru.counts().references(g);
        references += all;
        const auto row = [&](Table::Cell from, Table::Cell to, std::uint64_t count) {
            std::vector<Table::Cell> cells;
            if (options_.grouped())
                cells.emplace_back(touches.name(g, options_.description()));
            cells.insert(cells.end(), {std::move(from), std::move(to), count,
                                       static_cast<double>(count) / static_cast<double>(all)});
            table.rows.push_back(std::move(cells));
        };
        for (std::size_t i = 0; i < shown; ++i) // a distance counts the line itself
            row(i == 0 ? 0 : powers[i - 1], powers[i] - 1, lru.counts().at(g, i));
        row(std::string("first touch"), std::string(), lru.counts().firsts(g));
    }
    options_.give(
        "reuse", table,
        fmt::format("{} touches of {} lines of {} bytes", references, lru.lines(), options_.line_bytes()));
}

void WindowsCommand::add_to(CLI::App& app) {
    app_ = app.add_subcommand("windows", "what is touched, new and missed over time");
    options_.add_to(*app_, false);
    app_->add_option("--window", length_, "units of the trace's time a window")->type_name("N")->required();
    app_->add_option("--sizes", sizes_, "of LRU caches whose misses are counted, as 32KiB,1MiB")
        ->type_name("SIZES");
}

void WindowsCommand::run() {
    options_.prepare();
    const std::uint64_t length = parse_size("--window", length_);
    std::vector<std::uint64_t> lines;
    const std::vector<std::uint64_t> sizes =
        sizes_.empty() ? std::vector<std::uint64_t>() : parse_sizes("--sizes", sizes_);
    for (const std::uint64_t size : sizes) {
        if (size % options_.line_bytes() != 0)
            throw Error(fmt::format("--sizes {}: lines have {} bytes; give multiples of that", size,
                                    options_.line_bytes()));
        lines.push_back(size / options_.line_bytes());
    }
    analysis::Windows windows(length, lines);
    analysis::Touches touches = options_.touches();
    options_.each_block([&](const Block& block) {
        touches.each(block, [&](const Touch& t) { windows.touch(t); });
        if (windows.windows().size() > 1000000)
            throw Error(
                fmt::format("--window {}: there are more than a million windows; give longer ones", length));
    });
    Table table;
    table.columns = {"begins", "references", "writes", "lines", "bytes", "new lines"};
    for (const std::uint64_t size : sizes)
        table.columns.push_back(fmt::format("misses of {} bytes", size));
    for (const auto& [number, w] : windows.windows()) {
        table.rows.push_back(
            {number * length, w.touches, w.writes, w.lines, w.lines * options_.line_bytes(), w.first});
        table.rows.back().insert(table.rows.back().end(), w.misses.begin(), w.misses.end());
    }
    options_.give("windows", table,
                  fmt::format("windows of {} of the trace's time ({}), lines of {} bytes", length,
                              options_.description().time, options_.line_bytes()));
}

void LinesCommand::add_to(CLI::App& app) {
    app_ = app.add_subcommand("lines", "how much of lines is used, and who shares them");
    options_.add_to(*app_, true);
    app_->add_option("--hottest", hottest_, "instead, so many lines that are touched most")
        ->type_name("N")
        ->check(CLI::Range(1, 1000000));
}

void LinesCommand::run() {
    options_.prepare();
    analysis::LineUse use(options_.line_bytes());
    analysis::Touches touches = options_.touches();
    options_.each_block(
        [&](const Block& block) { touches.each(block, [&](const Touch& t) { use.touch(t); }); });
    Table table;
    if (options_.grouped())
        table.columns.emplace_back(options_.by());
    const auto named = [&](std::size_t group) {
        return options_.grouped() ? std::vector<Table::Cell>{touches.name(group, options_.description())}
                                  : std::vector<Table::Cell>();
    };
    if (hottest_ != 0) {
        for (const char* name : {"address", "references", "threads"})
            table.columns.emplace_back(name);
        for (const analysis::LineUse::Line& line : use.hottest(static_cast<std::size_t>(hottest_))) {
            table.rows.push_back(named(line.group));
            table.rows.back().insert(
                table.rows.back().end(),
                {fmt::format("0x{:x}", line.line * options_.line_bytes()), line.touches, line.threads});
        }
    } else {
        for (const char* name : {"lines", "references", "bytes used", "part used", "copies a line", "shared",
                                 "and written", "falsely", "references to those"})
            table.columns.emplace_back(name);
        const std::vector<analysis::LineUse::Group> groups = use.groups();
        for (std::size_t g = 0; g < groups.size(); ++g) {
            const auto& of = groups[g];
            if (of.lines == 0)
                continue;
            const auto per_line = [&](std::uint64_t n) {
                return static_cast<double>(n) / static_cast<double>(of.lines);
            };
            table.rows.push_back(named(g));
            table.rows.back().insert(table.rows.back().end(),
                                     {of.lines, of.touches, of.bytes,
                                      per_line(of.bytes) / static_cast<double>(options_.line_bytes()),
                                      per_line(of.copies), of.shared, of.written, of.falsely,
                                      of.false_touches});
        }
    }
    options_.give("lines", table,
                  fmt::format("lines of {} bytes{}", options_.line_bytes(),
                              options_.grouped()
                                  ? fmt::format(", by {} of who touched them first", options_.by())
                                  : ""));
}

void ObjectsCommand::add_to(CLI::App& app) {
    app_ = app.add_subcommand("objects", "misses of LRU caches of objects of any size, by their bytes");
    options_.add_to(*app_, false);
    app_->add_option("--sizes", sizes_, "of caches, as 128MiB..1GiB (doubling) or 128MiB,200MiB")
        ->type_name("SIZES")
        ->required();
}

void ObjectsCommand::run() {
    options_.prepare();
    const std::vector<std::uint64_t> sizes = parse_sizes("--sizes", sizes_);
    std::vector<analysis::ObjectLru> caches(sizes.begin(), sizes.end());
    std::vector<std::uint64_t> misses(sizes.size(), 0);
    std::uint64_t references = 0;
    options_.each_block([&](const Block& block) {
        each_in_time(block, [&](const Segment&, std::size_t i) {
            ++references;
            for (std::size_t c = 0; c < caches.size(); ++c)
                misses[c] += caches[c].touch(block.addresses[i], block.what(i).size) ? 0 : 1;
        });
    });
    Table table;
    table.columns = {"bytes", "references", "misses", "ratio"};
    for (std::size_t c = 0; c < sizes.size(); ++c)
        table.rows.push_back(
            {sizes[c], references, misses[c],
             references == 0 ? 0 : static_cast<double>(misses[c]) / static_cast<double>(references)});
    options_.give("objects", table, fmt::format("{} requests; an address is an object", references));
}

} // namespace traces
