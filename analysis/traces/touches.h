// The lines that a trace's references touch, one after the other, and what each counts for.
#pragma once

#include "analysis/traces/table.h"
#include "traces/description.h"
#include "traces/in_time.h"
#include "traces/io/interrupt.h"
#include "traces/reference.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace analysis {

/// What references are told apart by.
enum class By { all, structure, phase, work, kind, thread, site, window, tile };
inline constexpr std::array<const char*, 9> by_names = {"all",    "structure", "phase",  "work", "kind",
                                                        "thread", "site",      "window", "tile"};

/// By several at once: each combination that is met is a group. None, or `all`: all are one.
struct Grouping {
    Grouping(By what = By::all) : by{what} {} // NOLINT: one is a grouping
    Grouping(std::vector<By> what, std::uint64_t length, std::uint32_t tile = 0)
        : by(std::move(what)), window(length), only_tile(tile) {}
    std::vector<By> by;
    std::uint64_t window = 1;    // units of the trace's time, of By::window
    std::uint32_t only_tile = 0; // references for other tiles of the picture are passed over; 0: none are
};

/// A reference, as a trace has it.
struct Access {
    std::uint64_t address;
    std::uint64_t more; // bytes behind the first; of unknown sizes 0
    std::uint32_t group;
    std::uint32_t stream;
    std::uint64_t time;
    bool writes;            // or modifies, or writes back or through
    std::uint32_t tile = 0; // traces::Reference::tile
    std::uint32_t size = 0; // as the trace has it; 0: unknown
};

/// What it touches of a line.
struct Touch {
    std::uint64_t line;
    std::uint64_t low, high; // bytes of the line, both in
    std::uint32_t group;
    std::uint32_t stream;
    std::uint64_t time;
    bool writes;
    std::uint32_t tile = 0;
};

class Touches {
public:
    using Kinds = std::array<bool, traces::kind_names.size()>;
    /// Reads, writes, modifications and fetches.
    static constexpr Kinds demand = {true, true, true, true, false, false, false, false};

    /// Lines of `1 << line_shift` bytes; other kinds of references are passed over.
    Touches(unsigned line_shift, Kinds kinds, Grouping grouping);

    /// visit(Access) for each reference of a block, merged by time.
    template <class Visit> void each_access(const traces::Block& block, Visit visit) {
        classify(block);
        in_time_.each(block, [&](const traces::Segment& s, std::size_t i) {
            const Counted& c = counted_[block.classes[i]];
            const std::uint32_t tile = block.tile(i);
            if (!c.counts || (grouping_.only_tile != 0 && tile != grouping_.only_tile))
                return;
            const std::uint64_t address = block.addresses[i], time = block.times[i];
            const std::uint64_t more = std::min(c.more, ~std::uint64_t{0} - address);
            const auto segment = static_cast<std::size_t>(&s - block.segments.data());
            visit(Access{address, more, static_key_ ? c.group : group_of(segment, s.stream, c, time, tile),
                         s.stream, time, c.writes, tile, c.size});
        });
    }
    /// visit(Touch) for each line of each reference.
    template <class Visit> void each(const traces::Block& block, Visit visit) {
        const std::uint64_t within = (std::uint64_t{1} << shift_) - 1;
        each_access(block, [&](const Access& a) {
            const std::uint64_t last = a.address + a.more;
            Touch touch{
                a.address >> shift_, a.address & within, within, a.group, a.stream, a.time, a.writes, a.tile};
            for (; touch.line != last >> shift_; ++touch.line, touch.low = 0) {
                traces::check_interrupts(); // there may be millions
                visit(touch);
            }
            touch.high = last & within;
            visit(touch);
        });
    }

    std::uint64_t line_bytes() const { return std::uint64_t{1} << shift_; }
    /// Those met so far, by number.
    std::size_t groups() const { return keys_.size(); }
    /// What a group is, a cell for each that references are told apart by; windows by when they begin.
    std::vector<Table::Cell> cells(std::size_t group, const traces::Description& description) const;
    /// The same in one text.
    std::string name(std::size_t group, const traces::Description& description) const;

private:
    using Key = std::vector<std::uint64_t>; // numbers of structure, of phase, ...
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct Counted { // of a class
        bool counts = false, writes = false;
        std::uint32_t group = 0;    // if the class says it all
        std::uint32_t combined = 0; // else what the class says of it: a number in combined_
        std::uint32_t size = 0;
        std::uint64_t more = 0;
    };
    struct Recent { // group of a stream and of what classes say
        std::uint64_t window = 0;
        std::uint32_t tile = 0, group = none;
    };
    void classify(const traces::Block& block);
    std::uint32_t group_of(std::size_t segment, std::uint32_t stream, const Counted& c, std::uint64_t time,
                           std::uint32_t tile) {
        const std::uint64_t window = by_window_ ? time / grouping_.window : 0;
        Recent& recent = recent_[segment * combined_.size() + c.combined];
        if (recent.group == none || recent.window != window || recent.tile != tile)
            recent = {window, tile, group_of(combined_[c.combined], stream, window, tile)};
        return recent.group;
    }
    std::uint32_t group_of(Key key, std::uint32_t stream, std::uint64_t window, std::uint32_t tile);

    unsigned shift_;
    Kinds kinds_;
    Grouping grouping_;
    bool static_key_ = true, by_window_ = false; // static: classes alone say groups
    std::map<Key, std::uint32_t> groups_;
    std::vector<Key> keys_; // of groups
    traces::TimeOrder in_time_;
    // Of the block at hand:
    std::vector<Counted> counted_; // by class
    std::vector<Key> combined_;    // without streams and windows
    std::vector<Recent> recent_;   // by segment and number in combined_
};

} // namespace analysis
