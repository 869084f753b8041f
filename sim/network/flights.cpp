#include "sim/network/flights.h"

#include <algorithm>

namespace sim {

void Flights::send(std::uint64_t id, const Network::Leg& leg, cycle t) {
    if (free_.empty()) {
        free_.push_back(static_cast<std::uint32_t>(flights_.size()));
        flights_.emplace_back();
    }
    const std::uint32_t number = free_.back();
    free_.pop_back();
    Flight& f = flights_[number];
    f.id = id;
    f.number = sent_++;
    if (std::vector<Network::Sent>* noted = network_.noted_in()) {
        f.noted = noted->size();
        noted->push_back({leg, t, never});
    }
    f.leg = leg;
    f.sent = f.head = t;
    f.flits = f.left = network_.flits(leg);
    f.hop = 0;
    network_.route(leg, f.links);
    const cycle ahead = comes_back(f) ? ahead_ : 0;
    if (t < now_ + ahead)
        calendar_has_passed("messages", t, now_ + ahead);
    foresee(number, t - ahead);
}

/// It takes what is free of the link where it is. False if lines that come back may still want what is left.
bool Flights::take(std::uint32_t flight) {
    Flight& f = flights_[flight];
    const std::uint32_t link = f.links[f.hop];
    if (comes_back(f)) {
        f.taken = network_.book(link, f.head, f.flits);
        return true;
    }
    std::vector<std::uint32_t>& waiting = waiting_[link];
    const bool first = !waiting.empty() && waiting.front() == flight;
    if (!first && !waiting.empty()) {
        waiting.push_back(flight);
        return false;
    }
    const cycle from = std::max(now_, f.left == f.flits ? f.head : f.taken.last + 1);
    Calendar::Span taken{};
    const std::uint32_t count = network_.book_before(link, from, f.left, now_ + ahead_, taken);
    if (count != 0)
        f.taken = {f.left == f.flits ? taken.first : f.taken.first, taken.last};
    f.left -= count;
    if (f.left != 0) {
        if (!first)
            waiting.push_back(flight);
        foresee(flight, network_.free_from(link, count != 0 ? taken.last + 1 : from) - ahead_ + 1);
        return false;
    }
    if (first) {
        waiting.erase(waiting.begin());
        if (!waiting.empty())
            foresee(waiting.front(), now_);
    }
    return true;
}

std::optional<Flights::Arrival> Flights::step() {
    const Event e = events_.top();
    events_.pop();
    now_ = e.at;
    if (waiting_.empty())
        waiting_.resize(network_.topology().links());
    if (!take(e.flight))
        return std::nullopt;
    Flight& f = flights_[e.flight];
    f.head = network_.next(f.taken, f.flits, f.hop, f.links.size());
    f.left = f.flits;
    if (++f.hop < f.links.size()) {
        foresee(e.flight, std::max(now_, comes_back(f) ? f.head - ahead_ : f.head));
        return std::nullopt;
    }
    free_.push_back(e.flight);
    const cycle there = f.taken.last + 1;
    if (std::vector<Network::Sent>* noted = network_.noted_in())
        (*noted)[f.noted].there = there;
    network_.count(f.leg, f.links.size(), f.sent, there);
    return Arrival{f.id, there};
}

} // namespace sim
