// What is likely to come next in what caches pass on: the contexts in which a block's references are
// predicted one after the other, in the order in which they were made. The same for writing and reading:
// whoever calls says what comes (BitWriter), or is told (BitReader). README.md, "Predicted blocks", is its
// description.
#pragma once

#include "traces/line_moves.h"
#include "traces/predictor.h"
#include "traces/recent_lines.h"
#include "traces/recent_tiles.h"
#include "traces/reference.h"
#include "traces/varint.h"

#include <cstdlib>
#include <optional>
#include <unordered_map>

namespace traces {

class ReferenceModel {
public:
    /// What comes next: a reference; one, and before it a line that makes room for it; a window or the end
    /// (Turn); references of another stream; nothing more.
    enum class Step : std::uint32_t { reference, pair, window, end, stream, done };
    static constexpr std::uint32_t steps = 6;
    /// A reference: its class, its line (address without the bits that none has), its time, its tile.
    struct Coming {
        std::uint32_t what = 0;
        std::uint64_t line = 0, time = 0;
        std::uint32_t tile = 0;
    };

    /// A block begins, with this table of classes. `tiled`: it is known for which tile references are;
    /// `checked`: as of Predictor::begin().
    void begin(const std::vector<Class>& table, std::size_t references, std::size_t streams,
               unsigned set_bits, std::uint64_t first_time, bool tiled, bool checked);

    template <class Coder> Step step(Coder& coder, Step next) {
        const Stream& s = streams_[stream_];
        const auto got = static_cast<Step>(
            step_.symbol(coder,
                         {context(last_step_, std::min(in_window_, 3U), step_before_),
                          context(s.c1, last_step_), context(ahead(s.time, -64, 192), last_step_),
                          context(s.c1, s.c2, last_step_), context(s.line & RecentLines::mask(set_bits_))},
                         0, 3, static_cast<std::uint32_t>(next)));
        step_before_ = last_step_;
        last_step_ = static_cast<std::uint32_t>(got);
        return got;
    }

    /// The number of a stream in the block: whose references follow.
    template <class Coder> std::uint32_t stream(Coder& coder, std::uint32_t next) {
        const std::uint32_t got = stream_number_.symbol(
            coder, {context(0), context(stream_), context(stream_, stream_before_)}, 0, stream_bits_, next);
        if (got < streams_.size()) {
            stream_before_ = stream_;
            stream_ = got;
        }
        return got;
    }

    /// A window or the end: when it begins and until when it lasts.
    template <class Coder> void turn(Coder& coder, Turn& t) {
        const Stream& s = streams_[stream_];
        const Predictor<4>::Contexts in = {context(0), context(ahead(s.time, -130, 260) / 4), context(gap_),
                                           context(s.c1, std::min(in_window_, 4U))};
        const std::uint64_t longer =
            unzigzag(turn_.number(coder, in, 0, zigzag(t.until - t.begin - length_)));
        gap_ = unzigzag(turn_.number(coder, in, 1, zigzag(t.begin - until_)));
        t.begin = until_ + gap_;
        length_ += longer;
        t.until = until_ = t.begin + length_;
        in_window_ = 0;
    }

    /// A reference; a line makes room for it (`pair`); it is the first of its stream (`first`), else a piece
    /// is at the time of the one before. False: the table has no such class.
    template <class Coder> bool come(Coder& coder, Coming& r, bool pair, bool first) {
        Stream& s = streams_[stream_];
        const std::uint32_t p = pair ? 1 : 0;
        r.what = what_.symbol(coder,
                              {context(0, p), context(s.c1, p), context(s.c1, s.c2, p),
                               context(s.c1, s.c2, s.c3), context(s.line)},
                              p, class_bits_, r.what);
        if (r.what >= table_->size())
            return false;
        const Class& c = (*table_)[r.what];
        const Near near = line(coder, r.what, c.structure, r.line);
        if (first || c.part != Part::piece)
            time(coder, r, near, p);
        else
            r.time = s.time;
        if (tiled_)
            tile(coder, r, near);
        near.head->time = s.time = r.time;
        s.c3 = s.c2;
        s.c2 = s.c1;
        s.c1 = r.what;
        ++in_window_;
        return true;
    }

