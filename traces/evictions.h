// Lines that leave a cache, in few bits each.
#pragma once

#include "traces/reference.h"

#include <algorithm>
#include <array>

namespace traces {

/// Of what a cache passes on, a line that is written back makes room for the next one that comes, which lies
/// in the same set, and has come itself some time ago. So it is one of the last few lines that came to that
/// set.
class Evictions {
public:
    static constexpr unsigned most_set_bits = 12;

    static bool comes(const Class& c) { return c.kind <= Kind::prefetch; }
    static bool leaves(const Class& c) { return c.kind == Kind::write_back || c.kind == Kind::clean_back; }

    explicit Evictions(unsigned set_bits)
        : mask_((std::uint64_t{1} << set_bits) - 1), sets_(std::size_t{1} << set_bits) {}
    /// A cache of its own follows.
    void clear() {
        for (Set& s : sets_)
            s.count = 0;
    }
    void come(std::uint64_t line) {
        Set& s = sets_[line & mask_];
        std::size_t at = place(s, line);
        if (at == s.count)
            at = s.count < s.lines.size() ? s.count++ : s.count - 1;
        std::copy_backward(s.lines.begin(), s.lines.begin() + static_cast<std::ptrdiff_t>(at),
                           s.lines.begin() + static_cast<std::ptrdiff_t>(at) + 1);
        s.lines[0] = line;
    }
    /// Its place among those of the set that `next` lies in, from 1 on, the last that came first; 0: it is
    /// not one of them.
    std::uint64_t leave(std::uint64_t line, std::uint64_t next) {
        Set& s = sets_[next & mask_];
        const std::size_t at = place(s, line);
        return at == s.count ? 0 : (take(s, at), at + 1);
    }
    /// The line at such a place. False: there is none.
    bool leave_place(std::uint64_t place, std::uint64_t next, std::uint64_t& line) {
        Set& s = sets_[next & mask_];
        if (place > s.count)
            return false;
        line = s.lines[place - 1];
        take(s, place - 1);
        return true;
    }

private:
    struct Set {
        std::size_t count = 0;
        std::array<std::uint64_t, 32> lines; // NOLINT: the first `count`
    };
    static std::size_t place(const Set& s, std::uint64_t line) {
        return static_cast<std::size_t>(
            std::find(s.lines.begin(), s.lines.begin() + static_cast<std::ptrdiff_t>(s.count), line) -
            s.lines.begin());
    }
    static void take(Set& s, std::size_t at) {
        std::copy(s.lines.begin() + static_cast<std::ptrdiff_t>(at) + 1,
                  s.lines.begin() + static_cast<std::ptrdiff_t>(s.count),
                  s.lines.begin() + static_cast<std::ptrdiff_t>(at));
        --s.count;
    }

    std::uint64_t mask_;
    std::vector<Set> sets_;
};

} // namespace traces
