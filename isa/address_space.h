// Frame memory: one reservation of virtual addresses, cut into regions that each hold one data structure of one owner.
// Simulated addresses are distances from its base, so they never depend on the host. Memory reads as zero until
// written.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace isa {

struct region {
    std::string structure;            // the data structure it holds, as reports name it
    int owner = -1;                   // worker, or -1: everybody's
    std::uint64_t begin = 0, end = 0; // bytes from the base
    bool transient = false;           // dead when the frame ends
};

class address_space {
public:
    /// Regions begin at multiples of this many bytes.
    static constexpr std::uint64_t granule = std::uint64_t{1} << 16;

    /// Throws std::runtime_error (one line) if the reservation is refused.
    explicit address_space(std::uint64_t capacity_bytes);
    ~address_space();
    address_space(const address_space&) = delete;
    address_space& operator=(const address_space&) = delete;

    /// A region of at least `bytes`, after all earlier ones. Throws std::runtime_error if the space is full.
    std::byte* add(const std::string& structure, int owner, std::uint64_t bytes, bool transient = false);
    std::byte* base() const { return base_; }
    std::uint64_t offset(const void* p) const {
        return static_cast<std::uint64_t>(static_cast<const std::byte*>(p) - base_);
    }
    /// In ascending order of addresses.
    const std::vector<region>& regions() const { return regions_; }
    /// The region that holds this offset, or nullptr.
    const region* find(std::uint64_t offset) const;
    /// Gives the host's memory back; the bytes read as zero again.
    void clear(const region& r);
    /// How many of its bytes, in whole pages, the host has given memory for.
    std::uint64_t resident_bytes(const region& r) const;

private:
    std::byte* base_ = nullptr;
    std::uint64_t capacity_ = 0, used_ = 0;
    std::vector<region> regions_;
};

} // namespace isa
