// Numbers bit by bit, each bit predicted in several contexts at once, whose predictions are mixed by weights
// that learn (M. Mahoney, "Adaptive weighing of context models for lossless data compression", 2005). Whole
// numbers only, so that every host predicts the same. README.md says all that a reader needs to know.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace traces {

/// 65536 / (1 + exp(-x / 256)), x from -2047 to 2047, by straight lines between 33 points.
inline constexpr std::uint32_t squash(int x) {
    constexpr std::array<std::uint32_t, 33> at = {
        22,    36,    60,    98,    162,   267,   439,   720,   1179,  1921,  3108,
        4971,  7812,  11955, 17625, 24743, 32768, 40793, 47911, 53581, 57724, 60565,
        62428, 63615, 64357, 64816, 65097, 65269, 65374, 65438, 65476, 65500, 65514};
    const auto from = static_cast<std::uint32_t>(std::clamp(x, -2047, 2047) + 2048);
    const std::uint32_t i = from >> 7U, part = from & 127U;
    return (at[i] * (128 - part) + at[i + 1] * part) >> 7U;
}

/// Its inverse, of the upper 12 bits.
inline constexpr std::array<std::int16_t, 4096> stretches = [] {
    std::array<std::int16_t, 4096> out{};
    std::size_t next = 0;
    for (int x = -2047; x <= 2047; ++x)
        for (; next <= squash(x) >> 4U; ++next)
            out[next] = static_cast<std::int16_t>(x);
    for (; next < out.size(); ++next)
        out[next] = 2047;
    return out;
}();

/// A context's number, of what it is made of.
inline std::uint32_t context(std::uint64_t a, std::uint64_t b = 0, std::uint64_t c = 0, std::uint64_t d = 0) {
    constexpr std::uint64_t odd = 0x9E3779B97F4A7C15U, other = 0xD6E8FEB86659FD93U;
    std::uint64_t h = (a * odd + b) * other;
    h ^= h >> 32U;
    h = (h + c) * other;
    h ^= h >> 29U;
    return static_cast<std::uint32_t>(((h + d) * odd) >> 32U);
}

