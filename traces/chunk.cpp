#include "traces/chunk.h"

#include "traces/varint.h"

#include <zlib.h>

namespace traces {
namespace {

std::uint32_t continued(std::uint32_t crc, std::string_view bytes) {
    return static_cast<std::uint32_t>(
        crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

} // namespace

std::uint32_t checksum(std::string_view name, std::string_view bytes) {
    std::string length;
    append_fixed(length, std::uint64_t{bytes.size()});
    return continued(continued(continued(0, name), length), bytes);
}

std::string chunk_header(std::string_view name, std::string_view bytes) {
    std::string out(name);
    append_fixed(out, checksum(name, bytes));
    append_fixed(out, std::uint64_t{bytes.size()});
    return out;
}

} // namespace traces
