// Tags of a set-associative cache, replacement, and three flags a line, or four. Knows nothing of time or
// data. A set lies in consecutive memory of the host, 64 bytes for eight ways: the tags, filled up to groups
// of four; what replacement remembers; the flags. Replacement remembers
// * lru: the ways, last used first, a byte each;
// * plru: a bit for each inner node of a binary tree over the ways, which leads to the half that was not used
//   last;
// * srrip: two bits a way, how far off its next use is taken to be: 2 when filled, 0 when used again; the
//   first way at 3 goes, all others wait one more where none is (Jaleel et al., ISCA 2010, hit priority);
// * random: nothing; the cache's own numbers, which always begin alike, choose.
// The latter three have the way that was used last in the first byte. Empty ways are always taken first.
#pragma once

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <stdexcept>
#include <string_view>
#include <vector>
#ifdef __SSE2__
#include <emmintrin.h>
#endif

namespace sim {

enum class Replacement : std::uint8_t { lru, plru, srrip, random };
/// Of the name in a machine file.
Replacement replacement_of(std::string_view name);

class CacheArray {
public:
    using Entry = std::uint32_t; // set << 6 | way
    static constexpr Entry none = ~Entry{0};
    static constexpr std::uint64_t no_line = ~std::uint64_t{0};

    /// `sets` is a power of two, at most 2^25; at most 64 ways, for plru a power of two.
    /// `coherent`: lines have the flag `shared` too.
    explicit CacheArray(std::size_t sets, std::size_t ways, Replacement replacement = Replacement::lru,
                        bool coherent = false);
    CacheArray(const CacheArray&) = delete;
    CacheArray& operator=(const CacheArray&) = delete;

