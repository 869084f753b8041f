// The machine as programs use it: a configuration, and runs of workers on it.
#pragma once

#include "isa/address_space.h"
#include "sim/config/config.h"
#include "sim/machine/report.h"
#include "sim/machine/sampler.h"
#include "sim/network/network.h"

#include <atomic>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace sim {

class Recorder;

/// Every worker waits for a word that nobody will write. what() is one line.
class Deadlock : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// RunOptions::stop was set.
class Stopped : public std::runtime_error {
public:
    Stopped() : std::runtime_error("the run was stopped") {}
};

/// What else is wanted of a run.
struct RunOptions {
    std::uint64_t interval = 0; // cycles of an interval of Report::intervals, whole windows; 0: none are kept
    int frames = 1;             // so often all workers run, one time after another; the last counts
    std::function<void(int frame)> next_frame = {}; // called before all but the first, memory being quiet
    /// If it is given, all workers run once more in the last frame, with caches as they are, and that alone
    /// counts. Called before it, memory being quiet.
    std::function<void()> next_part = {};
    /// Another than 0: in each window all that the host may do in any order (tiles, what leaves them, who
    /// wakes) is done in one drawn with this seed. No report depends on it.
    std::uint32_t host_order = 0;
    /// Filled with all messages of the network, for who compares.
    std::vector<Network::Sent>* messages = nullptr;
    /// Records what counts; the caller finishes it.
    Recorder* recorder = nullptr;
    /// Is given what work and traffic that count cost whom they were for.
    OwnerCosts* owners = nullptr;
    /// Ends the run at the next window's beginning once it is true.
    const std::atomic<bool>* stop = nullptr;
    /// If it is given, the run is sampled (sampler.h): the report counts what was done, but for time, and
    /// laws are checked only where all was simulated in detail. One frame, one thread of the host, no
    /// recorder, no intervals, no owners.
    const Sampling* sampling = nullptr;
    Estimate* estimate = nullptr; // of a sampled run
};

class Machine {
public:
    explicit Machine(Config config) : config_(std::move(config)) {}

    /// Hardware threads: the most workers that can run.
    int threads() const { return static_cast<int>(config_.all_threads()); }
    const Config& config() const { return config_; }
    /// Why runs of this machine cannot be sampled, in a few words; empty if they can.
    std::string not_sampled() const;
    /// Calls worker(0 .. workers-1), each on a hardware thread of its own (chip.placement), with caches cold
    /// and time at 0. The workers' code is compiled for the target `simulated` and touches memory of `space`
    /// alone. Rethrows what a worker or a page service throws, after all other workers have been unwound;
    /// throws Deadlock, or Stopped. Checks all laws. One run at a time in a process. A worker begins in phase
    /// 0 and kind 0. With several frames, caches, predictors and open rows stay as the frame before left
    /// them: its dirty lines that outlive a frame have been written, others were dropped, and memory has
    /// become quiet. Where a frame goes on in a second part, its dirty lines stay; prefetched lines that
    /// nobody has used until then count as useless. Tiles run on `host_threads` threads of the host, which
    /// changes no digit of the report.
    Report run(const isa::address_space& space, int workers, const Labels& labels,
               const std::function<void(int worker)>& worker, int host_threads = 1,
               const RunOptions& options = {}) const;

private:
    Config config_;
};

} // namespace sim
