#include "traces/block_layout.h"
#include "traces/chunk.h"
#include "traces/codec.h"
#include "traces/evictions.h"
#include "traces/predicted.h"
#include "traces/tile_runs.h"
#include "traces/varint.h"

#include <fmt/format.h>
#include <zstd.h>

#include <algorithm>
#include <bit>
#include <numeric>

namespace traces {
namespace {

/// Of what caches pass on there is less than of what cores ask for, and hardly anything repeats itself.
constexpr int level_for_caches = 9;

/// From the most frequent to the least.
std::vector<std::uint32_t> by_frequency(const Block& block) {
    std::vector<std::uint32_t> count(block.table.size(), 0);
    for (const std::uint32_t c : block.classes)
        ++count[c];
    std::vector<std::uint32_t> order(count.size());
    std::iota(order.begin(), order.end(), 0U);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return count[a] > count[b]; });
    return order;
}

/// Trailing zeros that all addresses have.
unsigned common_shift(const std::vector<std::uint64_t>& addresses) {
    std::uint64_t any = 0;
    for (const std::uint64_t a : addresses)
        any |= a;
    return any == 0 ? 0 : static_cast<unsigned>(std::countr_zero(any));
}

void put_table(const Block& block, const std::vector<std::uint32_t>& order, std::string& out) {
    std::uint64_t stream = 0, site = 0;
    for (const Segment& s : block.segments) {
        append_varint(out, s.stream - stream);
        append_varint(out, s.end - s.begin);
        stream = s.stream;
    }
    for (const std::uint32_t number : order) {
        const Class& c = block.table[number];
        append_varint(out, static_cast<std::uint64_t>(c.kind) | static_cast<std::uint64_t>(c.part)
                                                                    << part_shift);
        append_varint(out, c.size);
        append_varint(out, c.structure);
        append_varint(out, c.phase);
        append_varint(out, c.work);
        append_varint(out, zigzag(c.site - site));
        append_varint(out, c.detail);
        site = c.site;
    }
}

// The order: how many bytes the turns take, and the counts; a varint a turn, 0 a window, 1 the end, 2 + the
// segment's number; the counts; what is to know of windows. (Apart, as each repeats itself.)
void put_order(const Block& block, std::string& out) {
    std::string turns, counts, windows;
    WindowGuess guess{block.times.front()};
    for (const Turn& t : block.order) {
        if (t.what == Turn::What::references) {
            append_varint(turns, std::uint64_t{t.segment} + 2);
            append_varint(counts, t.count);
            continue;
        }
        append_varint(turns, t.what == Turn::What::window ? 0 : 1);
        append_varint(windows, zigzag(t.until - guess.last - guess.length));
        append_varint(windows, zigzag(t.begin - guess.last));
        guess.see(t);
    }
    if (!turns.empty()) {
        append_varint(out, turns.size());
        append_varint(out, counts.size());
    }
    out += turns;
    out += counts;
    out += windows;
}

} // namespace

void Encoder::Free::operator()(ZSTD_CCtx_s* c) const {
    ZSTD_freeCCtx(c);
}

Coding coding_for(const std::string& level) {
    return level.empty() || level == "core" || level == "l1" ? Coding::columns : Coding::predicted;
}

Encoder::Encoder(Coding coding, int zstd_level)
    : context_(ZSTD_createCCtx()),
      model_(coding == Coding::predicted ? std::make_unique<ReferenceModel>() : nullptr), level_(zstd_level) {
}
Encoder::~Encoder() = default;

void Encoder::compress(const std::string& column, int level, std::string& out) {
    const std::size_t begin = out.size();
    out.resize(begin + ZSTD_compressBound(column.size()));
    const std::size_t n = ZSTD_compressCCtx(context_.get(), out.data() + begin, out.size() - begin,
                                            column.data(), column.size(), level);
    if (ZSTD_isError(n) != 0)
        throw std::runtime_error(fmt::format("zstd: {}", ZSTD_getErrorName(n)));
    out.resize(begin + n);
}

/// Lines that leave a cache: places, or addresses. Says which ones make room for what follows.
char* Encoder::put_leaving(const Block& block, const std::vector<std::uint32_t>& first_of, unsigned shift,
                           unsigned set_bits, char* to) {
    std::vector<std::uint64_t> last(first_of.size(), 0); // by class
    Evictions evictions(set_bits);
    for (const Segment& s : block.segments) {
        evictions.clear();
        for (std::size_t i = s.begin; i < s.end; ++i) {
            const std::uint64_t a = block.addresses[i] >> shift;
            if (!Evictions::leaves(block.what(i))) {
                if (Evictions::comes(block.what(i)))
                    evictions.come(a);
                continue;
            }
            const bool room =
                i + 1 != s.end && Evictions::comes(block.what(i + 1)) && block.times[i] == block.times[i + 1];
            const std::uint64_t at = room ? evictions.leave(a, block.addresses[i + 1] >> shift) : 0;
            to = put_varint(to, at);
            makes_room_[i] = at != 0 ? 1 : 0;
            if (at == 0) {
                std::uint64_t& before = last[first_of[ranks_[i]]];
                to = put_varint(to, zigzag(a - before));
                before = a;
            }
        }
    }
    return to;
}

