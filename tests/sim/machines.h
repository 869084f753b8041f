// Machines and shorthands of the tests. Most tests speak to the timing port directly: what a kernel does, one
// operation at a time.
#pragma once

#include "isa/address_space.h"
#include "isa/services.h"
#include "isa/simulated/port.h"
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "sim/machine/engine.h"
#include "sim/validation/core_forms.h"

#include <gtest/gtest.h>

namespace sim::test {

using namespace isa::timing;

inline constexpr site here{"test", 1};

/// One core, one thread, one lane for each logical lane, nothing in the way.
inline Config simple() {
    return plain_core();
}
/// A frame memory of one region of 64 MiB.
struct Memory {
    isa::address_space space{std::uint64_t{1} << 26};
    std::byte* data = space.add("data", -1, std::uint64_t{1} << 24, true);
    std::byte* more = space.add("more", -1, std::uint64_t{1} << 24, true);
};
inline Report run(const Config& c, const std::function<void(int)>& worker, int workers = 1) {
    Memory memory;
    return Machine(c).run(memory.space, workers, {{"work"}}, worker);
}
/// With memory: worker(base).
inline Report run_on(const Config& c, const std::function<void(std::byte*, int)>& worker, int workers = 1) {
    Memory memory;
    return Machine(c).run(memory.space, workers, {{"work"}}, [&](int w) { worker(memory.data, w); });
}
/// Writes 512 lines, reads 1,536 more, says that the first are dead if `discarded`, and reads until none of
/// them is in any cache.
inline Report write_and_displace(const Config& c, bool discarded) {
    return run_on(c, [=](std::byte* base, int) {
        for (int i = 0; i < 512; ++i)
            isa::timing::store(here, base + i * 64, 4, stamp{}, stamp{});
        stamp s;
        for (int i = 512; i < 2048; ++i)
            s = load(here, base + i * 64, 4, s);
        if (discarded)
            for (int i = 0; i < 512; ++i)
                isa::timing::discard(here, base + i * 64, 64, s);
        for (int i = 2048; i < 40000; ++i)
            s = load(here, base + i * 64, 4, s);
    });
}
/// When a value is there; waits for the answer if that is not known yet.
inline cycle when(const stamp& s) {
    return is_ticket(s.last) ? running_engine->await(*running_hart, s.last).last : s.last;
}
inline cycle u(integer x) {
    return static_cast<cycle>(x);
}
/// What is wrong with a machine file; nothing: "".
inline std::string mistake(const std::string& text) {
    try {
        parse_machine(text, "m.toml");
    } catch (const ConfigError& e) {
        return e.what();
    }
    return "";
}
inline std::uint64_t cause(const Report& r, Cause c) {
    return r.stack()[static_cast<std::size_t>(c)];
}

} // namespace sim::test
