// What a kernel may ask of the host: pages of topology weights, and to stop. Plain C++ types, so that the same object
// serves every target.
#pragma once

#include <cstdint>
#include <stdexcept>

namespace isa {

/// Makes the page named by (kind, index) present before it returns. Called once or more a key, from any worker's thread
/// natively and from the machine's scheduler, with time standing still, in the simulated machine.
class page_service {
public:
    virtual void make_page(std::int32_t space, std::int32_t kind, std::int32_t index) = 0;

protected:
    ~page_service() = default;
};

/// Thrown by trap(): a kernel cannot go on (an arena is exhausted, a wait was cancelled). The host says what the code
/// means.
class trapped : public std::runtime_error {
public:
    explicit trapped(int code) : std::runtime_error("kernel trap"), code(code) {}
    int code;
};

/// What trap() calls; out of line, so that kernels hold no code of the standard library's.
[[noreturn]] void throw_trapped(int code);

} // namespace isa
