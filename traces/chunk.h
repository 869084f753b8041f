// The frame of the format: chunks with a name, a length and a checksum. README.md has the whole picture.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace traces {

inline constexpr std::string_view magic{"\x89RZT\r\n\x1a\n", 8};
inline constexpr std::uint32_t format_version = 9, oldest_version = 1;
inline constexpr std::size_t prologue_bytes = 12;     // magic and version
inline constexpr std::size_t chunk_header_bytes = 16; // name, checksum, length
inline constexpr std::size_t tail_bytes = chunk_header_bytes + 8;

inline constexpr std::string_view head_chunk = "HEAD", names_chunk = "NAME", tables_chunk = "TABL",
                                  block_chunk = "BLCK", index_chunk = "INDX", tail_chunk = "TAIL";
/// The most bytes of a chunk of ours: a block is far smaller, a description or index as well.
inline constexpr std::uint64_t most_chunk_bytes = std::uint64_t{64} << 20;

/// CRC-32 of a chunk's name, length and bytes, as zlib's crc32 gives it.
std::uint32_t checksum(std::string_view name, std::string_view bytes);
/// The chunk's header.
std::string chunk_header(std::string_view name, std::string_view bytes);

} // namespace traces
