// Two-bit counters, one for each branch site and recent history of the thread (Smith 1981; Yeh and Patt
// 1991). Sites are dense numbers, so that no two share a counter and an edit elsewhere cannot change a
// prediction. Threads of a core share the table. Not modelled: finite capacity, targets.
#pragma once

#include <cstdint>
#include <vector>

namespace sim {

class Predictor {
public:
    explicit Predictor(unsigned history_bits) : history_bits_(history_bits) {}

    /// Predicts, learns, and says whether the prediction was right. `history` is the thread's.
    bool right(std::uint32_t site, std::uint32_t& history, bool taken) {
        std::uint32_t kept = history & ((1U << history_bits_) - 1U);
        std::size_t index = (static_cast<std::size_t>(site) << history_bits_) + kept;
        if (index >= counters_.size())
            counters_.resize(2 * index + 64, weakly_taken);
        std::uint8_t& counter = counters_[index];
        bool predicted = counter >= weakly_taken;
        if (taken)
            counter = counter == 3 ? counter : static_cast<std::uint8_t>(counter + 1);
        else
            counter = counter == 0 ? counter : static_cast<std::uint8_t>(counter - 1);
        history = history << 1U | (taken ? 1U : 0U);
        return predicted == taken;
    }

private:
    static constexpr std::uint8_t weakly_taken = 2; // loops close more often than they open
    unsigned history_bits_;
    std::vector<std::uint8_t> counters_;
};

} // namespace sim
