// Reads a trace, block by block, from anything that gives bytes.
#pragma once

#include "traces/codec.h"
#include "traces/description.h"
#include "traces/index.h"
#include "traces/io/source.h"

#include <deque>
#include <exception>
#include <future>
#include <memory>
#include <vector>

namespace traces {

/// Chunks are read before their turn, and blocks among them decoded on threads of their own; all that they
/// say, of errors too, is said in their turn, as if nothing had been read ahead.
class Reader {
public:
    /// Blocks that are decoded before they are asked for, one a processor: more would be memory without use.
    static constexpr std::size_t most_ahead = 8;

    /// Reads the beginning. Throws Error where that is not a trace of this format.
    explicit Reader(std::unique_ptr<Source> source, std::size_t ahead = usual_ahead());

    /// Grows by names that the blocks read so far use.
    const Description& description() const { return description_; }
    /// Replaces `block` by the next one; false: there is none. A file that was cut off ends with its last
    /// whole block. Throws Error where bytes differ from what was written.
    bool next(Block& block);
    /// After the last block: whether the file is whole. If not, note() says so in a line.
    bool complete() const { return complete_; }
    const std::string& note() const { return note_; }
    /// Of chunks whose turn was.
    std::uint64_t bytes() const { return at_; }

private:
    static std::size_t usual_ahead();
    struct Chunk {
        std::string name, bytes;
        std::uint64_t begin = 0, end = 0; // in the file
        bool whole = false;               // else the file ends before it does
        std::exception_ptr error;         // of reading it
    };
    /// What a block needs to be decoded, wherever that is.
    struct Work {
        Decoder decoder;
        Block block;
        std::uint64_t first_time = 0, last_time = 0;
    };
    struct Coming {
        Chunk chunk;
        std::unique_ptr<Work> work; // of a block
        std::future<void> done;     // the last: it waits for who uses the rest
    };

    Chunk read_chunk();
    Chunk read_whole_chunk();
    void look_ahead();
    void begin_decoding(Coming& coming);
    void take(Coming& coming, Block& block);
    void see(const Chunk& chunk);
    std::string text(const Chunk& chunk, const char* what) const;
    void check_index(const Chunk& chunk);
    std::string place(std::uint64_t at) const;

    std::unique_ptr<Source> source_;
    std::size_t ahead_;
    Description description_;
    std::uint64_t read_ = 0, at_ = 0; // bytes: that were read, whose turn was
    std::uint32_t version_ = 0;
    Index seen_; // what was read
    bool ended_ = false, complete_ = false;
    std::string note_;
    std::vector<std::unique_ptr<Work>> idle_;
    std::deque<Coming> coming_; // blocks, and at most one chunk that is none, the last
};

} // namespace traces
