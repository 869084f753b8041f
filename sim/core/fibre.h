// One stack of execution: the scheduler's own, or a simulated thread's. Any fibre may switch to any other.
// Fibres never move between host threads. Address-sanitizer builds tell it about every switch.
#pragma once

#include <boost/context/fiber.hpp>

#include <cstddef>
#include <functional>

namespace sim {

class Fibre {
public:
    /// The one that runs now.
    Fibre() = default;
    /// Runs `body` at the first switch to it; when `body` returns, control goes to `home`. `body` must not
    /// throw.
    Fibre(std::size_t stack_bytes, std::function<void()> body, Fibre& home);
    Fibre(const Fibre&) = delete;
    Fibre& operator=(const Fibre&) = delete;

    /// From this fibre, which runs, to another. Returns when somebody switches back.
    void switch_to(Fibre& other);
    bool finished() const { return finished_; }

private:
    void arrive(boost::context::fiber&& left, const void** stack, std::size_t* size);

    boost::context::fiber context_;
    bool finished_ = false;
    const void* stack_ = nullptr; // lowest address
    std::size_t stack_bytes_ = 0;
    void* fake_stack_ = nullptr;
};

} // namespace sim
