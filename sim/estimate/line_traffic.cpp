#include "sim/estimate/line_traffic.h"

#include "sim/estimate/real.h"
#include "sim/estimate/screen_schedule.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace sim {
namespace {

/// What the workers of one last cache do.
struct CacheShare {
    PhaseWork work{};
    double at_work = 0; // workers that have a screen tile
};

unsigned last_level(const Config& c) {
    return c.cache_levels() - 1;
}
double lines_held(const Config& c) {
    const auto& last = c.cache(last_level(c));
    return real(last.size_bytes / last.line_bytes);
}

std::vector<CacheShare> shares_of(const Config& machine, const ScreenWork& work,
                                  const std::vector<Seat>& seats) {
    std::map<int, CacheShare> by_cache;
    const std::vector<int> first =
        stretches(static_cast<int>(work.tiles.size()), static_cast<int>(seats.size()));
    for (std::size_t w = 0; w < seats.size(); ++w) {
        CacheShare& own =
            by_cache[seats[w].core / static_cast<int>(machine.cores_sharing(last_level(machine)))];
        own.work.resize(work.once.size());
        own.at_work += first[w] < first[w + 1] ? 1 : 0;
        for (auto t = static_cast<std::size_t>(first[w]); t < static_cast<std::size_t>(first[w + 1]); ++t)
            for (std::size_t p = 0; p < own.work.size(); ++p)
                own.work[p] += work.tiles[t][p] + work.built[t][p];
    }
    std::vector<CacheShare> out;
    for (auto& [number, share] : by_cache)
        out.push_back(std::move(share));
    return out;
}

/// Phases of one use, in the seed.
struct Group {
    double reads = 0, lines = 0, before = 0;
    double again = 0;  // lines read that had been read
    double alone = 0;  // ... if one thread had the cache
    double spared = 0; // lines not read, as a phase that is done once had left them there
};

Group group_of(const Seed& seed, PhaseUse use, double crowding) {
    Group g;
    for (const SeedPhase& p : seed.phases)
        if (p.use == use) {
            g.reads += p.reads;
            g.lines += p.lines;
            g.before += p.before;
        }
    g.again = std::max(g.reads - g.lines, 0.0);
    g.alone = std::clamp(g.reads / std::max(crowding, 1.0) - g.lines, 0.0, g.again);
    g.spared = std::min(g.before, std::max(g.lines - g.reads, 0.0));
    return g;
}

/// Of so many lines that come to a cache, those that push others out: lines fall on sets as they will
/// (Poisson), so that some sets are too small before the cache is full.
double pushed_out(const Config& c, double lines) {
    const auto& last = c.cache(last_level(c));
    const double sets = real(last.size_bytes / last.line_bytes / last.ways), of_set = lines / sets;
    double chance = std::exp(-of_set), room = 0; // of k lines in a set; left in it, in the mean
    for (integer k = 0; k < last.ways; ++k) {
        room += real(last.ways - k) * chance;
        chance *= of_set / real(k + 1);
    }
    return std::max(of_set - real(last.ways) + room, 0.0) * sets;
}

/// The part of lines touched for which there is no room.
double beyond(double held, double touched) {
    return touched > held ? 1 - held / touched : 0;
}

} // namespace

LineTraffic predict_lines(const Seed& seed, const Config& seed_machine, const Config& machine,
                          const ScreenWork& work, const std::vector<Seat>& seats) {
    const std::vector<CacheShare> shares = shares_of(machine, work, seats);
    const unsigned last = last_level(machine);
    const double seed_caches = std::max(
        1.0, std::min(real(seed_machine.all_cores() / seed_machine.cores_sharing(last)), seed.at_work));
    const double seed_threads = std::max(seed.at_work / seed_caches, 1.0);
    const double crowding = last == 0 ? 1 : seed.crowding[last];
    double seed_reads = 0, seed_writes = 0, seed_touched = 0, once = 0;
    for (const SeedPhase& p : seed.phases) {
        seed_reads += p.reads;
        seed_writes += p.writes;
        if (p.use == PhaseUse::once)
            once += p.reads;
        else
            seed_touched += p.lines;
    }
    const SeedPhase& end = seed.phases.back();
    const double workers = real(seats.size());
    once = std::max(once + seed.worker_reads * (workers - real(seed_machine.all_threads())), 0.0);

    LineTraffic out;
    out.reads = end.use == PhaseUse::end ? end.reads : 0;
    out.writes = end.use == PhaseUse::end ? end.writes : 0;
    const double held = lines_held(machine),
                 seed_beyond = beyond(lines_held(seed_machine), seed_touched / seed_caches);
    const double seed_pushed = pushed_out(seed_machine, (seed_reads - out.reads) / seed_caches) * seed_caches;
    const bool says = seed_pushed >= 1; // what becomes of lines that are pushed out
    const double dirty = says ? (seed_writes - out.writes) / seed_pushed : 0;
    for (const CacheShare& share : shares) {
        double reads = once / real(shares.size()), touched = 0;
        const auto part = [&](std::size_t p) {
            const SeedPhase& phase = seed.phases[p];
            return phase.instructions > 0 ? share.work[p] / phase.instructions : 0;
        };
        for (std::size_t p = 0; p < share.work.size(); ++p)
            if (seed.phases[p].use != PhaseUse::once)
                touched += seed.phases[p].lines * part(p);
        const double room = seed_beyond > 0 ? beyond(held, touched) / seed_beyond : 1;
        const double crowd = seed_threads > 1 ? std::max(share.at_work - 1, 0.0) / (seed_threads - 1) : 0;
        for (const PhaseUse use : {PhaseUse::builds, PhaseUse::renders}) {
            const Group g = group_of(seed, use, crowding);
            if (g.reads <= 0)
                continue;
            const double again = (g.alone + (g.again - g.alone) * crowd) * room;
            const double spared = g.spared * (1 - 1 / real(shares.size()));
            const double factor = (g.reads - g.again + again + spared) / g.reads;
            for (std::size_t p = 0; p < share.work.size(); ++p)
                if (seed.phases[p].use == use)
                    reads += seed.phases[p].reads * part(p) * factor;
        }
        out.reads += reads;
        out.writes += pushed_out(machine, reads) * dirty;
    }
    if (!says) // but only what is written whatever fits
        out.writes = seed_writes;
    return out;
}

} // namespace sim
