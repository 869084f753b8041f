// Numbers for classes of references, in the order in which they come.
#pragma once

#include "traces/reference.h"

#include <cstring>
#include <type_traits>

namespace traces {

/// A block's classes, each once. (Open addressing: a class is asked for at every reference, and a block has
/// thousands of them.)
class ClassTable {
public:
    ClassTable() : slots_(least_slots, 0) {}
    std::uint32_t number(const Class& c) {
        const Words words = words_of(c);
        for (std::size_t slot = hash(words);; ++slot) {
            std::uint32_t& at = slots_[slot & (slots_.size() - 1)];
            if (at == 0)
                return add(c, at);
            if (words_of(all_[at - 1]) == words)
                return at - 1;
        }
    }
    /// Hands all classes over, by number, for an empty vector; and begins anew.
    void take(std::vector<Class>& all);

private:
    struct Words {
        std::uint64_t a, b, c;
        bool operator==(const Words& other) const {
            return ((a ^ other.a) | (b ^ other.b) | (c ^ other.c)) == 0;
        }
    };
    /// (One by one: g++ 12 copies them all to memory and reads them there again, which waits.)
    static Words words_of(const Class& c) {
        static_assert(sizeof(Class) == sizeof(Words) && std::has_unique_object_representations_v<Class>);
        const auto word = [&](std::size_t i) {
            std::uint64_t w = 0;
            std::memcpy(&w, reinterpret_cast<const char*>(&c) + i * sizeof w, sizeof w);
            return w;
        };
        return {word(0), word(1), word(2)};
    }
    static std::size_t hash(const Words& w) {
        constexpr std::uint64_t odd = 0x9E3779B97F4A7C15U, other = 0xD6E8FEB86659FD93U;
        const std::uint64_t h = (w.a * odd ^ w.b) * other ^ w.c * odd;
        return static_cast<std::size_t>(h ^ h >> 32U);
    }
    std::uint32_t add(const Class& c, std::uint32_t& slot);

    static constexpr std::size_t least_slots = 4096;
    std::vector<std::uint32_t> slots_; // a power of two of them: 1 + a number, 0: empty
    std::vector<Class> all_;           // at most half as many
};

} // namespace traces
