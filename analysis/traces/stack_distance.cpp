#include "analysis/traces/stack_distance.h"

#include <algorithm>

namespace analysis {

void StackDistance::reserve(std::size_t slots) {
    const std::size_t groups = (slots + group_slots - 1) / group_slots;
    owners_.resize(groups * group_slots);
    words_.assign(groups * group_words, 0);
    tree_.assign(groups + 1, 0);
}

/// Moves all marks to the front, in their order; makes room where most slots are marked.
void StackDistance::pack() {
    std::uint32_t live = 0;
    for (std::size_t word = 0; word < words_.size(); ++word)
        for (std::uint64_t bits = words_[word]; bits != 0; bits &= bits - 1) {
            const std::uint64_t line = owners_[word * 64 + static_cast<std::size_t>(std::countr_zero(bits))];
            owners_[live] = line;
            slots_[line] = live++;
        }
    reserve(std::max(least_slots_, 3 * std::size_t{live}));
    for (next_ = 0; next_ < live;)
        mark();
}

} // namespace analysis
