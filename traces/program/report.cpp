#include "traces/program/report.h"

#include "analysis/plots/chart.h"
#include "analysis/traces/address_picture.h"
#include "traces/program/analysis_options.h"
#include "traces/program/tile_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace traces {
namespace {

using analysis::Axis;
using analysis::BarChart;
using analysis::LineChart;
using analysis::Page;
using analysis::Table;
using analysis::Unit;

constexpr unsigned most_sizes = 34; // powers of two of lines
constexpr std::uint64_t windows_of_a_trace = 240;
constexpr std::size_t most_series = 9, most_hottest = 40;

std::vector<std::uint64_t> powers() {
    std::vector<std::uint64_t> out;
    for (unsigned shift = 0; shift < most_sizes; ++shift)
        out.push_back(std::uint64_t{1} << shift);
    return out;
}

double number(std::uint64_t n) {
    return static_cast<double>(n);
}

BarChart bars(const char* label, Unit unit, std::initializer_list<const char*> parts) {
    BarChart out;
    out.x.label = label;
    out.x.unit = unit;
    out.parts.assign(parts.begin(), parts.end());
    return out;
}

} // namespace

Report::Report(analysis::CacheShape shape, std::uint64_t first_time, std::uint64_t last_time,
               std::uint32_t tiles)
    : shape_(shape), curve_(powers()),
      windows_(std::max<std::uint64_t>(1, (last_time - first_time) / windows_of_a_trace), {shape.lines()}),
      causes_(shape), residency_(shape), lines_(shape.line_bytes) {
    if (tiles != 0)
        tiles_.emplace(shape, tiles);
}

void Report::write(Page& page, const Names& names, const Description& description) {
    causes_.finish();
    residency_.finish();
    order_.resize(causes_.groups().size());
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::stable_sort(order_.begin(), order_.end(), [&](std::size_t a, std::size_t b) {
        return causes_.groups()[a].references > causes_.groups()[b].references;
    });
    write_curve(page, names);
    write_causes(page, names);
    write_use(page, names);
    write_time(page, description);
    page.heading("Addresses over time");
    page.paragraph("A band for each " + names.by +
                   ", time to the right; within a band addresses upwards, as far as they are touched; the "
                   "darker the more often.");
    page.drawing(analysis::with_legend(analysis::draw(addresses_, 1024, 640), addresses_, names.groups,
                                       description.time));
    write_reuse(page, names);
    write_strides(page, names);
    write_lines(page, names);
}

void Report::write_tiles(Page& page, const std::string& file, const Names& names,
                         const Picture& picture) const {
    page.heading("Over the picture");
    page.paragraph(
        fmt::format("What references for each screen tile of {} x {} pixels were, and what of them "
                    "missed: caches of {}.",
                    picture.side, picture.side, names.caches));
    TilePicture over(file, picture);
    for (const auto figure :
         {analysis::TileFigure::references, analysis::TileFigure::misses, analysis::TileFigure::ratio}) {
        over.draw(*tiles_, figure, "", true);
        page.drawing(over.svg());
    }
}

void Report::write_curve(Page& page, const Names& names) const {
    page.heading("Misses by the size of a cache");
    page.paragraph(
        fmt::format("Of one fully associative LRU cache for all threads, in lines of {} bytes: the part of "
                    "all references that miss, and what of it each {} adds.",
                    shape_.line_bytes, names.by));
    std::size_t shown = 1;
    while (shown < most_sizes && curve_.lines() > curve_.counts().sizes()[shown - 1])
        ++shown;
    std::uint64_t all = 0;
    for (const std::size_t g : order_)
        all += curve_.counts().references(g);
    LineChart chart{{"size", Unit::bytes, true}, {"misses a reference", Unit::percent}, {}};
    chart.series.push_back({"all", {}, {}, true});
    Table table{{"bytes", "all"}, {}};
    for (std::size_t i = 0; i < order_.size(); ++i) {
        if (i < most_series)
            chart.series.push_back({names.groups[order_[i]], {}, {}});
        table.columns.push_back(names.groups[order_[i]]);
    }
    for (std::size_t s = 0; s < shown; ++s) {
        const std::uint64_t bytes = curve_.counts().sizes()[s] * shape_.line_bytes;
        std::uint64_t sum = 0;
        std::vector<Table::Cell> row;
        row.emplace_back(bytes);
        row.emplace_back(std::uint64_t{0});
        for (std::size_t i = 0; i < order_.size(); ++i) {
            const std::uint64_t misses = curve_.counts().misses(order_[i], s);
            sum += misses;
            row.emplace_back(misses);
            if (i < most_series)
                chart.series[i + 1].points.emplace_back(number(bytes), part(misses, all));
        }
        row[1] = sum;
        chart.series[0].points.emplace_back(number(bytes), part(sum, all));
        table.rows.push_back(std::move(row));
    }
    page.drawing(chart.svg());
    page.table("misses", table);
}

