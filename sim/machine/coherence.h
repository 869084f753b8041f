// Coherence between the last caches of tiles (coherence.plain). MESI: a line that nobody else has comes
// exclusive; one that another may write is brought by that one, which writes it back if it had changed it and
// has it read from it; a write takes it from all sharers.
// * directory: who has a line is known at its bank of the cache that all tiles share, or at its memory
//   channel. There a request is looked up, sent on to the owner, or told to the sharers, which tell the
//   writer. A directory with room for some lines alone (coherence.directory_entries) first recalls another
//   one for a line that it does not know: who has that drops it, what was changed is written back, and when
//   all have answered the request goes on. Lines that somebody is just asking for stay.
// * snoop: all caches see each other's requests. Those of the same bus as it passes; the hub passes it on to
//   all other buses. coherence.snoop_cycles later all have said what they have, and the owner begins to bring
//   the line, of which memory takes what it had changed as it passes; memory is asked at once, but its answer
//   waits for what the caches say, as does a writer. What they say goes on lines of its own. A cache that all
//   tiles share stands where memory does here, at the hub.
// What happens to a line is decided when the directory has looked it up, or the hub has it, in the order in
// which requests are served, and acts on the tiles' caches at once, that is after the window: whether one has
// a line is what its tags say then. When it is done is what messages take over the network: each leaves when
// the one before it is there (see Send). Not modelled: ports of caches that look lines up or bring them; that
// a line which is asked for again while it is taken away cannot be read meanwhile, or, before a cache beyond
// the tiles, recalled; that a request waits where all lines of its set are being asked for; that a bus lets
// only so many requests be under way, or memory, or a cache beyond the tiles, reads in vain what an owner
// brings.
#pragma once

#include "sim/machine/tile.h"
#include "sim/memory/coherence_counters.h"
#include "sim/memory/directory.h"
#include "sim/network/ways.h"

#include <deque>
#include <functional>
#include <memory>
#include <vector>

namespace sim {

class Coherence {
public:
    /// A changed line that a tile's cache writes back from this cycle on.
    using WriteBack = std::function<void(const Request&)>;
    using Arrives = std::function<void(cycle)>;
    /// A message leaves at a cycle; who waits for it is called when it is known when it is there, at once or
    /// later.
    using Send = std::function<void(const Ways::Leg&, cycle, const Arrives&)>;

    Coherence(const Config& config, const Ways& ways, std::deque<Tile>& tiles, WriteBack write_back,
              Send send);

    /// What becomes of a request.
    struct Outcome {
        enum From : std::uint8_t { below, owner, nobody } from = below; // that brings the line
        cycle at = 0;       // when it is asked for below; of others, when all is there
        cycle finished = 0; // when all others have said that they dropped it
        cycle known = 0;    // no answer from below leaves earlier
    };
    /// Who asks hears, at once or later, when the line is to be asked for below, if it is, and then, when all
    /// of it is known, what has become of the request.
    struct Hears {
        Arrives below;
        std::function<void(const Outcome&)> over;
    };
    /// A line is asked for, or the right to write it, at `t`.
    void ask(const Request& r, cycle t, Hears hears);
    /// Whether a cache that asks for the right to write a line has it; then it is asked for no more.
    bool grants_silently(const Request& r);
    /// Whether a request for this line has to wait: when its owner has it is not known until arrives() says
    /// so, or what was asked for is over.
    bool is_coming(std::uint64_t line) const;
    /// It comes from below at `ready`.
    void arrives(const Request& r, cycle ready);
    /// It is written back.
    void written(const Request& r);
    /// A shared word in it is written; `over` is called when all others have dropped it.
    void claim(const Request& r, cycle t, std::function<void(const Outcome&)> over);

    /// Cycles of the directory, if there is one.
    std::uint64_t look_up() const { return look_up_; }
    const CoherenceCounters& counters() const { return counters_; }
    /// Lines that a cache may write or read but the directory does not know so: 0 when nothing is under way.
    std::uint64_t incoherent() const;

private:
    std::uint32_t number_of(const Request& r) const {
        return r.tile * static_cast<std::uint32_t>(exits_) + r.exit;
    }
    std::uint32_t tile_of(std::uint32_t cache) const { return cache / static_cast<std::uint32_t>(exits_); }
    Cache& cache(std::uint32_t number) const {
        return tiles_[tile_of(number)].caches[level_][number % exits_];
    }
    UnderWay& under_way(std::uint32_t number) const {
        return tiles_[tile_of(number)].exits[number % exits_].under_way;
    }
    /// A cache that hears of a line, and what was there when that was decided.
    struct Told {
        std::uint32_t cache;
        std::uint64_t line;
        cycle since;  // it has the line, if it is its owner
        bool holds;   // and nothing of it is on its way there
        bool changed; // and writes it back
    };
    /// What was decided of a request, and how far messages have got.
    struct Asking {
        Request r;
        Hears hears;
        Outcome out{};
        bool granted = false, invalidates = false, changes_owner = true;
        std::vector<Told> recalled, owner, sharers; // of the line that is asked for: its owner, or sharers
        std::size_t unheard = 1;                    // messages, and what has yet to be sent
        std::size_t deaf_buses = 0;
        cycle said = 0; // caches that snoop: all so far have said what they have
        bool writes_back = false;
    };
    using Shared = std::shared_ptr<Asking>;

    void make_room(Asking& a);
    void plan_recall(Asking& a, std::uint64_t line);
    void plan_forward(Asking& a, Directory::Line& l);
    void plan_invalidation(Asking& a, const Directory::Line& l);
    void forget_dropped(const Request& r, Directory::Line& l);
    bool give(const Request& r, Directory::Line& l);

    void recall(const Shared& a, cycle t);
    void carry_out(const Shared& a, cycle t);
    void pass_on(const Shared& a, cycle t);
    void owner_hears(const Shared& a, cycle there);
    void heard(const Shared& a);
    void send(const Ways::Leg& leg, cycle t, const Shared& a, std::function<void(cycle)> then);
    void write_back(std::uint32_t from, const Request& r, std::uint64_t line, cycle t);

    std::size_t exits_;
    unsigned level_; // of the tiles' last caches
    std::uint32_t line_bytes_;
    bool snoops_;
    std::uint64_t look_up_, snoop_;
    const Ways& ways_;
    std::deque<Tile>& tiles_;
    WriteBack write_back_;
    Send send_;
    Directory directory_;
    CoherenceCounters counters_;
};

} // namespace sim
