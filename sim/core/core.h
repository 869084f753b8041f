// A core: what its threads share.
#pragma once

#include "sim/core/calendar.h"
#include "sim/core/predictor.h"
#include "sim/memory/l1.h"

#include <array>
#include <optional>

namespace sim {

struct Hart;

struct Core {
    Core(const Config& config, const cycle& earliest, L2& l2, Tickets& tickets, Attribution& attribution)
        : issue("issue slots", earliest, static_cast<unsigned>(config.core.issue_width)),
          ports("L1 ports", earliest, static_cast<unsigned>(config.l1.ports)),
          predictor(static_cast<unsigned>(config.core.predictor_history)),
          l1(config, l2, tickets, attribution) {
        for (std::size_t i = 0; i < units.size(); ++i)
            if (config.interval[i] > 1)
                units[i].emplace("unit", earliest);
    }

    Calendar issue, ports;
    std::array<std::optional<Calendar>, class_count> units; // of classes that are not pipelined
    Predictor predictor;
    L1 l1;
    Hart* running = nullptr; // policy stall: who holds the core ...
    cycle busy_until = 0;    // ... and the cycle after its last issue
};

} // namespace sim
