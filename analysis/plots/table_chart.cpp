#include "analysis/plots/table_chart.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <stdexcept>

namespace analysis {
namespace {

std::size_t column_of(const Table& table, const std::string& name) {
    const auto found = std::find(table.columns.begin(), table.columns.end(), name);
    if (found == table.columns.end())
        throw std::logic_error("a table has no column " + name);
    return static_cast<std::size_t>(found - table.columns.begin());
}

double number_of(const Table::Cell& cell) {
    if (const auto* n = std::get_if<std::uint64_t>(&cell))
        return static_cast<double>(*n);
    if (const auto* n = std::get_if<std::int64_t>(&cell))
        return static_cast<double>(*n);
    const auto* n = std::get_if<double>(&cell);
    return n != nullptr ? *n : std::numeric_limits<double>::quiet_NaN();
}

/// Of a row; sizes as people say them.
std::string name_of(const Table& table, const std::vector<Table::Cell>& row, std::size_t names) {
    std::string out;
    for (std::size_t c = 0; c < names; ++c) {
        if (!out.empty())
            out += ", ";
        out += table.columns[c] == "bytes" ? short_text(number_of(row[c]), Unit::bytes) : text_of(row[c]);
    }
    return out;
}

} // namespace

std::string lines_of(const Table& table, std::size_t names, const std::string& x,
                     const std::vector<std::string>& ys, const Axis& x_axis, const Axis& y_axis) {
    LineChart chart;
    chart.x = x_axis;
    chart.y = y_axis;
    std::map<std::string, std::size_t> series; // by name
    const std::size_t at = column_of(table, x);
    for (const std::vector<Table::Cell>& row : table.rows)
        for (const std::string& y : ys) {
            std::string name = name_of(table, row, names);
            if (name.empty() || ys.size() > 1)
                name += (name.empty() ? "" : ", ") + y;
            const auto [found, fresh] = series.try_emplace(name, chart.series.size());
            if (fresh) {
                chart.series.emplace_back();
                chart.series.back().name = name;
            }
            const double value = number_of(row[column_of(table, y)]);
            if (std::isfinite(value))
                chart.series[found->second].points.emplace_back(number_of(row[at]), value);
        }
    return chart.svg();
}

std::string bars_of(const Table& table, std::size_t names, const std::vector<std::string>& parts,
                    const Axis& axis) {
    BarChart chart;
    chart.x = axis;
    chart.parts = parts;
    for (const std::vector<Table::Cell>& row : table.rows) {
        chart.bars.emplace_back();
        chart.bars.back().name = names == 0 ? "all" : name_of(table, row, names);
        for (const std::string& part : parts) {
            const double value = number_of(row[column_of(table, part)]);
            chart.bars.back().parts.push_back(std::isfinite(value) ? value : 0);
        }
    }
    return chart.svg();
}

} // namespace analysis