void Report::write_causes(Page& page, const Names& names) const {
    page.heading("Why caches miss");
    page.paragraph(
        names.caches +
        ". Compulsory: the cache never had the line. Capacity: as large a fully associative one misses "
        "as well. Conflict: it does not. Sharing: another cache's write took the line; false where "
        "nothing that was written there is touched before the line goes again.");
    BarChart chart =
        bars("misses", Unit::plain, {"compulsory", "capacity", "conflict", "true sharing", "false sharing"});
    Table table{{names.by, "references", "misses", "ratio", "compulsory", "capacity", "conflict",
                 "true sharing", "false sharing"},
                {}};
    for (const std::size_t g : order_) {
        const analysis::MissCauses::Group& of = causes_.groups()[g];
        chart.bars.push_back({names.groups[g],
                              {number(of.compulsory), number(of.capacity), number(of.conflict),
                               number(of.true_sharing), number(of.false_sharing)}});
        table.rows.push_back({names.groups[g], of.references, of.misses(), part(of.misses(), of.references),
                              of.compulsory, of.capacity, of.conflict, of.true_sharing, of.false_sharing});
    }
    page.drawing(chart.svg());
    page.table("causes", table);
}

void Report::write_use(Page& page, const Names& names) const {
    page.heading("What is used of lines that come");
    page.paragraph(
        "In the same caches, from when a line comes until it goes: how many of its bytes are touched.");
    BarChart chart = bars("lines that come", Unit::plain,
                          {"up to a quarter", "up to a half", "up to three quarters", "more"});
    Table table{{names.by, "fills", "touches each", "part used", "used once", "dropped"}, {}};
    for (const std::size_t g : order_) {
        if (g >= residency_.groups().size() || residency_.groups()[g].stays == 0)
            continue;
        const analysis::LineResidency::Group& of = residency_.groups()[g];
        chart.bars.push_back({names.groups[g], {of.parts.begin(), of.parts.end()}});
        table.rows.push_back({names.groups[g], of.stays, part(of.touches, of.stays),
                              part(of.bytes, of.stays * shape_.line_bytes), of.once, of.dropped});
    }
    page.drawing(chart.svg());
    page.table("use", table);
}

void Report::write_time(Page& page, const Description& description) const {
    page.heading("Working set over time");
    page.paragraph(fmt::format(
        "In windows of {} of the trace's time ({}): bytes of the lines that are touched, of those "
        "never touched before, and of those that a fully associative LRU cache of {} "
        "for all threads misses.",
        windows_.length(), description.time,
        analysis::short_text(number(shape_.lines() * shape_.line_bytes), Unit::bytes)));
    LineChart chart{{description.time}, {"in a window", Unit::bytes}, {}, true};
    for (const char* name : {"touched", "new", "missed"})
        chart.series.push_back({name, {}, {}});
    Table table{{"begins", "references", "lines", "new", "misses"}, {}};
    for (const auto& [n, w] : windows_.windows()) {
        const std::uint64_t begin = n * windows_.length();
        const std::uint64_t values[] = {w.lines, w.first, w.misses[0]};
        for (std::size_t i = 0; i < 3; ++i)
            chart.series[i].points.emplace_back(number(begin), number(values[i] * shape_.line_bytes));
        table.rows.push_back({begin, w.touches, w.lines, w.first, w.misses[0]});
    }
    page.drawing(chart.svg());
    page.table("windows", table);
}

