#include "sim/memory/dram_slots.h"

#include <algorithm>
#include <bit>
#include <utility>

namespace sim {
namespace {

/// The bits of word `number` that stand for clocks from `first` to `last`.
std::uint64_t part(std::uint64_t number, Clock first, Clock last) {
    Clock base = number * 64;
    if (first >= base + 64 || last < base)
        return 0;
    std::uint64_t from = first <= base ? 0 : first - base;
    std::uint64_t to = std::min<Clock>(last - base, 63);
    return ~std::uint64_t{0} >> (63 - to) & ~std::uint64_t{0} << from;
}
Clock back(Clock t, Clock distance) {
    return t > distance ? t - distance : 0;
}

} // namespace

DramSlots::DramSlots(const MemoryConfig& c, const DramTiming& timing, std::uint64_t disorder)
    : t_(timing), ranks_(static_cast<std::uint32_t>(c.ranks)),
      groups_(static_cast<std::uint32_t>(c.bank_groups)),
      rank_planes_(static_cast<std::uint32_t>(std::countr_zero(ranks_))) {
    row_bus_ = 1;
    column_bus_ = c.command_buses == 1 ? row_bus_ : row_bus_ + 1;
    columns_ = column_bus_ + 1;
    writes_ = columns_ + 1;
    planes_ = writes_ + 1;
    activates_ = planes_ + rank_planes_;
    beats_ = activates_ + ranks_;
    no_activate_ = beats_ + ranks_;
    no_column_ = no_activate_ + ranks_ * groups_;
    size_ = no_column_ + 2 * ranks_ * groups_;
    for (const auto& first : t_.column)
        for (const auto& second : first)
            reach_ = std::max(reach_, *std::max_element(second.begin(), second.end()));
    lookback_ = disorder + std::max({reach_, t_.tFAW, t_.activate[at(Near::group)]});
    beat_ = std::max(t_.tFAW, 4 * t_.activate[at(Near::rank)]);
    // Three quarters of what 64 clocks can take.
    pressing_activates_ = static_cast<int>(4 * 48 / beat_);
    pressing_columns_ = static_cast<int>(48 / t_.column[0][0][at(Near::rank)]);
    between_refreshes_.resize(ranks_);
    std::uint64_t words = std::bit_ceil(lookback_ / 64 + 16);
    mask_ = words - 1;
    words_.resize(words * size_);
    for (std::uint64_t n = 0; n < words; ++n)
        renew(&words_[n * size_], n);
}

Clock DramSlots::first_refresh(std::uint32_t rank) const {
    return t_.tREFI + t_.tREFI * rank / ranks_; // ranks take turns
}

Clock DramSlots::next_refresh(Clock t, std::uint32_t rank) {
    if (t_.tREFI == 0)
        return all;
    Interval& i = between_refreshes_[rank];
    if (t < i.begin || t >= i.end) {
        Clock first = first_refresh(rank);
        i.end = t < first ? first : first + ((t - first) / t_.tREFI + 1) * t_.tREFI;
        i.begin = t < first ? 0 : i.end - t_.tREFI;
    }
    return i.end;
}

/// The word of a ring large enough for it and all that are still needed.
DramSlots::Bits* DramSlots::grown(std::uint64_t number) {
    std::uint64_t words = std::bit_ceil(number - kept_ + 1);
    std::vector<Bits> old = std::exchange(words_, std::vector<Bits>(words * size_));
    std::uint64_t first = kept_; // words keep their places or, being new, get the latest number that fits
    for (std::uint64_t i = 0; i < words; ++i)
        renew(&words_[((first + i) & (words - 1)) * size_], first + i);
    for (std::uint64_t i = 0; i <= mask_; ++i)
        if (old[i * size_] >= kept_)
            std::copy_n(&old[i * size_], size_, &words_[(old[i * size_] & (words - 1)) * size_]);
    mask_ = words - 1;
    return word(number);
}

/// A word that nothing is booked in: beats, and refreshes, each after a precharge of all banks.
void DramSlots::renew(Bits* w, std::uint64_t number) {
    std::fill(w, w + size_, 0);
    w[0] = number;
    Clock base = number * 64;
    for (std::uint32_t rank = 0; rank < ranks_; ++rank) {
        Clock phase = beat_ * rank / ranks_;
        for (Clock k = back(4 * base, phase) / beat_, t = 0; (t = (k * beat_ + phase) / 4) < base + 64; ++k)
            w[beats_ + rank] |= part(number, t, t);
    }
    if (t_.tREFI == 0)
        return;
    for (std::uint32_t rank = 0; rank < ranks_; ++rank) {
        Clock opened = std::max(t_.tRC, t_.tRAS + t_.tRP);
        std::array<Clock, 2> column = {t_.tRP + t_.precharge[0], t_.tRP + t_.precharge[1]};
        Clock reach = std::max({opened, column[0], column[1]});
        for (Clock r = next_refresh(back(base, t_.tRFC), rank); r < base + 64 + reach; r += t_.tREFI) {
            Clock end = r + t_.tRFC - 1;
            w[row_bus_] |= part(number, r, r) | part(number, r - t_.tRP, r - t_.tRP);
            for (std::uint32_t group = 0; group < groups_; ++group) {
                std::uint32_t i = rank * groups_ + group;
                w[no_activate_ + i] |= part(number, r - opened + 1, end);
                for (std::uint32_t c = 0; c < 2; ++c)
                    w[no_column_ + 2 * i + c] |= part(number, r - column[c] + 1, end);
            }
        }
    }
}

Clock DramSlots::find_room_to_write(Clock from, std::uint64_t length) {
    std::uint32_t kind = no_column_ + 1; // rank 0 stands for all
    if (t_.tREFI != 0)                   // there is no longer stretch without a refresh
        length = std::min(length, t_.tREFI - t_.tRFC - (t_.tRP + t_.precharge[1]) + 1);
    Clock begin = from;
    for (Clock end = from; end < begin + length;) {
        Bits taken = word(end / 64)[kind] & all << (end % 64);
        if (taken == 0) {
            end = (end / 64 + 1) * 64;
        } else {
            Clock first = end / 64 * 64 + static_cast<unsigned>(std::countr_zero(taken));
            if (first >= begin + length)
                break;
            begin = end = find(first, kind, kind);
        }
    }
    return begin;
}

void DramSlots::take_bus(Clock t, std::uint32_t bus) {
    word(t / 64)[bus] |= Bits{1} << (t % 64);
}

/// For the whole rank.
void DramSlots::forbid_activates(Clock first, Clock last, std::uint32_t rank) {
    for (std::uint64_t n = first / 64; n <= last / 64; ++n) {
        Bits* w = word(n) + no_activate_ + rank * groups_;
        Bits bits = part(n, first, last);
        for (std::uint32_t g = 0; g < groups_; ++g)
            w[g] |= bits;
    }
}

/// Any five activates of a rank span tFAW at least: where four lie nearer than that, no fifth may join them.
void DramSlots::forbid_near_activates(Clock t, std::uint32_t rank) {
    constexpr int most = 3;
    std::array<Clock, 2 * most + 1> times{};
    int count = 0;
    Clock first = back(t, t_.tFAW - 1), last = t + t_.tFAW - 1;
    auto bits = [&](std::uint64_t n, Clock from, Clock to) {
        return word(n)[activates_ + rank] & part(n, from, to);
    };
    int near = 0;
    for (std::uint64_t n = first / 64; n <= last / 64; ++n)
        near += std::popcount(bits(n, first, last));
    if (near <= most)
        return;
    for (std::uint64_t n = t / 64; t > 0 && count < most; --n) { // backwards
        for (Bits b = bits(n, first, t - 1); b != 0 && count < most;) {
            auto bit = 63 - static_cast<unsigned>(std::countl_zero(b));
            times[static_cast<std::size_t>(count++)] = n * 64 + bit;
            b &= ~(Bits{1} << bit);
        }
        if (n <= first / 64)
            break;
    }
    std::reverse(times.begin(), times.begin() + count);
    int own = count;
    times[static_cast<std::size_t>(count++)] = t;
    for (std::uint64_t n = t / 64; n <= last / 64 && count < own + 1 + most; ++n)
        for (Bits b = bits(n, t + 1, last); b != 0 && count < own + 1 + most; b &= b - 1)
            times[static_cast<std::size_t>(count++)] = n * 64 + static_cast<unsigned>(std::countr_zero(b));
    for (int i = 0; i + 3 < count; ++i) {
        Clock low = times[static_cast<std::size_t>(i)], high = times[static_cast<std::size_t>(i) + 3];
        if (high - low < t_.tFAW)
            forbid_activates(back(high, t_.tFAW - 1), low + t_.tFAW - 1, rank);
    }
}

void DramSlots::take_activate(Clock t, std::uint32_t rank, std::uint32_t group) {
    take_bus(t, row_bus_);
    auto [near, far] = t_.activate; // near is the longer
    for (std::uint64_t n = back(t, near - 1) / 64; n <= (t + near - 1) / 64; ++n) {
        Bits* w = word(n) + no_activate_ + rank * groups_;
        Bits bits = part(n, back(t, far - 1), t + far - 1);
        for (std::uint32_t g = 0; g < groups_; ++g)
            w[g] |= bits;
        w[group] |= part(n, back(t, near - 1), t + near - 1);
    }
    word(t / 64)[activates_ + rank] |= Bits{1} << (t % 64);
    forbid_near_activates(t, rank);
}

void DramSlots::take_column(Clock t, Column c, std::uint32_t rank, std::uint32_t group) {
    count_changes(t, {true, c == Column::write, rank, t});
    take_bus(t, column_bus_);
    for (std::uint64_t n = back(t, reach_ - 1) / 64; n <= (t + reach_ - 1) / 64; ++n) {
        std::array<std::array<Bits, 3>, 2> marks; // [kind][near]
        for (std::size_t kind = 0; kind < 2; ++kind)
            for (std::size_t near = 0; near < 3; ++near)
                marks[kind][near] =
                    part(n, back(t, t_.column[kind][at(c)][near] - 1), t + t_.column[at(c)][kind][near] - 1);
        Bits* w = word(n) + no_column_;
        for (std::uint32_t r = 0; r < ranks_; ++r)
            for (std::uint32_t g = 0; g < groups_; ++g, w += 2) {
                Near near = r != rank ? Near::channel : g != group ? Near::rank : Near::group;
                w[0] |= marks[0][at(near)];
                w[1] |= marks[1][at(near)];
            }
    }
    Bits* w = word(t / 64);
    Bits bit = Bits{1} << (t % 64);
    w[columns_] |= bit;
    if (c == Column::write)
        w[writes_] |= bit;
    for (std::uint32_t p = 0; p < rank_planes_; ++p)
        if ((rank >> p & 1) != 0)
            w[planes_ + p] |= bit;
    if (t >= latest_) {
        latest_ = t;
        latest_burst_ = {true, c == Column::write, rank, t};
    }
}

/// What is left over between two bursts once the gap is filled with others.
Clock DramSlots::rest(const Burst& first, const Burst& second) const {
    constexpr Clock near = 64;
    Clock gap = second.at - first.at;
    if (!first.known || !second.known || gap > near)
        return 0;
    Clock least =
        t_.column[first.write][second.write][at(first.rank != second.rank ? Near::channel : Near::rank)];
    return gap < least ? gap : (gap - least) % t_.column[0][0][at(Near::rank)];
}

Clock DramSlots::find_gap(Clock from, Column c, std::uint32_t rank, std::uint32_t group) {
    constexpr Clock price = 16;   // of a clock left over, in clocks of delay
    constexpr Clock longest = 64; // that the search goes on
    std::uint32_t kind = column_kind(c, rank, group);
    Clock first = find(from, column_bus_, kind), best = first, least = ~Clock{0};
    for (Clock t = first; t <= first + longest;) {
        Burst own{true, c == Column::write, rank, t};
        Clock left = rest(before(t), own);
        Clock wasted = left + (t < latest_ ? rest(own, after(t)) : 0);
        if (wasted * price + t - first < least) {
            least = wasted * price + t - first;
            best = t;
        }
        if (t - first >= least)
            break;
        t = find(left == 0 ? t + 1 : t + t_.column[0][0][at(Near::rank)] - left, column_bus_, kind);
    }
    return best;
}

DramSlots::Burst DramSlots::burst_at(const Bits* w, std::uint64_t number, unsigned bit) const {
    Burst b{true, (w[writes_] >> bit & 1) != 0, 0, number * 64 + bit};
    for (std::uint32_t p = 0; p < rank_planes_; ++p)
        b.rank |= static_cast<std::uint32_t>(w[planes_ + p] >> bit & 1) << p;
    return b;
}

/// The neighbours in time of a burst that goes before the latest. Words that time has not reached, or has
/// left, hold none.
DramSlots::Burst DramSlots::before(Clock t) {
    Bits seen = (Bits{1} << (t % 64)) - 1;
    for (std::uint64_t n = t / 64, steps = 0; steps <= mask_; --n, ++steps, seen = all) {
        const Bits* w = &words_[(n & mask_) * size_];
        if (w[0] > n)
            break;
        Bits b = w[0] == n ? w[columns_] & seen : 0;
        if (b != 0)
            return burst_at(w, n, 63 - static_cast<unsigned>(std::countl_zero(b)));
        if (n == 0)
            break;
    }
    return {};
}
DramSlots::Burst DramSlots::after(Clock t) {
    Bits seen = ~((Bits{2} << (t % 64)) - 1);
    for (std::uint64_t n = t / 64;; ++n, seen = all) {
        const Bits* w = word(n);
        if (Bits b = w[columns_] & seen; b != 0)
            return burst_at(w, n, static_cast<unsigned>(std::countr_zero(b)));
    }
}

void DramSlots::count_changes(Clock t, const Burst& burst) {
    auto pair = [this](const Burst& a, const Burst& b, int sign) {
        if (a.known && b.known) {
            turnarounds_ += a.write != b.write ? sign : 0;
            rank_switches_ += a.rank != b.rank ? sign : 0;
        }
    };
    if (t > latest_ || !latest_burst_.known) {
        pair(latest_burst_, burst, 1);
        return;
    }
    Burst previous = before(t), next = after(t);
    pair(previous, next, -1);
    pair(previous, burst, 1);
    pair(burst, next, 1);
}

} // namespace sim
