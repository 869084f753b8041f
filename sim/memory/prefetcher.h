// What a cache's prefetcher asks for after an access. `next`: the lines that follow one that missed, or that
// was prefetched and is used for the first time (tagged prefetching; Smith, Computing Surveys 1982).
// `stride`: a table by site of the program (there are no program counters) of the last line and its distance
// from the one before; the same distance twice in a row, and the lines that follow at that distance are asked
// for (reference prediction; Chen and Baer, IEEE ToC 1995). Sites of all threads share the table.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace sim {

/// Where in the program the access at hand stands.
struct SiteAtHand {
    static constexpr std::uint32_t none = ~std::uint32_t{0}, unnumbered = none - 1;
    std::uint32_t number = none;
    bool first = false; // no line of the operation has been accessed yet
};

class Prefetcher {
public:
    enum class Kind : std::uint8_t { none, next, stride };

    Prefetcher(std::string_view kind, std::uint32_t degree, std::size_t sites)
        : kind_(kind == "next"     ? Kind::next
                : kind == "stride" ? Kind::stride
                                   : Kind::none),
          degree_(degree), table_(kind_ == Kind::stride ? sites : 0) {}

    Kind kind() const { return kind_; }
    /// Calls ask(line) for each line wanted. `first`: the line missed, or is used first since it was
    /// prefetched.
    template <class Ask> void after(std::uint64_t line, bool first, std::uint32_t site, Ask ask) {
        auto distance = static_cast<std::int64_t>(first ? 1 : 0);
        if (kind_ == Kind::stride)
            distance = site == SiteAtHand::none ? 0 : learn(line, site);
        auto at = static_cast<std::int64_t>(line);
        for (std::uint32_t i = 0; distance != 0 && i < degree_; ++i)
            if ((at += distance) >= 0)
                ask(static_cast<std::uint64_t>(at));
    }

private:
    struct Row {
        std::uint32_t site = SiteAtHand::none;
        std::uint64_t last = 0;
        std::int64_t distance = 0;
    };
    /// The distance to go on with; 0: none is known.
    std::int64_t learn(std::uint64_t line, std::uint32_t site) {
        Row& row = table_[site % table_.size()];
        if (row.site != site) {
            row = {site, line};
            return 0;
        }
        auto distance = static_cast<std::int64_t>(line - row.last);
        if (distance == 0)
            return 0;
        bool again = distance == row.distance;
        row.last = line;
        row.distance = distance;
        return again ? distance : 0;
    }

    Kind kind_;
    std::uint32_t degree_;
    std::vector<Row> table_;
};

} // namespace sim
