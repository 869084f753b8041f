// Messages link by link, in order of time: each comes to a link when its first flit does, and takes the
// link's cycles in the order in which messages come there; at the same cycle who has passed fewer links comes
// first, then who was sent first.
//
// Lines that come back go before all else on every link: of these it is known `ahead` cycles before that they
// will leave (memory has decided, a cache has hit), so that all of them take their links, in their order of
// time, `ahead` cycles before the rest comes there, which takes the cycles between. That tells early when
// they are there, as whoever simulates windows of time wants to know; and lines that go first are what frees
// the MSHRs for which requests wait. What comes to a link all of whose cycles of the next `ahead` are taken
// waits with it; a message of more flits than `ahead` then goes on no sooner than it is known that its flits
// follow each other.
#pragma once

#include "sim/network/network.h"

#include <functional>
#include <optional>
#include <queue>
#include <tuple>
#include <vector>

namespace sim {

class Flights {
public:
    struct Arrival {
        std::uint64_t id;
        cycle at; // all of it is there
    };

    /// Whoever else sends over this network takes links at once.
    Flights(Network& network, cycle ahead) : network_(network), ahead_(ahead) {}

    /// A message, by any number, leaves at `t`; in order of step(), a line that comes back no earlier than
    /// `ahead` after the step at hand.
    void send(std::uint64_t id, const Network::Leg& leg, cycle t);
    /// The cycle of the next step, or never.
    cycle next() const { return events_.empty() ? never : events_.top().at; }
    static constexpr cycle never = ~cycle{0};
    /// A message comes to a link. If that is its last one, it is known when it is there.
    std::optional<Arrival> step();

private:
    /// A message on its way.
    struct Flight {
        std::uint64_t id, number; // in the order in which they were sent
        std::size_t noted;        // among the network's
        Network::Leg leg;
        cycle sent, head; // its first flit comes to the link at hand
        std::uint32_t flits, left;
        Calendar::Span taken; // of the link at hand
        std::size_t hop;
        std::vector<std::uint32_t> links;
    };
    struct Event {
        cycle at;
        std::size_t hop;
        std::uint64_t number;
        std::uint32_t flight;
        bool operator>(const Event& e) const {
            return std::tie(at, hop, number) > std::tie(e.at, e.hop, e.number);
        }
    };

    static bool comes_back(const Flight& f) { return f.leg.comes_back(); }
    void foresee(std::uint32_t flight, cycle at) {
        const Flight& f = flights_[flight];
        events_.push({at, f.hop, f.number, flight});
    }
    bool take(std::uint32_t flight);

    Network& network_;
    cycle ahead_, now_ = 0;
    std::uint64_t sent_ = 0;
    std::vector<Flight> flights_;
    std::vector<std::uint32_t> free_; // of these
    std::priority_queue<Event, std::vector<Event>, std::greater<>> events_;
    std::vector<std::vector<std::uint32_t>> waiting_; // at each link
};

} // namespace sim
