#include "sim/reports/chip_plan.h"

#include "sim/machine/describe.h"
#include "sim/network/topology.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sim {
namespace {

constexpr double gap = 6, strip = 14; // between parts; of a cache under what shares it
constexpr double lane = 26;           // between tiles, where links run
constexpr double bar = 10;            // thickness of a backbone
constexpr double apart = 1.5;         // half the distance between the two ways of a connection

struct Box {
    double width = 0, height = 0;
};

double real(std::size_t n) {
    return static_cast<double>(n);
}

std::size_t rows_of(std::size_t n, std::size_t columns) {
    return (n + columns - 1) / columns;
}

/// Of a grid of n things of a size: a little wider than high, and with few places left empty.
std::size_t columns_of(std::size_t n, Box one) {
    constexpr double wide = 1.3;
    std::size_t best = 1;
    double least = 1e300;
    for (std::size_t columns = 1; columns <= n; ++columns) {
        const std::size_t rows = rows_of(n, columns);
        const double shape = std::log(real(columns) * one.width / (real(rows) * one.height) / wide);
        const double cost = std::abs(shape) + 2 * real(rows * columns - n) / real(n);
        if (cost < least) {
            least = cost;
            best = columns;
        }
    }
    return best;
}

/// So many cores leave each as much room as this.
Box core_box(integer cores) {
    return cores <= 4 ? Box{120, 66} : cores <= 32 ? Box{76, 44} : cores <= 256 ? Box{40, 26} : Box{16, 16};
}

class Planner {
public:
    explicit Planner(const Config& c)
        : c_(c), topology_(c), core_(core_box(c.all_cores())), tile_(group(c.tile_levels())) {
        // As many units as stand at one node of a ring or mesh.
        std::vector<std::size_t> at(topology_.tiles(), 0);
        for (std::size_t unit = topology_.tiles(); unit < topology_.units(); ++unit)
            most_ = std::max(most_, ++at[topology_.node(unit)]);
    }

    ChipPlan plan() {
        const bool nodes = c_.network.topology == "ring" || c_.network.topology == "mesh";
        nodes ? at_nodes() : along_backbone();
        return std::move(out_);
    }

private:
    // ---- within a tile

    /// What shares a cache of `level`, with the cache; the tile itself stands for the level below its caches.
    Box group(unsigned level) const {
        if (level == 0)
            return core_;
        const Box inner = group(level - 1);
        const std::size_t n = children(level), columns = columns_of(n, inner);
        const double rows = real(rows_of(n, columns));
        return {real(columns) * (inner.width + gap) + gap,
                rows * (inner.height + gap) + gap + (level < c_.tile_levels() ? strip + gap : 0)};
    }
    integer cores(unsigned level) const {
        return level == 0 ? 1 : level < c_.tile_levels() ? c_.cores_sharing(level) : c_.chip.cores;
    }
    std::size_t children(unsigned level) const {
        return static_cast<std::size_t>(cores(level) / cores(level - 1));
    }

    void add(ChipPart part) { out_.parts.push_back(std::move(part)); }

    std::string cache_label(unsigned level) const {
        return fmt::format("L{} {}", level + 1, size_text(static_cast<double>(c_.cache(level).size_bytes)));
    }

    /// `first`: the number of the group's first core, of the chip.
    void place_group(unsigned level, double x, double y, integer first) {
        if (level == 0)
            return place_core(x, y, first);
        const Box own = group(level), inner = group(level - 1);
        const std::size_t n = children(level), columns = columns_of(n, inner);
        if (level == c_.tile_levels())
            add({ChipPart::tile, 0, fmt::format("tile {}", first / c_.chip.cores), x, y, own.width,
                 own.height, ""});
        for (std::size_t i = 0; i < n; ++i)
            place_group(level - 1, x + gap + real(i % columns) * (inner.width + gap),
                        y + gap + real(i / columns) * (inner.height + gap),
                        first + static_cast<integer>(i) * cores(level - 1));
        if (level < c_.tile_levels())
            add({ChipPart::cache, level,
                 fmt::format("L{} {}: {} for {} core{}", level + 1, first / cores(level),
                             size_text(static_cast<double>(c_.cache(level).size_bytes)), cores(level),
                             cores(level) == 1 ? "" : "s"),
                 x + gap, y + own.height - gap - strip, own.width - 2 * gap, strip, cache_label(level)});
    }

