#include "traces/class_table.h"

#include <algorithm>

namespace traces {

/// `slot`: where it is looked for.
std::uint32_t ClassTable::add(const Class& c, std::uint32_t& slot) {
    all_.push_back(c);
    const auto count = static_cast<std::uint32_t>(all_.size());
    slot = count;
    if (2 * all_.size() <= slots_.size())
        return count - 1;
    slots_.assign(2 * slots_.size(), 0);
    for (std::uint32_t i = 0; i < count; ++i) {
        std::size_t at = hash(words_of(all_[i]));
        while (slots_[at & (slots_.size() - 1)] != 0)
            ++at;
        slots_[at & (slots_.size() - 1)] = i + 1;
    }
    return count - 1;
}

void ClassTable::take(std::vector<Class>& all) {
    all.clear();
    all.swap(all_);
    std::fill(slots_.begin(), slots_.end(), 0);
}

} // namespace traces
