// A thread's store buffer (core.store_buffer): stores that have issued and are not in the L1 yet. An entry is
// what one machine store writes to one line; it ends when its line is in the L1 and the entry before it has
// ended (in order). The L1 is asked for lines in the same order, but not one after the other. Not modelled:
// merging of entries.
#pragma once

#include "sim/memory/tickets.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

class StoreBuffer {
public:
    struct Entry {
        std::uint64_t low = 0, high = 0; // first and last byte
        bool whole = false;              // it writes all bytes between
        cycle until = 0;                 // when its own line is there: a cycle or a ticket
        Cause from = Cause::l1;
    };

    explicit StoreBuffer(std::size_t entries) : ring_(entries) {}

    bool full() const { return size_ == ring_.size(); }
    bool empty() const { return size_ == 0; }
    std::size_t size() const { return size_; }
    /// The i-th, oldest first.
    Entry& entry(std::size_t i) {
        const std::size_t at = oldest_ + i;
        return ring_[at < ring_.size() ? at : at - ring_.size()];
    }
    void push(const Entry& e) { entry(size_++) = e; }
    /// The oldest ended, at cycle `until` by itself; returns when it did.
    cycle pop(cycle until) {
        ended_ = std::max(ended_, until);
        oldest_ = (oldest_ + 1) % ring_.size();
        --size_;
        return ended_;
    }
    /// When the last entry that is no longer here ended.
    cycle ended() const { return ended_; }

    cycle asked = 0; // the L1, for the youngest entry

private:
    std::vector<Entry> ring_;
    std::size_t oldest_ = 0, size_ = 0;
    cycle ended_ = 0;
};

} // namespace sim
