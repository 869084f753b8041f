#include "razor/recording/touched_lines.h"

#include "razor/frame/kernel_table.h"

namespace razor {

constinit thread_local TouchedLines* measured_lines = nullptr;

void LineSet::add(const void* p, std::uint32_t bytes) {
    const auto first = reinterpret_cast<std::uintptr_t>(p);
    for (std::uintptr_t line = first / line_bytes; line <= (first + bytes - 1) / line_bytes; ++line) {
        std::uintptr_t& recent = recent_[line % recent_lines];
        if (recent == line)
            continue;
        recent = line;
        lines_.insert(line);
    }
}

void LineSet::clear() {
    lines_.clear();
    recent_.fill(0);
}

TouchedBytes TouchedLines::measure(Frame& frame, const SeeArguments& packet) {
    lines_.clear();
    kind = kind_none;
    struct Watch { // also where tracing throws
        explicit Watch(TouchedLines* lines) { measured_lines = lines; }
        ~Watch() { measured_lines = nullptr; }
        Watch(const Watch&) = delete;
        Watch& operator=(const Watch&) = delete;
    };
    {
        const Watch watch(this);
        frame.see(simulated::kernels, packet);
    }
    TouchedBytes touched;
    const isa::address_space& memory = frame.memory();
    for (const std::uintptr_t line : lines_.lines()) {
        const isa::region* region =
            memory.find(memory.offset(reinterpret_cast<const void*>(line * line_bytes)));
        if (region == nullptr)
            continue;
        touched.all += line_bytes;
        if (region->structure == "kd nodes" || region->structure == "item lists")
            touched.tree += line_bytes;
        if (region->structure == "grids")
            touched.grids += line_bytes;
    }
    return touched;
}

} // namespace razor
