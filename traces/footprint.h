// Which bytes of an address range a program has touched, and how.
#pragma once

#include <bitset>
#include <cstddef>
#include <cstdint>
#include <unordered_map>

namespace traces {

/// Grows with the pages touched, not with the range: three bits a byte of them.
class Footprint {
public:
    void read(std::uint64_t address, std::uint64_t bytes);
    void write(std::uint64_t address, std::uint64_t bytes);

    bool is_read(std::uint64_t address) const { return has(address, &Page::read); }
    bool is_written(std::uint64_t address) const { return has(address, &Page::written); }
    /// Read before anything was written there: what came from outside.
    bool is_input(std::uint64_t address) const { return has(address, &Page::input); }

    /// Number of bytes of each kind.
    std::uint64_t bytes_read() const { return count(&Page::read); }
    std::uint64_t bytes_written() const { return count(&Page::written); }
    std::uint64_t input_bytes() const { return count(&Page::input); }

    void clear();

private:
    static constexpr std::uint64_t page_bytes = 4096;
    using Bits = std::bitset<page_bytes>;
    struct Page {
        Bits read, written, input;
    };
    Page& page(std::uint64_t number);
    bool has(std::uint64_t address, Bits Page::*kind) const;
    std::uint64_t count(Bits Page::*kind) const;
    template <class Visit> void each_byte(std::uint64_t address, std::uint64_t bytes, Visit visit);

    std::unordered_map<std::uint64_t, Page> pages_;
    Page* last_ = nullptr; // of the page touched last
    std::uint64_t last_number_ = 0;
};

} // namespace traces
