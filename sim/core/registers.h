// Rule 3: a thread's vector registers hold the last R values used. A value used that is not among them was
// stored and comes back through the L1; the store is charged at the first such use. Whether a value was
// stored is remembered for the last 1024 stored ones; a value older than that is charged its store again.
#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>

namespace sim {

class RegisterFile {
public:
    enum class Use { resident, stored, unstored };

    explicit RegisterFile(std::size_t capacity) : recent_((capacity + 7) / 8 * 8), capacity_(capacity) {}

    /// Names a new value and holds it.
    std::uint32_t make() {
        if (++last_ == 0)
            last_ = 1;
        if (capacity_ != 0)
            push(capacity_ - 1, last_);
        return last_;
    }
    /// Makes `value` the last one used; says where it was.
    Use use(std::uint32_t value) {
        if (capacity_ == 0 || value == 0 || recent_[0] == value)
            return Use::resident;
        for (std::size_t i = 1; i < capacity_; ++i)
            if (recent_[i] == value) {
                push(i, value);
                return Use::resident;
            }
        push(capacity_ - 1, value);
        std::uint32_t& stored = stored_[value % stored_.size()];
        Use where = stored == value ? Use::stored : Use::unstored;
        stored = value;
        return where;
    }

private:
    void push(std::size_t out, std::uint32_t value) {
        std::uint32_t* recent = recent_.data();
        if (out > 16) {
            std::memmove(recent + 1, recent, out * sizeof(std::uint32_t));
            recent[0] = value;
            return;
        }
        std::uint32_t carried = value; // a few moves are cheaper than a call
        for (std::size_t i = 0; i <= out; ++i)
            std::swap(carried, recent[i]);
    }

    std::vector<std::uint32_t> recent_; // last used first
    std::size_t capacity_;
    std::array<std::uint32_t, 1024> stored_{};
    std::uint32_t last_ = 0;
};

} // namespace sim
