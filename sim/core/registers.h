// Rule 3: a thread's vector registers hold the last R values used. A value used that is not among them was
// stored and comes back through the L1; the store is charged at the first such use. Whether a value was
// stored is remembered for the last 1024 stored ones; a value older than that is charged its store again.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>
#include <utility>
#include <vector>
#ifdef __AVX2__
#include <immintrin.h>
#endif

namespace sim {

class RegisterFile {
public:
    enum class Use { resident, stored, unstored };

    explicit RegisterFile(std::size_t capacity)
        : capacity_(capacity), many_(capacity > 8 ? capacity : 0),
          recent_(capacity > 8 ? many_.data() : few_) {}
    RegisterFile(const RegisterFile&) = delete;
    RegisterFile& operator=(const RegisterFile&) = delete;

    /// Names a new value and holds it.
    std::uint32_t make() {
        name();
#ifdef __AVX2__
        if (capacity_ - 1 < 8) {
            keep(put_first(moved(eight(), capacity_ - 1), last_));
            return last_;
        }
#endif
        if (capacity_ != 0)
            push(capacity_ - 1, last_);
        return last_;
    }
    /// Makes `value` the last one used; says where it was.
    Use use(std::uint32_t value) {
        if (capacity_ == 0 || value == 0 || recent_[0] == value)
            return Use::resident;
#ifdef __AVX2__
        if (capacity_ <= 8)
            return use_all(value) ? Use::resident : bring_back(value);
#endif
        return holds(value) ? Use::resident : bring_back(value);
    }
    /// Uses values one after the other, if it can tell soon that all are here; if not, false, and none is
    /// used.
    template <class... Value> bool use_all(Value... values) {
#ifdef __AVX2__
        if (capacity_ - 1 < 8) {
            __m256i all = eight();
            const auto found = [&all](std::uint32_t value) {
                if (value == 0)
                    return true;
                const __m256i equal = _mm256_cmpeq_epi32(all, _mm256_set1_epi32(static_cast<int>(value)));
                const auto at = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(equal)));
                all = moved(all, static_cast<std::size_t>(std::countr_zero(at | 256U)) & 7U);
                return at != 0;
            };
            if (!(found(values) && ...))
                return false;
            keep(all);
            return true;
        }
#endif
        return capacity_ == 0 || ((values == 0) && ...);
    }

    /// Values that were not here when an operation used them, in its order.
    struct Absent {
        std::uint32_t count = 0;
        std::array<std::uint32_t, 4> values; // as many; not initialised
        Absent() {}                          // NOLINT: leaves `values` alone
    };
    /// Uses values one after the other, those that were not here are to be brought back; then, if `makes`,
    /// names a new one, which is returned, else 0.
    template <class... Value>
    [[gnu::always_inline]] std::uint32_t use_and_make(bool makes, Absent& absent, Value... values) {
        const auto miss = [&absent](std::uint32_t value) { absent.values[absent.count++] = value; };
#ifdef __AVX2__
        if (capacity_ - 1 < 8) [[likely]] {
            __m256i all = eight();
            const auto use_one = [&](std::uint32_t value) {
                if (value == 0)
                    return;
                const __m256i equal = _mm256_cmpeq_epi32(all, _mm256_set1_epi32(static_cast<int>(value)));
                const auto at = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(equal)));
                all = put_first(
                    moved(all, at != 0 ? static_cast<std::size_t>(std::countr_zero(at)) : capacity_ - 1),
                    value);
                if (at == 0)
                    miss(value);
            };
            (use_one(values), ...);
            if (makes)
                all = put_first(moved(all, capacity_ - 1), name());
            keep(all);
            return makes ? last_ : 0;
        }
#endif
        const auto use_one = [&](std::uint32_t value) {
            if (!holds(value)) {
                push(capacity_ - 1, value);
                miss(value);
            }
        };
        (use_one(values), ...);
        return makes ? make() : 0;
    }
    /// A value that was absent is brought back: says whether it was stored already, as it is from now on.
    Use store_once(std::uint32_t value) {
        std::uint32_t& stored = stored_[value % remembered];
        Use where = stored == value ? Use::stored : Use::unstored;
        stored = value;
        return where;
    }

private:
    static constexpr std::uint32_t remembered = 1024;

    std::uint32_t name() {
        if (++last_ == 0)
            last_ = 1;
        return last_;
    }
    /// Makes it the last one used, if it is here.
    bool holds(std::uint32_t value) {
        if (capacity_ == 0 || value == 0 || recent_[0] == value)
            return true;
        for (std::size_t i = 1; i < capacity_; ++i)
            if (recent_[i] == value) {
                push(i, value);
                return true;
            }
        return false;
    }
    Use bring_back(std::uint32_t value) {
        push(capacity_ - 1, value);
        return store_once(value);
    }
#ifdef __AVX2__
    __m256i eight() const {
        return _mm256_load_si256(reinterpret_cast<const __m256i*>(few_));
    }
    void keep(__m256i all) {
        _mm256_store_si256(reinterpret_cast<__m256i*>(few_), all);
    }
    /// The one at `out` first, those before it one further on.
    static __m256i moved(__m256i all, std::size_t out) {
        const __m128i places = _mm_loadl_epi64(reinterpret_cast<const __m128i*>(to_front[out]));
        return _mm256_permutevar8x32_epi32(all, _mm256_cvtepu8_epi32(places));
    }
    static __m256i put_first(__m256i all, std::uint32_t value) {
        return _mm256_blend_epi32(all, _mm256_set1_epi32(static_cast<int>(value)), 1);
    }
    static constexpr std::uint8_t to_front[8][8] = {
        {0, 1, 2, 3, 4, 5, 6, 7}, {1, 0, 2, 3, 4, 5, 6, 7}, {2, 0, 1, 3, 4, 5, 6, 7},
        {3, 0, 1, 2, 4, 5, 6, 7}, {4, 0, 1, 2, 3, 5, 6, 7}, {5, 0, 1, 2, 3, 4, 6, 7},
        {6, 0, 1, 2, 3, 4, 5, 7}, {7, 0, 1, 2, 3, 4, 5, 6},
    };
#endif
    /// The value at `out` goes, those before it move up by one, and `value` is first.
    void push(std::size_t out, std::uint32_t value) {
        std::uint32_t* recent = recent_;
#ifdef __AVX2__
        if (capacity_ <= 8) { // all at once
            keep(put_first(moved(eight(), out), value));
            return;
        }
#endif
        if (out > 16) {
            std::memmove(recent + 1, recent, out * sizeof(std::uint32_t));
            recent[0] = value;
            return;
        }
        std::uint32_t carried = value; // a few moves are cheaper than a call
        for (std::size_t i = 0; i <= out; ++i)
            std::swap(carried, recent[i]);
    }

    alignas(32) std::uint32_t few_[8] = {}; // as many as there can be, and zeroes, if that is up to eight
    std::size_t capacity_;
    std::vector<std::uint32_t> many_;
    std::uint32_t* recent_; // last used first
    std::uint32_t last_ = 0;
    std::vector<std::uint32_t> stored_ = std::vector<std::uint32_t>(remembered); // apart: rarely looked at
};

} // namespace sim
