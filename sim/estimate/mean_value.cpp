#include "sim/estimate/mean_value.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace sim {

double NetworkSolution::response() const {
    return std::accumulate(residence.begin(), residence.end(), delay);
}

NetworkSolution solve_exactly(const std::vector<double>& demands, double delay, int customers) {
    const double round = std::accumulate(demands.begin(), demands.end(), delay);
    if (delay < 0 || customers < 0 ||
        std::any_of(demands.begin(), demands.end(), [](double d) { return !(d >= 0); }))
        throw std::invalid_argument("a network's demands, delay and customers are not negative");
    if (!(round > 0))
        throw std::invalid_argument("a round through a network takes some time");
    NetworkSolution s;
    s.delay = delay;
    s.residence = demands;
    s.queue.assign(demands.size(), 0);
    for (int n = 1; n <= customers; ++n) {
        // Who arrives sees the network as it is with one customer less.
        for (std::size_t k = 0; k < demands.size(); ++k)
            s.residence[k] = demands[k] * (1 + s.queue[k]);
        s.throughput = n / s.response();
        for (std::size_t k = 0; k < demands.size(); ++k)
            s.queue[k] = s.throughput * s.residence[k];
    }
    return s;
}

double many_servers(double demand, double servers, double& delay) {
    delay += demand * (servers - 1) / servers;
    return demand / servers;
}

const std::vector<double>& ApproximateNetwork::solve(const std::vector<CustomerClass>& classes) {
    constexpr double enough = 1e-4; // relative change of rates
    constexpr int most = 1000;
    rates_.resize(classes.size(), 0);
    queues_.resize(classes.size());
    for (std::size_t c = 0; c < classes.size(); ++c) {
        const CustomerClass& kind = classes[c];
        if (queues_[c].size() != kind.visits.size())
            queues_[c].assign(kind.visits.size(), 0);
        // Nobody who has left waits any more; who has come waits as the others of the class.
        const double before = std::accumulate(queues_[c].begin(), queues_[c].end(), 0.0);
        const double scale = before > kind.customers ? kind.customers / before : 1;
        for (double& q : queues_[c])
            q *= scale;
    }
    double change = 1;
    for (passes_ = 0; passes_ < most && change > enough; ++passes_) {
        std::fill(totals_.begin(), totals_.end(), 0);
        for (std::size_t c = 0; c < classes.size(); ++c)
            for (std::size_t v = 0; v < classes[c].visits.size(); ++v)
                totals_[classes[c].visits[v].station] += queues_[c][v];
        change = 0;
        for (std::size_t c = 0; c < classes.size(); ++c) {
            const CustomerClass& kind = classes[c];
            if (kind.customers <= 0) {
                rates_[c] = 0;
                continue;
            }
            double round = kind.delay;
            for (std::size_t v = 0; v < kind.visits.size(); ++v) {
                const auto& [station, demand] = kind.visits[v];
                const double seen = totals_[station] - queues_[c][v] / kind.customers;
                queues_[c][v] = demand * (1 + std::max(seen, 0.0));
                round += queues_[c][v];
            }
            const double rate = 1 / round;
            for (double& q : queues_[c])
                q *= rate * kind.customers;
            change = std::max(change, std::abs(rate - rates_[c]) / rate);
            rates_[c] = rate;
        }
    }
    busy_.assign(totals_.size(), 0);
    for (std::size_t c = 0; c < classes.size(); ++c)
        for (const auto& [station, demand] : classes[c].visits)
            busy_[station] += rates_[c] * classes[c].customers * demand;
    return rates_;
}

} // namespace sim