    /// After a reference that a line made room for: which one of its set, by its place (RecentLines), and
    /// with what class. False: there is none such.
    template <class Coder> bool leave(Coder& coder, std::uint64_t& place, const Coming& came, Coming& left) {
        const std::uint32_t structure = (*table_)[came.what].structure;
        place = leaving_.number(
            coder, {context(0), context(came.what), context(structure), context(came.what, structure)}, 0,
            place);
        RecentLines::Line gone{};
        if (!recent_.leave(stream_, place, came.line, gone))
            return false;
        left.line = gone.line;
        left.time = came.time;
        left.tile = came.tile;
        left.what =
            left_what_.symbol(coder,
                              {context(gone.what, came.what),
                               context(came.what, (*table_)[gone.what].structure), context(gone.what)},
                              0, class_bits_, left.what);
        return left.what < table_->size();
    }
    /// After all that belongs to a reference.
    void came(const Coming& r) {
        if (moves_->comes(r.what))
            recent_.come(stream_, r.line, r.what);
        streams_[stream_].line = r.line;
    }
    std::uint64_t place_of(std::uint64_t leaving, std::uint64_t coming) const {
        return recent_.place_of(stream_, leaving, coming);
    }

private:
    struct Stream {
        std::uint32_t c1 = 0, c2 = 0, c3 = 0; // the classes of the last ones
        std::uint64_t time = 0, line = 0;
        RecentTiles tiles;
        std::uint32_t last_place = 0; // among them
    };
    /// Where somebody walks through a structure.
    struct Head {
        std::uint64_t line = 0, time = 0, step = 0;
        std::uint32_t what = 0, tile = 0;
    };
    struct Heads {
        static constexpr std::uint32_t most = 15;
        std::array<Head, most> all; // the last one used first
        std::uint32_t count = 0, last_place = 0;
    };
    struct Last { // of a class in a stream
        std::uint64_t line = 0, step = 0;
        std::uint32_t place = 0; // among heads
    };
    /// How a line lies to the head it follows.
    struct Near {
        Head* head;
        std::uint64_t time; // the head's
        std::uint32_t tile; // likewise
        int step;           // -3 to 3; 4: it follows none
        bool next;          // it is the next one to the stream's last
    };
    static constexpr std::uint64_t most_step = 64; // lines from a head

    static std::uint64_t limited(std::uint64_t difference, std::int64_t least, std::int64_t most) {
        return static_cast<std::uint64_t>(std::clamp(static_cast<std::int64_t>(difference), least, most) -
                                          least);
    }
    /// How far a time is beyond the window's end.
    std::uint64_t ahead(std::uint64_t time, std::int64_t least, std::int64_t most) const {
        return limited(time - until_, least, most);
    }
    static std::uint64_t distance(std::uint64_t a, std::uint64_t b) { return std::min(a - b, b - a); }

    template <class Coder>
    Near line(Coder& coder, std::uint32_t what, std::uint32_t structure, std::uint64_t& line) {
        const Stream& s = streams_[stream_];
        const std::uint64_t key = std::uint64_t{stream_} << 32U;
        Heads& heads = heads_[key | structure];
        Last& last = last_[key | place_[what]];
        std::uint32_t place = 0; // from 1 on; 0: none is near
        for (std::uint64_t i = 0, least = most_step; i < heads.count; ++i)
            if (const std::uint64_t d = distance(line, heads.all[i].line); d < least) {
                least = d;
                place = static_cast<std::uint32_t>(i + 1);
            }
        const Head first = heads.count == 0 ? Head{} : heads.all[0];
        place = head_.symbol(coder,
                             {context(what, last.place), context(what, last.place, first.step),
                              context(s.c1, what, heads.last_place),
                              context(structure, last.place, heads.last_place),
                              context(what, limited(s.time - first.time, 0, 200) / 2, first.what)},
                             0, 4, place);
        last.place = heads.last_place = place;
        std::uint64_t time = 0;
        std::uint32_t tile = 0;
        int q = 4;
        if (place != 0 && place <= heads.count) {
            const Head h = heads.all[place - 1];
            const std::uint64_t step = unzigzag(
                near_.number(coder,
                             {context(what, h.step), context(h.step, h.what),
                              context(h.line & 63U, h.step, structure), context(what, place, h.step)},
                             0, zigzag(line - h.line)));
            line = h.line + step;
            time = h.time;
            tile = h.tile;
            q = static_cast<int>(limited(step, -3, 3)) - 3;
            std::copy_backward(heads.all.begin(), heads.all.begin() + place - 1, heads.all.begin() + place);
            heads.all[0] = {line, 0, step, what};
        } else {
            const auto length = static_cast<std::uint64_t>(std::bit_width(zigzag(last.step)));
            line = last.line + unzigzag(far_.number(coder,
                                                    {context(what), context(what, last.step),
                                                     context(length, s.c1, s.c2), context(0)},
                                                    0, zigzag(line - last.line)));
            heads.count = std::min(heads.count + 1, Heads::most);
            std::copy_backward(heads.all.begin(), heads.all.begin() + heads.count - 1,
                               heads.all.begin() + heads.count);
            heads.all[0] = {line, 0, 0, what};
        }
        last.step = line - last.line;
        last.line = line;
        return {heads.all.data(), time, tile, q, line == s.line + 1};
    }

