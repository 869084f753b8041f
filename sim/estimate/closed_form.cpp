#include "sim/estimate/closed_form.h"

#include "sim/estimate/line_traffic.h"
#include "sim/estimate/mean_value.h"
#include "sim/estimate/screen_schedule.h"
#include "sim/machine/describe.h"
#include "sim/network/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

namespace sim {
namespace {

double sum(const PhaseWork& w) {
    return std::accumulate(w.begin(), w.end(), 0.0);
}

/// Cycles that a level, or memory, is away from the core on an idle machine.
double distance(const Config& c, unsigned level) {
    const ChipFigures f = chip_figures(c);
    const double cycle_ns = real(c.chip.clock_ps) * 1e-3;
    const double ns = level < c.cache_levels() ? f.below[level - 1].ns : f.memory_closed_ns;
    return ns / cycle_ns;
}

/// What an instruction asks for, in cycles, on the machine wanted.
struct Demands {
    double core = 0, unit = 0, network = 0, memory = 0;
    std::array<double, most_levels> banks{};
    double crowded_delay = 0; // more, where all threads of a core are at work
    double alone = 0;         // all of it, of a lone worker
    double stretch = 1;       // of what the seed says of phases
};

/// `alone`: of a lone worker on the seed's machine. `lines`: of memory.
Demands demands_of(const Seed& s, const Config& seed_machine, const Config& machine, double alone,
                   double lines) {
    Demands d;
    const unsigned levels = machine.cache_levels();
    double waits = 0, seen = 0, crowd = 0;
    for (unsigned level = 1; level <= levels; ++level) {
        const double was = s.waits[level < levels ? level : most_levels];
        const double is = was * distance(machine, level) / distance(seed_machine, level);
        seen += was;
        waits += is;
        crowd += is * (s.crowding[level - 1] - 1);
    }
    d.stretch = (alone + waits - seen) / alone;
    d.alone = alone + waits - seen;
    d.crowded_delay = std::max(crowd, 0.0);
    d.core = s.core;
    d.unit = s.unit;
    for (unsigned level = 1; level < levels; ++level)
        d.banks[level] = s.banks[level];
    const NetworkFigures network = network_figures(machine);
    if (network.bisection_bytes_per_second > 0)
        // Half of all ways cross the middle.
        d.network =
            s.network_bytes / 2 / (network.bisection_bytes_per_second * real(machine.chip.clock_ps) * 1e-12);
    d.memory = lines * line_service_cycles(machine, s.lines > 0 ? s.activates / s.lines : 0);
    return d;
}

/// The chip as a network of queues, a class of customers a core; rounds are a lone worker's cycles.
class Chip {
public:
    Chip(const Demands& d, const Config& c)
        : d_(d), c_(c), cores_(static_cast<std::size_t>(c.all_cores())),
          units_(c.core.shared_classes == "none"
                     ? 0
                     : (cores_ + static_cast<std::size_t>(c.core.shared_cores) - 1) /
                           static_cast<std::size_t>(c.core.shared_cores)),
          network_(cores_ + units_ + cores_ * (most_levels - 1) + 2), classes_(cores_) {
        for (std::size_t core = 0; core < cores_; ++core)
            add_visits(core);
    }

    const std::vector<double>& paces(const std::vector<int>& at_work) {
        const double crowd = d_.crowded_delay / d_.alone / std::max(real(c_.chip.threads) - 1, 1.0);
        for (std::size_t core = 0; core < cores_; ++core) {
            classes_[core].customers = at_work[core];
            classes_[core].delay = delay_ + crowd * std::max(at_work[core] - 1, 0);
        }
        return network_.solve(classes_);
    }

private:
    /// The share of a lone worker's cycle.
    double share(double demand) const { return demand / d_.alone; }
    void add_visits(std::size_t core) {
        std::vector<CustomerClass::Visit>& v = classes_[core].visits;
        // Stations of a thread work at the same time: slots while units and banks do. What it takes alone is
        // known, so that its round is that and all that queues add.
        double delay = 1;
        const auto add = [&](std::size_t station, double demand, double servers) {
            double others = 0;
            const double queued = many_servers(share(demand), servers, others);
            delay -= queued;
            if (queued > 0)
                v.push_back({station, queued});
        };
        add(core, d_.core, 1);
        if (units_ > 0)
            add(cores_ + core / static_cast<std::size_t>(c_.core.shared_cores), d_.unit, 1);
        std::size_t next = cores_ + units_;
        for (unsigned level = 1; level < c_.cache_levels(); ++level, next += cores_) {
            const auto sharing = static_cast<std::size_t>(c_.cores_sharing(level));
            add(next + core / sharing, d_.banks[level], real(c_.cache(level).banks));
        }
        const std::size_t last = cores_ + units_ + cores_ * (most_levels - 1);
        add(last, d_.network, 1);
        add(last + 1, d_.memory, real(c_.memory.channels));
        delay_ = delay;
    }

