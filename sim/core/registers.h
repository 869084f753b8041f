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
#ifdef __AVX2__
        if (capacity_ <= 8) {
            const __m256i equal = _mm256_cmpeq_epi32(eight(), _mm256_set1_epi32(static_cast<int>(value)));
            const auto at = static_cast<std::uint32_t>(_mm256_movemask_ps(_mm256_castsi256_ps(equal)));
            if (at != 0) {
                push(static_cast<std::size_t>(std::countr_zero(at)), value);
                return Use::resident;
            }
            return bring_back(value);
        }
#endif
        for (std::size_t i = 1; i < capacity_; ++i)
            if (recent_[i] == value) {
                push(i, value);
                return Use::resident;
            }
        return bring_back(value);
    }

private:
    Use bring_back(std::uint32_t value) {
        push(capacity_ - 1, value);
        std::uint32_t& stored = stored_[value % stored_.size()];
        Use where = stored == value ? Use::stored : Use::unstored;
        stored = value;
        return where;
    }
#ifdef __AVX2__
    __m256i eight() const {
        return _mm256_loadu_si256(reinterpret_cast<const __m256i*>(recent_.data()));
    }
#endif
    /// The value at `out` goes, those before it move up by one, and `value` is first.
    void push(std::size_t out, std::uint32_t value) {
        std::uint32_t* recent = recent_.data();
#ifdef __AVX2__
        if (capacity_ <= 8) { // all at once
            const __m256i before = _mm256_setr_epi32(0, 0, 1, 2, 3, 4, 5, 6);
            const __m256i place = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
            const __m256i stays = _mm256_cmpgt_epi32(place, _mm256_set1_epi32(static_cast<int>(out)));
            const __m256i from = _mm256_blendv_epi8(before, place, stays);
            const __m256i moved = _mm256_permutevar8x32_epi32(eight(), from);
            const __m256i first = _mm256_set1_epi32(static_cast<int>(value));
            _mm256_storeu_si256(reinterpret_cast<__m256i*>(recent), _mm256_blend_epi32(moved, first, 1));
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

    std::vector<std::uint32_t> recent_; // last used first
    std::size_t capacity_;
    std::array<std::uint32_t, 1024> stored_{};
    std::uint32_t last_ = 0;
};

} // namespace sim
