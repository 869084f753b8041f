#include "sim/estimate/line_traffic.h"

#include "sim/estimate/screen_schedule.h"

#include <algorithm>
#include <array>
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

/// What the seed says of lines, by its last caches at work.
class SeedLines {
public:
    SeedLines(const Seed& seed, const Config& machine) : seed_(seed) {
        const unsigned last = last_level(machine);
        const double caches =
            std::max(1.0, std::min(real(machine.all_cores() / machine.cores_sharing(last)), seed.at_work));
        threads_ = std::max(seed.at_work / caches, 1.0);
        const double crowding = last == 0 ? 1 : seed.crowding[last];
        groups_ = {group_of(seed, PhaseUse::builds, crowding), group_of(seed, PhaseUse::renders, crowding)};
        double reads = 0, touched = 0;
        for (const SeedPhase& p : seed.phases) {
            writes_ += p.writes;
            (p.use == PhaseUse::once ? once_ : p.use == PhaseUse::end ? end_reads_ : reads) += p.reads;
            end_writes_ += p.use == PhaseUse::end ? p.writes : 0;
            touched += p.use == PhaseUse::once ? 0 : p.lines;
        }
        beyond_ = beyond(lines_held(machine), touched / caches);
        const double pushed = pushed_out(machine, (reads + once_) / caches) * caches;
        tells_writes_ = pushed >= 1;
        once_ -= seed.worker_reads * real(machine.all_threads());
        dirty_ = tells_writes_ ? (writes_ - end_writes_) / pushed : 0;
    }

    /// Lines that all of so many workers read in phases done once.
    double once(double workers) const { return std::max(once_ + seed_.worker_reads * workers, 0.0); }
    double at_the_end() const { return end_reads_; }

    /// Lines that other phases read for one of so many last caches.
    double reads(const CacheShare& share, double held, double caches) const {
        double touched = 0;
        for (std::size_t p = 0; p < share.work.size(); ++p)
            if (seed_.phases[p].use != PhaseUse::once)
                touched += seed_.phases[p].lines * part(share, p);
        const double room = beyond_ > 0 ? beyond(held, touched) / beyond_ : 1;
        const double crowd = threads_ > 1 ? std::max(share.at_work - 1, 0.0) / (threads_ - 1) : 0;
        double sum = 0;
        for (std::size_t p = 0; p < share.work.size(); ++p) {
            const SeedPhase& phase = seed_.phases[p];
            if (phase.use != PhaseUse::builds && phase.use != PhaseUse::renders)
                continue;
            const Group& g = groups_[phase.use == PhaseUse::builds ? 0 : 1];
            const double again = (g.alone + (g.again - g.alone) * crowd) * room;
            const double spared = g.spared * (1 - 1 / caches);
            if (g.reads > 0)
                sum += phase.reads * part(share, p) * (g.reads - g.again + again + spared) / g.reads;
        }
        return sum;
    }

    /// ... written, of so many that are pushed out. A seed whose lines all fit says only what is written
    /// whatever fits.
    double writes(double pushed) const { return tells_writes_ ? end_writes_ + pushed * dirty_ : writes_; }

private:
    /// Of the seed's work in a phase.
    double part(const CacheShare& share, std::size_t p) const {
        const double all = seed_.phases[p].instructions;
        return all > 0 ? share.work[p] / all : 0;
    }

    const Seed& seed_;
    std::array<Group, 2> groups_;           // builds, and what renders
    double once_ = 0;                       // lines read in phases done once, but for those of each worker
    double end_reads_ = 0, end_writes_ = 0; // at the frame's end
    double writes_ = 0;
    double threads_ = 1;        // at work, by cache
    double beyond_ = 0;         // the part of lines touched that had no room
    bool tells_writes_ = false; // some lines were pushed out ...
    double dirty_ = 0;          // ... and this part of them written
};

} // namespace

LineTraffic predict_lines(const Seed& seed, const Config& seed_machine, const Config& machine,
                          const ScreenWork& work, const std::vector<Seat>& seats) {
    const SeedLines lines(seed, seed_machine);
    const std::vector<CacheShare> shares = shares_of(machine, work, seats);
    const double caches = real(shares.size());
    const double once = lines.once(real(seats.size()));
    LineTraffic out;
    out.reads = lines.at_the_end();
    double pushed = 0;
    for (const CacheShare& share : shares) {
        const double reads = once / caches + lines.reads(share, lines_held(machine), caches);
        out.reads += reads;
        pushed += pushed_out(machine, reads);
    }
    out.writes = lines.writes(pushed);
    return out;
}

} // namespace sim
