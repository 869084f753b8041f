#include "sim/machine/coherence.h"

#include <algorithm>
#include <utility>

namespace sim {

Coherence::Coherence(const Config& config, const Ways& ways, std::deque<Tile>& tiles, WriteBack write_back,
                     Send send)
    : exits_(tiles.front().exits.size()), level_(config.tile_levels() - 1),
      line_bytes_(static_cast<std::uint32_t>(config.cache(level_).line_bytes)),
      snoops_(config.coherence.snoops()),
      look_up_(snoops_ ? 0 : static_cast<std::uint64_t>(config.coherence.directory_cycles)),
      snoop_(snoops_ ? static_cast<std::uint64_t>(config.coherence.snoop_cycles) : 0), ways_(ways),
      tiles_(tiles), write_back_(std::move(write_back)), send_(std::move(send)),
      directory_(snoops_ || config.coherence.directory_entries == 0
                     ? 0
                     : static_cast<std::size_t>(config.coherence.directory_ways),
                 [&ways, bytes = line_bytes_,
                  sets = static_cast<std::uint64_t>(config.coherence.directory_entries /
                                                    config.coherence.directory_ways)](std::uint64_t address) {
                     return ways.home(address) * sets + Directory::set_of(address / bytes, sets);
                 }) {}

bool Coherence::grants_silently(const Request& r) {
    const Directory::Line* l = directory_.find(r.read);
    if (l == nullptr || l->owner != number_of(r))
        return false;
    under_way(number_of(r)).asked(r.read, true);
    ++counters_.silent_upgrades;
    return true;
}

// --- what is decided

void Coherence::ask(const Request& r, cycle t, Hears hears) {
    const bool upgrade = r.kind == Request::upgrade;
    const std::uint32_t who = number_of(r);
    const auto a = std::make_shared<Asking>();
    a->r = r;
    a->hears = std::move(hears);
    under_way(who).asked(r.read, upgrade);
    make_room(*a);
    Directory::Line& l = directory_.line(r.read);
    ++(upgrade ? counters_.upgrades : r.exclusive ? counters_.writes : counters_.reads);
    if (snoops_)
        forget_dropped(r, l);
    a->granted = upgrade && l.has(who);
    if (a->granted)
        a->out.from = Outcome::nobody;
    else if (upgrade)
        ++counters_.lost_upgrades;
    if (l.owner != Directory::nobody && l.owner != who)
        plan_forward(*a, l);
    else if (r.exclusive)
        plan_invalidation(*a, l);
    a->writes_back = give(r, l);
    l.coming = l.owner == who;
    recall(a, t);
}

void Coherence::claim(const Request& r, cycle t, std::function<void(const Outcome&)> over) {
    ++counters_.claims;
    const auto a = std::make_shared<Asking>();
    a->r = r;
    a->r.read = r.write / line_bytes_ * line_bytes_;
    a->r.exclusive = true;
    a->hears.over = std::move(over);
    a->out.from = Outcome::nobody;
    const Directory::Line* known = directory_.find(a->r.read);
    a->changes_owner = known != nullptr && known->shared_by(number_of(r));
    if (a->changes_owner) {
        Directory::Line& l = directory_.line(a->r.read);
        plan_invalidation(*a, l);
        give(a->r, l);
        l.coming = true;
    }
    carry_out(a, t);
}

/// Of a directory with room for some lines: others leave. Where it had none for an earlier one, several do.
void Coherence::make_room(Asking& a) {
    while (directory_.is_crowded_for(a.r.read)) {
        const auto leaving = directory_.leaving(a.r.read, [&](std::uint64_t line) {
            const Directory::Line& l = *directory_.find(line);
            const auto asks = [&](std::uint32_t cache) { return under_way(cache).asks(line); };
            return !is_coming(line) && !(l.owner != Directory::nobody && asks(l.owner)) &&
                   std::none_of(l.sharers.begin(), l.sharers.end(), asks);
        });
        if (!leaving) {
            ++counters_.crowded;
            break;
        }
        plan_recall(a, *leaving);
    }
}

/// All that have the line drop it.
void Coherence::plan_recall(Asking& a, std::uint64_t line) {
    const Directory::Line l = *directory_.find(line);
    directory_.forget(line);
    ++counters_.recalled_lines;
    const auto take = [&](std::uint32_t holder) {
        Cache& at = cache(holder);
        ++counters_.recalls;
        Told told{holder, line, holder == l.owner ? l.since : 0, at.says_it_holds(line, a.r.at), false};
        if (told.holds) {
            ++counters_.recalls_received;
            // A sharer's too: who writes a shared word has changed the line before the directory hears of it.
            told.changed = at.share(line, line_bytes_, a.r.at, a.r.column);
            counters_.written_back += told.changed ? 1 : 0;
            at.lose(line, line_bytes_);
        } else {
            ++counters_.recalls_stale;
        }
        a.recalled.push_back(told);
    };
    if (l.owner != Directory::nobody)
        take(l.owner);
    std::for_each(l.sharers.begin(), l.sharers.end(), take);
}

/// Caches that hear of a request say what they have then: what they dropped without a word is known now.
void Coherence::forget_dropped(const Request& r, Directory::Line& l) {
    const auto dropped = [&](std::uint32_t number) {
        return number != number_of(r) && !cache(number).says_it_holds(r.read, r.at) &&
               !under_way(number).asks(r.read);
    };
    if (l.owner != Directory::nobody && dropped(l.owner))
        l.owner = Directory::nobody;
    std::erase_if(l.sharers, dropped);
}

/// Another cache may write the line.
void Coherence::plan_forward(Asking& a, Directory::Line& l) {
    const Request& r = a.r;
    const std::uint32_t owner = std::exchange(l.owner, Directory::nobody);
    Cache& from = cache(owner);
    ++counters_.forwards;
    Told told{owner, r.read, l.since, from.says_it_holds(r.read, r.at) && !under_way(owner).asks_line(r.read),
              false};
    if (!told.holds) {
        ++counters_.forwards_stale;
    } else {
        a.out.from = Outcome::owner;
        bool dirty = false;
        if (!r.exclusive) {
            dirty = told.changed = from.share(r.read, line_bytes_, r.at, r.column);
            l.sharers.push_back(owner);
            counters_.written_back += dirty ? 1 : 0;
        } else if (!under_way(owner).asks(r.read)) {
            dirty = from.lose(r.read, line_bytes_);
        }
        ++(dirty ? counters_.forwards_dirty : counters_.forwards_clean);
    }
    a.owner.push_back(told);
}

/// All sharers but the writer drop the line.
void Coherence::plan_invalidation(Asking& a, const Directory::Line& l) {
    a.invalidates = true;
    for (const std::uint32_t sharer : l.sharers) {
        if (sharer == number_of(a.r))
            continue;
        Cache& at = cache(sharer);
        ++counters_.invalidations;
        const bool holds = at.says_it_holds(a.r.read, a.r.at) && !under_way(sharer).asks(a.r.read);
        ++(holds ? counters_.invalidations_received : counters_.invalidations_stale);
        if (holds)
            at.lose(a.r.read, line_bytes_);
        a.sharers.push_back({sharer, a.r.read, 0, holds, false});
    }
}

/// The line is the asker's. Returns whether it writes back what it had changed before: a right that was given
/// before, and taken while the line was asked for again.
bool Coherence::give(const Request& r, Directory::Line& l) {
    const std::uint32_t who = number_of(r);
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
        return cache(who).says_it_owns(r.read, r.at) && cache(who).share(r.read, line_bytes_, r.at, r.column);
    }
    cache(who).grant(r.read, line_bytes_);
    return false;
}

