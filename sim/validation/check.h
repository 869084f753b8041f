// The validation table: what was compared, with what, within which bar, and what came of it.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace sim {

struct ValidationRow {
    enum class State {
        passed,
        missed,
        reported, // a figure without a bar
        tests,    // compared by tests alone
        unbuilt,  // nothing is compared yet
    };
    std::string what, against, bar, measured;
    State state = State::unbuilt;

    bool operator==(const ValidationRow&) const = default;
};

const char* name_of(ValidationRow::State state);
/// A figure that must be within `part` of what is expected.
ValidationRow compare(std::string what, std::string against, double measured, double expected, double part,
                      const std::string& unit);
/// `wrong` of `count` comparisons differ; none may. `first`: what the first one was.
ValidationRow exact(std::string what, std::string against, std::size_t count, std::size_t wrong,
                    const std::string& first);
/// 0, or 1 if a bar was missed.
int exit_code(const std::vector<ValidationRow>& rows);

/// Each kernel of core_forms(), in cycles and instructions.
std::vector<ValidationRow> check_core();
/// Each of reference_forms(), likewise.
std::vector<ValidationRow> check_reference();
/// Each of tlb_forms(), likewise.
std::vector<ValidationRow> check_tlb();
/// Each of network_pings() in exact cycles, each of network_loads() within 2 %, each of network_orders() and
/// coherent_orders() message by message; and network_orders() as the fast mode has them.
std::vector<ValidationRow> check_network();
/// Each of coherence_forms() in both modes: accesses in exact cycles.
std::vector<ValidationRow> check_coherence();
/// Each memory preset beside dram_bounds.h: saturated random and sequential reads, idle random reads.
std::vector<ValidationRow> check_dram();

} // namespace sim
