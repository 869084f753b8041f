#include "analysis/traces/table.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>

namespace analysis {
namespace {

std::string plain(const Table::Cell& cell, const char* of_double) {
    if (const auto* text = std::get_if<std::string>(&cell))
        return *text;
    if (const auto* number = std::get_if<std::uint64_t>(&cell))
        return fmt::format("{}", *number);
    if (const auto* number = std::get_if<std::int64_t>(&cell))
        return fmt::format("{:+}", *number);
    const double value = std::get<double>(cell);
    return std::isnan(value) ? "-" : fmt::format(fmt::runtime(of_double), value);
}

std::string quoted(const std::string& text) {
    if (text.find_first_of(",\"\r\n") == std::string::npos)
        return text;
    std::string out = "\"";
    for (const char c : text) {
        if (c == '"')
            out += c;
        out += c;
    }
    out += '"';
    return out;
}

} // namespace

std::string text_of(const Table::Cell& cell) {
    const auto* const number = std::get_if<double>(&cell);
    const double size = number != nullptr ? std::abs(*number) : 1;
    if (size != 0 && size < 0.01) // three digits at least
        return plain(cell, "{:.4g}");
    return plain(cell, size >= 1000 && size == std::floor(size) ? "{:.0f}" : "{:.4f}");
}

std::string Table::text() const {
    std::vector<std::vector<std::string>> cells = {columns};
    for (const std::vector<Cell>& row : rows) {
        cells.emplace_back();
        for (const Cell& cell : row)
            cells.back().push_back(text_of(cell));
    }
    std::vector<std::size_t> width(columns.size(), 0);
    for (const std::vector<std::string>& row : cells)
        for (std::size_t c = 0; c < row.size(); ++c)
            width[c] = std::max(width[c], row[c].size());
    std::string out;
    for (const std::vector<std::string>& row : cells) {
        std::string line;
        for (std::size_t c = 0; c < row.size(); ++c) {
            const bool left = !rows.empty() && std::holds_alternative<std::string>(rows.front()[c]);
            if (c != 0)
                line += "  ";
            line += left ? fmt::format("{:<{}}", row[c], width[c]) : fmt::format("{:>{}}", row[c], width[c]);
        }
        line.erase(line.find_last_not_of(' ') + 1);
        out += line + '\n';
    }
    return out;
}

std::string Table::csv() const {
    std::string out;
    const auto add = [&](std::size_t column, const std::string& cell) {
        if (column != 0)
            out += ',';
        out += quoted(cell);
    };
    for (std::size_t c = 0; c < columns.size(); ++c)
        add(c, columns[c]);
    out += '\n';
    for (const std::vector<Cell>& row : rows) {
        for (std::size_t c = 0; c < row.size(); ++c)
            add(c, plain(row[c], "{}"));
        out += '\n';
    }
    return out;
}

std::string Table::json() const {
    nlohmann::ordered_json out = nlohmann::ordered_json::array();
    for (const std::vector<Cell>& row : rows) {
        nlohmann::ordered_json object;
        for (std::size_t c = 0; c < row.size(); ++c)
            std::visit([&](const auto& value) { object[columns[c]] = value; }, row[c]);
        out.push_back(std::move(object));
    }
    return out.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

} // namespace analysis