    void place_core(double x, double y, integer number) {
        const double l1 = core_.height * (core_.height > 20 ? 0.36 : 0.4);
        const std::string threads =
            fmt::format("{} thread{}", c_.chip.threads, c_.chip.threads == 1 ? "" : "s");
        const std::string lanes = fmt::format(", {} lane{}", c_.core.lanes, c_.core.lanes == 1 ? "" : "s");
        add({ChipPart::core, 0, fmt::format("core {}: ", number) + threads + lanes, x, y, core_.width,
             core_.height - l1, core_.width > 100 ? threads + lanes : threads});
        add({ChipPart::cache, 0,
             fmt::format("L1 {}: {}", number, size_text(static_cast<double>(c_.l1.size_bytes))), x,
             y + core_.height - l1, core_.width, l1, cache_label(0)});
    }

    // ---- beyond the tiles

    void place_unit(std::size_t unit, double x, double y, double width) {
        const std::size_t banks = topology_.tiles() + topology_.caches() * topology_.banks();
        std::string name = topology_.link_name(topology_.link_to(unit)).substr(3); // without "to "
        if (unit < banks) {
            const unsigned level = c_.cache_levels() - 1;
            const double bytes = static_cast<double>(c_.cache(level).size_bytes) / real(topology_.banks());
            add({ChipPart::bank, level, fmt::format("{}: {}", name, size_text(bytes)), x, y, width, strip,
                 fmt::format("L{}", level + 1)});
        } else {
            add({ChipPart::channel, 0,
                 fmt::format("{}: {:.4g} GB/s", name,
                             figures_.memory_bytes_per_second * 1e-9 / real(topology_.channels())),
                 x, y, width, strip, "DRAM"});
        }
    }

    /// The two links of a unit, whose ways are this one and the same beside it. `across`: how far, of each
    /// point.
    void connect(std::size_t unit, const std::vector<std::pair<double, double>>& points,
                 std::pair<double, double> across) {
        const auto moved = [&](double side) {
            std::vector<std::pair<double, double>> out = points;
            for (auto& [x, y] : out) {
                x += side * across.first;
                y += side * across.second;
            }
            return out;
        };
        if (c_.network.ideal()) {
            out_.ways.push_back({"", points, 1});
            return;
        }
        out_.links.push_back({topology_.link_name(topology_.link_from(unit)), moved(-1), 1});
        out_.links.push_back({topology_.link_name(topology_.link_to(unit)), moved(1), 1});
    }

    // ---- rings and meshes: tiles at routers, and with each what stands at its node

    struct Grid {
        std::size_t columns = 1;
        std::vector<std::pair<std::size_t, std::size_t>> cell; // column and row of each node
    };

    /// Of a ring: a closed walk in right angles, up and down the rows, and back along the first column.
    Grid ring_grid() const {
        const std::size_t n = topology_.tiles();
        Grid grid;
        if (n <= 3) {
            grid.columns = n;
            for (std::size_t i = 0; i < n; ++i)
                grid.cell.emplace_back(i, 0);
            return grid;
        }
        const auto root = static_cast<std::size_t>(std::sqrt(real(n) * tile_.width / tile_.height));
        const std::size_t rows = std::clamp<std::size_t>(root / 2 * 2, 2, n / 2);
        const std::size_t even = rows / 2 * 2;
        const std::size_t columns = (n - 1) / even, back = n - columns * even;
        grid.columns = columns + 1;
        for (std::size_t row = 0; row < even; ++row)
            for (std::size_t i = 0; i < columns; ++i)
                grid.cell.emplace_back(1 + (row % 2 == 0 ? i : columns - 1 - i), row);
        for (std::size_t i = 0; i < back; ++i)
            grid.cell.emplace_back(0, even - 1 - i);
        return grid;
    }
    Grid mesh_grid() const {
        Grid grid;
        grid.columns = topology_.columns();
        for (std::size_t n = 0; n < topology_.tiles(); ++n)
            grid.cell.emplace_back(n % grid.columns, n / grid.columns);
        return grid;
    }

