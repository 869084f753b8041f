// What a kernel may ask of the host: pages of topology weights, and to stop. Plain C++ types, so that the same object
// serves every target.
#pragma once

#include <atomic>
#include <chrono>
#include <cstdint>
#include <stdexcept>
#include <vector>

namespace isa {

/// Makes the page named by (kind, index) present before it returns. Called once or more a key, from any worker's thread
/// natively and from the machine's scheduler, with time standing still, in the simulated machine.
class page_service {
public:
    virtual void make_page(std::int32_t space, std::int32_t kind, std::int32_t index) = 0;

protected:
    ~page_service() = default;
};

// Instrumentation of the host, not part of the machine. Out of line, so that kernels hold no code of theirs.

/// Which of `count` things have happened. Any thread.
class mark_set {
public:
    explicit mark_set(std::int64_t count);
    void mark(std::int64_t i);
    bool is_marked(std::int64_t i) const;
    void clear();

private:
    std::vector<std::atomic<std::uint64_t>> words_;
};

/// When each of a few events first happened. Any thread.
class stopwatch {
public:
    explicit stopwatch(int events) : first_(static_cast<std::size_t>(events)) {}
    /// Begins anew: nothing has happened.
    void restart();
    void note(int event);
    /// Since it began; 0: it did not happen.
    double seconds(int event) const;

private:
    std::chrono::steady_clock::time_point begin_ = std::chrono::steady_clock::now();
    std::vector<std::atomic<std::int64_t>> first_; // nanoseconds, at least 1
};

/// Is told of laps, by their thread.
class lap_listener {
public:
    virtual void begun() = 0;
    /// The last one that was begun and has not ended, and the time that it took.
    virtual void ended(std::int64_t lap, double seconds) = 0;

protected:
    ~lap_listener() = default;
};

/// The host's time of each lap, of one thread.
class lap_timer {
public:
    struct figures {
        std::int64_t count = 0;
        double seconds = 0, slowest_seconds = 0;
        std::int64_t slowest = -1; // the number of that lap
    };

    /// A lap begun before the last one has ended takes none of that one's time.
    void begin();
    void end(std::int64_t lap);
    const figures& laps() const { return laps_; }
    /// Null: nobody is told.
    void tell(lap_listener* listener) { listener_ = listener; }

private:
    lap_listener* listener_ = nullptr;
    std::vector<std::chrono::steady_clock::time_point> begun_;
    figures laps_;
};

/// What becomes of memory that has a budget. Any thread.
class memory_log {
public:
    /// A kernel is about to drop what was last used at time `last` or before in arena `arena`. Nobody else is at work
    /// there.
    virtual void dropping(std::int32_t arena, std::int32_t last) = 0;
    virtual void note(std::int32_t event) = 0;

protected:
    ~memory_log() = default;
};

/// Thrown by trap(): a kernel cannot go on (an arena is exhausted, a wait was cancelled). The host says what the code
/// means.
class trapped : public std::runtime_error {
public:
    explicit trapped(int code);
    ~trapped() override;
    trapped(const trapped&) = default;
    trapped& operator=(const trapped&) = default;
    int code;
};

/// What trap() calls; out of line, so that kernels hold no code of the standard library's.
[[noreturn]] void throw_trapped(int code);

/// Calls work(data); false if trap(code) ended it. Other exceptions pass. Out of line, as a kernel that caught
/// `trapped` itself would hold a reference to its type that other targets' kernels would share.
[[nodiscard]] bool call_without_trap(int code, void (*work)(void* data), void* data);

/// The same of a callable.
template <class Work> [[nodiscard]] bool ends_without_trap(int code, Work work) {
    return call_without_trap(
        code, [](void* data) { (*static_cast<Work*>(data))(); }, &work);
}

} // namespace isa
