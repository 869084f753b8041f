// What a level of caches passed on in a run, passed on to the levels below once more.
#include "sim/replay/addresses.h"
#include "sim/replay/replay_machine.h"
#include "sim/trace/passing.h"

namespace sim {

Answer ReplayMachine::pass(const ReplayAction& a, const Seat& s, std::uint64_t address, std::uint32_t bytes,
                           cycle t) {
    if (is_memory()) {
        if (of_shared_level_)
            send_to_memory(a, s, address, bytes, t);
        else
            give_to_memory(a, s, address, bytes, t);
        return {t, Cause::memory};
    }
    const Passing passing(a.detail);
    s.tile->site = passing.site();
    Access access{address, bytes, t, a.column};
    passing.apply(access);
    access.by = s.cache;
    access.asker = s.cache->number();
    // What comes dirty from an exclusive level, and where it goes then, is in the trace.
    if (s.tile->events && level_ < tile_levels_ && config_.cache(level_).inclusion == "exclusive")
        access.by = nullptr;
    switch (a.kind) {
    case traces::Kind::read:
    case traces::Kind::write:
    case traces::Kind::modify:
    case traces::Kind::prefetch:
        return s.cache->below().read(access);
    case traces::Kind::write_back:
    case traces::Kind::clean_back:
    case traces::Kind::write_through:
        return s.cache->below().write(access);
    case traces::Kind::upgrade:
        return s.cache->below().own(access);
    case traces::Kind::word: // not through the L1
        s.tile->site = {};
        access.by = nullptr;
        access.asker = s.core->l1.number();
        return access.modify ? s.core->words.read(access) : s.core->words.write(access);
    case traces::Kind::refused:
        return ask_in_vain(passing.asks(), s, access);
    case traces::Kind::recall:
        s.cache->stand_in(address, passing.has(Passing::changed), !passing.has(Passing::owned));
        break;
    default:
        pass_word(a, s, address, t);
    }
    return {t, Cause::l1};
}

/// What was refused in the run.
Answer ReplayMachine::ask_in_vain(Passing::Asks asks, const Seat& s, Access access) {
    switch (asks) {
    case Passing::read:
        return s.cache->below().read(access);
    case Passing::write:
        return s.cache->below().write(access);
    case Passing::own:
        return s.cache->below().own(access);
    default: // a word, not through the L1
        s.tile->site = {};
        access.by = nullptr;
        access.asker = s.core->l1.number();
        return s.core->words.read(access);
    }
}

/// It is there at cycle `t`: each of its lines.
void ReplayMachine::give_to_memory(const ReplayAction& a, const Seat& s, std::uint64_t address,
                                   std::uint32_t bytes, cycle t) {
    const bool write = a.kind == traces::Kind::write || a.kind == traces::Kind::write_back ||
                       a.kind == traces::Kind::write_through;
    const std::uint64_t line_bytes = std::uint64_t{1} << line_shift_, before = address & (line_bytes - 1);
    for (std::uint64_t from = 0; from < before + bytes; from += line_bytes) {
        const std::uint64_t line = address - before + from;
        std::uint64_t counted = line;
        if (by_reference_) {
            counted %= CompactAddresses::end;
            place(a, counted);
        }
        if (write)
            s.tile->attribution.count_memory_write(counted, a.column);
        else
            s.tile->attribution.count_memory_read(counted, a.column);
        beyond_->ask_memory(write, line, t);
    }
}

/// A cache that tiles share asks for it at cycle `t`: a line that it misses, or one that leaves it.
void ReplayMachine::send_to_memory(const ReplayAction& a, const Seat& s, std::uint64_t address,
                                   std::uint32_t bytes, cycle t) {
    beyond_->serve(begin_of(t));
    Access access{address, bytes, t, a.column};
    Passing(a.detail).apply(access);
    MemoryPort& way = beyond_->way_to_memory(s.tile->number);
    switch (a.kind) {
    case traces::Kind::read:
    case traces::Kind::write:
    case traces::Kind::modify:
    case traces::Kind::prefetch:
        way.read(access);
        break;
    case traces::Kind::write_back:
    case traces::Kind::write_through:
        way.write(access);
        break;
    default:
        break;
    }
}

/// Word to a level below, or beyond the tile.
void ReplayMachine::pass_word(const ReplayAction& a, const Seat& s, std::uint64_t address, cycle t) {
    const unsigned level = Passing(a.detail).level();
    Tile& tile = *s.tile;
    tile.site = {};
    if (level >= tile_levels_) {
        TileExit& exit = tile.exits[s.number / tile.sharing[tile_levels_ - 1]];
        exit.tell(a.kind == traces::Kind::flush   ? Request::discard
                  : a.kind == traces::Kind::claim ? Request::claim
                                                  : Request::invalidate,
                  address, t, a.column);
        return;
    }
    if (a.kind == traces::Kind::invalidate)
        tile.cache_of(level, s.number).invalidate(address, t, a.column);
    else if (tile.events)
        tile.arrivals[level][s.number / tile.sharing[level]]->discard(
            address, t, level == 1 ? s.core->l1.number() : tile.cache_of(level - 1, s.number).number());
    else
        tile.cache_of(level, s.number).discard(address);
}

} // namespace sim
