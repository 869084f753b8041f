#include "traces/packed_text.h"

#include "traces/chunk.h"
#include "traces/error.h"

#include <fmt/format.h>
#include <zstd.h>

namespace traces {
namespace {

/// Texts are short, and written once: a short trace is hardly longer than they are.
constexpr int level = 19;

} // namespace

std::string pack(std::string_view text) {
    std::string bytes(ZSTD_compressBound(text.size()), '\0');
    bytes.resize(ZSTD_compress(bytes.data(), bytes.size(), text.data(), text.size(), level));
    return bytes;
}

std::string unpack(const std::string& bytes, const char* what, const std::string& place) {
    const auto refuse = [&](const char* why) {
        throw Error(fmt::format("{}: {} is damaged ({}); record or copy the file again", place, what, why));
    };
    const unsigned long long size = ZSTD_getFrameContentSize(bytes.data(), bytes.size());
    if (size > 4 * most_chunk_bytes)
        refuse("its length");
    std::string text(size, '\0');
    if (ZSTD_decompress(text.data(), text.size(), bytes.data(), bytes.size()) != size)
        refuse("it does not decompress");
    return text;
}

} // namespace traces
