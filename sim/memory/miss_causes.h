// Why a cache missed. Beside it stands a fully associative cache of as many lines with least-recently-used
// replacement, which sees the same references, prefetches and invalidations:
// * compulsory: nobody has asked this cache for the line before;
// * coherence: the line was there, or would have been in the other cache, until a write elsewhere dropped it;
// * conflict: the fully associative cache has the line; also where a level below, which has all of this one's
//   lines, dropped it;
// * capacity: it has not either.
// (Hill and Smith, IEEE ToC 1989.) Exact, for references in the order in which the cache sees them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace sim {

enum class MissCause { compulsory, capacity, conflict, coherence };

class MissCauses {
public:
    /// `lines`: that the cache holds.
    explicit MissCauses(std::size_t lines) : room_(lines) {}

    /// Of a miss; before use().
    MissCause of(std::uint64_t line) const {
        auto found = index_.find(line);
        if (found == index_.end())
            return MissCause::compulsory;
        const Line& l = lines_[found->second];
        return l.invalidated ? MissCause::coherence : l.there ? MissCause::conflict : MissCause::capacity;
    }
    /// A reference, hit or miss; with `allocate` off it brings no line.
    void use(std::uint64_t line, bool allocate) {
        if (newest_ != none && lines_[newest_].line == line)
            return;
        auto [found, made] = index_.try_emplace(line, static_cast<std::uint32_t>(lines_.size()));
        if (made)
            lines_.push_back({line});
        std::uint32_t i = found->second;
        if (!lines_[i].there && !allocate)
            return;
        if (lines_[i].there)
            unlink(i);
        else if (used_ == room_)
            unlink(oldest_);
        link(i);
    }
    /// A reference after which an exclusive cache does not have the line.
    void leave(std::uint64_t line) {
        auto [found, made] = index_.try_emplace(line, static_cast<std::uint32_t>(lines_.size()));
        if (made)
            lines_.push_back({line});
        if (lines_[found->second].there)
            unlink(found->second);
        lines_[found->second].invalidated = false; // it is elsewhere by the cache's own rule from now on
    }
    /// The line is dropped because it was written elsewhere; `present`: it was in the cache.
    void invalidate(std::uint64_t line, bool present) {
        auto found = index_.find(line);
        if (found == index_.end())
            return;
        Line& l = lines_[found->second];
        l.invalidated |= present || l.there;
        if (l.there)
            unlink(found->second);
    }

private:
    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct Line {
        std::uint64_t line;
        std::uint32_t newer = none, older = none;
        bool there = false, invalidated = false;
    };
    void link(std::uint32_t i) {
        Line& l = lines_[i];
        l.there = true;
        l.invalidated = false;
        l.newer = none;
        l.older = newest_;
        (newest_ == none ? oldest_ : lines_[newest_].newer) = i;
        newest_ = i;
        ++used_;
    }
    void unlink(std::uint32_t i) {
        Line& l = lines_[i];
        l.there = false;
        (l.newer == none ? newest_ : lines_[l.newer].older) = l.older;
        (l.older == none ? oldest_ : lines_[l.older].newer) = l.newer;
        --used_;
    }

    std::size_t room_, used_ = 0;
    std::uint32_t newest_ = none, oldest_ = none;
    std::vector<Line> lines_; // all that were ever asked for
    std::unordered_map<std::uint64_t, std::uint32_t> index_;
};

} // namespace sim
