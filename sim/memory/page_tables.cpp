#include "sim/memory/page_tables.h"

namespace sim {

PageTables::PageTables(const TlbConfig& config, std::uint64_t end, std::uint64_t more) {
    // The spills behind the tables have entries too: more tables move them, which soon asks for no more.
    for (std::uint64_t before = ~std::uint64_t{0}; bytes_ != before;) {
        before = bytes_;
        place(config, end, end + bytes_ + more);
    }
}

/// The tables from `begin` on, for addresses below `end`.
void PageTables::place(const TlbConfig& config, std::uint64_t begin, std::uint64_t end) {
    constexpr std::uint64_t table = entry_bytes << bits;
    const auto levels = static_cast<unsigned>(config.table_levels());
    const std::uint64_t last = (end - 1) / static_cast<std::uint64_t>(config.page_bytes);
    std::uint64_t next = begin;
    begins_.resize(levels);
    for (unsigned level = levels; level-- > 0;) {
        begins_[level] = next;
        next += ((index(level, last) + 1) * entry_bytes + table - 1) / table * table;
    }
    bytes_ = next - begin;
}

} // namespace sim
