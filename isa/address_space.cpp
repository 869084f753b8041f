#include "isa/address_space.h"

#include <fmt/core.h>

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <stdexcept>

namespace isa {

address_space::address_space(std::uint64_t capacity_bytes) : capacity_(capacity_bytes) {
    void* p = mmap(nullptr, capacity_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (p == MAP_FAILED)
        throw std::runtime_error(fmt::format("cannot reserve {} GiB of virtual addresses for frame memory: {}; raise "
                                             "the limit on virtual memory (ulimit -v)",
                                             capacity_ >> 30U, std::strerror(errno)));
    base_ = static_cast<std::byte*>(p);
}

address_space::~address_space() { munmap(base_, capacity_); }

std::byte* address_space::add(const std::string& structure, int owner, std::uint64_t bytes, bool transient) {
    std::uint64_t begin = used_;
    if (bytes > capacity_ - used_)
        throw std::runtime_error(fmt::format("frame memory is full: {} GiB reserved, {} GiB more wanted for {}",
                                             capacity_ >> 30U, (bytes >> 30U) + 1, structure));
    used_ = std::min(capacity_, (begin + bytes + granule - 1) / granule * granule);
    regions_.push_back({structure, owner, begin, begin + bytes, transient});
    return base_ + begin;
}

const region* address_space::find(std::uint64_t offset) const {
    auto after = std::upper_bound(regions_.begin(), regions_.end(), offset,
                                  [](std::uint64_t o, const region& r) { return o < r.begin; });
    if (after == regions_.begin() || offset >= (after - 1)->end)
        return nullptr;
    return &*(after - 1);
}

void address_space::clear(const region& r) {
    if (r.end > r.begin)
        madvise(base_ + r.begin, r.end - r.begin, MADV_DONTNEED);
}

std::uint64_t address_space::resident_bytes(const region& r) const {
    const auto page = static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE));
    constexpr std::uint64_t step = granule * 1024;
    std::vector<unsigned char> pages(step / page);
    std::uint64_t resident = 0;
    for (std::uint64_t at = r.begin; at < r.end; at += step) {
        const std::uint64_t bytes = std::min(step, r.end - at);
        const std::uint64_t count = (bytes + page - 1) / page;
        if (mincore(base_ + at, bytes, pages.data()) != 0)
            return 0; // unknown
        for (std::uint64_t i = 0; i < count; ++i)
            resident += (pages[i] & 1U) != 0 ? page : 0;
    }
    return resident;
}

} // namespace isa