void Encoder::put_columns(const Block& block, const std::vector<std::uint32_t>& order,
                          const std::vector<std::uint32_t>& rank, unsigned shift, unsigned set_bits) {
    const std::size_t n = block.size();
    const std::uint32_t id_bytes = bytes_for(order.size());
    const std::uint64_t first_time = block.times.front();
    ranks_.resize(n);
    for (std::size_t i = 0; i < n; ++i)
        ranks_[i] = rank[block.classes[i]];
    const bool beside = side_by_side(format_version, set_bits);
    classes_.resize(n * id_bytes);
    for (std::uint32_t byte = 0; byte < id_bytes; ++byte) {
        char* const out = classes_.data() + (beside ? byte : byte * n);
        const std::size_t step = beside ? id_bytes : 1;
        for (std::size_t i = 0; i < n; ++i)
            out[i * step] = static_cast<char>(ranks_[i] >> (8 * byte));
    }
    const auto of = [&](std::uint32_t c) -> const Class& { return block.table[order[c]]; };
    const std::vector<std::uint32_t> first_of = without_parts(order.size(), of);
    addresses_.resize(n * (longest_varint + 1)); // lines that leave take a byte more
    char* to = addresses_.data();
    std::vector<std::uint64_t> last(order.size(), 0); // by class
    const auto put = [&](std::size_t i) {
        const std::uint64_t a = block.addresses[i] >> shift;
        std::uint64_t& before = last[first_of[ranks_[i]]];
        to = put_varint(to, zigzag(a - before));
        before = a;
    };
    makes_room_.assign(n, 0);
    if (beside) {
        by_class_.sort(ranks_, without_leaving(first_of, of));
        for (std::size_t c = 0; c < by_class_.classes(); ++c)
            for (const std::uint32_t i : by_class_.of(c))
                put(i);
        to = put_leaving(block, first_of, shift, set_bits, to);
    } else {
        for (std::size_t i = 0; i < n; ++i)
            put(i);
    }
    addresses_.resize(static_cast<std::size_t>(to - addresses_.data()));
    std::vector<char> is_piece; // by class
    for (std::uint32_t c = 0; c < order.size(); ++c)
        is_piece.push_back(of(c).part == Part::piece ? 1 : 0);
    times_.resize(n * longest_varint);
    to = times_.data();
    for (const Segment& s : block.segments) {
        std::uint64_t before = first_time;
        for (std::size_t i = s.begin; i < s.end; ++i) {
            if (i != s.begin && (is_piece[ranks_[i]] | makes_room_[i - 1]) != 0)
                continue; // at the same time
            to = put_varint(to, zigzag(block.times[i] - before));
            before = block.times[i];
        }
    }
    times_.resize(static_cast<std::size_t>(to - times_.data()));
    order_.clear();
    put_order(block, order_);
    tiles_.clear();
    put_tiles(block, tiles_);
}

void Encoder::encode(const Block& block, std::string& out) {
    const std::vector<std::uint32_t> order = by_frequency(block);
    std::vector<std::uint32_t> rank(order.size());
    for (std::size_t i = 0; i < order.size(); ++i)
        rank[order[i]] = static_cast<std::uint32_t>(i);
    const unsigned shift = common_shift(block.addresses);
    const unsigned set_bits = LineMoves(block.table, model_ != nullptr).set_bits(block, shift);
    std::uint32_t coding = 0;
    table_.clear();
    put_table(block, order, table_);
    if (model_) {
        coding =
            is_predicted | (block.order.empty() ? 0 : is_ordered) | (block.tiles.empty() ? 0 : has_tiles);
        std::vector<Class> table;
        for (const std::uint32_t number : order)
            table.push_back(block.table[number]);
        for (std::string* column : {&classes_, &addresses_, &times_, &order_, &tiles_})
            column->clear();
        put_predicted(*model_, block, rank, table, shift, set_bits, classes_);
    } else {
        put_columns(block, order, rank, shift, set_bits);
    }

    const std::size_t begin = out.size();
    append_fixed(out, static_cast<std::uint32_t>(block.size()));
    append_fixed(out, static_cast<std::uint32_t>(block.segments.size()));
    append_fixed(out, static_cast<std::uint32_t>(order.size()));
    append_fixed(out,
                 static_cast<std::uint32_t>(shift | set_bits << set_bits_shift | coding << coding_shift));
    append_fixed(out, block.times.front());
    out.resize(begin + header_bytes(columns));
    std::string sizes;
    for (const std::string* column : {&table_, &classes_, &addresses_, &times_, &order_, &tiles_}) {
        const std::size_t before = out.size();
        if (coding == 0 || column == &table_)
            compress(*column, set_bits == 0 ? level_ : std::max(level_, level_for_caches), out);
        else
            out += *column;
        append_fixed(sizes, static_cast<std::uint32_t>(column->size()));
        append_fixed(sizes, static_cast<std::uint32_t>(out.size() - before));
    }
    std::copy(sizes.begin(), sizes.end(), out.begin() + static_cast<std::ptrdiff_t>(begin + 24));
}

} // namespace traces
