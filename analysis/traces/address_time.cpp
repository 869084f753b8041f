#include "analysis/traces/address_time.h"

#include "traces/error.h"

#include <fmt/format.h>

#include <algorithm>

namespace analysis {
namespace {

std::uint32_t sum(std::uint32_t a, std::uint32_t b) {
    return a > ~b ? ~0U : a + b;
}

} // namespace

void AddressTime::merge_columns() {
    ++column_shift_;
    columns_ = (columns_ + 1) / 2;
    for (auto& [key, counts] : rows_) {
        for (std::size_t i = 0; i < counts.size(); ++i)
            counts[i / 2] = i % 2 == 0 ? counts[i] : sum(counts[i / 2], counts[i]);
        counts.resize((counts.size() + 1) / 2);
    }
}

void AddressTime::check_groups() const {
    std::size_t groups = 0;
    for (auto at = rows_.begin(); at != rows_.end(); ++groups)
        at = rows_.upper_bound({at->first.first, ~std::uint64_t{0}});
    if (groups > most_rows_)
        throw traces::Error(
            fmt::format("--by: tells more than {} groups of references apart, which no picture "
                        "has room for; group more coarsely",
                        most_rows_));
}

void AddressTime::merge_pages() {
    ++page_shift_;
    last_ = nullptr;
    std::map<Key, std::vector<std::uint32_t>> merged;
    for (auto& [key, counts] : rows_) {
        std::vector<std::uint32_t>& into = merged[{key.first, key.second >> 1U}];
        if (into.size() < counts.size())
            into.swap(counts);
        for (std::size_t i = 0; i < counts.size(); ++i)
            into[i] = sum(into[i], counts[i]);
    }
    rows_.swap(merged);
}

std::vector<AddressTime::Row> AddressTime::rows() const {
    std::vector<Row> out;
    for (const auto& [key, counts] : rows_)
        if (!counts.empty())
            out.push_back({key.first, key.second << page_shift_, &counts});
    return out;
}

} // namespace analysis
