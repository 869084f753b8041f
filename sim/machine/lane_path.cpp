// What goes lane by lane (core.gather = lane; [lanes]), and what it takes beside the lanes' loads and stores.
// An instruction set without gathers or masks takes each lane's index and bit of the mask apart, and puts the
// lanes together on the thread's stack (isa/native/registers_sse4.h). References to the stack are accesses of
// one line there, tagged as spills. Not modelled: store buffers in front of them, and branches that leave
// idle lanes out.
#include "sim/machine/issue.h"

#include <bit>
#include <utility>

namespace sim {

/// All of it before the operation itself. `instructions` includes those that are references.
void Engine::assemble(Hart& h, std::uint32_t instructions, std::uint32_t references, Due ready) {
    end_stretch(h);
    h.counters.assembly_instructions += instructions;
    h.counters.assembly_references += references;
    h.site = {};
    const std::uint32_t trace_site = std::exchange(h.trace_site, 0U);
    if (instructions > references)
        issue_all(h, integer_kind, instructions - references, ready);
    touch_stack(h, references - references / 2, true, ready);
    touch_stack(h, references / 2, false, ready);
    h.trace_site = trace_site;
}

void Engine::touch_stack(Hart& h, std::uint32_t references, bool write, Due ready) {
    constexpr std::uint32_t most = 64;
    while (references != 0) {
        const std::uint32_t n = std::min(references, most);
        references -= n;
        const Issued at = issue(h, write ? store_kind : load_kind, n, ready);
        if (write)
            h.counters.assembly_stores += n;
        Data data;
        cycle from = translated(h, h.spill_base, h.spill_base + 3, at.first);
        touch_line(h, h.spill_base, 4, write, n, n, from, data);
        if (write)
            stored(h, data);
        else
            loaded(h, data, false);
    }
}

void Engine::assemble_load(Hart& h, std::uint64_t lanes, Due ready) {
    const LanePath& c = lane_path_;
    std::uint32_t instructions = pieces_ * c.gather_instructions, references = 0;
    if (lane_gather_) {
        const auto handled = idle_lanes_ ? width : static_cast<std::uint32_t>(std::popcount(lanes));
        instructions = pieces_ * c.piece_instructions + handled * c.load_instructions;
        references = pieces_ * c.piece_references + handled * c.load_references;
    }
    if (instructions != 0)
        assemble(h, instructions, references, ready);
}

void Engine::assemble_store(Hart& h, std::uint64_t lanes, Due ready) {
    const auto active = static_cast<std::uint32_t>(std::popcount(lanes));
    const LanePath& c = lane_path_;
    const std::uint32_t instructions = pieces_ * c.piece_instructions + active * c.store_instructions;
    if (instructions != 0)
        assemble(h, instructions, pieces_ * c.piece_references + active * c.store_references, ready);
}

/// Registers are stored, and each lane comes from where its index says.
void Engine::assemble_shuffle(Hart& h, Due ready) {
    const LanePath& c = lane_path_;
    assemble(h, pieces_ * (1 + c.piece_instructions) + width * (1 + c.load_instructions),
             pieces_ * (1 + c.piece_references) + width * (1 + c.load_references), ready);
}

} // namespace sim
