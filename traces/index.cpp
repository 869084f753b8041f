#include "traces/index.h"

#include "traces/chunk.h"
#include "traces/error.h"
#include "traces/packed_text.h"
#include "traces/varint.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <fstream>

namespace traces {

using json = nlohmann::ordered_json;

std::string to_bytes(const Index& index) {
    json blocks = json::array();
    for (const IndexEntry& b : index.blocks)
        blocks.push_back({b.offset, b.references, b.first_time, b.last_time});
    const json out = {{"version", format_version},
                      {"references", index.references()},
                      {"by_kind", index.by_kind},
                      {"blocks", std::move(blocks)}};
    const std::string text = out.dump(-1, ' ', false, json::error_handler_t::replace);
    return pack(text);
}

Index index_from_bytes(const std::string& bytes, const std::string& place) {
    const auto refuse = [&](const char* why) {
        throw Error(fmt::format("{}: the index is damaged ({}); record or copy the file again", place, why));
    };
    const std::string text = unpack(bytes, "the index", place);
    Index index;
    try {
        const json in = json::parse(text);
        for (const json& b : in.at("blocks"))
            index.blocks.push_back({b.at(0), b.at(1), b.at(2), b.at(3)});
        index.version = in.value("version", std::uint32_t{0});
        const json& kinds = in.at("by_kind"); // earlier versions had less
        for (std::size_t k = 0; k < std::min(kinds.size(), index.by_kind.size()); ++k)
            index.by_kind[k] = kinds.at(k);
    } catch (const json::exception& e) {
        refuse(e.what());
    }
    return index;
}

std::optional<Index> read_index(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    std::string tail(tail_bytes, '\0');
    file.seekg(-static_cast<std::streamoff>(tail_bytes), std::ios::end);
    if (!file || !file.read(tail.data(), static_cast<std::streamsize>(tail.size())))
        return std::nullopt;
    const auto end = static_cast<std::uint64_t>(file.tellg()) - tail_bytes;
    const std::string where = tail.substr(chunk_header_bytes);
    const auto offset = fixed_at<std::uint64_t>(where.data());
    if (tail.substr(0, chunk_header_bytes) != chunk_header(tail_chunk, where) || offset > end ||
        end - offset < chunk_header_bytes || end - offset > most_chunk_bytes)
        return std::nullopt;
    std::string chunk(end - offset, '\0');
    file.seekg(static_cast<std::streamoff>(offset));
    if (!file.read(chunk.data(), static_cast<std::streamsize>(chunk.size())))
        return std::nullopt;
    const std::string bytes = chunk.substr(chunk_header_bytes);
    if (chunk.substr(0, chunk_header_bytes) != chunk_header(index_chunk, bytes))
        return std::nullopt;
    return index_from_bytes(bytes, path);
}

} // namespace traces
