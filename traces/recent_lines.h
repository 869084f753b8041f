// The last lines that came to each set of each cache: those that leave it are among them.
#pragma once

#include "traces/evictions.h"

#include <unordered_map>
#include <vector>

namespace traces {

/// As Evictions, of many streams in turns, with the classes that lines came with.
class RecentLines {
public:
    struct Line {
        std::uint64_t line;
        std::uint32_t what; // the class that it came with
    };
    static std::uint64_t mask(unsigned set_bits) { return (std::uint64_t{1} << set_bits) - 1; }

    void begin(unsigned set_bits) {
        mask_ = mask(set_bits);
        sets_.clear();
    }
    void come(std::uint32_t stream, std::uint64_t line, std::uint32_t what) {
        Set& s = set(stream, line);
        const std::size_t at = place(s, line);
        if (at != s.size())
            s.erase(s.begin() + static_cast<std::ptrdiff_t>(at));
        else if (s.size() == most)
            s.pop_back();
        s.insert(s.begin(), {line, what});
    }
    /// Where a line is among those of the set that `next` lies in, from 1 on, the last that came first; 0:
    /// nowhere.
    std::uint64_t place_of(std::uint32_t stream, std::uint64_t line, std::uint64_t next) const {
        const auto found = sets_.find(key(stream, next));
        if (found == sets_.end())
            return 0;
        const std::size_t at = place(found->second, line);
        return at == found->second.size() ? 0 : at + 1;
    }
    /// Takes the one at such a place. False: there is none.
    bool leave(std::uint32_t stream, std::uint64_t place, std::uint64_t next, Line& line) {
        Set& s = set(stream, next);
        if (place == 0 || place > s.size())
            return false;
        line = s[place - 1];
        s.erase(s.begin() + static_cast<std::ptrdiff_t>(place - 1));
        return true;
    }

private:
    using Set = std::vector<Line>;
    static constexpr std::size_t most = 32;
    static std::size_t place(const Set& s, std::uint64_t line) {
        return static_cast<std::size_t>(
            std::find_if(s.begin(), s.end(), [&](const Line& l) { return l.line == line; }) - s.begin());
    }
    std::uint64_t key(std::uint32_t stream, std::uint64_t line) const {
        return std::uint64_t{stream} << Evictions::most_set_bits | (line & mask_);
    }
    Set& set(std::uint32_t stream, std::uint64_t line) { return sets_[key(stream, line)]; }

    std::uint64_t mask_ = 0;
    std::unordered_map<std::uint64_t, Set> sets_; // those that lines came to
};

} // namespace traces
