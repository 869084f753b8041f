// What a trace holds, in counts.
#pragma once

#include "traces/description.h"
#include "traces/reference.h"

#include <map>
#include <set>
#include <string>
#include <vector>

namespace traces {

class Summary {
public:
    void add(const Block& block);
    std::uint64_t references() const { return references_; }

    /// What the program says of the file besides: its format, its bytes as it lies there (0: unknown), and
    /// what is wrong with its end (empty: nothing).
    struct File {
        std::string name, format, note;
        std::uint64_t bytes = 0;
    };
    std::string text(const Description& description, const File& file) const;
    std::string json(const Description& description, const File& file) const;

private:
    using Counts = std::map<std::uint64_t, std::uint64_t>; // by number
    struct Row {
        std::string name;
        std::uint64_t count;
    };
    struct Table {
        const char* name;
        std::vector<Row> rows;
    };
    std::vector<Table> tables(const Description& description) const;

    std::uint64_t references_ = 0, bytes_ = 0, first_ = ~std::uint64_t{0}, last_ = 0;
    std::uint64_t for_tiles_ = 0; // references
    std::set<std::uint32_t> tiles_;
    Counts streams_, structures_, phases_, work_, kinds_;
};

} // namespace traces
