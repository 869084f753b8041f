// Whole traces in memory, for tests of the format.
#pragma once

#include "tests/traces/samples.h"
#include "traces/error.h"
#include "traces/reader.h"
#include "traces/writer.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace traces::test {

/// A trace of some blocks, what was put into it, and where blocks end.
struct Written {
    std::string bytes;
    std::vector<std::vector<Reference>> blocks; // in the order that blocks have
    std::vector<std::uint64_t> ends;            // of each block's chunk
};

inline Written write_sample(std::size_t blocks, std::size_t references) {
    Written out;
    Writer writer(memory_sink(out.bytes), small_description());
    writer.add_sites({"a:1", "b:2", "c:3", "d:4", "e:5"});
    BlockBuilder builder;
    Block block;
    for (std::size_t b = 0; b < blocks; ++b) {
        if (b == 1)
            writer.add_sites({"f:6", "g:7", "h:8", "i:9"});
        for (const Reference& r :
             with_tiles(mixed_references(references, static_cast<std::uint32_t>(b), b == 0 ? 5 : 9)))
            builder.add(r);
        builder.take(block);
        writer.write(block);
        out.blocks.push_back(references_of(block));
        out.ends.push_back(out.bytes.size());
    }
    writer.finish();
    EXPECT_EQ(writer.bytes(), out.bytes.size());
    return out;
}

/// What a reader makes of bytes.
struct Got {
    std::vector<std::vector<Reference>> blocks;
    bool complete = false;
    std::string note, error;
};
inline Got read_all(const std::string& bytes, std::size_t ahead = Reader::most_ahead) {
    Got got;
    try {
        Reader reader(memory_source(bytes, "sample"), ahead);
        Block block;
        while (reader.next(block))
            got.blocks.push_back(references_of(block));
        got.complete = reader.complete();
        got.note = reader.note();
    } catch (const Error& e) {
        got.error = e.what();
    }
    return got;
}

inline bool equal_blocks(const std::vector<Reference>& a, const std::vector<Reference>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), equal);
}

} // namespace traces::test
