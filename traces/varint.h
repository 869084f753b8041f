// Numbers as bytes: LEB128, seven bits a byte, lowest first; signed ones zigzag; fixed ones little-endian.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>

namespace traces {

/// Small where a signed number is near 0; wraps around.
inline std::uint64_t zigzag(std::uint64_t d) {
    return d << 1U ^ (0 - (d >> 63U));
}
inline std::uint64_t unzigzag(std::uint64_t z) {
    return z >> 1U ^ (0 - (z & 1U));
}

inline constexpr std::size_t longest_varint = 10;

/// Writes to where there is room for longest_varint bytes; returns the end. (Most numbers are short; the
/// lengths of others nobody guesses, so there is no loop to their ends.)
inline char* put_varint(char* to, std::uint64_t x) {
    if (x < 0x80) {
        *to = static_cast<char>(x);
        return to + 1;
    }
    if (x >> 56U != 0) [[unlikely]] {
        while (x >= 0x80) {
            *to++ = static_cast<char>(x | 0x80U);
            x >>= 7U;
        }
        *to++ = static_cast<char>(x);
        return to;
    }
    const auto bytes = static_cast<std::size_t>((std::bit_width(x | 1U) + 6) / 7);
    x = (x & 0xFFFFFFFU) | (x & 0xFFFFFFF0000000U) << 4U; // 7 bits a byte: first of halves, ...
    x = (x & 0x3FFF00003FFFU) | (x & 0xFFFC0000FFFC000U) << 2U;
    x = (x & 0x7F007F007F007FU) | (x & 0x3F803F803F803F80U) << 1U;
    x |= 0x8080808080808080U & ((std::uint64_t{1} << (8 * (bytes - 1))) - 1);
    if constexpr (std::endian::native == std::endian::little)
        std::memcpy(to, &x, sizeof x);
    else
        for (std::size_t i = 0; i < sizeof x; ++i)
            to[i] = static_cast<char>(x >> (8 * i));
    return to + bytes;
}
inline void append_varint(std::string& out, std::uint64_t x) {
    char bytes[longest_varint]; // NOLINT: filled as far as used
    out.append(bytes, static_cast<std::size_t>(put_varint(bytes, x) - bytes));
}
template <class Number> void append_fixed(std::string& out, Number x) {
    for (std::size_t i = 0; i < sizeof(Number); ++i)
        out.push_back(static_cast<char>(std::uint64_t{x} >> (8 * i)));
}
template <class Number> Number fixed_at(const char* from) {
    std::uint64_t x = 0;
    for (std::size_t i = 0; i < sizeof(Number); ++i)
        x |= std::uint64_t{static_cast<std::uint8_t>(from[i])} << (8 * i);
    return static_cast<Number>(x);
}

/// Reads numbers from bytes; where they end too early, or one is too long, `bad` and 0.
class VarintReader {
public:
    VarintReader(const char* begin, const char* end) : at_(begin), end_(end) {}

    std::uint64_t next() {
        if (at_ != end_ && static_cast<signed char>(*at_) >= 0) [[likely]]
            return static_cast<std::uint8_t>(*at_++);
        return longer();
    }
    bool bad() const { return bad_; }
    bool ended() const { return at_ == end_; }
    const char* at() const { return at_; }

private:
    std::uint64_t longer() {
        std::uint64_t x = 0;
        for (unsigned shift = 0; at_ != end_ && shift < 64; shift += 7) {
            const auto byte = static_cast<std::uint8_t>(*at_++);
            x |= std::uint64_t{byte & 0x7FU} << shift;
            if (byte < 0x80) {
                bad_ |= shift == 63 && byte > 1;
                return x;
            }
        }
        bad_ = true;
        return 0;
    }

    const char *at_, *end_;
    bool bad_ = false;
};

} // namespace traces