void Report::write_reuse(Page& page, const Names& names) const {
    page.heading("Reuse");
    page.paragraph(
        "How many other lines are touched between two touches of a line: parts of each one's references.");
    BarChart chart = bars("references", Unit::percent,
                          {"0", "1 to 15", "16 to 255", "256 to 4095", "more", "first touch"});
    Table table{{names.by, "0", "1 to 15", "16 to 255", "256 to 4095", "more", "first touch"}, {}};
    for (const std::size_t g : order_) {
        std::array<std::uint64_t, 6> counts{};
        for (std::size_t s = 0; s <= most_sizes;
             ++s) // sizes are powers of two, distances count the line itself
            counts[s == 0 ? 0 : s <= 4 ? 1 : s <= 8 ? 2 : s <= 12 ? 3 : 4] += curve_.counts().at(g, s);
        counts[5] = curve_.counts().firsts(g);
        BarChart::Bar bar{names.groups[g], {}};
        std::vector<Table::Cell> row;
        row.emplace_back(names.groups[g]);
        for (const std::uint64_t n : counts) {
            bar.parts.push_back(part(n, curve_.counts().references(g)));
            row.emplace_back(n);
        }
        chart.bars.push_back(std::move(bar));
        table.rows.push_back(std::move(row));
    }
    page.drawing(chart.svg());
    page.table("reuse", table);
}

void Report::write_strides(Page& page, const Names& names) const {
    page.heading("Strides");
    page.paragraph(
        "From a reference to the next one of its thread and " + names.by +
        ": the same address, where the last one ended, as far as the step before, or anything else.");
    using analysis::Strides;
    BarChart chart = bars("references", Unit::percent, {});
    chart.parts.assign(Strides::pattern_names.begin(), Strides::pattern_names.end());
    Table table{{names.by, "references"}, {}};
    table.columns.insert(table.columns.end(), Strides::pattern_names.begin(), Strides::pattern_names.end());
    table.columns.emplace_back("most frequent, bytes");
    for (const std::size_t g : order_) {
        if (g >= strides_.groups().size())
            continue;
        const Strides::Group& of = strides_.groups()[g];
        BarChart::Bar bar{names.groups[g], {}};
        std::vector<Table::Cell> row;
        row.emplace_back(names.groups[g]);
        row.emplace_back(of.references());
        for (const std::uint64_t n : of.counts) {
            bar.parts.push_back(part(n, of.references()));
            row.emplace_back(n);
        }
        std::string most;
        for (const auto& [value, count] : of.values.most(4))
            most += fmt::format("{}{:+} ({:.1f} %)", most.empty() ? "" : ", ", value,
                                100 * part(count, of.references()));
        row.emplace_back(std::move(most));
        chart.bars.push_back(std::move(bar));
        table.rows.push_back(std::move(row));
    }
    page.drawing(chart.svg());
    page.table("strides", table);
}

void Report::write_lines(Page& page, const Names& names) const {
    page.heading("Lines and who shares them");
    page.paragraph("Over the whole trace, by " + names.by + " of who touched them first.");
    BarChart chart = bars("bytes of lines", Unit::bytes,
                          {"of one thread", "shared, only read", "shared and written", "falsely shared"});
    Table table{{names.by, "lines", "part used", "copies a line", "shared", "and written", "falsely"}, {}};
    const std::vector<analysis::LineUse::Group> groups = lines_.groups();
    for (const std::size_t g : order_) {
        if (g >= groups.size() || groups[g].lines == 0)
            continue;
        const analysis::LineUse::Group& of = groups[g];
        const auto bytes = [&](std::uint64_t lines) { return number(lines * shape_.line_bytes); };
        chart.bars.push_back({names.groups[g],
                              {bytes(of.lines - of.shared), bytes(of.shared - of.written),
                               bytes(of.written - of.falsely), bytes(of.falsely)}});
        table.rows.push_back({names.groups[g], of.lines, part(of.bytes, of.lines * shape_.line_bytes),
                              part(of.copies, of.lines), of.shared, of.written, of.falsely});
    }
    page.drawing(chart.svg());
    page.table("sharing", table);
    Table hottest{{names.by, "address", "references", "threads"}, {}};
    for (const analysis::LineUse::Line& line : lines_.hottest(most_hottest))
        hottest.rows.push_back({names.groups[line.group],
                                fmt::format("0x{:x}", line.line * shape_.line_bytes), line.touches,
                                line.threads});
    page.table("the lines that are touched most", hottest);
}

} // namespace traces
