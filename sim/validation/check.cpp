#include "sim/validation/check.h"

#include "sim/config/memory_presets.h"
#include "sim/memory/dram_bounds.h"
#include "sim/memory/dram_load.h"
#include "sim/validation/coherence_forms.h"
#include "sim/validation/core_forms.h"
#include "sim/validation/network_forms.h"
#include "sim/validation/network_order.h"
#include "sim/validation/reference_forms.h"
#include "sim/validation/tlb_forms.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace sim {

const char* name_of(ValidationRow::State state) {
    switch (state) {
    case ValidationRow::State::passed:
        return "passed";
    case ValidationRow::State::missed:
        return "MISSED";
    case ValidationRow::State::reported:
        return "reported";
    case ValidationRow::State::tests:
        return "tests only";
    case ValidationRow::State::unbuilt:
        break;
    }
    return "not built";
}

ValidationRow compare(std::string what, std::string against, double measured, double expected, double part,
                      const std::string& unit) {
    const double off = measured / expected - 1;
    return {std::move(what), std::move(against), fmt::format("{:.0f} %", 100 * part),
            fmt::format("{:.4g} {} for {:.4g}: {:+.2f} %", measured, unit, expected, 100 * off),
            std::abs(off) <= part ? ValidationRow::State::passed : ValidationRow::State::missed};
}

ValidationRow exact(std::string what, std::string against, std::size_t count, std::size_t wrong,
                    const std::string& first) {
    return {std::move(what), std::move(against), "exact",
            wrong == 0 ? fmt::format("{} of {} equal", count, count)
                       : fmt::format("{} of {} differ, first {}", wrong, count, first),
            wrong == 0 && count != 0 ? ValidationRow::State::passed : ValidationRow::State::missed};
}

int exit_code(const std::vector<ValidationRow>& rows) {
    return std::any_of(rows.begin(), rows.end(),
                       [](const ValidationRow& r) { return r.state == ValidationRow::State::missed; })
               ? 1
               : 0;
}

namespace {

std::vector<ValidationRow> check_forms(const std::string& of, const std::vector<CoreForm>& forms) {
    std::vector<ValidationRow> rows;
    for (const CoreForm& form : forms) {
        const Report r = form.run();
        const bool right = r.cycles == form.cycles && r.core.instructions == form.instructions;
        rows.push_back({of + ": " + form.name, "closed form", "exact cycles",
                        fmt::format("{} for {}", r.cycles, form.cycles),
                        right ? ValidationRow::State::passed : ValidationRow::State::missed});
    }
    return rows;
}

} // namespace

std::vector<ValidationRow> check_core() {
    return check_forms("core", core_forms());
}

std::vector<ValidationRow> check_reference() {
    return check_forms("reference mode", reference_forms());
}

std::vector<ValidationRow> check_tlb() {
    return check_forms("TLB", tlb_forms());
}

namespace {

ValidationRow compare_arrivals(const std::string& what, const std::vector<cycle>& measured,
                               const std::vector<cycle>& expected) {
    std::size_t wrong = measured.size() == expected.size() ? 0 : 1;
    std::string first = wrong == 0 ? "" : fmt::format("{} messages for {}", measured.size(), expected.size());
    for (std::size_t i = 0; i < std::min(measured.size(), expected.size()); ++i)
        if (measured[i] != expected[i] && wrong++ == 0)
            first = fmt::format("message {}: at {} for {}", i, measured[i], expected[i]);
    return exact(what, "lists of taken cycles", expected.size(), wrong, first);
}

double mean_way(const NetworkOrder& o, const std::vector<cycle>& there) {
    double sum = 0;
    for (std::size_t i = 0; i < there.size(); ++i)
        sum += static_cast<double>(there[i] - o.messages[i].sent);
    return sum / static_cast<double>(there.size());
}

} // namespace