// --- messages

void Coherence::send(const Ways::Leg& leg, cycle t, const Shared& a, std::function<void(cycle)> then) {
    ++a->unheard;
    send_(leg, t, [this, a, then = std::move(then)](cycle there) {
        then(there);
        heard(a);
    });
}

/// One message less is on its way.
void Coherence::heard(const Shared& a) {
    if (--a->unheard != 0)
        return;
    if (a->out.from != Outcome::below && a->changes_owner)
        arrives(a->r, std::max(a->out.at, a->out.finished));
    if (a->hears.over)
        a->hears.over(a->out);
}

/// Lines that leave the directory, at `t`; what else is to be done follows when all of them have left.
void Coherence::recall(const Shared& a, cycle t) {
    if (a->recalled.empty())
        return carry_out(a, t);
    struct Left {
        std::size_t messages;
        cycle ready;
    };
    const auto left = std::make_shared<Left>(Left{a->recalled.size(), t});
    for (const Told& told : a->recalled) {
        const std::uint32_t tile = tile_of(told.cache);
        send(ways_.telling_tile(told.line, tile), t, a, [this, a, told, tile, left](cycle there) {
            const cycle done =
                (told.holds ? std::max(there, told.since) : there) + cache(told.cache).latency();
            if (told.changed)
                write_back(told.cache, a->r, told.line, done);
            send(ways_.answering_directory(tile, told.line), done, a, [this, a, left](cycle back) {
                left->ready = std::max(left->ready, back);
                if (--left->messages == 0)
                    carry_out(a, left->ready);
            });
        });
    }
}

