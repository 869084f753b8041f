#include "sim/machine/machine.h"

#include "sim/config/config.h"
#include "sim/machine/engine.h"

#include <chrono>
#include <ctime>

namespace sim {
namespace {

class Running {
public:
    explicit Running(Engine& engine) {
        if (running_engine != nullptr)
            throw std::logic_error("a machine is running already in this process");
        running_engine = &engine;
    }
    Running(const Running&) = delete;
    Running& operator=(const Running&) = delete;
    ~Running() {
        running_engine = nullptr;
        running_hart = nullptr;
    }
};

} // namespace

std::string Machine::not_sampled() const {
    if (config_.coherence.kept())
        return "its plain data are kept coherent (coherence.plain)";
    if (config_.beyond_tiles(config_.cache_levels() - 1))
        return "tiles share its last level of caches";
    return "";
}

Report Machine::run(const isa::address_space& space, int workers, const Labels& labels,
                    const std::function<void(int worker)>& worker, int host_threads,
                    const RunOptions& options) const {
    if (workers < 1 || workers > threads())
        throw std::invalid_argument("as many workers as the machine has hardware threads, at most");
    check_consistency(config_, "machine");
    if (options.sampling != nullptr &&
        (!not_sampled().empty() || host_threads != 1 || options.frames != 1 || options.next_part ||
         options.recorder != nullptr || options.interval != 0))
        throw std::invalid_argument("a run that cannot be sampled");
    auto begin = std::chrono::steady_clock::now();
    std::clock_t worked = std::clock();
    auto engine = std::make_unique<Engine>(config_, space, workers, labels, host_threads, options, worker);
    Running running(*engine);
    Report report = engine->run();
    if (options.estimate != nullptr && options.sampling != nullptr)
        *options.estimate = engine->estimate();
    report.processor_seconds = static_cast<double>(std::clock() - worked) / CLOCKS_PER_SEC;
    report.host_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    if (options.sampling == nullptr || options.sampling->fraction >= 1)
        check_laws(report);
    return report;
}

} // namespace sim