/// Of one kind of numbers, in so many contexts each.
template <std::size_t Inputs> class Predictor {
public:
    using Contexts = std::array<std::uint32_t, Inputs>;
    static constexpr std::uint32_t sets = 4; // of weights, for whoever asks

    /// Knows nothing yet; keeps 2^line_bits lines of counters for each input. `checked`: a line knows whose
    /// it is, and goes to another context when it is the least used of four; else contexts share lines
    /// unseen.
    void begin(unsigned line_bits, bool checked) {
        line_bits_ = line_bits;
        checked_ = checked;
        lines_.assign(Inputs << line_bits, Line{});
        weights_.assign(std::size_t{sets} * positions * 16,
                        filled(static_cast<std::int32_t>((2U << 16U) / (Inputs + 1))));
    }

    /// A number below 2^bits, from the highest bit on. Coder: a BitWriter, or a BitReader, which gives it.
    template <class Coder>
    std::uint32_t symbol(Coder& coder, const Contexts& in, std::uint32_t set, unsigned bits,
                         std::uint32_t value) {
        std::uint32_t got = 1;
        for (unsigned left = bits; left != 0;) {
            const unsigned n = std::min(4U, left);
            left -= n;
            const std::uint32_t position = std::min(last_position, (bits - left - 1) / 4);
            got = got << n | nibble(coder, in, got, set, position, n, value >> left & 15U);
        }
        return got - (1U << bits);
    }

    /// Any number: how many bits it has, 15 standing for more, and then all but the first.
    template <class Coder>
    std::uint64_t number(Coder& coder, const Contexts& in, std::uint32_t set, std::uint64_t value) {
        const auto want = static_cast<std::uint32_t>(std::bit_width(value));
        std::uint32_t length = nibble(coder, in, 0x10000000U, set, 0, 4, std::min(want, 15U));
        if (length == 15)
            length += nibble(coder, in, 0x10000001U, set, 1, 4, (want - length) / 4) * 4;
        if (length >= 15)
            length += nibble(coder, in, 0x10000002U + length, set, 1, 2, (want - length) % 4);
        length = std::min(length, 64U); // of damaged bytes
        if (length == 0)
            return 0;
        std::uint64_t got = 1;
        for (unsigned left = length - 1, chunk = 0; left != 0; ++chunk) {
            const unsigned n = std::min(4U, left);
            left -= n;
            const std::uint32_t group =
                0x20000000U + (length << 20U) + (chunk << 16U) +
                (chunk < 3 ? static_cast<std::uint32_t>(got & 0xFFFFU) : 0); // low bits of long ones: noise
            const std::uint32_t position = chunk == 0 ? std::min(last_position - 1, length) : last_position;
            got = got << n |
                  nibble(coder, in, group, set, position, n, static_cast<std::uint32_t>(value >> left) & 15U);
        }
        return got;
    }

private:
    /// How often a bit was set, of 65536, and how often it was seen, 127 at most.
    struct Counter {
        std::uint16_t set = 32768, seen = 0;
    };
    /// Of a context and of what is known of a number so far: counters by node, from 1 on. One line of a
    /// processor's caches, as most are far.
    struct alignas(64) Line {
        std::uint16_t check = 0, spare = 0;
        std::array<Counter, 15> counters;
        Counter& operator[](std::uint32_t node) { return counters[node - 1]; }
    };
    using Lines = std::array<Line*, Inputs>;
    using Weights = std::array<std::int32_t, Inputs>;
    static constexpr std::uint32_t positions = 24, last_position = positions - 1;
    static constexpr std::uint32_t most_seen = 127;
    static constexpr std::int32_t rate = 4;

    /// A counter moves so far, of 65536, towards the bit.
    static constexpr std::array<std::uint16_t, most_seen + 1> steps = [] {
        std::array<std::uint16_t, most_seen + 1> out{};
        for (std::uint32_t n = 0; n < out.size(); ++n)
            out[n] = static_cast<std::uint16_t>(655360 / (10 * n + 16));
        return out;
    }();
    /// How much of what a counter says counts, of 256.
    static constexpr std::array<std::int32_t, most_seen + 1> trust = [] {
        std::array<std::int32_t, most_seen + 1> out{};
        for (std::uint32_t n = 0; n < out.size(); ++n)
            out[n] = static_cast<std::int32_t>(256 * n / (n + 1));
        return out;
    }();
    static Weights filled(std::int32_t w) {
        Weights out;
        out.fill(w);
        return out;
    }

    Lines lines_of(const Contexts& in, std::uint32_t group) {
        Lines out;
        std::array<std::uint16_t, Inputs> checks;
        for (std::size_t i = 0; i < Inputs; ++i) { // all are on their way before the first one is waited for
            std::uint32_t h = (in[i] + group * 0x9E3779B1U) * 0x85EBCA6BU;
            h = (h ^ h >> 15U) * 0xC2B2AE35U;
            out[i] = &lines_[(i << line_bits_) + (h >> (32 - line_bits_))];
            checks[i] = static_cast<std::uint16_t>(h);
            __builtin_prefetch(out[i], 1);
        }
        if (checked_)
            for (std::size_t i = 0; i < Inputs; ++i)
                out[i] = line_of(out[i], checks[i]);
        return out;
    }
    /// This line, or one of its three neighbours, that has the check; if none has, the least seen begins
    /// anew.
    Line* line_of(Line* line, std::uint16_t check) {
        if (line->check == check)
            return line;
        const auto at = static_cast<std::size_t>(line - lines_.data());
        Line* least = line;
        for (std::size_t i = 1; i < 4; ++i) {
            Line* const other = &lines_[at ^ i];
            if (other->check == check)
                return other;
            if ((*other)[1].seen < (*least)[1].seen)
                least = other;
        }
        *least = Line{};
        least->check = check;
        return least;
    }
    template <class Coder>
    std::uint32_t nibble(Coder& coder, const Contexts& in, std::uint32_t group, std::uint32_t set,
                         std::uint32_t position, unsigned bits, std::uint32_t value) {
        const Lines lines = lines_of(in, group);
        std::uint32_t node = 1;
        for (unsigned left = bits; left-- != 0;)
            node = node << 1U | bit(coder, lines, node, set, position, value >> left & 1U);
        return node - (1U << bits);
    }
    template <class Coder>
    std::uint32_t bit(Coder& coder, const Lines& lines, std::uint32_t at, std::uint32_t set,
                      std::uint32_t position, std::uint32_t value) {
        Weights& weights = weights_[(std::size_t{set} * positions + position) * 16 + at];
        std::array<std::int32_t, Inputs> stretched;
        std::int64_t sum = 0;
        for (std::size_t i = 0; i < Inputs; ++i) {
            const Counter& c = (*lines[i])[at];
            stretched[i] = stretches[c.set >> 4U] * trust[c.seen] >> 8U;
            sum += std::int64_t{weights[i]} * stretched[i];
        }
        const std::uint32_t p = squash(static_cast<int>(std::clamp<std::int64_t>(sum >> 16U, -2047, 2047)));
        const std::uint32_t got = coder.code(p, value);
        // Without branches, as no processor guesses bits that are worth storing.
        const std::uint32_t towards = (0 - got) & 65535U; // 65535 or 0
        const std::int32_t error = static_cast<std::int32_t>(towards) - static_cast<std::int32_t>(p);
        for (std::size_t i = 0; i < Inputs; ++i) {
            const std::int32_t step = stretched[i] * error * rate >> 16U; // at most 2047 x 65535 x 4
            weights[i] = std::clamp(weights[i] + step, -most_weight, most_weight);
            Counter& c = (*lines[i])[at];
            const std::uint32_t moved = (c.set ^ towards) * steps[c.seen] >> 16U; // part of what is missing
            c.set = static_cast<std::uint16_t>(got != 0 ? c.set + moved : c.set - moved);
            c.seen = static_cast<std::uint16_t>(c.seen + (c.seen < most_seen ? 1 : 0));
        }
        return got;
    }

    static constexpr std::int32_t most_weight = std::int32_t{1} << 24;
    unsigned line_bits_ = 0;
    bool checked_ = false;
    std::vector<Line> lines_;
    std::vector<Weights> weights_;
};

} // namespace traces
