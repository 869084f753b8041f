// Reads a trace, block by block, from anything that gives bytes.
#pragma once

#include "traces/codec.h"
#include "traces/description.h"
#include "traces/index.h"
#include "traces/io/source.h"

#include <memory>

namespace traces {

class Reader {
public:
    /// Reads the beginning. Throws Error where that is not a trace of this format.
    explicit Reader(std::unique_ptr<Source> source);

    /// Grows by names that the blocks read so far use.
    const Description& description() const { return description_; }
    /// Replaces `block` by the next one; false: there is none. A file that was cut off ends with its last
    /// whole block. Throws Error where bytes differ from what was written.
    bool next(Block& block);
    /// After the last block: whether the file is whole. If not, note() says so in a line.
    bool complete() const { return complete_; }
    const std::string& note() const { return note_; }
    std::uint64_t bytes() const { return at_; }

private:
    bool read_chunk();
    std::string text(const char* what) const;
    void check_index();
    std::string place() const;

    std::unique_ptr<Source> source_;
    Description description_;
    Decoder decoder_;
    std::string name_, bytes_; // of the chunk at hand
    std::uint64_t at_ = 0;
    std::uint32_t version_ = 0;
    Index seen_; // what was read
    bool ended_ = false, complete_ = false;
    std::string note_;
};

} // namespace traces