    /// For which tile: mostly one of the stream's last ones.
    template <class Coder> void tile(Coder& coder, Coming& r, const Near& near) {
        Stream& s = streams_[stream_];
        const std::uint32_t of_head = near.step == 4 ? RecentTiles::most + 1 : s.tiles.place_of(near.tile);
        const std::uint64_t later = limited(r.time - s.time, 0, 20);
        const std::uint32_t place = which_tile_.symbol(
            coder,
            {context(s.last_place), context(r.what, of_head),
             context(of_head, s.last_place, std::min<std::uint64_t>(later, 3)), context(r.what, s.c1, later),
             context((*table_)[r.what].structure, of_head, later)},
            in_window_ == 0 ? 1 : 0, 4, s.tiles.place_of(r.tile));
        r.tile = place != 0
                     ? s.tiles.at(place)
                     : s.tiles.last() + static_cast<std::uint32_t>(unzigzag(far_tile_.number(
                                            coder, {context(0), context(s.tiles.last()), context(r.what)}, 0,
                                            zigzag(std::uint64_t{r.tile} - s.tiles.last()))));
        s.tiles.use(r.tile, place);
        s.last_place = place;
        near.head->tile = r.tile;
    }

    template <class Coder> void time(Coder& coder, Coming& r, const Near& near, std::uint32_t pair) {
        const Stream& s = streams_[stream_];
        const std::uint32_t fresh = in_window_ == 0 ? 1 : 0;
        const std::uint64_t over = ahead(s.time, -130, 260), how = std::uint64_t{fresh} * 2 + pair;
        const auto step = static_cast<std::uint64_t>(near.step + 3);
        r.time = s.time + unzigzag(time_.number(coder,
                                                {context(r.what, step, near.next ? 1 : 0, fresh),
                                                 context(limited(s.time - near.time, -130, 260), step,
                                                         (*table_)[r.what].structure),
                                                 context(over, how), context(r.what, s.c1, how),
                                                 context(r.what == s.c1 ? 1 : 0, over / 4, how)},
                                                static_cast<std::uint32_t>(how), zigzag(r.time - s.time)));
    }

    Predictor<5> step_, what_, head_, time_, which_tile_;
    Predictor<4> turn_, near_, far_, leaving_;
    Predictor<3> stream_number_, left_what_, far_tile_;

    const std::vector<Class>* table_ = nullptr;
    std::optional<LineMoves> moves_;
    std::vector<std::uint32_t> place_; // by class: the first that differs in its part alone
    bool tiled_ = false;
    unsigned class_bits_ = 0, stream_bits_ = 0, set_bits_ = 0;
    std::vector<Stream> streams_;
    std::unordered_map<std::uint64_t, Heads> heads_; // by stream and structure
    std::unordered_map<std::uint64_t, Last> last_;   // by stream and class
    RecentLines recent_;
    std::uint32_t stream_ = 0, stream_before_ = 0, last_step_ = 0, step_before_ = 0, in_window_ = 0;
    std::uint64_t until_ = 0, length_ = 0, gap_ = 0;
};

} // namespace traces
