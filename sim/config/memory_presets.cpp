#include "sim/config/memory_presets.h"

#include <algorithm>

namespace sim {
namespace {

/// Queues and policies are of the controller; no data sheet gives them. Assumed: 64 entries, as gem5's
/// controller has, drained in long batches; an age that only what is starved reaches.
MemoryConfig controller() {
    MemoryConfig c;
    c.scheduler = "fr-fcfs";
    c.age_cap = 5000;
    c.read_queue = 64;
    c.write_queue = 64;
    c.write_high = 56;
    c.write_low = 8;
    c.page_policy = "open";
    c.page_timeout = 200;
    c.refresh = "all-bank";
    c.refresh_postponed = 0;
    c.transfers_per_clock = 2;
    c.bank_xor = "off";
    c.command_buses = 1;
    return c;
}

/// One 64-bit channel of one rank of eight 2 Gbit x8 devices of speed bin DDR3-1600K (11-11-11), JESD79-3F.
MemoryConfig ddr3_1600k() {
    MemoryConfig c = controller();
    c.preset = "ddr3-1600k";
    c.clock_ps = 1250; // speed bin: tCK
    c.channels = 1;
    c.ranks = 1;
    c.bank_groups = 1; // DDR3 has none
    c.banks = 8;
    c.rows = 32768;     // 2 Gbit x8: 15 row bits
    c.row_bytes = 8192; // page of 1 KiB a device
    c.bus_bytes = 8;
    c.burst_length = 8;
    c.tRCD = 11; // speed bin: 13.75 ns
    c.tRP = 11;  // speed bin: 13.75 ns
    c.tRAS = 28; // speed bin: 35 ns
    c.tRC = 39;  // speed bin: 48.75 ns
    c.tCL = 11;  // speed bin
    c.tCWL = 8;  // for tCK of 1.25 ns
    c.tCCD_S = c.tCCD_L = 4;
    c.tRRD_S = c.tRRD_L = 5; // max(4 clocks, 6 ns), page of 1 KiB
    c.tFAW = 24;             // 30 ns, page of 1 KiB
    c.tRTP = 6;              // max(4 clocks, 7.5 ns)
    c.tWR = 12;              // 15 ns
    c.tWTR_S = c.tWTR_L = 6; // max(4 clocks, 7.5 ns)
    c.tRTW = 2;              // read to write: CL + BL/2 + 2 - CWL
    c.tRTRS = 1;             // of the board; DRAMsim3's value
    c.tREFI = 6240;          // 7.8 us
    c.tRFC = 128;            // 160 ns, 2 Gbit
    c.tRFCpb = 128;          // DDR3 refreshes all banks: unused
    c.tRREFD = 5;            // unused
    c.mapping = "row:rank:bank:group:column:channel";
    return c;
}

/// One 64-bit channel of one rank of eight 8 Gbit x8 devices of speed bin DDR4-2400R (16-16-16), JESD79-4B.
/// Public models differ in tRFC: 350 ns in the standard and DRAMsim3, 360 ns (433 clocks) in Ramulator 2.1.
MemoryConfig ddr4_2400r() {
    MemoryConfig c = controller();
    c.preset = "ddr4-2400r";
    c.clock_ps = 833; // speed bin: tCK
    c.channels = 1;
    c.ranks = 1;
    c.bank_groups = 4;
    c.banks = 4;
    c.rows = 65536;     // 8 Gbit x8: 16 row bits
    c.row_bytes = 8192; // page of 1 KiB a device
    c.bus_bytes = 8;
    c.burst_length = 8;
    c.tRCD = 16; // speed bin: 13.32 ns
    c.tRP = 16;  // speed bin: 13.32 ns
    c.tRAS = 39; // speed bin: 32 ns
    c.tRC = 55;  // speed bin: 45.32 ns
    c.tCL = 16;  // speed bin
    c.tCWL = 12; // for 2400 Mb/s, first set
    c.tCCD_S = 4;
    c.tCCD_L = 6;   // max(5 clocks, 5 ns)
    c.tRRD_S = 4;   // max(4 clocks, 3.3 ns), page of 1 KiB
    c.tRRD_L = 6;   // max(4 clocks, 4.9 ns), page of 1 KiB
    c.tFAW = 26;    // max(20 clocks, 21 ns), page of 1 KiB
    c.tRTP = 9;     // max(4 clocks, 7.5 ns)
    c.tWR = 18;     // 15 ns
    c.tWTR_S = 3;   // max(2 clocks, 2.5 ns)
    c.tWTR_L = 9;   // max(4 clocks, 7.5 ns)
    c.tRTW = 2;     // read to write: CL + BL/2 + 2 - CWL
    c.tRTRS = 1;    // of the board; DRAMsim3's value
    c.tREFI = 9363; // 7.8 us
    c.tRFC = 421;   // 350 ns, 8 Gbit
    c.tRFCpb = 421; // DDR4 refreshes all banks: unused
    c.tRREFD = 6;   // unused
    c.mapping = "row:rank:bank:column:channel:group";
    return c;
}

/// One stack of HBM2 at 2 Gb/s a pin: 8 channels of two pseudo channels, each 64 bits wide, four bank groups
/// of four banks; 4 Gbit a channel. Timing as in Ramulator 2.1's HBM2_2000Mbps, refresh of all banks after
/// JESD235A (260 ns for 4 Gbit). JESD235 leaves most of these to the vendor. DRAMsim3's HBM2 differs in tFAW
/// (30 clocks) and tRRD_L (6).
MemoryConfig hbm2() {
    MemoryConfig c = controller();
    c.preset = "hbm2";
    c.clock_ps = 1000;
    c.channels = 16; // pseudo channels
    c.ranks = 1;
    c.bank_groups = 4;
    c.banks = 4;
    c.rows = 16384;     // 256 MiB a pseudo channel
    c.row_bytes = 1024; // of a pseudo channel
    c.bus_bytes = 8;
    c.burst_length = 4;
    c.command_buses = 2; // rows and columns
    c.tRCD = 14;         // of reads; 12 for writes is not modelled
    c.tRP = 14;
    c.tRAS = 34;
    c.tRC = 48;
    c.tCL = 14;
    c.tCWL = 5;
    c.tCCD_S = 2;
    c.tCCD_L = 4;
    c.tRRD_S = c.tRRD_L = 4; // 4 ns
    c.tFAW = 15;             // 15 ns
    c.tRTP = 5;
    c.tWR = 16;
    c.tWTR_S = 6;
    c.tWTR_L = 8;
    c.tRTW = 2;     // read to write: CL + BL/2 + 2 - CWL
    c.tRTRS = 1;    // one rank: unused
    c.tREFI = 3900; // 3.9 us
    c.tRFC = 260;   // 260 ns
    c.tRFCpb = 160; // 160 ns; DRAMsim3's tRFCb of HBM2 at 4 Gbit
    c.tRREFD = 8;   // 8 ns
    c.mapping = "row:rank:bank:column:group:channel:column.1";
    return c;
}

} // namespace

const std::vector<MemoryConfig>& memory_presets() {
    static const std::vector<MemoryConfig> presets = {ddr3_1600k(), ddr4_2400r(), hbm2()};
    return presets;
}

bool memory_preset_sets(std::string_view key) {
    return key.starts_with("memory.") && key != "memory.preset" && key != "memory.controller_cycles";
}

void apply_memory_preset(Config& config, const std::string& name) {
    const auto& all = memory_presets();
    auto found =
        std::find_if(all.begin(), all.end(), [&](const MemoryConfig& c) { return c.preset == name; });
    if (found == all.end())
        return;
    integer controller_cycles = config.memory.controller_cycles;
    config.memory = *found;
    config.memory.controller_cycles = controller_cycles;
}

} // namespace sim
