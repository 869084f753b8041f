// The index at the end of a trace: where its blocks are, what they hold in all.
#pragma once

#include "traces/reference.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace traces {

struct IndexEntry {
    std::uint64_t offset = 0; // of the block's chunk, bytes from the file's beginning
    std::uint64_t references = 0, first_time = 0, last_time = 0;
    friend bool operator==(const IndexEntry&, const IndexEntry&) = default;
};

struct Index {
    std::vector<IndexEntry> blocks;
    std::array<std::uint64_t, kind_names.size()> by_kind{};
    std::uint32_t version = 0; // of the format, since version 7: the one at the beginning has no checksum

    std::uint64_t references() const {
        std::uint64_t n = 0;
        for (const IndexEntry& b : blocks)
            n += b.references;
        return n;
    }
    friend bool operator==(const Index&, const Index&) = default;
};

/// A chunk's bytes: JSON in a zstd frame.
std::string to_bytes(const Index& index);
/// Throws Error: "`place`: ...".
Index index_from_bytes(const std::string& bytes, const std::string& place);

/// Of an uncompressed file, by its end, without reading the rest; nothing where it is not whole. Throws
/// Error.
std::optional<Index> read_index(const std::string& path);

} // namespace traces
