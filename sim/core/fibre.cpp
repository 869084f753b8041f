#include "sim/core/fibre.h"

#include <boost/context/protected_fixedsize_stack.hpp>

#include <atomic>

#if defined(__SANITIZE_ADDRESS__)
#define SIM_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SIM_ADDRESS_SANITIZER 1
#endif
#endif
#if defined(SIM_ADDRESS_SANITIZER)
#include <sanitizer/asan_interface.h>
#include <sanitizer/common_interface_defs.h>
#endif

namespace sim {
namespace {

void announce([[maybe_unused]] void** fake_stack, [[maybe_unused]] const void* stack,
              [[maybe_unused]] std::size_t bytes) {
#if defined(SIM_ADDRESS_SANITIZER)
    __sanitizer_start_switch_fiber(fake_stack, stack, bytes);
#endif
}

/// Forgets what earlier stacks at the same place left marked.
void clean([[maybe_unused]] const void* stack, [[maybe_unused]] std::size_t bytes) {
#if defined(SIM_ADDRESS_SANITIZER)
    __asan_unpoison_memory_region(stack, bytes);
#endif
}

void landed([[maybe_unused]] void* fake_stack, [[maybe_unused]] const void** stack,
            [[maybe_unused]] std::size_t* bytes) {
#if defined(SIM_ADDRESS_SANITIZER)
    __sanitizer_finish_switch_fiber(fake_stack, stack, bytes);
#endif
}

} // namespace

Fibre::Fibre(std::size_t stack_bytes, std::function<void()> body, Fibre& home) : home_(home) {
    // Stacks lie at multiples of large powers of two: all would use the same few sets of the host's caches.
    static std::atomic<std::size_t> count{0};
    const std::size_t colour = count++ * 37 % 1024 * 64;
    boost::context::protected_fixedsize_stack allocator(stack_bytes + 65536);
    boost::context::stack_context memory = allocator.allocate();
    void* const top = static_cast<std::byte*>(memory.sp) - colour;
    stack_ = static_cast<const std::byte*>(memory.sp) - memory.size;
    stack_bytes_ = memory.size;
    clean(stack_, stack_bytes_);
    auto run = [this, body = std::move(body)](boost::context::fiber&& from) {
        arrive(std::move(from));
        body();
        finished_ = true;
        home_.left_ = this;
        announce(nullptr, home_.stack_, home_.stack_bytes_);
        return std::move(home_.context_);
    };
    context_ = boost::context::fiber(std::allocator_arg,
                                     boost::context::preallocated(top, memory.size - colour, memory),
                                     allocator, std::move(run));
}

/// Of the fibre that was left for this one.
void Fibre::arrive(boost::context::fiber&& context) {
    Fibre& left = *home_.left_;
    landed(fake_stack_, &left.stack_, &left.stack_bytes_);
    if (context)
        left.context_ = std::move(context);
}

void Fibre::switch_to(Fibre& other) {
    home_.left_ = this;
    left_at_ = __builtin_frame_address(0);
    announce(&fake_stack_, other.stack_, other.stack_bytes_);
    arrive(std::move(other.context_).resume());
}

} // namespace sim
