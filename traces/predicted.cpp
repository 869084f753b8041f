#include "traces/predicted.h"

#include "traces/arithmetic.h"
#include "traces/block_layout.h"

namespace traces {
namespace {

using Step = ReferenceModel::Step;
using Coming = ReferenceModel::Coming;

/// Where nothing is known of the order, streams come one after the other.
std::vector<Turn> stream_by_stream(const Block& block) {
    std::vector<Turn> out;
    for (std::uint32_t s = 0; s < block.segments.size(); ++s)
        out.push_back({Turn::What::references, s,
                       static_cast<std::uint32_t>(block.segments[s].end - block.segments[s].begin), 0, 0});
    return out;
}

class Put {
public:
    Put(ReferenceModel& model, const Block& block, const std::vector<std::uint32_t>& rank, unsigned shift,
        unsigned set_bits, std::string& out)
        : model_(model), block_(block), rank_(rank), moves_(block.table, true), shift_(shift),
          pairs_(set_bits != 0), coder_(out) {}

    void all(const std::vector<Turn>& turns) {
        for (const Segment& s : block_.segments)
            next_.push_back(s.begin);
        for (Turn turn : turns) {
            if (turn.what == Turn::What::references) {
                references(turn);
                continue;
            }
            model_.step(coder_, turn.what == Turn::What::window ? Step::window : Step::end);
            model_.turn(coder_, turn);
        }
        model_.step(coder_, Step::done);
        coder_.finish();
    }

private:
    Coming coming(std::size_t i) const {
        return {rank_[block_.classes[i]], block_.addresses[i] >> shift_, block_.times[i], block_.tile(i)};
    }
    /// The place of a line that leaves at i, if it makes room for what comes next, else 0.
    std::uint64_t room(std::size_t i, std::size_t end) const {
        if (!pairs_ || i + 1 == end || !moves_.leaves(block_.classes[i]) ||
            !moves_.comes(block_.classes[i + 1]) || block_.what(i + 1).part == Part::piece ||
            block_.times[i] != block_.times[i + 1] || block_.tile(i) != block_.tile(i + 1))
            return 0;
        return model_.place_of(block_.addresses[i] >> shift_, block_.addresses[i + 1] >> shift_);
    }
    void references(const Turn& turn) {
        if (turn.segment != segment_) {
            model_.step(coder_, Step::stream);
            segment_ = model_.stream(coder_, turn.segment);
        }
        const std::size_t first = block_.segments[turn.segment].begin, end = next_[turn.segment] + turn.count;
        for (std::size_t& i = next_[turn.segment]; i != end; ++i) {
            std::uint64_t place = room(i, end);
            const bool pair = place != 0;
            Coming left = coming(i), r = pair ? coming(i + 1) : left;
            model_.step(coder_, pair ? Step::pair : Step::reference);
            model_.come(coder_, r, pair, i == first);
            if (pair) {
                model_.leave(coder_, place, r, left);
                ++i;
            }
            model_.came(r);
        }
    }

    ReferenceModel& model_;
    const Block& block_;
    const std::vector<std::uint32_t>& rank_;
    LineMoves moves_;
    unsigned shift_;
    bool pairs_;
    BitWriter coder_;
    std::vector<std::size_t> next_; // by segment
    std::uint32_t segment_ = 0;
};

class Get {
public:
    Get(ReferenceModel& model, const std::string& bytes, unsigned shift, std::uint32_t most_tile,
        Block& block)
        : model_(model), block_(block), shift_(shift), most_tile_(most_tile), coder_(bytes) {}

    const char* all() {
        for (const Segment& s : block_.segments)
            next_.push_back(s.begin);
        for (std::size_t turns = 0;;) {
            const Step step = model_.step(coder_, Step::done);
            if (coder_.beyond())
                return "a block's references end too early";
            if (step == Step::done)
                break;
            if (step == Step::stream) {
                segment_ = model_.stream(coder_, 0);
                if (segment_ >= block_.segments.size() || next_[segment_] == block_.segments[segment_].end)
                    return "a block's order is of references that it does not have";
            } else if (step == Step::window || step == Step::end) {
                if (++turns > most_turns(block_.size()))
                    return "a block's order does not fit its count";
                Turn t{step == Step::window ? Turn::What::window : Turn::What::end, 0, 0, 0, 0};
                model_.turn(coder_, t);
                block_.order.push_back(t);
            } else if (step != Step::reference && step != Step::pair) {
                return "a block has steps that there are none of";
            } else if (!reference(step == Step::pair)) {
                return "a block's references are none of its classes, lines, tiles or streams";
            }
        }
        for (std::size_t s = 0; s < next_.size(); ++s)
            if (next_[s] != block_.segments[s].end)
                return "a block's order does not fit its count";
        return coder_.ended() ? nullptr : "a block's references do not fill it";
    }

private:
    void set(std::size_t i, const Coming& r) {
        block_.classes[i] = r.what;
        block_.addresses[i] = r.line << shift_;
        block_.times[i] = r.time;
        if (!block_.tiles.empty())
            block_.tiles[i] = r.tile;
    }
    bool reference(bool pair) {
        const Segment& s = block_.segments[segment_];
        std::size_t& i = next_[segment_];
        const std::size_t count = pair ? 2 : 1;
        if (s.end - i < count)
            return false;
        Coming r, left;
        if (!model_.come(coder_, r, pair, i == s.begin) || r.tile > most_tile_)
            return false;
        std::uint64_t place = 0;
        if (pair) {
            if (!model_.leave(coder_, place, r, left))
                return false;
            set(i++, left);
        }
        set(i++, r);
        model_.came(r);
        std::vector<Turn>& order = block_.order;
        if (order.empty() || order.back().what != Turn::What::references || order.back().segment != segment_)
            order.push_back({Turn::What::references, segment_, 0, 0, 0});
        order.back().count += static_cast<std::uint32_t>(count);
        return true;
    }

    ReferenceModel& model_;
    Block& block_;
    unsigned shift_;
    std::uint32_t most_tile_;
    BitReader coder_;
    std::vector<std::size_t> next_; // by segment
    std::uint32_t segment_ = 0;
};

} // namespace

void put_predicted(ReferenceModel& model, const Block& block, const std::vector<std::uint32_t>& rank,
                   const std::vector<Class>& table, unsigned shift, unsigned set_bits, std::string& out) {
    model.begin(table, block.size(), block.segments.size(), set_bits, block.times.front(),
                !block.tiles.empty(), true);
    Put(model, block, rank, shift, set_bits, out)
        .all(block.order.empty() ? stream_by_stream(block) : block.order);
}

const char* get_predicted(ReferenceModel& model, const std::string& bytes, unsigned shift, unsigned set_bits,
                          std::uint64_t first_time, bool ordered, bool tiled, bool checked,
                          std::uint32_t most_tile, Block& block) {
    const std::size_t n = block.segments.back().end;
    block.times.resize(n);
    block.addresses.resize(n);
    block.classes.resize(n);
    block.tiles.resize(tiled ? n : 0);
    model.begin(block.table, n, block.segments.size(), set_bits, first_time, tiled, checked);
    const char* const wrong = Get(model, bytes, shift, most_tile, block).all();
    if (!ordered)
        block.order.clear();
    return wrong;
}

} // namespace traces
