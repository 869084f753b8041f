// One stack of execution: the scheduler's own, or a simulated thread's. Any fibre may switch to any other of
// the same home. All of them may go on on another host thread, if the home's own stack is that thread's:
// nothing here is thread_local. Address-sanitizer builds tell it about every switch.
#pragma once

#include <boost/context/fiber.hpp>

#include <cstddef>
#include <functional>

namespace sim {

class Fibre {
public:
    /// The home of others: the stack of whoever switches from it.
    Fibre() : home_(*this) {}
    /// Runs `body` at the first switch to it; when `body` returns, control goes to `home`. `body` must not
    /// throw.
    Fibre(std::size_t stack_bytes, std::function<void()> body, Fibre& home);
    Fibre(const Fibre&) = delete;
    Fibre& operator=(const Fibre&) = delete;

    /// From this fibre, which runs, to another. Returns when somebody switches back.
    void switch_to(Fibre& other);
    bool finished() const { return finished_; }
    /// Its stack, as far as it will probably be used first, comes to the host's caches.
    void prefetch() const {
        constexpr int lines = 32, line_bytes = 64, below = 2;
        if (left_at_ != nullptr)
#pragma GCC unroll 32
            for (int i = -below; i < lines - below; ++i)
                __builtin_prefetch(static_cast<const std::byte*>(left_at_) + i * line_bytes);
    }

private:
    void arrive(boost::context::fiber&& context);

    Fibre& home_;
    Fibre* left_ = nullptr; // of a home: who of its own switched last
    boost::context::fiber context_;
    bool finished_ = false;
    const void* stack_ = nullptr;   // lowest address
    const void* left_at_ = nullptr; // where it was in it when it left last
    std::size_t stack_bytes_ = 0;
    void* fake_stack_ = nullptr;
};

} // namespace sim