    void at_nodes() {
        const Grid grid = c_.network.topology == "ring" ? ring_grid() : mesh_grid();
        const double units = most_ == 0 ? 0 : strip + gap + lane / 2;
        const double width = lane + tile_.width, height = tile_.height + gap + units + lane;
        std::size_t rows = 0;
        for (const auto& [column, row] : grid.cell)
            rows = std::max(rows, row + 1);
        const auto left = [&](std::size_t node) { return lane + real(grid.cell[node].first) * width; };
        const auto top = [&](std::size_t node) { return gap + real(grid.cell[node].second) * height; };
        const auto router = [&](std::size_t node) {
            return std::pair{left(node) - lane / 2, top(node) + tile_.height + gap + units};
        };
        for (std::size_t node = 0; node < topology_.tiles(); ++node) {
            const auto [x, y] = router(node);
            place_group(c_.tile_levels(), left(node), top(node), static_cast<integer>(node) * c_.chip.cores);
            connect(node, {{left(node) + 2, top(node) + tile_.height}, {left(node) + 2, y}, {x, y}},
                    {apart, apart});
            add({ChipPart::router, 0, fmt::format("router {}", node), x - 5, y - 5, 10, 10, ""});
        }
        std::vector<std::size_t> at(topology_.tiles(), 0);
        const double unit = most_ == 0 ? 0 : std::min(48.0, (tile_.width - 8) / real(most_) - 2);
        for (std::size_t u = topology_.tiles(); u < topology_.units(); ++u) {
            const std::size_t node = topology_.node(u);
            const double x = left(node) + 8 + real(at[node]++) * (unit + 2);
            const double y = top(node) + tile_.height + gap;
            place_unit(u, x, y, unit);
            const auto [rx, ry] = router(node);
            connect(u, {{x + unit / 2, y + strip}, {x + unit / 2, ry - 6}, {rx, ry - 6}}, {apart, apart});
        }
        for (std::size_t link = 2 * topology_.units(); link < topology_.links(); ++link)
            between_routers(link, router);
        out_.width = real(grid.columns) * width + lane;
        out_.height = real(rows) * height + gap;
    }

    /// Straight where routers stand in one row or column; else along the row first.
    template <class Router> void between_routers(std::size_t link, Router router) {
        const auto [from, to] = topology_.ends(link);
        const auto [x1, y1] = router(from);
        const auto [x2, y2] = router(to);
        const double side = from < to ? apart : -apart;
        std::vector<std::pair<double, double>> points{{x1 + side, y1 + side}};
        if (x1 != x2 && y1 != y2) // there and back bend at one corner
            points.emplace_back((from < to ? x2 : x1) + side, (from < to ? y1 : y2) + side);
        points.emplace_back(x2 + side, y2 + side);
        out_.links.push_back({topology_.link_name(link), std::move(points), 1});
    }

    // ---- crossbars, buses, and networks that take no time: units hang on what they meet in

