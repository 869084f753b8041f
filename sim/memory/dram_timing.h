// What commands of one channel owe each other, in memory clocks, from first command to second.
// From JESD79-4 (DDR4), whose rules cover DDR3 (one bank group), DDR5, GDDR and HBM as well. Not modelled:
// power-down and self-refresh, calibration, tPPD, additive latency, different tRCD of reads and writes (HBM,
// GDDR), tCCD_R of HBM's stack ids, tCCD_L_WR of DDR5, the limit of 32 activates (GDDR5), commands that take
// two clocks (DDR5, HBM3).
#pragma once

#include "sim/config/config.h"

#include <algorithm>
#include <array>
#include <cstdint>

namespace sim {

using Clock = std::uint64_t; // memory clocks since the start

enum class Column : unsigned { read, write };
enum class Near : unsigned { group, rank, channel }; // what two commands have in common, at most

/// Rows and columns of the tables below are indexed by these.
constexpr std::size_t at(Column c) {
    return static_cast<std::size_t>(c);
}
constexpr std::size_t at(Near n) {
    return static_cast<std::size_t>(n);
}

struct DramTiming {
    Clock burst;                                               // of the data bus
    Clock tRCD, tRP, tRAS, tRC, tFAW, tREFI, tRFC;             // as in the data sheets
    Clock tRFCpb, tRREFD;                                      // of one bank
    std::array<Clock, 2> activate;                             // to activate: near group, rank
    std::array<Clock, 2> data;                                 // column command to first data, by Column
    std::array<Clock, 2> precharge;                            // column command to precharge, by Column
    std::array<std::array<std::array<Clock, 3>, 2>, 2> column; // [first][second][near]

    /// The longest time around a refresh in which a row can be neither opened and read or written.
    Clock blocked_by_refresh() const { return tRFC + around_refresh(); }
    /// From an activate to the first refresh that its row's accesses leave room for.
    Clock around_refresh() const { return std::max(tRC, tRCD + std::max(precharge[0], precharge[1]) + tRP); }

    explicit DramTiming(const MemoryConfig& c) {
        auto u = [](integer x) { return static_cast<Clock>(std::max<integer>(x, 1)); };
        integer half = c.burst_clocks();
        integer turn = std::max(c.tRTW, c.tRTRS);
        burst = u(half);
        tRCD = u(c.tRCD), tRP = u(c.tRP), tRAS = u(c.tRAS), tRC = u(std::max(c.tRC, c.tRAS + c.tRP));
        tFAW = u(c.tFAW);
        tREFI = static_cast<Clock>(c.tREFI), tRFC = static_cast<Clock>(c.tRFC);
        tRFCpb = u(c.tRFCpb), tRREFD = u(c.tRREFD);
        activate = {u(c.tRRD_L), u(c.tRRD_S)};
        data = {u(c.tCL), u(c.tCWL)};
        precharge = {u(c.tRTP), u(c.tCWL + half + c.tWR)};
        // Two bursts never meet on the bus, whoever sends them, and keep the order of their commands.
        integer same = std::max(half, c.tCCD_S), group = std::max(same, c.tCCD_L), other = half + c.tRTRS;
        column[0][0] = column[1][1] = {u(group), u(same), u(other)};
        column[0][1] = {u(c.tCL + half + c.tRTW - c.tCWL), u(c.tCL + half + c.tRTW - c.tCWL),
                        u(c.tCL + half + turn - c.tCWL)};
        column[1][0] = {u(c.tCWL + half + c.tWTR_L), u(c.tCWL + half + c.tWTR_S),
                        u(c.tCWL + half + c.tRTRS - c.tCL)};
    }
};

} // namespace sim