    /// Where a line (number, not address) is, or none.
    Entry find(std::uint64_t line) const {
        const std::byte* set = set_of(line);
        std::uint32_t wanted = tag(line);
        auto recent = static_cast<std::uint32_t>(set[order_at_]);
        if (tag_at(set, recent) == wanted)
            return entry(line, recent);
        for (std::uint32_t w = 0; w < ways_; w += 4)
            if (std::uint32_t equal = equal_tags(set + w * 4, wanted); equal != 0)
                return entry(line, w + static_cast<std::uint32_t>(std::countr_zero(equal)));
        return none;
    }
    /// The host's caches get the set of a line.
    void bring_set(std::uint64_t line) const { __builtin_prefetch(set_of(line)); }
    /// Where a line is; of use as long as nothing else is done to the array.
    struct Place {
        std::byte* set;
        std::uint32_t way;
    };
    /// Whether the line is there and not on its way; where it is then.
    [[gnu::always_inline]] bool find_present(std::uint64_t line, Place& at) const {
        std::byte* const set = set_of(line);
        const std::uint64_t wanted = line >> set_bits_;
        if (wanted >= empty) [[unlikely]]
            return false;
        auto way = static_cast<std::uint32_t>(set[order_at_]);
        if (tag_at(set, way) != wanted) {
            const auto narrow = static_cast<std::uint32_t>(wanted);
            std::uint32_t group = 0, equal = equal_tags(set, narrow);
            while (equal == 0) {
                if ((group += 4) >= ways_)
                    return false;
                equal = equal_tags(set + group * 4, narrow);
            }
            way = group + static_cast<std::uint32_t>(std::countr_zero(equal));
        }
        at = {set, way};
        return !in_flight(set + flags_at_, way);
    }
    /// It is used.
    void use(Place at, bool write) {
        if (write) {
            std::uint64_t dirty;
            std::memcpy(&dirty, at.set + flags_at_, 8);
            dirty |= std::uint64_t{1} << at.way;
            std::memcpy(at.set + flags_at_, &dirty, 8);
        }
        touch(at.set + order_at_, at.way);
    }
    /// Whether the line is the one that was used last in its set, and not on its way: then it is used again.
    bool use_recent(std::uint64_t line, bool write) {
        std::byte* set = base_ + (line & mask_) * stride_;
        const auto way = static_cast<std::uint32_t>(set[order_at_]);
        if (tag_at(set, way) != line >> set_bits_ || in_flight(set + flags_at_, way))
            return false;
        if (write) {
            std::uint64_t dirty;
            std::memcpy(&dirty, set + flags_at_, 8);
            dirty |= std::uint64_t{1} << way;
            std::memcpy(set + flags_at_, &dirty, 8);
        }
        return true;
    }
    /// Makes the entry the most recently used of its set.
    void touch(Entry e) { touch(base_ + (e >> 6U) * stride_ + order_at_, e & 63U); }
    /// The entry that a line would take: an empty one, or the one that replacement chooses in its set.
    Entry victim(std::uint64_t line) const {
        if (replacement_ != Replacement::lru) [[unlikely]]
            return other_victim(line);
        return entry(line, static_cast<std::uint32_t>(set_of(line)[order_at_ + ways_ - 1]));
    }
    /// The number of the line in an entry, or no_line.
    std::uint64_t line(Entry e) const {
        std::uint32_t t = tag_at(base_ + (e >> 6U) * stride_, e & 63U);
        return t == empty ? no_line : std::uint64_t{t} << set_bits_ | e >> 6U;
    }
    /// Puts a line, clean and not on its way, into the entry that victim() gave, as one just used.
    void fill(Entry e, std::uint64_t line) {
        if (replacement_ != Replacement::lru) [[unlikely]]
            note_fill(e);
        else
            touch(e);
        set_tag(e, tag(line));
        set_dirty(e, false);
        set_in_flight(e, false);
        set_prefetched(e, false);
    }
    void drop(Entry e) {
        std::byte* set = base_ + (e >> 6U) * stride_;
        set_tag(e, empty);
        set_dirty(e, false);
        set_in_flight(e, false);
        set_prefetched(e, false);
        if (replacement_ != Replacement::lru)
            return;
        // Oldest from now on.
        std::byte* order = set + order_at_;
        std::size_t i = 0;
        while (order[i] != static_cast<std::byte>(e & 63U))
            ++i;
        for (; i + 1 < ways_; ++i)
            order[i] = order[i + 1];
        order[ways_ - 1] = static_cast<std::byte>(e & 63U);
    }

    bool dirty(Entry e) const { return flag(e, 0); }
    bool in_flight(Entry e) const { return flag(e, 8); }
    bool prefetched(Entry e) const { return flag(e, 16); }
    /// Of a coherent array: others may have the line too, so that it is not to be written.
    bool shared(Entry e) const { return flag(e, 24); }
    void set_shared(Entry e, bool on) { set_flag(e, 24, on); }
    void set_dirty(Entry e, bool on) { set_flag(e, 0, on); }
    void set_prefetched(Entry e, bool on) { set_flag(e, 16, on); }
    void set_in_flight(Entry e, bool on) { set_flag(e, 8, on); }

    /// Calls f(entry) for every line that is there.
    template <class F> void for_each(F f) const {
        for (std::uint32_t s = 0; s <= mask_; ++s)
            for (std::uint32_t w = 0; w < ways_; ++w)
                if (Entry e = s << 6U | w; line(e) != no_line)
                    f(e);
    }

private:
    static constexpr std::uint32_t empty = ~std::uint32_t{0};

