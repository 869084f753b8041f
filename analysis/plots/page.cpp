#include "analysis/plots/page.h"

#include "analysis/plots/svg.h"

#include <fmt/format.h>

namespace analysis {

void Page::heading(std::string_view text) {
    body_ += fmt::format("<h2>{}</h2>\n", escaped(text));
}

void Page::paragraph(std::string_view text) {
    body_ += fmt::format("<p>{}</p>\n", escaped(text));
}

void Page::drawing(std::string_view element) {
    body_ += fmt::format("<div class=\"drawing\">\n{}</div>\n", element);
}

void Page::table(std::string_view name, const Table& table) {
    body_ += fmt::format("<details><summary>{}</summary>\n<table>\n<tr>", escaped(name));
    for (const std::string& column : table.columns)
        body_ += fmt::format("<th>{}</th>", escaped(column));
    body_ += "</tr>\n";
    for (const std::vector<Table::Cell>& row : table.rows) {
        body_ += "<tr>";
        for (const Table::Cell& cell : row)
            body_ += fmt::format("<td{}>{}</td>",
                                 std::holds_alternative<std::string>(cell) ? "" : " class=\"number\"",
                                 escaped(text_of(cell)));
        body_ += "</tr>\n";
    }
    body_ += "</table>\n</details>\n";
}

std::string Page::html() const {
    constexpr std::string_view style =
        "body{font-family:sans-serif;max-width:1220px;margin:2em auto;padding:0 1em;color:#222}"
        "h2{margin-top:2em;border-bottom:1px solid #ccc}"
        "table{border-collapse:collapse;font-size:13px}th,td{padding:2px 8px;border-bottom:1px solid #eee}"
        "th{text-align:left}td.number{text-align:right;font-variant-numeric:tabular-nums}"
        ".drawing{overflow-x:auto}details{margin:0.5em 0}summary{cursor:pointer}";
    return fmt::format(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<title>{0}</title>\n"
        "<style>{1}</style>\n</head>\n<body>\n<h1>{0}</h1>\n{2}</body>\n</html>\n",
        escaped(title_), style, body_);
}

} // namespace analysis
