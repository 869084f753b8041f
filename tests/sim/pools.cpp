// Pools of entries that are held for a time against a plain one, which looks at all holds for whatever it is
// asked; times in any order, some of them not known yet.
#include "sim/memory/pool.h"

#include <gtest/gtest.h>

#include <optional>
#include <random>
#include <vector>

namespace sim {
namespace {

class PlainPool {
public:
    PlainPool(std::size_t entries, Tickets& tickets, bool heard)
        : entries_(entries), most_(2 * entries + 8), heard_(heard), tickets_(tickets) {}

    cycle take(cycle t) {
        for (;;) {
            std::size_t held = 0;
            cycle next = Pool::unknown, floor = Pool::unknown;
            for (Pool::Hold& h : holds_) {
                resolve(h);
                if (h.from > t || (!is_ticket(h.until) && h.until <= t))
                    continue;
                ++held;
                if (is_ticket(h.until))
                    floor = std::min(floor, h.what == Pool::What::right ? tickets_.floors().any
                                                                        : tickets_.floors().lines);
                else
                    next = std::min(next, h.until);
            }
            if (held < entries_)
                return t;
            if (floor != Pool::unknown && next > floor)
                return heard_ && next != Pool::unknown ? at_most(next) : Pool::unknown;
            t = next;
        }
    }
    void hold(const Pool::Hold& h) {
        if (holds_.size() >= most_) {
            auto oldest = holds_.end();
            for (auto one = holds_.begin(); one != holds_.end(); ++one) {
                resolve(*one);
                if (!is_ticket(one->until) && (oldest == holds_.end() || one->until < oldest->until))
                    oldest = one;
            }
            if (oldest != holds_.end())
                holds_.erase(oldest);
        }
        holds_.push_back(h);
    }
    std::optional<Pool::Hold> find(std::uint64_t line, bool right) {
        for (auto one = holds_.rbegin(); one != holds_.rend(); ++one)
            if (one->line == line && one->what != (right ? Pool::What::line : Pool::What::right)) {
                resolve(*one);
                return *one;
            }
        return {};
    }

private:
    void resolve(Pool::Hold& h) {
        Answered a;
        if (is_ticket(h.until) && tickets_.find(h.until, a)) {
            h.until = a.last;
            h.cause = a.from;
        }
    }
    std::size_t entries_, most_;
    bool heard_;
    std::vector<Pool::Hold> holds_; // as they came
    Tickets& tickets_;
};

TEST(Pools, HoldAsAPlainOneDoes) {
    std::size_t found = 0, waits = 0, unknown = 0;
    for (std::uint64_t trial = 0; trial < 60; ++trial) {
        std::mt19937_64 random(trial);
        const std::size_t entries = 1 + trial % 7;
        const bool heard = trial % 2 == 0;
        Tickets tickets;
        Pool pool(entries, tickets, heard);
        PlainPool plain(entries, tickets, heard);
        std::vector<cycle> open;
        cycle now = 100;
        for (int i = 0; i < 3000; ++i) {
            now += random() % 12;
            const cycle t = now - random() % 40;
            const std::uint64_t line = random() % 12;
            switch (random() % 8) {
            case 0: { // a window ends
                for (const cycle ticket : open)
                    if (random() % 4 != 0)
                        tickets.answer(ticket, now + random() % 100, Cause::memory);
                std::erase_if(open, [&](cycle ticket) {
                    Answered a;
                    return tickets.find(ticket, a);
                });
                tickets.set_floors({now, now + 20});
                break;
            }
            case 1:
            case 2: {
                const Pool::Hold* const h = pool.find(line, t);
                const auto expected = plain.find(line, false);
                const bool lasts = expected && expected->until > t; // a ticket is later than any cycle
                ASSERT_EQ(h != nullptr, lasts);
                if (lasts) {
                    ++found;
                    EXPECT_EQ(h->until, expected->until);
                    EXPECT_EQ(h->cause, expected->cause);
                }
                break;
            }
            case 3: {
                const Pool::Hold* const h = pool.find_right(line);
                const auto expected = plain.find(line, true);
                ASSERT_EQ(h != nullptr, expected && is_ticket(expected->until));
                if (h != nullptr) {
                    EXPECT_EQ(h->until, expected->until);
                }
                break;
            }
            default: {
                const cycle at = pool.take(t);
                ASSERT_EQ(at, plain.take(t)) << "trial " << trial << ", step " << i;
                waits += at != t ? 1 : 0;
                if (at == Pool::unknown || maybe_sooner(at)) {
                    ++unknown;
                    break;
                }
                cycle until = at + random() % 90;
                if (random() % 3 == 0)
                    open.push_back(until = tickets.open());
                const Pool::Hold hold{line, at, until, Cause::l2, static_cast<Pool::What>(random() % 3)};
                pool.hold(hold);
                plain.hold(hold);
            }
            }
        }
    }
    EXPECT_GT(found, 1000U);
    EXPECT_GT(waits, 1000U);
    EXPECT_GT(unknown, 100U);
}

} // namespace
} // namespace sim
