// Which of a few threads of neighbouring numbers comes next. A tournament of their keys: each node of a
// binary tree has the lesser of the two below it, so that a thread that comes, goes or changes its key costs
// a way to the root, without a branch that the host could mispredict, and the next one stands there.
#pragma once

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace sim {

class Turns {
public:
    using Key = std::uint64_t;
    static constexpr Key none = ~Key{0}; // later than every thread

    /// Makes room for a thread: the first one, or one of a higher number than that.
    void admit(std::uint32_t thread) {
        if (leaves_ == 0)
            first_thread_ = thread;
        const std::size_t leaves = std::bit_ceil(std::size_t{thread - first_thread_} + 1);
        if (leaves <= leaves_)
            return;
        std::vector<Key> longer(2 * leaves, none);
        std::copy_n(nodes_.begin() + static_cast<std::ptrdiff_t>(leaves_), leaves_,
                    longer.begin() + static_cast<std::ptrdiff_t>(leaves));
        for (std::size_t i = leaves - 1; i > 0; --i)
            longer[i] = std::min(longer[2 * i], longer[2 * i + 1]);
        nodes_ = std::move(longer);
        leaves_ = leaves;
    }
    /// The thread's turn is at `k`, or (none) it has no more.
    void set(std::uint32_t thread, Key k) {
        Key* const nodes = nodes_.data();
        std::size_t i = leaves_ + (thread - first_thread_);
        nodes[i] = k;
        while (i > 1) {
            k = std::min(k, nodes[i ^ 1U]);
            i /= 2;
            nodes[i] = k;
        }
    }
    /// The least of all keys, or none.
    Key first() const { return nodes_[1]; }

private:
    // The root is at 1, below the one at i stand 2 i and 2 i + 1; leaves are last.
    std::vector<Key> nodes_ = std::vector<Key>(2, none);
    std::size_t leaves_ = 0; // before the first thread
    std::uint32_t first_thread_ = 0;
};

} // namespace sim
