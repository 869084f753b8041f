// A memory reference, and a block of them as columns.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace traces {

/// What a reference is. `modify` reads and writes; `write_back` is a dirty line that leaves a cache,
/// `write_through` a write that a cache passes on, `flush` says that a line's contents need not be kept,
/// `invalidate` that copies of a line in caches of who is near go, as a word in it is written; with
/// `invalidate_all` those everywhere go. Of what a level of caches passes on besides: `upgrade` asks for the
/// right to write a line that is there, `clean_back` gives a clean line to an exclusive level, `word` is of a
/// shared word that the level below holds, `claim` tells a directory that one was written, and `recall` says
/// what a level above had when one below asked it for a line. `refused` is of what was asked for, had to be
/// asked for again (which is another reference), but had lines moved for it already.
enum class Kind : std::uint8_t {
    read,
    write,
    modify,
    fetch,
    prefetch,
    write_back,
    write_through,
    flush,
    invalidate,
    invalidate_all,
    upgrade,
    clean_back,
    word,
    claim,
    recall,
    refused
};
inline constexpr std::array<const char*, 16> kind_names = {
    "read",          "write", "modify",     "fetch",          "prefetch", "write_back",
    "write_through", "flush", "invalidate", "invalidate_all", "upgrade",  "clean_back",
    "word",          "claim", "recall",     "refused"};

/// How a reference belongs to the one before it in its stream: it begins an operation of the program; or is a
/// further access of the same operation; or a further piece of the same access, of one line at one time. What
/// stands aside belongs to no operation with a site: words that threads share, tables of pages, spills.
enum class Part : std::uint8_t { operation, access, piece, aside };
inline constexpr std::size_t parts = 4;

/// All of a reference that few others differ in: what a block keeps in a table.
struct Class {
    std::uint64_t site = 0; // a number in Description::sites, from 1 on, or an address; 0: unknown
    std::uint32_t size = 0; // bytes; 0: unknown
    std::uint16_t structure = 0, phase = 0, work = 0; // numbers in the tables of the description
    Kind kind = Kind::read;
    Part part = Part::operation;
    /// How it goes on to the level below, in the words of the recorder (sim/trace/passing.h); 0: unknown.
    std::uint32_t detail = 0;
    friend bool operator==(const Class&, const Class&) = default;
};

struct Reference {
    std::uint64_t time = 0, address = 0;
    std::uint32_t stream = 0;
    Class what{};
    std::uint32_t tile = 0; // of the picture it is for (Picture in description.h); 0: none
};

/// The references [begin, end) of a block are of one stream, in its order.
struct Segment {
    std::uint32_t stream = 0;
    std::size_t begin = 0, end = 0;
};

/// What came next in the order in which all streams' references were made.
struct Turn {
    enum class What : std::uint8_t { references, window, end };
    What what = What::references;
    std::uint32_t segment = 0, count = 0; // the next so many of this segment
    /// A window of time begins, up to whose end streams go on by themselves, each in its turns: what was
    /// asked for before is served as far as cycle `begin`. Or all has ended at cycle `until`, served
    /// likewise.
    std::uint64_t until = 0, begin = 0;
    friend bool operator==(const Turn&, const Turn&) = default;
};

/// Some references of all streams, those of one stream side by side. Those of later blocks come later in
/// their streams.
struct Block {
    std::vector<Segment> segments; // ascending streams
    std::vector<std::uint64_t> times, addresses;
    std::vector<std::uint32_t> classes; // numbers in `table`
    std::vector<Class> table;
    std::vector<Turn> order;          // empty: only what times and streams say is known
    std::vector<std::uint32_t> tiles; // of each reference, as Reference::tile; empty: all are of none

    std::size_t size() const { return addresses.size(); }
    const Class& what(std::size_t i) const { return table[classes[i]]; }
    std::uint32_t tile(std::size_t i) const { return tiles.empty() ? 0 : tiles[i]; }
    void clear() {
        segments.clear();
        times.clear();
        addresses.clear();
        classes.clear();
        table.clear();
        order.clear();
        tiles.clear();
    }
};

/// The most references that a block may hold.
inline constexpr std::size_t most_references = std::size_t{1} << 20;
/// A block has no more windows than references and these.
inline constexpr std::size_t most_idle_windows = std::size_t{1} << 15U;

} // namespace traces
