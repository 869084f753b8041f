#include "sim/core/fibre.h"

#include <boost/context/protected_fixedsize_stack.hpp>

#if defined(__SANITIZE_ADDRESS__)
#define SIM_ADDRESS_SANITIZER 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define SIM_ADDRESS_SANITIZER 1
#endif
#endif
#if defined(SIM_ADDRESS_SANITIZER)
#include <sanitizer/common_interface_defs.h>
#endif

namespace sim {
namespace {

Fibre* leaving = nullptr; // who switched last

void announce([[maybe_unused]] void** fake_stack, [[maybe_unused]] const void* stack,
              [[maybe_unused]] std::size_t bytes) {
#if defined(SIM_ADDRESS_SANITIZER)
    __sanitizer_start_switch_fiber(fake_stack, stack, bytes);
#endif
}

void landed([[maybe_unused]] void* fake_stack, [[maybe_unused]] const void** stack,
            [[maybe_unused]] std::size_t* bytes) {
#if defined(SIM_ADDRESS_SANITIZER)
    __sanitizer_finish_switch_fiber(fake_stack, stack, bytes);
#endif
}

} // namespace

Fibre::Fibre(std::size_t stack_bytes, std::function<void()> body, Fibre& home) {
    boost::context::protected_fixedsize_stack allocator(stack_bytes);
    boost::context::stack_context memory = allocator.allocate();
    stack_ = static_cast<const std::byte*>(memory.sp) - memory.size;
    stack_bytes_ = memory.size;
    auto run = [this, body = std::move(body), &home](boost::context::fiber&& from) {
        arrive(std::move(from), &leaving->stack_, &leaving->stack_bytes_);
        body();
        finished_ = true;
        leaving = this;
        announce(nullptr, home.stack_, home.stack_bytes_);
        return std::move(home.context_);
    };
    context_ = boost::context::fiber(std::allocator_arg,
                                     boost::context::preallocated(memory.sp, memory.size, memory), allocator,
                                     std::move(run));
}

void Fibre::arrive(boost::context::fiber&& left, const void** stack, std::size_t* bytes) {
    landed(fake_stack_, stack, bytes);
    if (left)
        leaving->context_ = std::move(left);
}

void Fibre::switch_to(Fibre& other) {
    leaving = this;
    announce(&fake_stack_, other.stack_, other.stack_bytes_);
    boost::context::fiber left = std::move(other.context_).resume();
    arrive(std::move(left), &leaving->stack_, &leaving->stack_bytes_);
}

} // namespace sim
