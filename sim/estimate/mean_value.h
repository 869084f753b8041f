// Mean-value analysis of closed queueing networks: throughput and residence times from service demands and
// numbers of customers alone (Reiser and Lavenberg, "Mean-value analysis of closed multichain queuing
// networks", JACM 27(2), 1980; Lazowska et al., Quantitative System Performance, 1984, chapters 6 and 7).
// Not modelled: service times that vary less or more than exponential ones, and priorities.
#pragma once

#include <vector>

namespace sim {

/// Of a network at rest: units are the demands' own.
struct NetworkSolution {
    double throughput = 0;           // customers that go round, per unit of time
    std::vector<double> residence{}; // by station: of one round, waiting and being served
    std::vector<double> queue{};     // by station: customers there, on average
    double delay = 0;                // of one round, away from all stations
    /// Of one round.
    double response() const;
    /// Of the station with this demand.
    double utilisation(double demand) const { return throughput * demand; }
};

/// Exact, for one kind of customers: `demands` are the time of service that one round asks of each station,
/// `delay` what it spends elsewhere, where nobody waits. Throws std::invalid_argument for negative ones, or
/// where a round takes no time at all.
NetworkSolution solve_exactly(const std::vector<double>& demands, double delay, int customers);

/// `servers` in place of one, each taking `demand` a round: a queue of demand / servers, and a delay for the
/// rest (Seidmann et al., 1987). Returns the queue's demand and adds to `delay`.
double many_servers(double demand, double servers, double& delay);

/// Customers of one kind: how many, and where they go.
struct CustomerClass {
    double customers = 0;
    double delay = 0; // of a round; below 0 where stations serve a customer at the same time
    struct Visit {
        std::size_t station = 0;
        double demand = 0;
    };
    std::vector<Visit> visits{};
};

/// Approximately, for several kinds (Schweitzer, 1979; Bard, 1979): each customer meets, on arrival, its own
/// kind's mean queue less its own share of it. Starts from what it found the last time, which a few changes
/// leave nearly right.
class ApproximateNetwork {
public:
    explicit ApproximateNetwork(std::size_t stations) : totals_(stations) {}

    /// Rounds that one customer of each class makes, per unit of time; 0 for classes without customers.
    /// Classes keep their number and stations from call to call.
    const std::vector<double>& solve(const std::vector<CustomerClass>& classes);
    /// Rounds that all of a station's customers ask for, times demand: busy, of all time.
    const std::vector<double>& utilisations() const { return busy_; }
    /// Passes that the last call took.
    int passes() const { return passes_; }

private:
    std::vector<double> totals_, busy_;       // by station
    std::vector<std::vector<double>> queues_; // by class and visit
    std::vector<double> rates_;
    int passes_ = 0;
};

} // namespace sim
