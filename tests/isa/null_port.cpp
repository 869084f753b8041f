// A machine in which everything is there at once: the timing port for tests that look at values only.
#include "isa/services.h"
#include "isa/simulated/port.h"

namespace isa::timing {

stamp vector_op(operation, const stamp&) { return {}; }
stamp vector_op(operation, const stamp&, const stamp&) { return {}; }
stamp vector_op(operation, const stamp&, const stamp&, const stamp&) { return {}; }
stamp cross_op(operation, const stamp&, const stamp&) { return {}; }
stamp cross_to_scalar(operation, const stamp&, const stamp&) { return {}; }
stamp scalar_op(operation, const stamp&) { return {}; }
stamp scalar_op(operation, const stamp&, const stamp&) { return {}; }
stamp scalar_op(operation, const stamp&, const stamp&, const stamp&) { return {}; }
void branch(site, const stamp&, bool) {}

stamp load(site, const void*, std::uint32_t, const stamp&) { return {}; }
stamp load_broadcast(site, const void*, std::uint32_t, const stamp&) { return {}; }
stamp load_vector(site, const void*, std::uint64_t, const stamp&, const stamp&) { return {}; }
stamp gather(site, const void*, const std::int32_t*, std::uint64_t, const stamp&, const stamp&, const stamp&) {
    return {};
}
void store(site, const void*, std::uint32_t, const stamp&, const stamp&) {}
void store_vector(site, const void*, std::uint64_t, const stamp&, const stamp&, const stamp&) {}
void scatter(site, const void*, const std::int32_t*, std::uint64_t, const stamp&, const stamp&, const stamp&,
             const stamp&) {}
void prefetch(site, const void*, const stamp&) {}
void discard(site, const void*, std::uint32_t, const stamp&) {}

void before_atomic(site, atomic, const void*, const stamp&, const stamp&) {}
stamp after_atomic(site, atomic, const void*, bool) { return {}; }
stamp wait_while(site, const std::int32_t* p, std::int32_t value, const stamp&, const stamp&) {
    while (__atomic_load_n(p, __ATOMIC_ACQUIRE) == value) {
    }
    return {};
}

void request_page(void* service, std::int32_t space, std::int32_t kind, std::int32_t index) {
    static_cast<isa::page_service*>(service)->make_page(space, kind, index);
}
std::int32_t set_phase(std::int32_t phase) {
    static std::int32_t current = 0;
    std::int32_t before = current;
    current = phase;
    return before;
}
std::int32_t set_kind(std::int32_t) { return 0; }
std::uint64_t set_owners(const std::int32_t*, std::uint64_t) { return 0; }
std::uint64_t narrow_owners(std::uint64_t) { return 0; }
void restore_owners(std::uint64_t) {}
void note_level(const void*, std::uint64_t, std::int32_t) {}
void note_level_of(const void*, std::uint64_t, const void*) {}

} // namespace isa::timing
