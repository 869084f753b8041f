// From one format to another, block by block, and what the other cannot hold.
#pragma once

#include "traces/formats/format.h"

namespace traces {

class Conversion {
public:
    Conversion(Input& input, Output& output, const Holds& holds)
        : input_(input), output_(output), holds_(holds) {}

    /// Converts the next block; false: there was none, and the output is not finished yet. Throws Error.
    bool step();
    std::uint64_t read() const { return read_; }
    std::uint64_t written() const { return written_; }
    /// What the target does not have of what the input had, as a part of a sentence; empty: nothing.
    std::string lost() const;

private:
    void convert(Reference r);

    Input& input_;
    Output& output_;
    Holds holds_;
    Block block_;
    std::uint64_t read_ = 0, written_ = 0, zeros_ = 0; // zeros: references to address 0 that are left out
    bool streams_ = false, size_ = false, sites_ = false, names_ = false, parts_ = false, windows_ = false,
         tiles_ = false; // met
    std::array<std::uint64_t, kind_names.size()> replaced_{}, left_out_{};
};

} // namespace traces
