// Addresses of programs, of 64 bits, as ones that a machine's memory has: blocks of 256 MiB keep all that
// lies below them and are numbered as they come, so that lines, sets and rows stay what they were.
#pragma once

#include "traces/error.h"

#include <fmt/format.h>

#include <cstdint>
#include <unordered_map>

namespace sim {

class CompactAddresses {
public:
    static constexpr unsigned block_shift = 28;
    static constexpr std::uint64_t most_blocks = 1024;
    static constexpr std::uint64_t end = most_blocks << block_shift;

    /// Throws traces::Error where the trace is of too much of memory.
    std::uint64_t operator()(std::uint64_t address) {
        const std::uint64_t block = address >> block_shift;
        if (block != last_block_) [[unlikely]] {
            last_number_ = number(block);
            last_block_ = block;
        }
        return last_number_ << block_shift | (address & ((std::uint64_t{1} << block_shift) - 1));
    }

private:
    std::uint64_t number(std::uint64_t block) {
        const std::uint64_t next = numbers_.size();
        const std::uint64_t n = numbers_.try_emplace(block, next).first->second;
        if (n >= most_blocks)
            throw traces::Error(
                fmt::format("the trace touches more than {} blocks of 256 MiB, which a machine's "
                            "memory does not have; replay a part of it",
                            most_blocks));
        return n;
    }

    std::unordered_map<std::uint64_t, std::uint64_t> numbers_;
    std::uint64_t last_block_ = ~std::uint64_t{0}, last_number_ = 0;
};

} // namespace sim
