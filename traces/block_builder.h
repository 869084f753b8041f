// Collects references in the order in which they come, and makes blocks of them.
#pragma once

#include "traces/class_table.h"

namespace traces {

class BlockBuilder {
public:
    void add(const Reference& r) {
        if (turns_.empty() || turns_.back().what != Turn::What::references ||
            turns_.back().segment != r.stream)
            turns_.push_back({Turn::What::references, r.stream});
        // A piece is of what comes directly before it, at the same time.
        const bool piece = ++turns_.back().count > 1 && times_.back() == r.time;
        times_.push_back(r.time);
        addresses_.push_back(r.address);
        classes_.push_back(table_.number(r.what.part == Part::piece && !piece ? as_access(r.what) : r.what));
        tiles_.push_back(r.tile);
        any_tile_ |= r.tile;
    }
    /// A window, or the end, before the references that follow.
    void mark(const Turn& turn) {
        turns_.push_back(turn);
        ++marks_;
    }
    /// No further window fits.
    bool idle() const { return marks_ >= size() + most_idle_windows; }
    /// What stays with the reference before it, in one block.
    static bool continues(const Class& c) {
        return c.part == Part::piece || (c.kind == Kind::flush && c.part == Part::access);
    }
    std::size_t size() const { return times_.size(); }
    bool full() const { return size() >= most_references; }
    /// Replaces `block` by what was collected, and begins anew.
    void take(Block& block);

private:
    static Class as_access(Class c) {
        c.part = Part::access;
        return c;
    }
    std::vector<Segment> make_segments();
    template <class T>
    void place(std::vector<T>& column, const std::vector<Segment>& segments, std::vector<T>& out) const;

    ClassTable table_;
    std::vector<std::uint32_t> classes_, tiles_;
    std::uint32_t any_tile_ = 0; // 0: all are of none
    std::vector<std::uint64_t> times_, addresses_;
    std::size_t marks_ = 0;
    std::vector<Turn> turns_; // until a block is made, with streams in place of segments
};

} // namespace traces