    /// Rows of units of one width, each above a horizontal bar; the bars of a row meet at the left.
    void along_backbone() {
        const std::size_t tiles = topology_.tiles();
        const bool bus = c_.network.bus();
        std::size_t columns = columns_of(tiles, {tile_.width + gap, tile_.height + lane});
        std::size_t widest = bus ? 0 : tiles;
        for (std::size_t b = 0; bus && b < topology_.buses(); ++b)
            widest = std::max(widest, tiles_of(b).second - tiles_of(b).first);
        columns = std::min(columns, widest);
        const double right = lane + real(columns) * (tile_.width + gap);
        double y = gap;
        for (std::size_t b = 0; b < (bus ? topology_.buses() : 1); ++b) {
            const auto [first, end] = bus ? tiles_of(b) : std::pair<std::size_t, std::size_t>{0, tiles};
            std::vector<std::pair<double, double>> path; // of the bus
            for (std::size_t row = first; row < end; row += columns) {
                const std::size_t stop = std::min(end, row + columns);
                const double line = y + tile_.height + lane / 2;
                for (std::size_t t = row; t < stop; ++t) {
                    const double x = lane + real(t - row) * (tile_.width + gap);
                    place_group(c_.tile_levels(), x, y, static_cast<integer>(t) * c_.chip.cores);
                    connect(t, {{x + tile_.width / 2, y + tile_.height}, {x + tile_.width / 2, line}},
                            {2 * apart, 0});
                }
                if (bus) {
                    path.insert(path.end(), {{lane / 2 + 5, line}, {right, line}, {lane / 2 + 5, line}});
                } else
                    add({ChipPart::backbone, 0, network_name(), lane / 2, line, right - lane / 2, bar, ""});
                y = line + bar;
                last_bar_ = line;
            }
            if (bus)
                out_.links.push_back({topology_.link_name(2 * topology_.units() + b), std::move(path), 4});
        }
        y = beyond_backbone(bus ? y : last_bar_, right);
        // What joins the rows, or buses.
        const double first = gap + tile_.height + lane / 2;
        add({ChipPart::backbone, 0, network_name(), lane / 2 - 5, first, bar, last_bar_ + bar - first, ""});
        out_.width = right + lane;
        out_.height = y;
    }
    std::string network_name() const {
        return c_.network.bus() ? "hub of the buses" : c_.network.topology + " network";
    }
    std::pair<std::size_t, std::size_t> tiles_of(std::size_t bus) const {
        return {topology_.tile_of_bus(bus),
                bus + 1 < topology_.buses() ? topology_.tile_of_bus(bus + 1) : topology_.tiles()};
    }

    /// Banks and channels under bars of their own, below y; returns what is below them.
    double beyond_backbone(double y, double right) {
        const std::size_t first = topology_.tiles(), count = topology_.units() - first;
        const double room = right - lane - gap, least = 18;
        const std::size_t row =
            std::clamp<std::size_t>(static_cast<std::size_t>(room / (least + gap)), 1, count);
        const std::size_t columns = rows_of(count, rows_of(count, row));
        const double width = std::clamp(room / real(columns) - gap, least, 64.0);
        for (std::size_t i = 0; i < count; i += columns) {
            const double line = y;
            if (line != last_bar_) // those of tiles have one
                add({ChipPart::backbone, 0, network_name(), lane / 2, line, right - lane / 2, bar, ""});
            last_bar_ = line;
            y += bar + lane / 2;
            for (std::size_t k = i; k < std::min(count, i + columns); ++k) {
                const double x = lane + real(k - i) * (width + gap);
                place_unit(first + k, x, y, width);
                connect(first + k, {{x + width / 2, y}, {x + width / 2, line + bar}}, {2 * apart, 0});
            }
            y += strip + lane / 2;
        }
        return y;
    }

    const Config& c_;
    const Topology topology_;
    const ChipFigures figures_ = chip_figures(c_);
    const Box core_;
    const Box tile_;
    std::size_t most_ = 0;
    double last_bar_ = 0;
    ChipPlan out_;
};

} // namespace

ChipPlan plan_chip(const Config& config) {
    return Planner(config).plan();
}

} // namespace sim
