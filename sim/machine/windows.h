// How far apart in time things can lie, and how long windows are. All from the machine's own figures.
#pragma once

#include "sim/config/config.h"

#include <cstdint>

namespace sim {

std::uint64_t to_core_cycles(const Config& config, integer memory_clocks);
/// Memory clocks that have begun by then.
std::uint64_t to_memory_clocks(const Config& config, std::uint64_t core_cycles);
/// Core cycles from a tile's request to the answer, at the least: of the cache beyond it, of memory, or of a
/// directory.
std::uint64_t shortest_answer(const Config& config);
/// ... to one with a line, from below or from another tile.
std::uint64_t shortest_line(const Config& config);
/// Memory with queues: cycles by which it is known earlier that an answer leaves it, a cache beyond the
/// tiles, or one of a tile that was told of a line.
std::uint64_t known_ahead(const Config& config);
/// Cycles of a window between meetings of tiles and memory (sim.window, or what it stands for).
std::uint64_t window_cycles(const Config& config);
/// No operation asks for a core's resources farther ahead of its thread's time than this.
inline constexpr std::uint64_t booking_reach = 2048;
/// Cycles that accesses may wait for L1 ports before their operation holds up younger ones.
inline constexpr std::uint64_t port_backlog = 256;
/// How far behind its latest turn an operation may issue: younger operations of an issue window are simulated
/// after older ones that had to wait. What the window would let issue earlier still issues then.
std::uint64_t reach_cycles(const Config& config);

} // namespace sim
