// Machine files: any text is a machine that prints as one which reads back the same, or one clear line.
#include "sim/config/error.h"
#include "sim/config/machine_file.h"
#include "tests/fuzz/target.h"

#include <fstream>
#include <iterator>

namespace {

std::string shipped(const std::string& name) {
    std::ifstream in(RAZOR_SOURCE_DIR "/configs/machines/" + name);
    return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        "[chip]\ntiles = 2\ncores = 4\n[l2]\nsize_bytes = 65536\nways = 4\n",
        "[network]\ntopology = \"mesh\"\nhop_cycles = 2\n[memory]\npreset = \"ddr4-2400r\"\nchannels = 2\n",
        "[chip]\nthreads = 4\n[core]\nlanes = 4\nswitch_policy = \"stall\"\n[l1]\nline_bytes = 32 # known: a "
        "book\n",
        shipped("tiny.toml"),
    };
    return all;
}

bool fuzz::try_bytes(std::string_view bytes) {
    try {
        const sim::MachineDescription machine = sim::describe_machine_text(std::string(bytes), "fuzz");
        const sim::MachineDescription again =
            sim::describe_machine_text(sim::print_machine(machine), "again");
        require(sim::print_machine(again.config) == sim::print_machine(machine.config));
    } catch (const sim::ConfigError& error) {
        require_line(error.what());
    }
    return true;
}
