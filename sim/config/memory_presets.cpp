#include "sim/config/memory_presets.h"

#include <algorithm>
#include <utility>

namespace sim {
namespace {

/// Queues and policies are of the controller; no data sheet gives them. Assumed: 64 entries, as gem5's
/// controller has, drained in long batches; an age that only what is starved reaches. Energies are assumed
/// too: sheets give currents, which differ from maker to maker; what is here are a rank's round numbers.
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
    // Energies: of usual 2 Gbit parts at 1.5 V, from their currents; termination as 10 pJ a bit.
    c.activate_pj = 29000;
    c.read_pj = 13000;
    c.write_pj = 14000;
    c.refresh_pj = 330000;
    c.background_mw = 500;
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
    // Energies: of usual 8 Gbit parts at 1.2 V, from their currents; termination as 5 pJ a bit.
    c.activate_pj = 9000;
    c.read_pj = 6000;
    c.write_pj = 6000;
    c.refresh_pj = 700000;
    c.background_mw = 360;
    c.mapping = "row:rank:bank:column:channel:group";
    return c;
}

/// The same with two ranks.
MemoryConfig ddr4_2400r_2() {
    MemoryConfig c = ddr4_2400r();
    c.preset = "ddr4-2400r-2r";
    c.ranks = 2;
    return c;
}

/// One module of DDR5-4800B (40-39-39), JESD79-5: two channels of 32 bits, each one rank of four 16 Gbit x8
/// devices. Not modelled: the longer distance of writes to one bank group (tCCD_L_WR), refresh of the same
/// bank of every group.
MemoryConfig ddr5_4800b() {
    MemoryConfig c = controller();
    c.preset = "ddr5-4800b";
    c.clock_ps = 416; // speed bin: tCK
    c.channels = 2;
    c.ranks = 1;
    c.bank_groups = 8;
    c.banks = 4;
    c.rows = 65536;     // 16 Gbit x8: 16 row bits
    c.row_bytes = 4096; // page of 1 KiB a device
    c.bus_bytes = 4;
    c.burst_length = 16;
    c.tRCD = 39; // speed bin
    c.tRP = 39;  // speed bin
    c.tRAS = 77; // speed bin: 32 ns
    c.tRC = 116; // tRAS + tRP
    c.tCL = 40;  // speed bin
    c.tCWL = 38; // CL - 2
    c.tCCD_S = 8;
    c.tCCD_L = 12; // max(8 clocks, 5 ns)
    c.tRRD_S = 8;
    c.tRRD_L = 12;  // max(8 clocks, 5 ns)
    c.tFAW = 32;    // 32 clocks, page of 1 KiB
    c.tRTP = 18;    // max(12 clocks, 7.5 ns)
    c.tWR = 72;     // 30 ns
    c.tWTR_S = 6;   // max(4 clocks, 2.5 ns)
    c.tWTR_L = 24;  // max(16 clocks, 10 ns)
    c.tRTW = 2;     // read to write: CL + BL/2 + 2 - CWL
    c.tRTRS = 2;    // of the board; Ramulator 2.1's value
    c.tREFI = 9375; // 3.9 us
    c.tRFC = 710;   // 295 ns, 16 Gbit
    c.tRFCpb = 710; // unused
    c.tRREFD = 12;  // unused
    // Energies: a fifth less a bit than DDR4.
    c.activate_pj = 5500;
    c.read_pj = 4500;
    c.write_pj = 4500;
    c.refresh_pj = 600000;
    c.background_mw = 260;
    c.mapping = "row:rank:bank:column:group:channel";
    return c;
}

/// A board of 256 bits of GDDR5 at 4 Gb/s a pin: four channels of two 1 Gbit devices of 32 bits each. Timing
/// as in gem5's GDDR5_4000_2x32, which cites the data sheet of SK Hynix H5GQ1H24AFR; that gives neither tCL
/// (gem5 assumes tRCD), nor the write latency and the refresh interval (assumed here).
MemoryConfig gddr5_4000() {
    MemoryConfig c = controller();
    c.preset = "gddr5-4000";
    c.clock_ps = 1000; // CK; data at four times its rate
    c.channels = 4;
    c.ranks = 1;
    c.bank_groups = 4;
    c.banks = 4;
    c.rows = 4096;      // 1 Gbit: 16 banks of 4096 rows of 2 KiB
    c.row_bytes = 4096; // of two devices
    c.bus_bytes = 8;
    c.burst_length = 8;
    c.transfers_per_clock = 4;
    c.tRCD = 12; // 12 ns
    c.tRP = 12;  // 12 ns
    c.tRAS = 28; // 28 ns
    c.tRC = 40;  // tRAS + tRP
    c.tCL = 12;  // assumed: tRCD
    c.tCWL = 4;  // assumed
    c.tCCD_S = 2;
    c.tCCD_L = 3;
    c.tRRD_S = c.tRRD_L = 6; // 5.5 ns
    c.tFAW = 23;             // 23 ns
    c.tRTP = 2;
    c.tWR = 12;              // 12 ns
    c.tWTR_S = c.tWTR_L = 5; // 5 ns, mean of both in gem5
    c.tRTW = 2;
    c.tRTRS = 1;    // one rank: unused
    c.tREFI = 3900; // assumed: 3.9 us
    c.tRFC = 65;    // 65 ns
    c.tRFCpb = 65;  // unused
    c.tRREFD = 6;   // unused
    // Energies: 14 pJ a bit in all (O'Connor et al., MICRO 2017), a quarter of it for rows.
    c.activate_pj = 6000;
    c.read_pj = 2600;
    c.write_pj = 2600;
    c.refresh_pj = 120000;
    c.background_mw = 250;
    c.mapping = "row:rank:bank:column:group:channel";
    return c;
}

/// A board of 256 bits of GDDR6 at 14 Gb/s a pin: eight 8 Gbit devices of two channels of 16 bits. Timing as
/// in Ramulator 2.1's GDDR6_14000_1350mV_double.
MemoryConfig gddr6_14000() {
    MemoryConfig c = controller();
    c.preset = "gddr6-14000";
    c.clock_ps = 571; // CK; data at eight times its rate
    c.channels = 16;
    c.ranks = 1;
    c.bank_groups = 4;
    c.banks = 4;
    c.rows = 16384;
    c.row_bytes = 2048;
    c.bus_bytes = 2;
    c.burst_length = 16;
    c.transfers_per_clock = 8;
    c.tRCD = 27; // of reads; 16 for writes is not modelled
    c.tRP = 27;
    c.tRAS = 53;
    c.tRC = 80; // tRAS + tRP
    c.tCL = 24;
    c.tCWL = 6;
    c.tCCD_S = 2;
    c.tCCD_L = 4;
    c.tRRD_S = c.tRRD_L = 8;
    c.tFAW = 29;
    c.tRTP = 4;
    c.tWR = 27;
    c.tWTR_S = 9;
    c.tWTR_L = 11;
    c.tRTW = 5;     // read to write: CL + 1
    c.tRTRS = 1;    // one rank: unused
    c.tREFI = 3333; // 1.9 us
    c.tRFC = 211;   // 120 ns
    c.tRFCpb = 106; // 60 ns
    c.tRREFD = 15;
    // Energies: half as much a bit as GDDR5.
    c.activate_pj = 4000;
    c.read_pj = 1900;
    c.write_pj = 1900;
    c.refresh_pj = 120000;
    c.background_mw = 250;
    c.mapping = "row:rank:bank:column:group:channel:column.1";
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
    c.tRFCpb = 160; // 160 ns, up to 8 Gbit
    c.tRREFD = 8;   // 8 ns
    // Energies: 3.9 pJ a bit in all (O'Connor et al., MICRO 2017), a third of it for rows.
    c.activate_pj = 1200;
    c.read_pj = 700;
    c.write_pj = 700;
    c.refresh_pj = 60000;
    c.background_mw = 40;
    c.mapping = "row:rank:bank:column:group:channel:column.1";
    return c;
}

/// One stack of HBM3 at 6.4 Gb/s a pin: 16 channels of two pseudo channels, each 32 bits wide, four bank
/// groups of four banks; one stack id, 4 Gbit a channel. Timing as in Ramulator 2.1's HBM3_6400Mbps; refresh
/// after JESD238.
MemoryConfig hbm3() {
    MemoryConfig c = controller();
    c.preset = "hbm3-6400";
    c.clock_ps = 625; // CK; data at four times its rate
    c.channels = 32;  // pseudo channels
    c.ranks = 1;
    c.bank_groups = 4;
    c.banks = 4;
    c.rows = 16384;
    c.row_bytes = 1024; // of a pseudo channel
    c.bus_bytes = 4;
    c.burst_length = 8;
    c.transfers_per_clock = 4;
    c.command_buses = 2; // rows and columns
    c.tRCD = 31;         // of reads; 15 for writes is not modelled
    c.tRP = 26;
    c.tRAS = 45;
    c.tRC = 72;
    c.tCL = 20;
    c.tCWL = 10;
    c.tCCD_S = 2;
    c.tCCD_L = 4;
    c.tRRD_S = 4;
    c.tRRD_L = 5;
    c.tFAW = 24;
    c.tRTP = 9;
    c.tWR = 33;
    c.tWTR_S = 7;
    c.tWTR_L = 10;
    c.tRTW = 8;     // read to write: 20
    c.tRTRS = 1;    // one rank: unused
    c.tREFI = 6240; // 3.9 us
    c.tRFC = 416;   // 260 ns, 4 Gbit a channel
    c.tRFCpb = 320; // 200 ns
    c.tRREFD = 13;  // 8 ns
    // Energies: a fifth less a bit than HBM2.
    c.activate_pj = 1000;
    c.read_pj = 550;
    c.write_pj = 550;
    c.refresh_pj = 60000;
    c.background_mw = 40;
    c.mapping = "row:rank:bank:column:group:channel:column.1";
    return c;
}

} // namespace

const std::vector<MemoryConfig>& memory_presets() {
    static const std::vector<MemoryConfig> presets = {ddr3_1600k(), ddr4_2400r(), ddr4_2400r_2(),
                                                      ddr5_4800b(), gddr5_4000(), gddr6_14000(),
                                                      hbm2(),       hbm3()};
    return presets;
}

bool memory_preset_sets(const Config&, std::string_view key) {
    return key.starts_with("memory.") && key != "memory.preset" && !key.starts_with("memory.controller");
}

void apply_memory_preset(Config& config, const std::string& name) {
    const auto& all = memory_presets();
    auto found =
        std::find_if(all.begin(), all.end(), [&](const MemoryConfig& c) { return c.preset == name; });
    if (found == all.end())
        return;
    const MemoryConfig old = std::exchange(config.memory, *found);
    config.memory.controller = old.controller;
    config.memory.controller_cycles = old.controller_cycles;
}

} // namespace sim