std::vector<ValidationRow> check_network() {
    std::vector<ValidationRow> rows;
    for (const NetworkPing& p : network_pings()) {
        std::size_t wrong = 0;
        std::string first;
        for (std::size_t tile = 0; tile < p.expected.size(); ++tile)
            if (p.measured[tile] != p.expected[tile] && wrong++ == 0)
                first = fmt::format("tile {}: {} cycles for {}", tile, p.measured[tile], p.expected[tile]);
        rows.push_back(exact("network: ping-pong with memory, " + p.name,
                             "hops x cycles a hop + flits, both ways", p.expected.size(), wrong, first));
    }
    for (const NetworkLoad& l : network_loads())
        rows.push_back(compare("network: " + l.name, "closed form: " + l.by, static_cast<double>(l.run()),
                               static_cast<double>(l.expected), 0.02, "cycles"));
    constexpr cycle ahead = 100;
    for (const NetworkOrder& o : network_orders())
        rows.push_back(compare_arrivals("network: link by link, " + o.name,
                                        arrivals_of_flights(o.config, o.messages, ahead),
                                        arrivals_by_lists(o.config, o.messages)));
    for (const auto& [o, counted] : coherent_orders()) {
        std::vector<cycle> measured(counted); // 0: a message that is not among those sent link by link
        for (std::size_t i = 0; i < std::min(measured.size(), o.messages.size()); ++i)
            measured[i] = o.messages[i].there;
        rows.push_back(compare_arrivals("network: what coherence says, " + o.name, measured,
                                        arrivals_by_lists(o.config, o.messages)));
    }
    for (const NetworkOrder& o : network_orders()) {
        const double exact = mean_way(o, arrivals_by_lists(o.config, o.messages)),
                     measured = mean_way(o, arrivals_at_once(o.config, o.messages, ahead));
        rows.push_back({"network: all links at once (fast mode), " + o.name, "lists of taken cycles", "none",
                        fmt::format("{:.4g} cycles for {:.4g}: {:+.1f} %", measured, exact,
                                    100 * (measured / exact - 1)),
                        ValidationRow::State::reported});
    }
    return rows;
}

std::vector<ValidationRow> check_coherence() {
    std::vector<ValidationRow> rows;
    for (const std::string mode : {"fast", "reference"})
        for (const CoherenceForm& f : coherence_forms(mode)) {
            std::size_t wrong = f.measured.size() == f.expected.size() ? 0 : 1;
            std::string first = "their number";
            for (std::size_t i = 0; i < std::min(f.measured.size(), f.expected.size()); ++i)
                if (f.measured[i] != f.expected[i] && wrong++ == 0)
                    first = fmt::format("{}: {} cycles for {}", i, f.measured[i], f.expected[i]);
            rows.push_back(exact(fmt::format("coherence, {} mode: {}", mode, f.name), f.by, f.expected.size(),
                                 wrong, first));
        }
    return rows;
}

namespace {

constexpr std::uint64_t gibibyte = std::uint64_t{1} << 30;

/// The memory by itself, as fast as it answers, with so many reads under way in each channel.
ValidationRow saturated(const Config& c, const char* stream, std::uint64_t requests,
                        std::uint64_t in_flight) {
    const auto channels = static_cast<std::uint64_t>(c.memory.channels);
    const DramBound bound = dram_bandwidth_bound(c, stream);
    const double ns = static_cast<double>(c.memory.clock_ps) * 1e-3;
    const DramOutcome o = run_dram_queued(c, make_dram_stream(stream, c, gibibyte, 0, 1),
                                          {0, in_flight * channels, requests * channels, 1});
    // Where every clock of tRRD counts, an activate that meets a column command on the one command bus is
    // late, which the bound does not know.
    const bool late = bound.by.find("tRRD") != std::string::npos && c.memory.command_buses == 1;
    return compare(fmt::format("DRAM: {}, saturated {} reads", c.memory.preset, stream),
                   "closed form: " + bound.by, o.bytes_per_clock / ns, bound.bytes_per_clock / ns,
                   late ? 0.1 : 0.02, "GB/s");
}

ValidationRow idle(const Config& c, const char* controller,
                   DramOutcome (*run)(const Config&, const DramStream&, const DramLoad&, bool)) {
    const double gap = 4000 / static_cast<double>(c.memory.channels);
    const double ns = static_cast<double>(c.memory.clock_ps) * 1e-3;
    const DramOutcome o =
        run(c, make_dram_stream("random", c, gibibyte, 0, 1), {gap, 1000, 100000, 1}, false);
    return compare(fmt::format("DRAM: {}, idle random read, {}", c.memory.preset, controller),
                   "closed form: commands, open rows, refresh", o.mean * ns, dram_idle_latency(c, gap) * ns,
                   0.02, "ns");
}

} // namespace

std::vector<ValidationRow> check_dram() {
    std::vector<ValidationRow> rows;
    for (const MemoryConfig& preset : memory_presets()) {
        Config c;
        apply_memory_preset(c, preset.preset);
        rows.push_back(idle(c, "queued", run_dram_queued));
        rows.push_back(idle(c, "immediate", run_dram_immediate));
        c.memory.age_cap = 0;
        c.memory.read_queue = 64;
        rows.push_back(saturated(c, "sequential", 20000, 64));
        c.memory.channels = 1;
        c.memory.read_queue = 512; // so many that hardly a bank is ever without
        rows.push_back(saturated(c, "random", 50000, 512));
    }
    return rows;
}

} // namespace sim
