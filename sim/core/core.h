// A core: what its threads share.
#pragma once

#include "sim/core/calendar.h"
#include "sim/core/host_lines.h"
#include "sim/core/mmu.h"
#include "sim/core/predictor.h"
#include "sim/memory/cache.h"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace sim {

struct Hart;

/// What instructions of core.shared_classes go through, of one core or of several.
struct SharedUnit {
    explicit SharedUnit(const cycle& earliest) : calendar("shared unit", earliest) {}
    Calendar calendar;
    std::uint64_t busy_cycles = 0;
};

struct Core {
    Core(const Config& config, const cycle& earliest, std::size_t pairing_ports, const SiteAtHand& site,
         Below& words, Below& below, Tickets& tickets, Attribution& attribution)
        : issue("issue slots", earliest, static_cast<unsigned>(config.core.issue_width)),
          ports("L1 ports", earliest, static_cast<unsigned>(config.l1.ports)),
          l1(config, 0, false, earliest, site, below, tickets, attribution), predictor(config.core),
          words(words) {
        for (std::size_t i = 0; i < units.size(); ++i)
            if (config.interval[i] > 1)
                units[i].emplace("unit", earliest);
        for (std::size_t i = 0; i < pairing_ports; ++i)
            issue_ports.emplace_back("issue port", earliest);
        port_instructions.resize(pairing_ports);
    }

    /// What most operations touch at about cycle `t` comes to the host's caches.
    void prefetch(cycle t) const {
        prefetch_lines(this, &l1);
        issue.prefetch(t);
        ports.prefetch(t);
        l1.prefetch_host();
    }

    // --- what nearly every operation touches
    Calendar issue, ports;
    SharedUnit* shared = nullptr;
    Hart* running = nullptr; // policy stall: who holds the core ...
    cycle busy_until = 0;    // ... and the cycle after its last issue
    Cache l1;
    // --- what few do
    Predictor predictor;
    std::int64_t passed_a_cycle =
        256; // while caches are warmed: what work costs (Hart::ahead) of which is a cycle here

    std::vector<Calendar> issue_ports; // of core.pairing
    std::vector<std::uint64_t> port_instructions;
    std::array<std::optional<Calendar>, class_count> units; // of classes that are not pipelined
    Below& words;                                           // the L2, where shared words are changed
    std::unique_ptr<Mmu> mmu;                               // null: addresses need no translation
};

} // namespace sim
