// Collects references in the order in which they come, and makes blocks of them.
#pragma once

#include "traces/reference.h"

#include <unordered_map>

namespace traces {

class BlockBuilder {
public:
    BlockBuilder();
    void add(const Reference& r) {
        if (turns_.empty() || turns_.back().what != Turn::What::references || r.stream != streams_.back())
            turns_.push_back({});
        ++turns_.back().count;
        streams_.push_back(r.stream);
        // A piece is of what comes directly before it, at the same time.
        const bool piece = turns_.back().count > 1 && times_.back() == r.time;
        times_.push_back(r.time);
        addresses_.push_back(r.address);
        classes_.push_back(r.what.part == Part::piece && !piece ? number(as_access(r.what)) : number(r.what));
        tiles_.push_back(r.tile);
        any_tile_ |= r.tile;
    }
    /// A window, or the end, before the references that follow.
    void mark(const Turn& turn) { turns_.push_back(turn); }
    /// What stays with the reference before it, in one block.
    static bool continues(const Class& c) {
        return c.part == Part::piece || (c.kind == Kind::flush && c.part == Part::access);
    }
    std::size_t size() const { return times_.size(); }
    bool full() const { return size() >= most_references; }
    /// Replaces `block` by what was collected, and begins anew.
    void take(Block& block);

private:
    struct Hash {
        std::size_t operator()(const Class& c) const { return static_cast<std::size_t>(hash(c)); }
    };
    static Class as_access(Class c) {
        c.part = Part::access;
        return c;
    }
    static std::uint64_t hash(const Class& c) {
        const std::uint64_t rest = std::uint64_t{c.size} << 32U | std::uint64_t{c.structure} << 16U |
                                   std::uint64_t{c.phase} << 8U | std::uint64_t{c.work} << 4U |
                                   static_cast<std::uint64_t>(c.kind) |
                                   static_cast<std::uint64_t>(c.part) << 62U;
        std::uint64_t h =
            (c.site + (rest ^ std::uint64_t{c.detail} << 20U) * 0x9E3779B97F4A7C15U) * 0xD6E8FEB86659FD93U;
        return h ^ h >> 32U;
    }
    std::uint32_t number(const Class& c) {
        Recent& recent = recent_[hash(c) % recent_.size()];
        if (recent.number == none || !(recent.what == c))
            recent = {c, find(c)};
        return recent.number;
    }
    std::uint32_t find(const Class& c);
    void name_segments(Block& block);

    static constexpr std::uint32_t none = ~std::uint32_t{0};
    struct Recent {
        Class what{};
        std::uint32_t number = none;
    };
    std::vector<Recent> recent_; // by hash
    std::unordered_map<Class, std::uint32_t, Hash> numbers_;
    std::vector<Class> table_;
    std::vector<std::uint32_t> streams_, classes_, tiles_;
    std::uint32_t any_tile_ = 0; // 0: all are of none
    std::vector<std::uint64_t> times_, addresses_;
    std::vector<Turn> turns_;
};

} // namespace traces
