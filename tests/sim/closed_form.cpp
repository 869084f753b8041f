// Closed forms: mean-value analysis against closed forms of its own (machine repairmen, bounds, Little's
// law), screens against schedules worked out by hand, and what a seed knows.
#include "sim/estimate/closed_form.h"
#include "sim/config/machine_file.h"
#include "sim/estimate/mean_value.h"
#include "sim/estimate/screen_schedule.h"
#include "sim/estimate/seed.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numeric>
#include <random>

namespace sim::test {
namespace {

/// Utilisation of one repairman by n machines that run for a mean time z and take d to repair: Erlang's loss
/// formula, summed directly.
double repairman(int n, double d, double z) {
    double term = 1, sum = 1; // of n! / (n - k)! (d / z)^k
    for (int k = 1; k <= n; ++k)
        sum += term *= (n - k + 1) * d / z;
    return 1 - 1 / sum;
}

TEST(ClosedForm, SolvesMachineRepairmenExactly) {
    for (const double z : {0.5, 4.0, 30.0})
        for (const int n : {1, 2, 7, 40}) {
            const NetworkSolution s = solve_exactly({1.5}, z, n);
            EXPECT_NEAR(s.utilisation(1.5), repairman(n, 1.5, z), 1e-12) << n << " machines, " << z;
        }
}

TEST(ClosedForm, KeepsWithinBoundsAndLittlesLaw) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> some(0, 2);
    for (unsigned network = 0; network < 200; ++network) {
        std::vector<double> d(1 + network % 6);
        for (double& x : d)
            x = some(random);
        const double z = network % 3 == 0 ? 0 : 5 * some(random);
        const double sum = std::accumulate(d.begin(), d.end(), 0.0),
                     most = *std::max_element(d.begin(), d.end());
        const double mean = sum / static_cast<double>(d.size());
        for (const int n : {1, 2, 5, 33}) {
            const NetworkSolution s = solve_exactly(d, z, n);
            const double x = s.throughput, others = n - 1;
            // Asymptotic bounds, and those of balanced jobs (Zahorjan et al., 1982).
            EXPECT_LE(x, std::min(1 / most, n / (sum + z)) + 1e-12);
            EXPECT_GE(x, n / (n * sum + z) - 1e-12);
            EXPECT_GE(x, n / (sum + z + others * most / (1 + z / (n * sum))) - 1e-12);
            EXPECT_LE(x, n / (sum + z + others * mean / (1 + z / sum)) + 1e-12);
            // Everybody is somewhere.
            EXPECT_NEAR(std::accumulate(s.queue.begin(), s.queue.end(), x * z), n, 1e-9 * n);
        }
    }
    // All stations alike: N / (D (N + K - 1) / K).
    EXPECT_NEAR(solve_exactly({2, 2, 2, 2}, 0, 9).throughput, 9 / (2.0 * (9 + 4 - 1)), 1e-12);
    EXPECT_THROW(solve_exactly({-1}, 3, 1), std::invalid_argument);
    EXPECT_THROW(solve_exactly({0}, 0, 1), std::invalid_argument);
}

CustomerClass visiting(double customers, double delay, const std::vector<double>& demands) {
    CustomerClass c{customers, delay, {}};
    for (std::size_t k = 0; k < demands.size(); ++k)
        c.visits.push_back({k, demands[k]});
    return c;
}

TEST(ClosedForm, ApproximatesWhatIsExact) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> some(0.1, 2);
    for (unsigned network = 0; network < 100; ++network) {
        std::vector<double> d(1 + network % 4);
        for (double& x : d)
            x = some(random);
        const double z = 4 * some(random);
        const int n = 1 + static_cast<int>(network % 17);
        const double exact = solve_exactly(d, z, n).throughput;
        ApproximateNetwork one(d.size());
        EXPECT_NEAR(one.solve({visiting(n, z, d)})[0] * n / exact, 1, n == 1 ? 1e-3 : 0.12);
        // The same customers under two names, and again after there were others.
        ApproximateNetwork two(d.size());
        const double a = n * 0.25, b = n * 0.75;
        two.solve({visiting(5, z, d), visiting(0, z, d)});
        const std::vector<double> rates = two.solve({visiting(a, z, d), visiting(b, z, d)});
        double most = 0;
        for (const double u : two.utilisations())
            most = std::max(most, u);
        EXPECT_LE(most, 1 + 1e-3);
        EXPECT_NEAR((rates[0] * a + rates[1] * b) / exact, 1, 0.2);
        EXPECT_EQ(two.solve({visiting(0, z, d), visiting(1, z, d)})[0], 0);
    }
}

TEST(ClosedForm, TakesNoPartOfTheDelayTwice) {
    // Who is alone takes all of the demand, however many servers share it.
    double delay = 3;
    const double queued = many_servers(8, 4, delay);
    EXPECT_EQ(queued + delay, 11);
    EXPECT_EQ(queued, 2);
}

