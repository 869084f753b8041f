#include "sim/reports/chip_drawing.h"

#include "sim/machine/describe.h"
#include "sim/network/topology.h"
#include "sim/reports/chip_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <string>

namespace sim {
namespace {

constexpr double margin = 12, heading = 44, legend_line = 17;
constexpr std::string_view link_colour = "#8a8a8a";
constexpr std::array<std::string_view, most_levels> cache_colours = {"#9ecae1", "#6baed6", "#4a90c4",
                                                                     "#2f6ea5", "#1f4e79"};

std::string_view colour_of(const ChipPart& part) {
    switch (part.kind) {
    case ChipPart::tile:
        return "#f0ede4";
    case ChipPart::core:
        return "#fdc086";
    case ChipPart::cache:
    case ChipPart::bank:
        return cache_colours[part.level];
    case ChipPart::router:
    case ChipPart::backbone:
        return "#5f5f5f";
    case ChipPart::channel:
        return "#74c476";
    }
    return "#000000";
}

/// The largest size up to 11 at which a label fits a box; 0: none that can be read.
double text_size(std::string_view label, double width, double height) {
    constexpr double letter = 0.58, least = 7; // widths of letters, of their height
    const double size =
        std::min({11.0, height * 0.85, (width - 2) / (letter * static_cast<double>(label.size()))});
    return size < least || label.empty() ? 0 : size;
}

struct Entry {
    std::string_view colour;
    std::string text;
};

std::string times(integer n, const char* one, const char* more = "s") {
    return fmt::format("{} {}{}", n, one, n == 1 ? "" : more);
}

std::string whose(const Config& c, unsigned level) {
    const integer cores = level == 0 ? 1 : c.cores_sharing(level);
    return cores == 1               ? "for one core each"
           : cores == c.all_cores() ? "for all cores"
           : cores == c.chip.cores  ? "for a tile each"
                                    : fmt::format("for {} cores each", cores);
}

std::string network_text(const Config& c) {
    if (c.network.ideal())
        return "network: ideal, takes no time; lines show who meets whom";
    const Topology t(c);
    const std::string kind = c.network.bus() ? times(c.network.buses, "bus", "es")
                             : c.network.topology == "mesh"
                                 ? fmt::format("mesh, {} x {}", t.columns(), t.rows())
                                 : c.network.topology;
    return fmt::format("network: {}, {} of {} bytes a cycle, {} cycles a hop", kind,
                       times(static_cast<integer>(t.links()), "link"), c.network.link_bytes,
                       c.network.hop_cycles);
}

std::vector<Entry> legend(const Config& c) {
    const ChipFigures f = chip_figures(c);
    std::vector<Entry> out;
    out.push_back(
        {"#f0ede4", fmt::format("{} of {}", times(c.chip.tiles, "tile"), times(c.chip.cores, "core"))});
    out.push_back(
        {"#fdc086", fmt::format("{} of {}, {} of {} a cycle; {:.4g} GHz", times(c.all_cores(), "core"),
                                times(c.chip.threads, "thread"), times(c.core.issue_width, "instruction"),
                                times(c.core.lanes, "lane"), 1e3 / static_cast<double>(c.chip.clock_ps))});
    for (unsigned level = 0; level < c.cache_levels(); ++level) {
        const integer cores = level == 0 ? 1 : c.cores_sharing(level), caches = c.all_cores() / cores;
        out.push_back({cache_colours[level],
                       fmt::format("{} L{} of {} {}{}; {:.3g} ns", caches, level + 1,
                                   size_text(static_cast<double>(c.cache(level).size_bytes)), whose(c, level),
                                   c.beyond_tiles(level)
                                       ? fmt::format(", {} a cache", times(c.cache(level).banks, "bank"))
                                       : "",
                                   level == 0 ? f.l1_ns : f.below[level - 1].ns)});
    }
    out.push_back({link_colour, network_text(c)});
    out.push_back({"#74c476", fmt::format("memory: {} of {}, {:.4g} GB/s in all; {:.3g} ns",
                                          times(c.memory.channels, "channel"), c.memory.preset,
                                          f.memory_bytes_per_second * 1e-9, f.memory_closed_ns)});
    return out;
}

} // namespace

analysis::Svg draw_chip(const Config& config, std::string_view title) {
    const ChipPlan plan = plan_chip(config);
    const std::vector<Entry> entries = legend(config);
    double wide = 6.5 * static_cast<double>(title.size());
    for (const Entry& entry : entries)
        wide = std::max(wide, 6.8 * static_cast<double>(entry.text.size()) + 20);
    const double width = std::max(plan.width, wide) + 2 * margin;
    const double below = heading + plan.height + margin;
    analysis::Svg svg(width, below + legend_line * static_cast<double>(entries.size()) + margin);
    svg.text(margin, margin + 16, title, analysis::Svg::Anchor::start, 16);
    const double left = margin + (width - 2 * margin - plan.width) / 2, top = heading;
    const auto moved = [&](std::vector<std::pair<double, double>> points) {
        for (auto& [x, y] : points) {
            x += left;
            y += top;
        }
        return points;
    };
    for (const ChipLink& way : plan.ways)
        svg.path(moved(way.points), "#c4c4c4", way.width);
    for (const ChipLink& link : plan.links)
        svg.path(moved(link.points), link_colour, link.width, "link " + link.name);
    for (const ChipPart& part : plan.parts) {
        const double x = left + part.x, y = top + part.y;
        svg.rectangle(x, y, part.width, part.height, colour_of(part), part.name);
        if (const double size = text_size(part.label, part.width, part.height); size > 0)
            svg.text(x + part.width / 2, y + part.height / 2 + 0.36 * size, part.label,
                     analysis::Svg::Anchor::middle, size);
    }
    for (std::size_t i = 0; i < entries.size(); ++i) {
        const double y = below + legend_line * static_cast<double>(i);
        svg.rectangle(margin, y, 12, 12, entries[i].colour);
        svg.text(margin + 18, y + 10, entries[i].text);
    }
    return svg;
}

} // namespace sim
