// How often which addresses are touched when: counts by page, group and time, of a trace of any length in
// bounded memory.
#pragma once

#include "analysis/traces/touches.h"

#include <cstddef>
#include <cstdint>
#include <map>
#include <utility>
#include <vector>

namespace analysis {

/// Time is cut into columns and addresses into pages of a power of two of bytes; where there are too many,
/// two become one. A reference counts in its first byte's page.
class AddressTime {
public:
    /// At most so many columns, an even number, and rows (pages of a group that are touched).
    explicit AddressTime(std::size_t most_columns = 2048, std::size_t most_rows = 4096)
        : most_columns_(most_columns), most_rows_(most_rows) {}

    /// Throws traces::Error where there are more groups than rows.
    void add(const Access& access) {
        if (!begun_) {
            begun_ = true;
            begin_ = access.time;
        }
        // Streams of a block begin anew in time: what is earlier than the first counts as the first.
        std::uint64_t column = (std::max(access.time, begin_) - begin_) >> column_shift_;
        while (column >= most_columns_) {
            merge_columns();
            column >>= 1U;
        }
        columns_ = std::max(columns_, static_cast<std::size_t>(column) + 1);
        std::vector<std::uint32_t>& row = row_of(access.group, access.address >> page_shift_);
        if (row.size() <= column)
            row.resize(static_cast<std::size_t>(column) + 1, 0);
        row[static_cast<std::size_t>(column)] += row[static_cast<std::size_t>(column)] != ~0U ? 1 : 0;
    }

    /// Counts of a page that a group touches, by column; later ones are 0.
    struct Row {
        std::uint32_t group;
        std::uint64_t address; // of its first byte
        const std::vector<std::uint32_t>* counts;
    };
    /// By group, then by address.
    std::vector<Row> rows() const;
    std::size_t columns() const { return columns_; }
    std::uint64_t begin() const { return begin_; }
    std::uint64_t column_length() const { return std::uint64_t{1} << column_shift_; }
    std::uint64_t page_bytes() const { return std::uint64_t{1} << page_shift_; }

private:
    using Key = std::pair<std::uint32_t, std::uint64_t>; // group, page
    std::vector<std::uint32_t>& row_of(std::uint32_t group, std::uint64_t page) {
        if (last_ != nullptr && last_key_ == Key{group, page})
            return *last_;
        std::vector<std::uint32_t>* row = &rows_[{group, page}];
        while (rows_.size() > most_rows_ && page_shift_ < 63) {
            check_groups();
            merge_pages();
            page >>= 1U;
            row = &rows_[{group, page}];
        }
        last_key_ = {group, page};
        last_ = row;
        return *row;
    }
    void check_groups() const;
    void merge_columns();
    void merge_pages();

    std::size_t most_columns_, most_rows_, columns_ = 0;
    bool begun_ = false;
    std::uint64_t begin_ = 0;
    unsigned column_shift_ = 0, page_shift_ = 8;
    std::map<Key, std::vector<std::uint32_t>> rows_;
    Key last_key_;
    std::vector<std::uint32_t>* last_ = nullptr; // of the reference before
};

} // namespace analysis
