// Rows of names and numbers, as text for people, CSV and JSON for programs.
#pragma once

#include <cstdint>
#include <string>
#include <variant>
#include <vector>

namespace analysis {

struct Table {
    using Cell = std::variant<std::string, std::uint64_t, std::int64_t, double>;
    std::vector<std::string> columns;
    std::vector<std::vector<Cell>> rows;

    /// Columns below each other, numbers to the right; doubles with four digits; not-a-number is a dash, as
    /// in CSV (in JSON null).
    std::string text() const;
    /// RFC 4180, with a line of names.
    std::string csv() const;
    /// An array of objects by column.
    std::string json() const;
};

/// A cell as Table::text() has it.
std::string text_of(const Table::Cell& cell);

} // namespace analysis