    void touch(std::byte* order, std::uint32_t way) {
        if (order[0] == static_cast<std::byte>(way))
            return;
        if (replacement_ != Replacement::lru) [[unlikely]] {
            touch_other(order, way);
            return;
        }
        if (std::endian::native == std::endian::little && ways_ <= 8) {
            // All at once: bytes below that of the way move up by one. The bytes above are other ways or
            // unused.
            constexpr std::uint64_t ones = 0x0101010101010101U, tops = ones << 7U;
            std::uint64_t all;
            std::memcpy(&all, order, 8);
            std::uint64_t differ = all ^ ones * way;
            auto top = static_cast<unsigned>(std::countr_zero((differ - ones) & ~differ & tops));
            std::uint64_t moved = (std::uint64_t{2} << top) - 1; // up to and with the way's byte
            all = (all & ~moved) | (all << 8U & moved) | way;
            std::memcpy(order, &all, 8);
            return;
        }
        std::size_t i = 1;
        while (order[i] != static_cast<std::byte>(way))
            ++i;
        for (; i > 0; --i)
            order[i] = order[i - 1];
        order[0] = static_cast<std::byte>(way);
    }
    void touch_other(std::byte* order, std::uint32_t way);
    Entry other_victim(std::uint64_t line) const;
    void note_fill(Entry e);
    /// Tags do not tell this line from others.
    [[noreturn]] void too_far(std::uint64_t line) const;
    static constexpr std::size_t state_at = 8; // from the first byte, of plru and srrip

    std::byte* set_of(std::uint64_t line) const { return base_ + (line & mask_) * stride_; }
    Entry entry(std::uint64_t line, std::uint32_t way) const {
        return static_cast<Entry>((line & mask_) << 6U) | way;
    }
    std::uint32_t tag(std::uint64_t line) const {
        std::uint64_t t = line >> set_bits_;
        if (t >= empty) [[unlikely]]
            too_far(line);
        return static_cast<std::uint32_t>(t);
    }
    /// Which of four consecutive tags are `wanted`: one bit each.
    static std::uint32_t equal_tags(const std::byte* tags, std::uint32_t wanted) {
#ifdef __SSE2__
        __m128i four = _mm_load_si128(reinterpret_cast<const __m128i*>(tags));
        __m128i equal = _mm_cmpeq_epi32(four, _mm_set1_epi32(static_cast<int>(wanted)));
        return static_cast<std::uint32_t>(_mm_movemask_ps(_mm_castsi128_ps(equal)));
#else
        std::uint32_t equal = 0;
        for (std::uint32_t w = 0; w < 4; ++w)
            equal |= static_cast<std::uint32_t>(tag_at(tags, w) == wanted) << w;
        return equal;
#endif
    }
    static bool in_flight(const std::byte* flags, std::uint32_t way) {
        std::uint64_t bits;
        std::memcpy(&bits, flags + 8, 8);
        return (bits >> way & 1U) != 0;
    }
    static std::uint32_t tag_at(const std::byte* set, std::uint32_t way) {
        std::uint32_t t;
        std::memcpy(&t, set + way * 4, 4);
        return t;
    }
    void set_tag(Entry e, std::uint32_t t) {
        std::memcpy(base_ + (e >> 6U) * stride_ + (e & 63U) * 4, &t, 4);
    }
    bool flag(Entry e, std::size_t which) const {
        std::uint64_t bits;
        std::memcpy(&bits, base_ + (e >> 6U) * stride_ + flags_at_ + which, 8);
        return (bits >> (e & 63U) & 1U) != 0;
    }
    void set_flag(Entry e, std::size_t which, bool on) {
        std::byte* at = base_ + (e >> 6U) * stride_ + flags_at_ + which;
        std::uint64_t bits;
        std::memcpy(&bits, at, 8);
        std::uint64_t bit = std::uint64_t{1} << (e & 63U);
        bits = on ? bits | bit : bits & ~bit;
        std::memcpy(at, &bits, 8);
    }

    std::uint64_t mask_;
    unsigned set_bits_ = 0;
    std::uint32_t ways_;
    Replacement replacement_;
    std::uint64_t random_ = 0x9E3779B97F4A7C15U;
    std::size_t order_at_, flags_at_, stride_;
    std::vector<std::byte> bytes_;
    std::byte* base_;
};

} // namespace sim
