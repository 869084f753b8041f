#include "sim/machine/coherence.h"

#include <algorithm>
#include <utility>

namespace sim {

Coherence::Coherence(const Config& config, Ways& ways, std::deque<Tile>& tiles, WriteBack write_back)
    : exits_(tiles.front().exits.size()), level_(config.tile_levels() - 1),
      line_bytes_(static_cast<std::uint32_t>(config.cache(level_).line_bytes)),
      snoops_(config.coherence.snoops()),
      look_up_(snoops_ ? 0 : static_cast<std::uint64_t>(config.coherence.directory_cycles)),
      snoop_(snoops_ ? static_cast<std::uint64_t>(config.coherence.snoop_cycles) : 0), ways_(ways),
      tiles_(tiles), write_back_(std::move(write_back)),
      directory_(snoops_ || config.coherence.directory_entries == 0
                     ? 0
                     : static_cast<std::size_t>(config.coherence.directory_ways),
                 [&ways, bytes = line_bytes_,
                  sets = static_cast<std::uint64_t>(config.coherence.directory_entries /
                                                    config.coherence.directory_ways)](std::uint64_t address) {
                     return ways.home(address) * sets + Directory::set_of(address / bytes, sets);
                 }),
      heard_(ways_.network().topology().buses()) {}

bool Coherence::grants_silently(const Request& r) {
    const Directory::Line* l = directory_.find(r.read);
    if (l == nullptr || l->owner != number_of(r))
        return false;
    under_way(number_of(r)).asked(r.read, true);
    ++counters_.silent_upgrades;
    return true;
}

Coherence::Outcome Coherence::ask(const Request& r, cycle t) {
    const bool upgrade = r.kind == Request::upgrade;
    const std::uint32_t who = number_of(r);
    under_way(who).asked(r.read, upgrade);
    t = make_room(r, t);
    Directory::Line& l = directory_.line(r.read);
    ++(upgrade ? counters_.upgrades : r.exclusive ? counters_.writes : counters_.reads);
    Outcome out;
    out.at = t;
    if (snoops_) {
        pass_on(r, t);
        forget_dropped(r, l);
        out.known = said_;
    }
    if (upgrade && l.has(who)) {
        out.from = Outcome::nobody;
        out.at = snoops_ ? said_ : ways_.tell_tile(r.read, r.tile, t);
    } else if (upgrade) {
        ++counters_.lost_upgrades;
    }
    if (l.owner != Directory::nobody && l.owner != who)
        forward(r, l, t, out);
    else if (r.exclusive)
        out.finished = invalidate(r, l, t);
    give(r, l);
    if (out.from != Outcome::below)
        arrives(r, std::max(out.at, out.finished));
    else
        l.coming = l.owner == who;
    return out;
}

/// Of a directory with room for some lines: until it has room for this one. Where it had none for an earlier
/// one, several leave.
cycle Coherence::make_room(const Request& r, cycle t) {
    cycle ready = t;
    while (directory_.is_crowded_for(r.read)) {
        const auto leaving = directory_.leaving(r.read, [&](std::uint64_t line) {
            const Directory::Line& l = *directory_.find(line);
            const auto asks = [&](std::uint32_t cache) { return under_way(cache).asks(line); };
            return !is_coming(line) && !(l.owner != Directory::nobody && asks(l.owner)) &&
                   std::none_of(l.sharers.begin(), l.sharers.end(), asks);
        });
        if (!leaving) {
            ++counters_.crowded;
            break;
        }
        ready = std::max(ready, recall(r, *leaving, t));
    }
    return ready;
}

/// All that have the line drop it; returns when they have said so.
cycle Coherence::recall(const Request& r, std::uint64_t line, cycle t) {
    const Directory::Line l = *directory_.find(line);
    directory_.forget(line);
    ++counters_.recalled_lines;
    cycle told = t;
    const auto take = [&](std::uint32_t holder) {
        const cycle there = ways_.tell_tile(line, tile_of(holder), t);
        Cache& at = cache(holder);
        ++counters_.recalls;
        cycle done = there + at.latency();
        if (at.holds(line)) {
            ++counters_.recalls_received;
            if (holder == l.owner)
                done = std::max(there, l.since) + at.latency();
            // A sharer's too: who writes a shared word has changed the line before the directory hears of it.
            if (at.share(line, line_bytes_, r.column)) {
                ++counters_.written_back;
                write_back(holder, r, line, done);
            }
            at.lose(line, line_bytes_);
        } else {
            ++counters_.recalls_stale;
        }
        told = std::max(told, ways_.answer_directory(tile_of(holder), line, done));
    };
    if (l.owner != Directory::nobody)
        take(l.owner);
    std::for_each(l.sharers.begin(), l.sharers.end(), take);
    return told;
}

/// The request is on its own bus at `t`: to the others.
void Coherence::pass_on(const Request& r, cycle t) {
    const Topology& topology = ways_.network().topology();
    const std::size_t own = topology.bus_of(r.tile);
    said_ = t;
    for (std::size_t bus = 0; bus < heard_.size(); ++bus) {
        heard_[bus] = bus == own ? t : ways_.tell_bus(r.read, bus, t);
        counters_.passed_on += bus == own ? 0 : 1;
        said_ = std::max(said_, heard_[bus]);
    }
    said_ += snoop_;
    counters_.snoops += tiles_.size() * exits_ - 1;
}

/// Caches that hear of a request say what they have then: what they dropped without a word is known now.
void Coherence::forget_dropped(const Request& r, Directory::Line& l) {
    const auto dropped = [&](std::uint32_t number) {
        return number != number_of(r) && !cache(number).holds(r.read) && !under_way(number).asks(r.read);
    };
    if (l.owner != Directory::nobody && dropped(l.owner))
        l.owner = Directory::nobody;
    std::erase_if(l.sharers, dropped);
}

/// When a cache hears of the request that the directory has looked up, or the hub has, at `t`.
cycle Coherence::hears(const Request& r, std::uint32_t cache, cycle t) {
    const std::uint32_t tile = tile_of(cache);
    return snoops_ ? heard_[ways_.network().topology().bus_of(tile)] + snoop_
                   : ways_.tell_tile(r.read, tile, t);
}

/// Another cache may write the line.
void Coherence::forward(const Request& r, Directory::Line& l, cycle t, Outcome& out) {
    const std::uint32_t owner = std::exchange(l.owner, Directory::nobody);
    const cycle there = hears(r, owner, t);
    Cache& from = cache(owner);
    ++counters_.forwards;
    if (!from.holds(r.read) || under_way(owner).asks_line(r.read)) {
        ++counters_.forwards_stale;
        if (!snoops_)
            out.at = ways_.answer_directory(tile_of(owner), r.read, there + from.latency());
        return;
    }
    const cycle start = std::max(there, l.since) + from.latency();
    counters_.wait_cycles += start - from.latency() - there;
    out.from = Outcome::owner;
    out.at = ways_.pass(tile_of(owner), r.tile, line_bytes_, start); // before it is written back
    bool dirty = false;
    if (!r.exclusive) {
        dirty = from.share(r.read, line_bytes_, r.column);
        l.sharers.push_back(owner);
        if (dirty) {
            ++counters_.written_back;
            write_back(owner, r, r.read, start);
        }
    } else if (!under_way(owner).asks(r.read)) {
        dirty = from.lose(r.read, line_bytes_);
    }
    ++(dirty ? counters_.forwards_dirty : counters_.forwards_clean);
}

/// All sharers but the writer drop the line; returns when the writer knows.
cycle Coherence::invalidate(const Request& r, const Directory::Line& l, cycle t) {
    cycle told = snoops_ ? said_ : 0;
    for (const std::uint32_t sharer : l.sharers) {
        if (sharer == number_of(r))
            continue;
        const cycle there = hears(r, sharer, t);
        Cache& at = cache(sharer);
        ++counters_.invalidations;
        if (at.holds(r.read) && !under_way(sharer).asks(r.read)) {
            ++counters_.invalidations_received;
            at.lose(r.read, line_bytes_);
        } else {
            ++counters_.invalidations_stale;
        }
        if (snoops_)
            continue;
        ++counters_.acknowledgements;
        told = std::max(told, ways_.tell_writer(tile_of(sharer), r.tile, there + at.latency()));
    }
    return told;
}

/// The line is the asker's.
void Coherence::give(const Request& r, Directory::Line& l) {
    const std::uint32_t who = number_of(r);
    l.coming = false;
    if (r.exclusive) {
        l.sharers.clear();
        l.owner = who;
    } else if (l.owner == Directory::nobody &&
               (l.sharers.empty() || (l.sharers.size() == 1 && l.shared_by(who)))) {
        l.sharers.clear();
        l.owner = who;
        ++counters_.exclusive;
    } else if (l.owner == who) {
        ++counters_.exclusive;
    } else {
        if (!l.shared_by(who))
            l.sharers.push_back(who);
        ++counters_.shared;
        // A right that was given before, and taken while the line was asked for again.
        if (cache(who).owns(r.read) && cache(who).share(r.read, line_bytes_, r.column)) {
            ++counters_.written_back;
            write_back(who, r, r.read, r.at);
        }
        return;
    }
    cache(who).grant(r.read, line_bytes_);
}

void Coherence::write_back(std::uint32_t from, const Request& r, std::uint64_t line, cycle t) {
    Request w{};
    w.at = t;
    w.tile = tile_of(from);
    w.exit = static_cast<std::uint32_t>(from % exits_);
    w.sequence = r.sequence;
    w.write = line;
    w.bytes = line_bytes_;
    w.whole = true;
    w.column = r.column;
    w.stage = Request::writes;
    // One of a kind in the order of requests.
    w.to = r.tile + 1 + (line == r.read ? 0 : static_cast<std::uint32_t>(tiles_.size()));
    w.mshr = Request::no_entry;
    write_back_(w);
}

void Coherence::arrives(const Request& r, cycle ready) {
    Directory::Line* l = directory_.find(r.read);
    if (l == nullptr || l->owner != number_of(r)) // it may have been recalled
        return;
    l->since = ready;
    l->coming = false;
}

bool Coherence::is_coming(std::uint64_t line) const {
    const Directory::Line* l = directory_.find(line);
    return l != nullptr && l->owner != Directory::nobody && l->coming;
}

void Coherence::written(const Request& r) {
    const std::uint32_t who = number_of(r);
    const bool again = under_way(who).written(r.write, r.sequence);
    if (!again && !r.stays)
        directory_.remove(r.write, who);
}

void Coherence::claim(const Request& r, cycle t) {
    ++counters_.claims;
    Request line = r;
    line.read = r.write / line_bytes_ * line_bytes_;
    if (snoops_)
        pass_on(line, t);
    const Directory::Line* known = directory_.find(line.read);
    if (known == nullptr || !known->shared_by(number_of(r)))
        return;
    line.exclusive = true;
    Directory::Line& l = directory_.line(line.read);
    l.since = std::max(t, invalidate(line, l, t));
    give(line, l);
}

std::uint64_t Coherence::incoherent() const {
    std::uint64_t lines = 0;
    for (std::uint32_t number = 0; number < tiles_.size() * exits_; ++number) {
        const Cache& c = cache(number);
        lines += c.incoherent();
        c.each_address([&](std::uint64_t address) {
            const Directory::Line* l = directory_.find(address);
            lines += l == nullptr || !(c.owns(address) ? l->owner == number : l->has(number)) ? 1 : 0;
        });
    }
    return lines;
}

} // namespace sim
