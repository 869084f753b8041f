// Where an address lies in the memory: channel, rank, bank group, bank, row, column, by named fields of
// address bits. A mapping names the fields above the bytes of a burst, most significant first, joined by
// colons: "row:rank:bank:column:group:channel:column.1". A field may stand in several parts; a part with a
// number is that many bits wide, one part of each field has none and takes the rest.
// Not modelled: an end of memory (bits above all fields make further rows), spare rows, ECC.
#pragma once

#include "sim/config/config.h"

#include <cstdint>
#include <string>
#include <vector>

namespace sim {

struct DramPlace {
    std::uint64_t row = 0;
    std::uint32_t channel = 0, rank = 0, group = 0, bank = 0; // bank: within its group
};

class DramMapping {
public:
    /// The configuration has passed check_consistency.
    explicit DramMapping(const MemoryConfig& config);

    DramPlace locate(std::uint64_t address) const;
    /// What is wrong with memory.mapping and how to mend it, or an empty string.
    static std::string mistake(const MemoryConfig& config);

private:
    enum Field { row, rank, bank, group, channel, column, fields };
    struct Part {
        Field field;
        unsigned shift; // in the address
        std::uint64_t mask;
        unsigned to; // in the field
    };
    static std::string parse(const MemoryConfig& config, std::vector<Part>& parts);

    std::vector<Part> parts_;
    unsigned top_ = 0, row_bits_ = 0, group_bits_ = 0;
    std::uint64_t group_mask_ = 0, bank_mask_ = 0; // of the row's bits that bank_xor folds in
};

} // namespace sim
