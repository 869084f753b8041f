#include "isa/services.h"

#include <algorithm>

namespace isa {

trapped::trapped(int code) : std::runtime_error("kernel trap"), code(code) {}
trapped::~trapped() = default;

void throw_trapped(int code) { throw trapped(code); }

bool call_without_trap(int code, void (*work)(void* data), void* data) {
    try {
        work(data);
        return true;
    } catch (const trapped& trap) {
        if (trap.code != code)
            throw;
        return false;
    }
}

mark_set::mark_set(std::int64_t count) : words_(static_cast<std::size_t>((count + 63) / 64)) {}

void mark_set::mark(std::int64_t i) {
    std::atomic<std::uint64_t>& word = words_[static_cast<std::size_t>(i / 64)];
    const std::uint64_t bit = std::uint64_t{1} << static_cast<unsigned>(i % 64);
    if ((word.load(std::memory_order_relaxed) & bit) == 0)
        word.fetch_or(bit, std::memory_order_relaxed);
}

bool mark_set::is_marked(std::int64_t i) const {
    const std::uint64_t word = words_[static_cast<std::size_t>(i / 64)].load(std::memory_order_relaxed);
    return (word >> static_cast<unsigned>(i % 64) & 1) != 0;
}

void mark_set::clear() {
    for (std::atomic<std::uint64_t>& word : words_)
        word.store(0, std::memory_order_relaxed);
}

void stopwatch::restart() {
    begin_ = std::chrono::steady_clock::now();
    for (std::atomic<std::int64_t>& first : first_)
        first.store(0, std::memory_order_relaxed);
}

void stopwatch::note(int event) {
    std::atomic<std::int64_t>& first = first_[static_cast<std::size_t>(event)];
    if (first.load(std::memory_order_relaxed) != 0)
        return;
    const std::chrono::nanoseconds passed = std::chrono::steady_clock::now() - begin_;
    std::int64_t none = 0;
    first.compare_exchange_strong(none, std::max<std::int64_t>(passed.count(), 1), std::memory_order_relaxed);
}

double stopwatch::seconds(int event) const {
    return static_cast<double>(first_[static_cast<std::size_t>(event)].load(std::memory_order_relaxed)) * 1e-9;
}

void lap_timer::begin() {
    if (listener_ != nullptr)
        listener_->begun();
    begun_.push_back(std::chrono::steady_clock::now());
}

void lap_timer::end(std::int64_t lap) {
    const auto passed = std::chrono::steady_clock::now() - begun_.back();
    begun_.pop_back();
    for (std::chrono::steady_clock::time_point& outer : begun_)
        outer += passed;
    const double seconds = std::chrono::duration<double>(passed).count();
    ++laps_.count;
    laps_.seconds += seconds;
    if (seconds > laps_.slowest_seconds) {
        laps_.slowest_seconds = seconds;
        laps_.slowest = lap;
    }
    if (listener_ != nullptr)
        listener_->ended(lap, seconds);
}

} // namespace isa
