// Dense numbers for places in the source, in the order in which a tile first meets them. Two pointers to the
// same file name are one file, so that numbers depend on no linker.
#pragma once

#include "isa/simulated/port.h"

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace sim {

class Sites {
public:
    std::uint32_t number(isa::timing::site where) {
        const Known& k = known_[slot_of(where)];
        return k.file != nullptr ? k.number : note(where);
    }

    /// The number that it has, or would have if it were met next.
    std::uint32_t number_if_met(isa::timing::site where) const {
        const Known& k = known_[slot_of(where)];
        if (k.file != nullptr)
            return k.number;
        const auto found = all_.find({where.file, where.line});
        return found != all_.end() ? found->second : static_cast<std::uint32_t>(all_.size());
    }

    /// File and line, to number.
    const std::map<std::pair<std::string, std::uint32_t>, std::uint32_t>& all() const { return all_; }

    /// The host's caches get what number() will look at.
    void bring(isa::timing::site where) const {
        __builtin_prefetch(&known_[hash_of(where) & (known_.size() - 1)]);
    }

private:
    struct Known {
        const char* file = nullptr;
        std::uint32_t line = 0, number = 0;
    };
    static std::size_t hash_of(isa::timing::site where) {
        return (reinterpret_cast<std::uintptr_t>(where.file) + where.line) * 0x9E3779B97F4A7C15U >> 32U;
    }
    /// Where the place is in `known_`, or would be.
    std::size_t slot_of(isa::timing::site where) const {
        const std::size_t mask = known_.size() - 1;
        for (std::size_t i = hash_of(where) & mask;; i = (i + 1) & mask)
            if ((known_[i].file == where.file && known_[i].line == where.line) || known_[i].file == nullptr)
                return i;
    }
    std::uint32_t note(isa::timing::site where) {
        if (2 * ++met_ > known_.size()) {
            const std::vector<Known> before = std::exchange(known_, std::vector<Known>(2 * known_.size()));
            for (const Known& k : before)
                if (k.file != nullptr)
                    known_[slot_of({k.file, k.line})] = k;
        }
        const auto next = static_cast<std::uint32_t>(all_.size());
        const std::uint32_t number = all_.try_emplace({where.file, where.line}, next).first->second;
        known_[slot_of(where)] = {where.file, where.line, number};
        return number;
    }

    std::vector<Known> known_ = std::vector<Known>(256); // by pointer; a power of two, half empty at least
    std::size_t met_ = 0;                                // of these
    std::map<std::pair<std::string, std::uint32_t>, std::uint32_t> all_;
};

} // namespace sim
