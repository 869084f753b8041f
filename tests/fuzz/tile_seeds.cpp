// Kept seeds of closed forms: any bytes are refused in one clear line, or are a seed of which finite times
// follow.
#include "razor/frame/phases.h"
#include "razor/scene/error.h"
#include "sim/config/machine_file.h"
#include "sim/estimate/closed_form.h"
#include "sim/program/seed_file.h"
#include "tests/fuzz/target.h"

#include <cmath>
#include <fstream>
#include <iterator>

namespace {

const fuzz::File& file() {
    static const fuzz::File one("fuzz.json");
    return one;
}

std::string sound() {
    sim::KeptSeed out;
    out.machine = sim::parse_machine("[chip]\ntiles = 1\ncores = 2\nthreads = 2\n", "seed");
    out.scene = "samples = 1\n";
    out.drivers.assign(razor::phase_count, 1000);
    out.needs.assign(4, {5, 6});
    out.seed.phases.assign(razor::phase_count + 1, {20000, 2.5, 30, 4, 20, 3, sim::PhaseUse::renders});
    out.seed.phases[razor::phase_animate].use = sim::PhaseUse::once;
    out.seed.phases[razor::phase_build].use = sim::PhaseUse::builds;
    out.seed.phases.back().use = sim::PhaseUse::end;
    out.seed.core = 1;
    out.seed.banks.fill(0.1);
    out.seed.waits.fill(0.2);
    out.seed.crowding.fill(1.1);
    out.seed.lines = 0.01;
    out.seed.network_bytes = 0.5;
    out.processor_seconds = 0.25;
    sim::write_seed(file().path(), out);
    std::ifstream in(file().path());
    return {std::istreambuf_iterator<char>(in), {}};
}

/// Four screen tiles for two workers.
sim::ScreenWork work(std::size_t phases) {
    sim::ScreenWork out;
    out.once.assign(phases, 100);
    out.tiles.assign(4, sim::PhaseWork(phases, 1000));
    out.built.assign(4, sim::PhaseWork(phases, 50));
    return out;
}

} // namespace

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{sound()};
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    file().write(bytes);
    try {
        const sim::KeptSeed seed = sim::read_seed("--seed-report", file().path());
        if (seed.machine.all_threads() < 2 || seed.machine.all_threads() > 64)
            return true;
        const int other = seed.machine.chip.cores > 1 ? 1 : 0;
        const sim::Prediction found = sim::predict(seed.seed, seed.machine, seed.machine,
                                                   work(seed.seed.phases.size()), {{0, 0}, {other, 0}});
        require(std::isfinite(found.cycles) && found.cycles >= 0);
        require(std::isfinite(found.reads) && found.reads >= 0 && std::isfinite(found.writes));
    } catch (const razor::UserError& error) {
        require_line(error.what(), "--seed-report: ");
    }
    return true;
}
