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

Report Machine::run(const isa::address_space& space, int workers, const Labels& labels,
                    const std::function<void(int worker)>& worker, int host_threads,
                    const RunOptions& options) const {
    if (workers < 1 || workers > threads())
        throw std::invalid_argument("as many workers as the machine has hardware threads, at most");
    check_consistency(config_, "machine");
    auto begin = std::chrono::steady_clock::now();
    std::clock_t worked = std::clock();
    auto engine = std::make_unique<Engine>(config_, space, workers, labels, host_threads, options, worker);
    Running running(*engine);
    Report report = engine->run();
    report.processor_seconds = static_cast<double>(std::clock() - worked) / CLOCKS_PER_SEC;
    report.host_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    check_laws(report);
    return report;
}

} // namespace sim