/// The directory, or the hub, says what is to be done.
void Coherence::carry_out(const Shared& a, cycle t) {
    const Request& r = a->r;
    const auto latest = [](cycle& at) { return [&at](cycle there) { at = std::max(at, there); }; };
    a->out.at = t;
    if (snoops_)
        pass_on(a, t);
    else {
        if (a->granted)
            send(ways_.telling_tile(r.read, r.tile), t, a, [a](cycle there) { a->out.at = there; });
        for (const Told& owner : a->owner)
            send(ways_.telling_tile(r.read, tile_of(owner.cache)), t, a,
                 [this, a](cycle there) { owner_hears(a, there); });
        for (const Told& sharer : a->sharers) {
            ++counters_.acknowledgements;
            send(ways_.telling_tile(r.read, tile_of(sharer.cache)), t, a,
                 [this, a, number = sharer.cache, latest](cycle there) {
                     send(ways_.telling_writer(tile_of(number), a->r.tile), there + cache(number).latency(),
                          a, latest(a->out.finished));
                 });
        }
    }
    if (a->writes_back) {
        ++counters_.written_back;
        write_back(number_of(r), r, r.read, r.at);
    }
    if (a->out.from == Outcome::below && (snoops_ || a->owner.empty()))
        a->hears.below(t);
    heard(a);
}

/// The request is on its own bus at `t`: to the others.
void Coherence::pass_on(const Shared& a, cycle t) {
    const Topology& topology = ways_.network().topology();
    const std::size_t own = topology.bus_of(a->r.tile), buses = topology.buses();
    counters_.snoops += tiles_.size() * exits_ - 1;
    a->deaf_buses = buses;
    const auto hears = [this, a](std::size_t bus, cycle there) {
        a->said = std::max(a->said, there + snoop_);
        for (const Told& owner : a->owner)
            if (ways_.network().topology().bus_of(tile_of(owner.cache)) == bus)
                owner_hears(a, there + snoop_);
        if (--a->deaf_buses != 0)
            return;
        a->out.known = a->said;
        if (a->granted)
            a->out.at = a->said;
        if (a->invalidates)
            a->out.finished = a->said;
    };
    for (std::size_t bus = 0; bus < buses; ++bus) {
        if (bus == own) {
            hears(bus, t);
        } else {
            ++counters_.passed_on;
            const auto there_hear = [hears, bus](cycle there) { hears(bus, there); };
            // A line that its owner brings waits for nobody else.
            if (a->out.from != Outcome::owner || topology.bus_of(tile_of(a->owner.front().cache)) == bus)
                send(ways_.telling_bus(a->r.read, bus), t, a, there_hear);
            else
                send_(ways_.telling_bus(a->r.read, bus), t, there_hear);
        }
    }
}

/// The owner of the line brings it, or says that it has it no more.
void Coherence::owner_hears(const Shared& a, cycle there) {
    const Request& r = a->r;
    const Told& owner = a->owner.front();
    const std::uint32_t tile = tile_of(owner.cache);
    const std::uint64_t latency = cache(owner.cache).latency();
    if (!owner.holds) {
        if (!snoops_)
            send(ways_.answering_directory(tile, r.read), there + latency, a, [a](cycle back) {
                a->out.at = back;
                a->hears.below(back);
            });
        return;
    }
    const cycle ready = std::max(there, owner.since);
    counters_.wait_cycles += ready - there;
    // Before it is written back.
    send(ways_.passing(tile, r.tile, line_bytes_), ready + latency, a, [a](cycle back) { a->out.at = back; });
    if (owner.changed)
        write_back(owner.cache, r, r.read, ready + latency);
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