    const Demands& d_;
    const Config& c_;
    std::size_t cores_, units_;
    ApproximateNetwork network_;
    std::vector<CustomerClass> classes_;
    double delay_ = 0;
};

} // namespace

double line_service_cycles(const Config& c, double activates_a_line) {
    const MemoryConfig& m = c.memory;
    const double bursts = std::max(1.0, real(c.last_cache().line_bytes) / real(m.bus_bytes * m.burst_length));
    const double bus = bursts * real(m.burst_clocks());
    const double rows = activates_a_line * std::max(real(m.tRRD_S), real(m.tFAW) / 4) / real(m.ranks);
    const integer blocked = m.refresh == "per-bank" ? m.tRFCpb : m.tRFC; // a bank, of each that long
    const double refreshed = m.tREFI == 0 ? 0 : real(blocked) / real(m.tREFI);
    return std::max(bus, rows) / (1 - std::min(refreshed, 0.5)) * real(m.clock_ps) / real(c.chip.clock_ps);
}

Prediction predict(const Seed& seed, const Config& seed_machine, const Config& machine,
                   const ScreenWork& work, const std::vector<Seat>& seats) {
    Prediction p;
    PhaseWork all = work.once;
    const auto add = [&](const PhaseWork& w) {
        for (std::size_t i = 0; i < all.size(); ++i)
            all[i] += w[i];
    };
    for (const PhaseWork& w : work.built) {
        add(w);
        p.built += sum(w);
    }
    for (const PhaseWork& w : work.tiles)
        add(w);
    p.instructions = sum(all);
    double alone = 0;
    for (std::size_t i = 0; i < all.size(); ++i)
        alone += all[i] * seed.phases[i].alone;
    const LineTraffic lines = predict_lines(seed, seed_machine, machine, work, seats);
    p.reads = lines.reads;
    p.writes = lines.writes;
    const Demands d = demands_of(seed, seed_machine, machine, alone / p.instructions,
                                 (lines.reads + lines.writes) / p.instructions);
    const auto cycles = [&](const PhaseWork& w) {
        double c = 0;
        for (std::size_t i = 0; i < w.size(); ++i)
            c += w[i] * seed.phases[i].alone * d.stretch;
        return c;
    };

    std::vector<double> screen;
    for (std::size_t t = 0; t < work.tiles.size(); ++t)
        screen.push_back(cycles(work.tiles[t]) + cycles(work.built[t]));
    std::map<int, int> workers_of; // by tree
    for (const Seat& seat : seats)
        ++workers_of[seat.tree];
    std::vector<ScreenWorker> workers;
    std::vector<bool> used(static_cast<std::size_t>(machine.all_cores()));
    for (const Seat& seat : seats) {
        workers.push_back({seat.core, seat.tree, workers_of[seat.tree] > 1 ? seed.word_wait : 0});
        used[static_cast<std::size_t>(seat.core)] = true;
    }
    Chip chip(d, machine);
    const ScreenSchedule rendered = schedule_screen(
        screen, workers, static_cast<int>(machine.all_cores()),
        [&](const std::vector<int>& at_work) -> const std::vector<double>& { return chip.paces(at_work); });
    const double used_cores = real(std::count(used.begin(), used.end(), true));
    p.once_cycles = cycles(work.once) / used_cores;
    p.cycles = p.once_cycles + rendered.cycles;
    p.threads = rendered.busy / std::max(rendered.cycles, 1.0);
    p.waiting = rendered.waiting / std::max(rendered.cycles, 1.0);
    const double time = std::max(rendered.cycles, 1.0);
    const auto use = [&](const char* name, const char* meaning, double demand, double servers) {
        if (demand > 0)
            p.stations.push_back({name, meaning, p.instructions * demand / servers / time});
    };
    const double all_cores = real(machine.all_cores());
    use("cores", "issue slots, or the port of a core that works most", d.core, all_cores);
    if (machine.core.shared_classes != "none")
        use("shared units", "units of core.shared_classes", d.unit,
            all_cores / real(machine.core.shared_cores));
    constexpr std::array<const char*, most_levels> banks = {"", "L2 banks", "L3 banks", "L4 banks",
                                                            "L5 banks"};
    for (unsigned level = 1; level < machine.cache_levels(); ++level)
        use(banks[level], "banks of the level's caches", d.banks[level],
            all_cores / real(machine.cores_sharing(level)) * real(machine.cache(level).banks));
    use("network", "links across its middle", d.network, 1);
    use("memory", "channels, by what a line takes of one", d.memory, real(machine.memory.channels));
    std::stable_sort(p.stations.begin(), p.stations.end(),
                     [](const StationUse& a, const StationUse& b) { return a.utilisation > b.utilisation; });
    const double idle = 1 - (p.threads + p.waiting) / real(seats.size());
    const StationUse& most = p.stations.front();
    p.limiter = most.utilisation >= 0.6
                    ? fmt::format("{}: busy for {:.0f} % of the run", most.name, 100 * most.utilisation)
                : idle >= 0.5 ? fmt::format("few screen tiles: workers are without one for {:.0f} % of "
                                            "the time",
                                            100 * idle)
                              : fmt::format("waiting: the busiest, {}, works for {:.0f} % of the run",
                                            most.name, 100 * most.utilisation);
    return p;
}

} // namespace sim
