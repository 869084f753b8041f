// Bits in as little room as their probabilities ask for: a binary arithmetic coder of 32 bits without carries
// (as in M. Mahoney's PAQ; Witten, Neal & Cleary, "Arithmetic coding for data compression", 1987).
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>

namespace traces {

/// [low, high] is what bytes that follow may say; a bit takes its share of it.
class Interval {
protected:
    std::uint32_t middle(std::uint32_t p) const {
        return low_ + static_cast<std::uint32_t>(std::uint64_t{high_ - low_} * p >> 16U);
    }
    void narrow(std::uint32_t middle, std::uint32_t bit) {
        high_ = bit != 0 ? middle : high_; // of both a processor takes one, without a guess
        low_ = bit != 0 ? low_ : middle + 1;
    }
    bool byte_is_known() const { return (low_ ^ high_) >> 24U == 0; }
    void shift() {
        low_ <<= 8U;
        high_ = high_ << 8U | 0xFFU;
    }

    std::uint32_t low_ = 0, high_ = ~std::uint32_t{0};
};

class BitWriter : Interval {
public:
    explicit BitWriter(std::string& out) : out_(out) {}
    /// Of a bit that is set with probability p / 65536, 0 < p < 65536. Returns it.
    std::uint32_t code(std::uint32_t p, std::uint32_t bit) {
        narrow(middle(p), bit);
        for (; byte_is_known(); shift())
            out_.push_back(static_cast<char>(high_ >> 24U));
        return bit;
    }
    /// After the last bit.
    void finish() {
        for (int i = 0; i < 4; ++i, shift())
            out_.push_back(static_cast<char>(low_ >> 24U));
    }

private:
    std::string& out_;
};

class BitReader : Interval {
public:
    explicit BitReader(const std::string& bytes) : at_(bytes.data()), end_(at_ + bytes.size()) {
        for (int i = 0; i < 4; ++i)
            take();
    }
    /// The next bit, which was written with the same p; the second argument is not looked at.
    std::uint32_t code(std::uint32_t p, std::uint32_t /*bit*/) {
        const std::uint32_t m = middle(p), bit = value_ <= m ? 1 : 0;
        narrow(m, bit);
        for (; byte_is_known(); shift())
            take();
        return bit;
    }
    /// All bytes were read, and none after the last.
    bool ended() const { return at_ == end_ && !beyond_; }
    bool beyond() const { return beyond_; }

private:
    void take() {
        beyond_ |= at_ == end_;
        value_ = value_ << 8U | (at_ == end_ ? 0 : static_cast<std::uint8_t>(*at_++));
    }

    const char *at_, *end_;
    std::uint32_t value_ = 0;
    bool beyond_ = false;
};

} // namespace traces
