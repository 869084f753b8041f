// A page of HTML that stands alone: headings, words, drawings, tables; nothing is fetched from anywhere.
#pragma once

#include "analysis/traces/table.h"

#include <string>
#include <string_view>

namespace analysis {

class Page {
public:
    explicit Page(std::string title) : title_(std::move(title)) {}

    void heading(std::string_view text);
    void paragraph(std::string_view text);
    /// An element as it is, as of Svg::str().
    void drawing(std::string_view element);
    /// Folded away under its name.
    void table(std::string_view name, const Table& table);

    std::string html() const;

private:
    std::string title_, body_;
};

} // namespace analysis
