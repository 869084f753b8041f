// What a trace says of itself: the text at its beginning.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace traces {

/// What was rendered while references were recorded: pixels, in screen tiles of `side` x `side`, row by row
/// from the top, the first of which has number 1 (Reference::tile).
struct Picture {
    std::uint32_t width = 0, height = 0, side = 0; // pixels; 0: there was none
    std::uint32_t columns() const { return (width + side - 1) / side; }
    std::uint32_t rows() const { return (height + side - 1) / side; }
    /// The number of the last tile, 0 without a picture.
    std::uint32_t tiles() const { return side == 0 ? 0 : columns() * rows(); }
    std::uint32_t tile_of(std::uint32_t x, std::uint32_t y) const {
        return y / side * columns() + x / side + 1;
    }
    /// Of a pixel's number, row by row; 0 where there is no such pixel.
    std::uint32_t tile_of(std::int64_t pixel) const {
        const std::int64_t pixels = std::int64_t{width} * height;
        return side == 0 || pixel < 0 || pixel >= pixels ? 0
                                                         : tile_of(static_cast<std::uint32_t>(pixel % width),
                                                                   static_cast<std::uint32_t>(pixel / width));
    }
    /// Its upper left pixel.
    std::uint32_t left(std::uint32_t tile) const { return (tile - 1) % columns() * side; }
    std::uint32_t top(std::uint32_t tile) const { return (tile - 1) / columns() * side; }
    friend bool operator==(const Picture&, const Picture&) = default;
};
/// The longest side of a picture, in pixels.
inline constexpr std::uint32_t most_side = 1U << 16U;

struct Description {
    std::string program; // that made it, with its version
    std::string level;   // where references were seen: core, l1, l2, ..., dram; empty: unknown
    std::string time =
        "order"; // what times count: cycles, instructions, seconds; order: only which came first
    std::uint64_t line_bytes = 0; // of the lines there, a power of two; 0: none are known
    /// Whether Class::site is the address of an instruction, else a number of `sites`.
    bool site_addresses = false;
    /// Of all lines this fraction was recorded: those with hash_of_line() below it (sample.h).
    double sample = 1;
    std::uint64_t window = 0;  // of time, in which streams went on by themselves; 0: none is known
    std::string filters;       // what else was left out, in words; empty: nothing
    std::string configuration; // of what was traced, whole
    /// What lies where, by ascending addresses: whose structure a line is that leaves a cache. None: lines
    /// are of the structure that references to them say.
    struct Region {
        std::uint64_t begin = 0, end = 0;
        std::uint16_t structure = 0;
        bool lasts = false; // it is of use when what was traced is over
        friend bool operator==(const Region&, const Region&) = default;
    };
    std::vector<Region> regions;
    Picture picture; // of whose tiles references are
    /// Of some files they grow while these are read.
    std::vector<std::string> structures = {"unknown"}, phases = {"unknown"}, work = {"unknown"};
    std::vector<std::string> streams; // names, as far as there are any
    std::vector<std::string> sites;   // the first has number 1; grows while a trace is read
};

/// Names that came to the tables of structures, phases and work since they had so many, as a JSON object;
/// empty: none.
struct TableSizes {
    std::size_t structures = 0, phases = 0, work = 0;
};
std::string names_since(const TableSizes& before, const Description& description);
/// Adds names of such an object. Throws Error: "`place`: ...".
void add_names(Description& description, const std::string& text, const std::string& place);

/// JSON, one object. The sites are no part of it.
std::string to_json(const Description& description);
/// Throws Error: "`place`: ...".
Description description_from_json(const std::string& text, const std::string& place);

} // namespace traces
