// When shared words were last written. Entries older than the oldest thread's horizon of interest are dropped
// as the table fills, so that it stays as small as the number of recent writes.
#pragma once

#include "sim/core/stalls.h"

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

namespace sim {

class Published {
public:
    struct Write {
        std::uint64_t word = ~std::uint64_t{0};
        cycle written = 0, visible = 0; // to threads of the writer's tile
        cycle visible_elsewhere = 0;
        std::uint32_t writer = 0;
    };

    Published() : table_(1024) {}

    /// The word's last write, or nullptr if nobody who reads from now on can notice it.
    const Write* find(std::uint64_t word) const {
        for (std::size_t i = hash(word);; ++i) {
            const Write& w = table_[i & (table_.size() - 1)];
            if (w.word == word)
                return &w;
            if (w.word == ~std::uint64_t{0})
                return nullptr;
        }
    }
    /// `oldest`: no thread reads before this cycle.
    void write(const Write& w, cycle oldest) {
        if (2 * (used_ + 1) > table_.size())
            rebuild(oldest);
        insert(w);
    }

private:
    std::size_t hash(std::uint64_t word) const {
        return static_cast<std::size_t>(word * 0x9E3779B97F4A7C15U >> 40U);
    }
    void insert(const Write& w) {
        for (std::size_t i = hash(w.word);; ++i) {
            Write& slot = table_[i & (table_.size() - 1)];
            if (slot.word == w.word || slot.word == ~std::uint64_t{0}) {
                used_ += slot.word == w.word ? 0 : 1;
                slot = w;
                return;
            }
        }
    }
    void rebuild(cycle oldest) {
        std::vector<Write> kept;
        for (const Write& w : table_)
            if (w.word != ~std::uint64_t{0} && w.visible_elsewhere > oldest)
                kept.push_back(w);
        std::size_t size = std::max<std::size_t>(1024, std::bit_ceil(4 * (kept.size() + 1)));
        table_.assign(size, Write{});
        used_ = 0;
        for (const Write& w : kept)
            insert(w);
    }

    std::vector<Write> table_;
    std::size_t used_ = 0;
};

} // namespace sim
