#include "traces/block_layout.h"
#include "traces/codec.h"
#include "traces/error.h"
#include "traces/evictions.h"
#include "traces/predicted.h"
#include "traces/tile_runs.h"
#include "traces/varint.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>

namespace traces {
namespace {

/// Version 1 has no order, those before 5 no tiles.
std::size_t columns_of(std::uint32_t version) {
    return version == 1 ? columns - 2 : version < 5 ? columns - 1 : columns;
}
/// A predicted block may say its order, since version 5 also its tiles.
bool known_coding(std::uint32_t coding, std::uint32_t version) {
    return coding == 0 ||
           ((coding & is_predicted) != 0 && coding <= (is_predicted | is_ordered | has_tiles) &&
            (version >= 5 || (coding & has_tiles) == 0));
}
std::uint32_t largest(const std::uint8_t* bytes, std::size_t n) {
    std::uint8_t most = 0;
    for (std::size_t i = 0; i < n; ++i)
        most = std::max(most, bytes[i]);
    return most;
}

/// Numbers of so many bytes, the lowest first: that of each number so far behind that of the one before, the
/// next ones of a number so far behind it.
template <std::uint32_t Bytes>
void number(const std::uint8_t* bytes, std::size_t n, std::size_t step, std::size_t more,
            std::uint32_t* out) {
    for (std::size_t i = 0; i < n; ++i) {
        out[i] = bytes[i * step];
        for (std::uint32_t b = 1; b < Bytes; ++b)
            out[i] |= std::uint32_t{bytes[i * step + b * more]} << (8 * b);
    }
}

[[noreturn]] void refuse(const std::string& place, const char* what) {
    throw Error(fmt::format("{}: {}; the file is damaged, record or copy it again", place, what));
}

} // namespace

void Decoder::Free::operator()(ZSTD_DCtx_s* c) const {
    ZSTD_freeDCtx(c);
}

Decoder::Decoder() : context_(ZSTD_createDCtx()) {}
Decoder::~Decoder() = default;

void Decoder::decode(const std::string& bytes, const Limits& limits, std::uint32_t version,
                     const std::string& place, Block& block) {
    const std::size_t header = header_bytes(columns_of(version));
    if (bytes.size() < header)
        refuse(place, "a block is shorter than its own header");
    const std::size_t n = fixed_at<std::uint32_t>(bytes.data());
    const std::size_t segments = fixed_at<std::uint32_t>(bytes.data() + 4);
    const std::size_t classes = fixed_at<std::uint32_t>(bytes.data() + 8);
    const std::uint32_t shifts = fixed_at<std::uint32_t>(bytes.data() + 12);
    const std::uint32_t coding = version < 4 ? 0 : shifts >> coding_shift;
    const std::uint32_t set_bits = version < 3 ? 0 : (shifts - (coding << coding_shift)) >> set_bits_shift;
    const std::uint32_t shift = shifts - (coding << coding_shift) - (set_bits << set_bits_shift);
    const std::uint64_t first_time = fixed_at<std::uint64_t>(bytes.data() + 16);
    if (n == 0 || n > most_references || segments == 0 || segments > n || classes == 0 || classes > n ||
        shift > 63 || set_bits > Evictions::most_set_bits || !known_coding(coding, version))
        refuse(place, "a block claims impossible counts");
    const std::uint32_t id_bytes = bytes_for(classes);
    const std::array<std::size_t, columns> most = {(segments * 2 + classes * 7) * longest_varint,
                                                   coding != 0 ? bytes.size() : n * id_bytes,
                                                   n * (longest_varint + 1),
                                                   n * longest_varint,
                                                   most_turns(n) * 4 * longest_varint,
                                                   (n * 3 + 1) * longest_varint};
    std::size_t at = header, column = 0;
    order_.clear();
    tiles_.clear();
    for (std::string* raw : {&table_, &classes_, &addresses_, &times_, &order_, &tiles_}) {
        if (column == columns_of(version))
            break;
        const std::size_t raw_bytes = fixed_at<std::uint32_t>(bytes.data() + 24 + column * 8);
        const std::size_t stored = fixed_at<std::uint32_t>(bytes.data() + 28 + column * 8);
        if (raw_bytes > most[column++] || stored > bytes.size() - at)
            refuse(place, "a block claims columns that are too long");
        if (coding != 0 && raw != &table_) {
            raw->assign(bytes, at, stored);
            if (raw_bytes != stored || (raw != &classes_ && stored != 0))
                refuse(place, "a block claims columns that it does not have");
        } else {
            raw->resize(raw_bytes);
            const std::size_t got =
                ZSTD_decompressDCtx(context_.get(), raw->data(), raw_bytes, bytes.data() + at, stored);
            if (ZSTD_isError(got) != 0 || got != raw_bytes)
                refuse(place, "a column of a block does not decompress to what it should");
        }
        at += stored;
    }
    if (at != bytes.size() || (coding == 0 && classes_.size() != n * id_bytes))
        refuse(place, "a block's columns do not fill it");
    get_table(limits, version, segments, classes, place, block);
    if (block.segments.back().end != n)
        refuse(place, "a block's table does not fit its counts");
    if (coding == 0) {
        get_columns(version, place, shift, set_bits, first_time, block);
        if (const char* wrong = get_tiles(tiles_, limits.tiles, block))
            refuse(place, wrong);
        return;
    }
    if (!model_)
        model_ = std::make_unique<ReferenceModel>();
    if (const char* wrong =
            get_predicted(*model_, classes_, shift, set_bits, first_time, (coding & is_ordered) != 0,
                          (coding & has_tiles) != 0, version >= 7, limits.tiles, block))
        refuse(place, wrong);
}

void Decoder::get_table(const Limits& limits, std::uint32_t version, std::size_t segments,
                        std::size_t classes, const std::string& place, Block& block) {
    VarintReader table(table_.data(), table_.data() + table_.size());
    // The columns keep their room, and what is there until it is overwritten.
    block.segments.clear();
    block.table.clear();
    block.order.clear();
    block.tiles.clear();
    std::uint64_t stream = 0, site = 0;
    std::size_t end = 0;
    for (std::size_t i = 0; i < segments; ++i) {
        const std::uint64_t step = table.next(), length = table.next();
        if (step > ~std::uint32_t{0} - stream || (i != 0 && step == 0) || length == 0 ||
            length > most_references - end)
            refuse(place, "a block's streams are not in order");
        stream += step;
        block.segments.push_back({static_cast<std::uint32_t>(stream), end, end + length});
        end += length;
    }
    for (std::size_t i = 0; i < classes; ++i) {
        const std::uint64_t first = table.next(), size = table.next(), structure = table.next(),
                            phase = table.next(), work = table.next();
        site += unzigzag(table.next());
        const std::uint64_t detail = version < 3 ? 0 : table.next();
        const std::uint64_t kind = first & ((1U << part_shift) - 1), part = first >> part_shift;
        if (kind >= kind_names.size() || part >= parts || size > ~std::uint32_t{0} ||
            detail > ~std::uint32_t{0} || structure >= limits.structures || phase >= limits.phases ||
            work >= limits.work || site > limits.sites)
            refuse(place, "a block names what the description does not");
        block.table.push_back({site, static_cast<std::uint32_t>(size), static_cast<std::uint16_t>(structure),
                               static_cast<std::uint16_t>(phase), static_cast<std::uint16_t>(work),
                               static_cast<Kind>(kind), static_cast<Part>(part),
                               static_cast<std::uint32_t>(detail)});
    }
    if (table.bad() || !table.ended())
        refuse(place, "a block's table does not fit its counts");
}

void Decoder::get_classes(bool beside, const std::string& place, Block& block) {
    const std::size_t n = block.segments.back().end, classes = block.table.size();
    const std::uint32_t id_bytes = bytes_for(classes);
    block.classes.resize(n);
    const auto* bytes = reinterpret_cast<const std::uint8_t*>(classes_.data());
    const std::size_t step = beside ? id_bytes : 1, more = beside ? 1 : n;
    if (id_bytes == 1)
        number<1>(bytes, n, 1, 0, block.classes.data());
    else if (id_bytes == 2)
        number<2>(bytes, n, step, more, block.classes.data());
    else
        number<3>(bytes, n, step, more, block.classes.data());
    const bool one_byte = id_bytes == 1; // of which processors compare many at once
    const std::uint32_t most_class =
        one_byte ? largest(bytes, n) : *std::max_element(block.classes.begin(), block.classes.end());
    if (most_class >= classes)
        refuse(place, "a reference is of a class that its block does not have");
}

void Decoder::get_addresses(bool beside, const std::string& place, unsigned shift, unsigned set_bits,
                            Block& block) {
    const std::size_t n = block.segments.back().end, classes = block.table.size();
    block.addresses.resize(n);
    const auto of = [&](std::uint32_t c) -> const Class& { return block.table[c]; };
    const std::vector<std::uint32_t> first_of = without_parts(classes, of);
    last_.assign(classes, 0);
    VarintReader addresses(addresses_.data(), addresses_.data() + addresses_.size());
    const auto get = [&](std::size_t i) {
        return last_[first_of[block.classes[i]]] += unzigzag(addresses.next());
    };
    if (set_bits == 0) {
        for (std::size_t i = 0; i < n; ++i)
            block.addresses[i] = get(i) << shift;
    } else if (!beside) {
        for (std::size_t i = 0; i < n; ++i)
            if (!Evictions::leaves(block.what(i)))
                block.addresses[i] = get(i) << shift;
    } else {
        by_class_.sort(block.classes, without_leaving(first_of, of));
        for (std::size_t c = 0; c < classes; ++c) {
            std::uint64_t line = 0;
            for (const std::uint32_t i : by_class_.of(c))
                block.addresses[i] = (line += unzigzag(addresses.next())) << shift;
        }
    }
    makes_room_.assign(n, 0);
    if (set_bits != 0) {
        Evictions evictions(set_bits);
        for (const Segment& s : block.segments) {
            evictions.clear();
            for (std::size_t i = s.begin; i < s.end; ++i) {
                if (!Evictions::leaves(block.what(i))) {
                    if (Evictions::comes(block.what(i)))
                        evictions.come(block.addresses[i] >> shift);
                    continue;
                }
                const std::uint64_t at = addresses.next();
                std::uint64_t line = 0;
                if (at == 0)
                    line = get(i);
                else if (i + 1 == s.end || !Evictions::comes(block.what(i + 1)) ||
                         !evictions.leave_place(at, block.addresses[i + 1] >> shift, line))
                    refuse(place, "a line that leaves a cache is none that came");
                block.addresses[i] = line << shift;
                makes_room_[i] = at != 0 ? 1 : 0;
            }
        }
    }
    if (addresses.bad() || !addresses.ended())
        refuse(place, "a block's addresses do not fit its count");
}

void Decoder::get_columns(std::uint32_t version, const std::string& place, unsigned shift, unsigned set_bits,
                          std::uint64_t first_time, Block& block) {
    const bool beside = side_by_side(version, set_bits);
    get_classes(beside, place, block);
    get_addresses(beside, place, shift, set_bits, block);
    if (version < 6)
        std::fill(makes_room_.begin(), makes_room_.end(), 0); // all have times there
    const std::size_t n = block.segments.back().end;
    block.times.resize(n);
    VarintReader times(times_.data(), times_.data() + times_.size());
    std::vector<char> piece;
    for (const Class& c : block.table)
        piece.push_back(static_cast<char>(c.part == Part::piece));
    for (const Segment& s : block.segments) {
        std::uint64_t t = first_time;
        char same = 0; // as the time of the one before
        for (std::size_t i = s.begin; i < s.end; ++i) {
            same = static_cast<char>(same | (i == s.begin ? 0 : piece[block.classes[i]]));
            block.times[i] = same != 0 ? t : t += unzigzag(times.next());
            same = makes_room_[i];
        }
    }
    if (times.bad() || !times.ended())
        refuse(place, "a block's times do not fit its count");
    get_order(place, block);
}

/// Turns that take all of every segment, once; or none.
void Decoder::get_order(const std::string& place, Block& block) {
    const char* const end = order_.data() + order_.size();
    VarintReader sizes(order_.data(), end);
    const std::uint64_t of_turns = order_.empty() ? 0 : sizes.next();
    const std::uint64_t of_counts = order_.empty() ? 0 : sizes.next();
    const auto room = static_cast<std::uint64_t>(end - sizes.at());
    if (sizes.bad() || of_turns > room || of_counts > room - of_turns)
        refuse(place, "a block's order is longer than itself");
    const char* const first = sizes.at();
    VarintReader turns(first, first + of_turns), counts(first + of_turns, first + of_turns + of_counts),
        windows(first + of_turns + of_counts, end);
    WindowGuess guess{block.times.front()};
    std::vector<std::size_t> left;
    for (const Segment& s : block.segments)
        left.push_back(s.end - s.begin);
    std::size_t taken = 0;
    while (!turns.ended() && !turns.bad()) {
        Turn t;
        const std::uint64_t what = turns.next();
        if (what >= 2) {
            const std::uint64_t segment = what - 2, count = counts.next();
            if (segment >= left.size() || count == 0 || count > left[segment])
                refuse(place, "a block's order is of references that it does not have");
            left[segment] -= count;
            taken += count;
            t.segment = static_cast<std::uint32_t>(segment);
            t.count = static_cast<std::uint32_t>(count);
        } else {
            t.what = what == 0 ? Turn::What::window : Turn::What::end;
            t.until = guess.last + guess.length + unzigzag(windows.next());
            t.begin = guess.last + unzigzag(windows.next());
            guess.see(t);
        }
        block.order.push_back(t);
    }
    if (turns.bad() || counts.bad() || !counts.ended() || windows.bad() || !windows.ended() ||
        (taken != block.size() && !order_.empty()))
        refuse(place, "a block's order does not fit its count");
}

} // namespace traces
