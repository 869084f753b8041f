// What translation of addresses takes, in closed form, for tests and for `razor-sim validate`.
#pragma once

#include "sim/validation/core_forms.h"

namespace sim {

/// plain_core() with a fully associative TLB of `entries` pages of 4 KiB, walks of 30 cycles, and an L1 in
/// which a line of each of 64 pages has room.
Config plain_tlb(integer entries);

/// `turns` times over, a load of a line of each of `pages` pages, each address known when the load before is
/// done. Lines of neighbouring pages are in different sets of the L1.
void chase_pages(std::byte* base, const Config& config, int pages, int turns);

/// Chases over fewer and more pages than TLBs have entries, by kind of walk: the last of several turns alone.
std::vector<CoreForm> tlb_forms();

} // namespace sim
