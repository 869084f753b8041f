#include "traces/footprint.h"

namespace traces {

Footprint::Page& Footprint::page(std::uint64_t number) {
    if (last_ == nullptr || number != last_number_) {
        last_ = &pages_[number]; // references to elements outlive rehashing
        last_number_ = number;
    }
    return *last_;
}

template <class Visit> void Footprint::each_byte(std::uint64_t address, std::uint64_t bytes, Visit visit) {
    for (std::uint64_t a = address; a < address + bytes; ++a)
        visit(page(a / page_bytes), static_cast<std::size_t>(a % page_bytes));
}

void Footprint::read(std::uint64_t address, std::uint64_t bytes) {
    each_byte(address, bytes, [](Page& p, std::size_t i) {
        p.read.set(i);
        if (!p.written[i])
            p.input.set(i);
    });
}

void Footprint::write(std::uint64_t address, std::uint64_t bytes) {
    each_byte(address, bytes, [](Page& p, std::size_t i) { p.written.set(i); });
}

bool Footprint::has(std::uint64_t address, Bits Page::*kind) const {
    auto found = pages_.find(address / page_bytes);
    return found != pages_.end() && (found->second.*kind)[address % page_bytes];
}

std::uint64_t Footprint::count(Bits Page::*kind) const {
    std::uint64_t n = 0;
    for (const auto& [number, p] : pages_)
        n += (p.*kind).count();
    return n;
}

void Footprint::clear() {
    pages_.clear();
    last_ = nullptr;
}

} // namespace traces
