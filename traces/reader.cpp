#include "traces/reader.h"

#include "traces/chunk.h"
#include "traces/error.h"
#include "traces/packed_text.h"
#include "traces/varint.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace traces {

Reader::Reader(std::unique_ptr<Source> source) : source_(std::move(source)) {
    std::string prologue(prologue_bytes, '\0');
    prologue.resize(source_->read(prologue.data(), prologue.size()));
    if (prologue.empty())
        throw Error(fmt::format("{}: is empty; record the trace again", source_->name()));
    if (!prologue.starts_with(magic) || prologue.size() < prologue_bytes)
        throw Error(fmt::format("{}: is no trace of razor-trace; say what it is (--from)", source_->name()));
    version_ = fixed_at<std::uint32_t>(prologue.data() + magic.size());
    if (version_ < oldest_version || version_ > format_version)
        throw Error(
            fmt::format("{}: has version {} of the format, and this program reads versions {} to {}; use the "
                        "program that wrote it",
                        source_->name(), version_, oldest_version, format_version));
    at_ = prologue_bytes;
    if (!read_chunk())
        throw Error(fmt::format("{}: ends within its description; record the trace again", source_->name()));
    if (name_ != head_chunk)
        throw Error(
            fmt::format("{}: does not begin with a description; record the trace again", source_->name()));
    description_ = description_from_json(text("the description"), source_->name());
}

std::string Reader::place() const {
    return fmt::format("{}: byte {}", source_->name(), at_);
}

/// Of the chunk at hand; those before version 4 are as they are.
std::string Reader::text(const char* what) const {
    return version_ < 4 ? bytes_ : unpack(bytes_, what, place());
}

/// Reads the next chunk; false: the file ends before it is whole.
bool Reader::read_chunk() {
    char header[chunk_header_bytes];
    const std::size_t got = source_->read(header, sizeof header);
    if (got < sizeof header)
        return false;
    name_.assign(header, 4);
    const auto length = fixed_at<std::uint64_t>(header + 8);
    if (length > most_chunk_bytes)
        throw Error(fmt::format("{}: a part claims {} bytes, which none has; the file is damaged, record or "
                                "copy it again",
                                place(), length));
    bytes_.clear();
    constexpr std::size_t step = std::size_t{1} << 20; // memory follows what is really there
    while (bytes_.size() < length) {
        const std::size_t before = bytes_.size(), want = std::min<std::size_t>(step, length - before);
        bytes_.resize(before + want);
        const std::size_t part = source_->read(bytes_.data() + before, want);
        if (part < want)
            return false;
    }
    if (checksum(name_, bytes_) != fixed_at<std::uint32_t>(header + 4))
        throw Error(
            fmt::format("{}: the checksum is wrong; the file is damaged, record or copy it again", place()));
    at_ += chunk_header_bytes + length;
    return true;
}

bool Reader::next(Block& block) {
    while (!ended_) {
        const std::uint64_t begin = at_;
        if (!read_chunk()) {
            ended_ = true;
            note_ = fmt::format("{}: was cut off; it has {} whole blocks, {} references", source_->name(),
                                seen_.blocks.size(), seen_.references());
        } else if (name_ == names_chunk) {
            try {
                const auto names =
                    nlohmann::json::parse(text("a list of sites")).get<std::vector<std::string>>();
                description_.sites.insert(description_.sites.end(), names.begin(), names.end());
            } catch (const nlohmann::json::exception& e) {
                throw Error(fmt::format("{}: a list of sites is damaged ({}); record the trace again",
                                        place(), e.what()));
            }
        } else if (name_ == tables_chunk) {
            add_names(description_, text("a list of names"), place());
        } else if (name_ == block_chunk) {
            decoder_.decode(bytes_,
                            {description_.structures.size(), description_.phases.size(),
                             description_.work.size(),
                             description_.site_addresses ? ~std::uint64_t{0} : description_.sites.size(),
                             description_.picture.tiles()},
                            version_, fmt::format("{}: byte {}", source_->name(), begin), block);
            const auto [first, last] = std::minmax_element(block.times.begin(), block.times.end());
            seen_.blocks.push_back({begin, block.size(), *first, *last});
            return true;
        } else if (name_ == index_chunk) {
            check_index();
        } else if (name_ == tail_chunk) {
            ended_ = true;
            if (!complete_)
                throw Error(fmt::format("{}: ends without its index; record the trace again", place()));
        }
    }
    block.clear();
    return false;
}

void Reader::check_index() {
    const Index index = index_from_bytes(bytes_, place());
    if (index.blocks != seen_.blocks)
        throw Error(fmt::format(
            "{}: the index has {} blocks, {} references, but the file {}, {}; the file is "
            "damaged, copy it again",
            place(), index.blocks.size(), index.references(), seen_.blocks.size(), seen_.references()));
    complete_ = true;
}

} // namespace traces
