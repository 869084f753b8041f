#include "sim/memory/dram_mapping.h"

#include <fmt/core.h>

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <string_view>

namespace sim {
namespace {

constexpr std::array<std::string_view, 6> names = {"row", "rank", "bank", "group", "channel", "column"};

unsigned bits_of(integer count) {
    return static_cast<unsigned>(std::countr_zero(static_cast<std::uint64_t>(count)));
}

std::array<unsigned, 6> widths(const MemoryConfig& c) {
    return {bits_of(c.rows),     bits_of(c.ranks),
            bits_of(c.banks),    bits_of(c.bank_groups),
            bits_of(c.channels), bits_of(c.row_bytes / (c.bus_bytes * c.burst_length))};
}

} // namespace

std::string DramMapping::parse(const MemoryConfig& c, std::vector<Part>& parts) {
    struct Named {
        Field field;
        unsigned bits;
        bool rest;
    };
    std::vector<Named> named;
    std::array<unsigned, fields> left = widths(c);
    std::array<int, fields> rests{};
    for (std::string_view text = c.mapping; !text.empty();) {
        std::string_view word = text.substr(0, text.find(':'));
        text.remove_prefix(std::min(text.size(), word.size() + 1));
        std::string_view name = word.substr(0, word.find('.'));
        const auto* found = std::find(names.begin(), names.end(), name);
        if (found == names.end())
            return fmt::format("has a field \"{}\"; fields are row, rank, bank, group, channel, column",
                               word);
        auto f = static_cast<Field>(found - names.begin());
        Named part{f, 0, name.size() == word.size()};
        if (part.rest) {
            ++rests[f];
        } else {
            std::string_view number = word.substr(name.size() + 1);
            auto [end, error] = std::from_chars(number.data(), number.data() + number.size(), part.bits);
            if (error != std::errc{} || end != number.data() + number.size() || part.bits > 63)
                return fmt::format("has a part \"{}\"; write its bits as in {}.2", word, name);
            if (part.bits > left[f])
                return fmt::format("gives {} more than its {} bits; shorten \"{}\"", name, widths(c)[f],
                                   word);
            left[f] -= part.bits;
        }
        named.push_back(part);
    }
    for (std::size_t f = 0; f < fields; ++f)
        if (rests[f] != 1)
            return fmt::format("names {} without a number {} times; name it so once", names[f], rests[f]);
    unsigned shift = bits_of(c.bus_bytes * c.burst_length);
    std::array<unsigned, fields> to{};
    for (auto p = named.rbegin(); p != named.rend(); ++p) {
        unsigned bits = p->rest ? left[p->field] : p->bits;
        if (bits != 0)
            parts.push_back({p->field, shift, (std::uint64_t{1} << bits) - 1, to[p->field]});
        to[p->field] += bits;
        shift += bits;
    }
    return shift > 63 ? fmt::format("makes addresses of {} bits; lower memory.rows", shift) : "";
}

std::string DramMapping::mistake(const MemoryConfig& config) {
    std::vector<Part> parts;
    return parse(config, parts);
}

DramMapping::DramMapping(const MemoryConfig& c) : row_bits_(bits_of(c.rows)) {
    parse(c, parts_);
    std::erase_if(parts_, [](const Part& p) { return p.field == column; });
    for (unsigned bits : widths(c))
        top_ += bits;
    top_ += bits_of(c.bus_bytes * c.burst_length);
    group_bits_ = bits_of(c.bank_groups);
    if (c.bank_xor == "on") {
        group_mask_ = static_cast<std::uint64_t>(c.bank_groups) - 1;
        bank_mask_ = static_cast<std::uint64_t>(c.banks) - 1;
    }
}

DramPlace DramMapping::locate(std::uint64_t address) const {
    std::array<std::uint64_t, fields> value{};
    for (const Part& p : parts_)
        value[p.field] |= ((address >> p.shift) & p.mask) << p.to;
    auto narrow = [](std::uint64_t x) { return static_cast<std::uint32_t>(x); };
    std::uint64_t r = value[row];
    return {r | address >> top_ << row_bits_, narrow(value[channel]), narrow(value[rank]),
            narrow(value[group] ^ (r & group_mask_)), narrow(value[bank] ^ (r >> group_bits_ & bank_mask_))};
}

} // namespace sim
