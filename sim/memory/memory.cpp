#include "sim/memory/memory.h"

#include <algorithm>
#include <bit>
#include <string_view>

namespace sim {
namespace {

std::uint64_t wide(integer x) {
    return static_cast<std::uint64_t>(x);
}
unsigned log2(integer x) {
    return static_cast<unsigned>(std::countr_zero(wide(x)));
}

} // namespace

Memory::Memory(const Config& config, std::uint64_t ring_clocks)
    : c_(config.memory), core_ps_(wide(config.chip.clock_ps)), memory_ps_(wide(c_.clock_ps)),
      there_(wide(c_.controller_cycles) / 2), back_(wide(c_.controller_cycles) - there_),
      burst_bytes_(wide(c_.bus_bytes * c_.burst_length)), line_bytes_(wide(config.l2.line_bytes)),
      burst_clocks_(static_cast<std::uint32_t>(c_.burst_length / 2)) {
    for (integer i = 0; i < c_.channels; ++i)
        channels_.push_back({Calendar("memory bus", ring_clocks), std::vector<Bank>(wide(c_.banks))});
    unsigned shift = static_cast<unsigned>(std::countr_zero(burst_bytes_));
    std::string_view fields = c_.mapping;
    while (!fields.empty()) {
        std::size_t colon = fields.rfind(':');
        std::string_view name = colon == std::string_view::npos ? fields : fields.substr(colon + 1);
        fields = colon == std::string_view::npos ? "" : fields.substr(0, colon);
        if (name == "row") {
            row_ = {shift, ~std::uint64_t{0}};
        } else if (name == "column") {
            shift += static_cast<unsigned>(std::countr_zero(wide(c_.row_bytes) / burst_bytes_));
        } else {
            integer count = name == "channel" ? c_.channels : c_.banks;
            (name == "channel" ? channel_ : bank_) = {shift, wide(count) - 1};
            shift += log2(count);
        }
    }
}

Memory::Place Memory::locate(std::uint64_t address) const {
    return {(address >> channel_.shift) & channel_.mask, (address >> bank_.shift) & bank_.mask,
            address >> row_.shift};
}

Memory::clock Memory::after_refresh(clock t) const {
    if (c_.tREFI == 0)
        return t;
    clock into = t % wide(c_.tREFI);
    return t >= wide(c_.tREFI) && into < wide(c_.tRFC) ? t + wide(c_.tRFC) - into : t;
}

/// The clock from which a column command may go to `row`, opened if need be.
Memory::clock Memory::open_row(Bank& b, std::uint64_t row, clock arrival) {
    clock epoch = c_.tREFI == 0 ? 0 : arrival / wide(c_.tREFI);
    if (epoch > b.epoch) {
        b.epoch = epoch;
        b.row = b.closed_row = no_row;
        b.activate_ok = std::max(b.activate_ok, epoch * wide(c_.tREFI) + wide(c_.tRFC));
    }
    if (b.row == row) {
        ++counters_.row_hits;
        return std::max(arrival, b.column_ok);
    }
    clock activate = 0;
    if (b.row == no_row) {
        ++counters_.row_empties;
        activate = std::max(arrival, b.activate_ok);
    } else {
        ++counters_.row_conflicts;
        b.closing = std::max(arrival, b.precharge_ok);
        b.closed_row = b.row;
        b.closed_column_ok = b.column_ok;
        activate = b.closing + wide(c_.tRP);
    }
    activate = after_refresh(activate);
    b.row = row;
    b.precharge_ok = activate + wide(c_.tRAS);
    return activate + wide(c_.tRCD);
}

/// One burst; returns the clock after its last transfer.
Memory::clock Memory::burst(std::uint64_t address, clock arrival, bool write) {
    Place p = locate(address);
    Channel& channel = channels_[p.channel];
    Bank& b = channel.banks[p.bank];
    ++counters_.bursts;
    counters_.busy_clocks += burst_clocks_;
    arrival = after_refresh(arrival);
    clock to_data = wide(write ? c_.tCWL : c_.tCL);
    clock data = 0;
    if (!write && b.closed_row == p.row && b.row != p.row) {
        data = channel.bus.find_run(std::max(arrival, b.closed_column_ok) + to_data, burst_clocks_);
        clock column = data - to_data;
        if (column + wide(c_.tRTP) <= b.closing) {
            channel.bus.mark_run(data, burst_clocks_);
            b.closed_column_ok = column + wide(c_.tCCD);
            ++counters_.row_hits;
            counters_.last_clock = std::max(counters_.last_clock, data + burst_clocks_);
            return data + burst_clocks_;
        }
    }
    clock ready = after_refresh(open_row(b, p.row, arrival));
    data = channel.bus.take_run(ready + to_data, burst_clocks_);
    clock column = data - to_data;
    b.column_ok = column + wide(c_.tCCD);
    b.precharge_ok =
        std::max(b.precharge_ok, write ? data + burst_clocks_ + wide(c_.tWR) : column + wide(c_.tRTP));
    counters_.last_clock = std::max(counters_.last_clock, data + burst_clocks_);
    return data + burst_clocks_;
}

cycle Memory::transfer(std::uint64_t address, cycle t, bool write) {
    clock arrival = (t * core_ps_ + memory_ps_ - 1) / memory_ps_;
    clock done = 0;
    for (std::uint64_t part = 0; part < line_bytes_; part += burst_bytes_)
        done = std::max(done, burst(address + part, arrival, write));
    return (done * memory_ps_ + core_ps_ - 1) / core_ps_;
}

cycle Memory::read(std::uint64_t address, cycle t) {
    ++counters_.reads;
    return transfer(address, t + there_, false) + back_;
}

cycle Memory::write(std::uint64_t address, cycle t) {
    ++counters_.writes;
    return transfer(address, t + there_, true);
}

} // namespace sim