/// Workers of one core each, with one tree.
std::vector<ScreenWorker> apart(int workers, double delay = 0) {
    std::vector<ScreenWorker> out;
    for (int w = 0; w < workers; ++w)
        out.push_back({w, 0, delay});
    return out;
}
/// Cores that do `rate` of work a cycle in all, one of their workers at most all of it.
Paces shared_cores(std::vector<double>& pace) {
    return [&pace](const std::vector<int>& at_work) -> const std::vector<double>& {
        pace.clear();
        for (const int n : at_work)
            pace.push_back(1.0 / std::max(n, 1));
        return pace;
    };
}

TEST(ClosedForm, SchedulesScreensAsByHand) {
    std::vector<double> pace;
    const Paces paces = shared_cores(pace);
    // One worker: the sum, and its wait.
    EXPECT_NEAR(schedule_screen({3, 4, 5}, apart(1, 10), 1, paces).cycles, 22, 1e-9);
    // Two, of which one steals: 6 and 1 + 1, then the second takes 6's neighbour.
    const ScreenSchedule stolen = schedule_screen({6, 5, 1, 1}, apart(2), 2, paces);
    EXPECT_NEAR(stolen.cycles, 7, 1e-9);
    EXPECT_NEAR(stolen.busy, 13, 1e-9);
    EXPECT_NEAR(stolen.finish[0], 6, 1e-9);
    EXPECT_EQ(stolen.stolen_from_others, 0);
    // Two on one core: both at half the pace until the shorter one ends.
    const ScreenSchedule together = schedule_screen({2, 6}, {{0, 0, 0}, {0, 0, 0}}, 1, paces);
    EXPECT_NEAR(together.finish[0], 4, 1e-9);
    EXPECT_NEAR(together.cycles, 8, 1e-9);
    // Fewer tiles than workers: each is taken by one, and no worker has two.
    const ScreenSchedule few = schedule_screen({7, 7, 7, 7}, apart(8), 8, paces);
    EXPECT_NEAR(few.cycles, 7, 1e-9);
    // Of another's tree only when one's own has none left.
    const ScreenSchedule trees = schedule_screen({1, 9, 9, 1}, {{0, 0, 0}, {1, 1, 0}}, 2, paces);
    EXPECT_EQ(trees.stolen_from_others, 0);
    EXPECT_EQ(schedule_screen({9, 1, 1, 1, 1, 1}, {{0, 0, 0}, {1, 1, 0}}, 2, paces).stolen_from_others, 2);
    EXPECT_EQ(schedule_screen({}, apart(3), 3, paces).cycles, 0);
}

TEST(ClosedForm, SchedulesWithinBounds) {
    std::mt19937 random(3);
    std::exponential_distribution<double> some(1);
    std::vector<double> pace;
    const Paces paces = shared_cores(pace);
    for (const int tiles : {1, 5, 64, 300})
        for (const int workers : {1, 3, 16, 100}) {
            std::vector<double> work;
            for (int t = 0; t < tiles; ++t)
                work.push_back(some(random));
            const double sum = std::accumulate(work.begin(), work.end(), 0.0);
            const double longest = *std::max_element(work.begin(), work.end());
            const ScreenSchedule s = schedule_screen(work, apart(workers), workers, paces);
            EXPECT_GE(s.cycles, std::max(longest, sum / workers) - 1e-6);
            EXPECT_LE(s.cycles, sum / workers + longest + 1e-6); // Graham, 1969
            EXPECT_NEAR(s.busy, sum, 1e-6 * sum);
        }
}

/// A seed of one instruction a cycle, of which so many cycles wait for memory.
Seed plain_seed(double memory) {
    Seed s;
    s.phases = {{1000, 1 + memory, 1, 0}};
    s.core = 1;
    s.waits[most_levels] = memory;
    s.crowding.fill(1);
    return s;
}
Config machine_of(const char* settings) {
    return parse_machine(std::string("[memory]\nchannels = 1\n[chip]\ncores = 1\nthreads = 1\ntiles = 1\n") +
                             settings,
                         "test");
}
ScreenWork even_work(int tiles, double instructions) {
    ScreenWork w;
    w.once = {0};
    w.tiles.assign(static_cast<std::size_t>(tiles), {instructions});
    w.built.assign(static_cast<std::size_t>(tiles), {0});
    return w;
}
std::vector<Seat> seats(int tiles, int threads) {
    std::vector<Seat> out;
    for (int t = 0; t < tiles * threads; ++t)
        out.push_back({t / threads, t / threads});
    return out;
}

TEST(ClosedForm, AddsUpWhereNobodyWaits) {
    const Config one = machine_of("");
    // A lone thread takes what the seed's took, and tiles divide it.
    const Prediction alone = predict(plain_seed(3), one, one, even_work(16, 1e6), seats(1, 1));
    EXPECT_NEAR(alone.cycles / (16e6 * 4), 1, 0.02);
    Config four = one;
    four.chip.tiles = 4;
    EXPECT_NEAR(predict(plain_seed(3), one, four, even_work(16, 1e6), seats(4, 1)).cycles / alone.cycles,
                0.25, 0.02);
    EXPECT_EQ(alone.instructions, 16e6);
}

