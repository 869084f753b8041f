#include "traces/writer.h"

#include "traces/chunk.h"
#include "traces/packed_text.h"
#include "traces/varint.h"

#include <nlohmann/json.hpp>

#include <algorithm>

namespace traces {

Writer::Writer(std::unique_ptr<Sink> sink, const Description& description, std::optional<Coding> coding)
    : sink_(std::move(sink)), encoder_(coding.value_or(coding_for(description.level))) {
    std::string prologue(magic);
    append_fixed(prologue, format_version);
    sink_->write(prologue);
    at_ = prologue.size();
    chunk(head_chunk, pack(to_json(description)));
    tables_ = {description.structures.size(), description.phases.size(), description.work.size()};
}

void Writer::chunk(std::string_view name, std::string_view bytes) {
    sink_->write(chunk_header(name, bytes));
    sink_->write(bytes);
    at_ += chunk_header_bytes + bytes.size();
}

void Writer::add_sites(const std::vector<std::string>& names) {
    if (names.empty())
        return;
    chunk(names_chunk,
          pack(nlohmann::json(names).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace)));
}

void Writer::add_names(const Description& description) {
    const std::string names = names_since(tables_, description);
    if (!names.empty())
        chunk(tables_chunk, pack(names));
    tables_ = {description.structures.size(), description.phases.size(), description.work.size()};
}

void Writer::write(const Block& block) {
    if (block.size() == 0)
        return;
    const auto [first, last] = std::minmax_element(block.times.begin(), block.times.end());
    index_.blocks.push_back({at_, block.size(), *first, *last});
    std::vector<std::uint64_t> count(block.table.size(), 0);
    for (const std::uint32_t c : block.classes)
        ++count[c];
    for (std::size_t c = 0; c < count.size(); ++c)
        index_.by_kind[static_cast<std::size_t>(block.table[c].kind)] += count[c];
    bytes_.clear();
    encoder_.encode(block, bytes_);
    chunk(block_chunk, bytes_);
}

void Writer::finish() {
    const std::uint64_t offset = at_;
    chunk(index_chunk, to_bytes(index_));
    std::string where;
    append_fixed(where, offset);
    chunk(tail_chunk, where);
    sink_->commit();
}

} // namespace traces
