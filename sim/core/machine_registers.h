// Rule 3 where core.broadcasts is "register": a thread's machine registers. A value takes `pieces` of them,
// and one that is the same in all lanes a single one, as compilers keep it. The values used last stay as far
// as there is room; what RegisterFile says of stores holds here too.
//
// Compilers that look for short lives of registers (g++'s -flive-range-shrinkage) take a stretch of code
// without branches a piece of its values at a time in part: a value of which only a piece is alive at once
// needs no register for the others. So the last `interleaved` values used since the stretch began are here as
// well.
#pragma once

#include "sim/core/registers.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

namespace sim {

class MachineRegisters {
public:
    /// `count` registers, room for a value at least.
    MachineRegisters(std::size_t count, std::size_t pieces, std::size_t interleaved)
        : count_(count), pieces_(pieces), interleaved_(interleaved) {}

    /// Names a new value, never 0, and holds it.
    std::uint32_t make(bool broadcast) {
        last_ = last_ % ((1U << 31U) - 1) + 1;
        const std::uint32_t value = last_ << 1U | (broadcast ? 1U : 0U);
        hold(value);
        passes(value);
        return value;
    }
    /// Makes `value` the last one used; says where it was.
    RegisterFile::Use use(std::uint32_t value) {
        const bool passing = passes(value);
        const auto at = std::find(recent_.begin(), recent_.end(), value);
        if (at != recent_.end()) {
            std::rotate(recent_.begin(), at, at + 1);
            return RegisterFile::Use::resident;
        }
        hold(value);
        if (passing)
            return RegisterFile::Use::resident;
        std::uint32_t& stored = stored_[number(value) % stored_.size()];
        const bool was = stored == value;
        stored = value;
        return was ? RegisterFile::Use::stored : RegisterFile::Use::unstored;
    }
    /// At a branch, or what takes a value's pieces together.
    void end_stretch() { stretch_.clear(); }

    static bool is_broadcast(std::uint32_t value) { return (value & 1U) != 0; }
    /// How many values were made up to this one.
    static std::uint32_t number(std::uint32_t value) { return value >> 1U; }

private:
    std::size_t registers_of(std::uint32_t value) const { return is_broadcast(value) ? 1 : pieces_; }
    void hold(std::uint32_t value) {
        recent_.insert(recent_.begin(), value);
        for (taken_ += registers_of(value); taken_ > count_; recent_.pop_back())
            taken_ -= registers_of(recent_.back());
    }
    /// Makes `value` the stretch's last one used; says whether it was among those that stay.
    bool passes(std::uint32_t value) {
        if (interleaved_ == 0)
            return false;
        const auto at = std::find(stretch_.begin(), stretch_.end(), value);
        const bool there = at != stretch_.end();
        if (there)
            stretch_.erase(at);
        else if (stretch_.size() == interleaved_)
            stretch_.pop_back();
        stretch_.insert(stretch_.begin(), value);
        return there;
    }

    std::size_t count_, pieces_, interleaved_, taken_ = 0;
    std::vector<std::uint32_t> recent_, stretch_; // last used first
    std::uint32_t last_ = 0;
    std::array<std::uint32_t, 1024> stored_{};
};

} // namespace sim