TEST(ClosedForm, ThreadsHideDelaysUntilTheCoreIsBusy) {
    const Config one = machine_of("");
    Config threads = one;
    double before = 1e300;
    for (const int n : {1, 2, 4, 8, 16}) {
        threads.chip.threads = n;
        const Prediction p = predict(plain_seed(3), one, threads, even_work(64, 1e6), seats(1, n));
        EXPECT_LT(p.cycles, before);
        EXPECT_GE(p.cycles, 64e6 * (1 - 1e-3)); // an instruction a cycle
        const double x = solve_exactly({1}, 3, n).throughput;
        EXPECT_NEAR(p.cycles / (64e6 / x), 1, 0.12) << n;
        before = p.cycles;
    }
    EXPECT_LT(before, 64e6 * 1.1);
    EXPECT_NE(predict(plain_seed(3), one, threads, even_work(64, 1e6), seats(1, 16)).limiter.find("cores"),
              std::string::npos);
}

TEST(ClosedForm, MemoryBindsWhereItIsSlow) {
    const Config one = machine_of("");
    Config many = one;
    many.chip.tiles = 8;
    many.chip.threads = 4;
    Seed s = plain_seed(3);
    s.phases.front().reads = 100;
    const double service = 0.1 * line_service_cycles(many, 0);
    const Prediction p = predict(s, one, many, even_work(64, 1e6), seats(8, 4));
    EXPECT_GE(p.cycles, 64e6 * service * (1 - 1e-3));
    EXPECT_LE(p.cycles, 64e6 * service * 1.25);
    EXPECT_NE(p.limiter.find("memory"), std::string::npos) << p.limiter;
    // Twice the channels move twice as much.
    many.memory.channels = 2;
    EXPECT_NEAR(predict(s, one, many, even_work(64, 1e6), seats(8, 4)).cycles / p.cycles, 0.5, 0.1);
    // A slower clock leaves memory nearer.
    Config slow = one;
    slow.chip.clock_ps *= 4;
    const double fast_cycles = predict(plain_seed(3), one, one, even_work(4, 1e6), seats(1, 1)).cycles;
    const double slow_cycles = predict(plain_seed(3), one, slow, even_work(4, 1e6), seats(1, 1)).cycles;
    EXPECT_LT(slow_cycles, 0.9 * fast_cycles);
    EXPECT_GT(4 * slow_cycles, fast_cycles);
}

TEST(ClosedForm, SeedsSayWhatTheyKnow) {
    const Config one = machine_of("");
    Config other = one;
    other.chip.tiles = 4;
    other.chip.threads = 8;
    other.memory.tRCD += 3;
    other.l2.latency += 5;
    other.sim.mode = "reference";
    EXPECT_EQ(unknown_to_seed(one, other), "");
    other.l2.size_bytes *= 2;
    EXPECT_EQ(unknown_to_seed(one, other), "l2.size_bytes");
    other = one;
    other.core.lanes *= 2;
    EXPECT_EQ(unknown_to_seed(one, other), "core.lanes");
    // Of messages, those that a seed counted know another network, and one that takes no time.
    other = one;
    other.network.topology = "mesh";
    EXPECT_EQ(unknown_to_seed(one, other), "network.topology");
    EXPECT_EQ(unknown_to_seed(other, one), "");
    Config ring = other;
    ring.network.topology = "ring";
    EXPECT_EQ(unknown_to_seed(other, ring), "");
    ring.network.request_bytes *= 2;
    EXPECT_EQ(unknown_to_seed(other, ring), "network.request_bytes");

    Seed s = plain_seed(2.5);
    s.banks[2] = 0.25;
    s.crowding[1] = 1.5;
    s.word_wait = 1e6;
    s.at_work = 12;
    s.worker_reads = 34;
    s.phases.push_back({5, 6, 7, 8, 9, 10, PhaseUse::builds});
    s.phases.push_back({0, 1, 2, 3, 0, 0, PhaseUse::end});
    const Seed back = seed_of_json(nlohmann::ordered_json::parse(json_of_seed(s).dump()));
    EXPECT_EQ(json_of_seed(back).dump(), json_of_seed(s).dump());
    EXPECT_EQ(back.waits, s.waits);
    EXPECT_EQ(back.phases.front().alone, 3.5);
    EXPECT_EQ(back.banks, s.banks);
    EXPECT_EQ(back.worker_reads, 34);
    EXPECT_EQ(back.phases[1].use, PhaseUse::builds);
    EXPECT_EQ(back.phases[1].before, 10);
    nlohmann::ordered_json odd = json_of_seed(s);
    odd["phases"][0]["use"] = "never";
    EXPECT_THROW(seed_of_json(odd), nlohmann::json::exception);
}

} // namespace
} // namespace sim::test
