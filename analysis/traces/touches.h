// The lines that a trace's references touch, one after the other, and what each counts for.
#pragma once

#include "traces/description.h"
#include "traces/in_time.h"
#include "traces/reference.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace analysis {

/// What references are told apart by.
enum class By { all, structure, phase, work, kind, thread, site };
inline constexpr std::array<const char*, 7> by_names = {"all",  "structure", "phase", "work",
                                                        "kind", "thread",    "site"};

struct Touch {
    std::uint64_t line;
    std::uint64_t low, high; // bytes of the line, both in
    std::uint32_t group;
    std::uint32_t stream;
    std::uint64_t time;
    bool writes; // or modifies, or writes back or through
};

class Touches {
public:
    using Kinds = std::array<bool, traces::kind_names.size()>;
    /// Reads, writes, modifications and fetches.
    static constexpr Kinds demand = {true, true, true, true, false, false, false, false};

    /// Lines of `1 << line_shift` bytes; other kinds of references are passed over.
    Touches(unsigned line_shift, Kinds kinds, By by) : shift_(line_shift), kinds_(kinds), by_(by) {}

    /// visit(Touch) for each line of each reference of a block, merged by time.
    template <class Visit> void each(const traces::Block& block, Visit visit) {
        const std::vector<Counted> counted = classify(block);
        const std::uint64_t within = (std::uint64_t{1} << shift_) - 1;
        std::uint32_t stream = 0, group_of_stream = none;
        traces::each_in_time(block, [&](const traces::Segment& s, std::size_t i) {
            const Counted& c = counted[block.classes[i]];
            if (!c.counts)
                return;
            if (by_ == By::thread && (group_of_stream == none || s.stream != stream)) {
                stream = s.stream;
                group_of_stream = group_of(stream);
            }
            const std::uint64_t first = block.addresses[i];
            const std::uint64_t last = first + c.more < first ? ~std::uint64_t{0} : first + c.more;
            Touch touch{
                first >> shift_, first & within, within,  by_ == By::thread ? group_of_stream : c.group,
                s.stream,        block.times[i], c.writes};
            for (; touch.line != last >> shift_; ++touch.line, touch.low = 0)
                visit(touch);
            touch.high = last & within;
            visit(touch);
        });
    }

    std::uint64_t line_bytes() const { return std::uint64_t{1} << shift_; }
    /// Those met so far, by number.
    std::size_t groups() const { return keys_.size(); }
    std::string name(std::size_t group, const traces::Description& description) const;

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct Counted { // of a class
        bool counts = false, writes = false;
        std::uint32_t more = 0, group = 0; // bytes behind the first
    };
    std::vector<Counted> classify(const traces::Block& block);
    std::uint32_t group_of(std::uint64_t key);

    unsigned shift_;
    Kinds kinds_;
    By by_;
    std::map<std::uint64_t, std::uint32_t> groups_; // by number of structure, of phase, ...
    std::vector<std::uint64_t> keys_;               // of groups
};

} // namespace analysis
