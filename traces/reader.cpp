#include "traces/reader.h"

#include "traces/chunk.h"
#include "traces/error.h"
#include "traces/packed_text.h"
#include "traces/varint.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <system_error>
#include <thread>
#include <utility>

namespace traces {

std::size_t Reader::usual_ahead() {
    return std::clamp<std::size_t>(std::thread::hardware_concurrency(), 1, most_ahead);
}

Reader::Reader(std::unique_ptr<Source> source, std::size_t ahead)
    : source_(std::move(source)), ahead_(ahead) {
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
    at_ = read_ = prologue_bytes;
    const Chunk chunk = read_chunk();
    if (chunk.error)
        std::rethrow_exception(chunk.error);
    if (!chunk.whole)
        throw Error(fmt::format("{}: ends within its description; record the trace again", source_->name()));
    if (chunk.name != head_chunk)
        throw Error(
            fmt::format("{}: does not begin with a description; record the trace again", source_->name()));
    at_ = chunk.end;
    description_ = description_from_json(text(chunk, "the description"), source_->name());
}

std::string Reader::place(std::uint64_t at) const {
    return fmt::format("{}: byte {}", source_->name(), at);
}

/// Those before version 4 are as they are.
std::string Reader::text(const Chunk& chunk, const char* what) const {
    return version_ < 4 ? chunk.bytes : unpack(chunk.bytes, what, place(chunk.end));
}

/// The next chunk; not whole: the file ends before it is.
Reader::Chunk Reader::read_whole_chunk() {
    Chunk chunk;
    char header[chunk_header_bytes];
    const std::size_t got = source_->read(header, sizeof header);
    if (got < sizeof header)
        return chunk;
    chunk.name.assign(header, 4);
    const auto length = fixed_at<std::uint64_t>(header + 8);
    if (length > most_chunk_bytes)
        throw Error(fmt::format("{}: a part claims {} bytes, which none has; the file is damaged, record or "
                                "copy it again",
                                place(read_), length));
    constexpr std::size_t step = std::size_t{1} << 20; // memory follows what is really there
    while (chunk.bytes.size() < length) {
        const std::size_t before = chunk.bytes.size(), want = std::min<std::size_t>(step, length - before);
        chunk.bytes.resize(before + want);
        const std::size_t part = source_->read(chunk.bytes.data() + before, want);
        if (part < want)
            return chunk;
    }
    if (checksum(chunk.name, chunk.bytes) != fixed_at<std::uint32_t>(header + 4))
        throw Error(fmt::format("{}: the checksum is wrong; the file is damaged, record or copy it again",
                                place(read_)));
    chunk.begin = read_;
    chunk.end = read_ += chunk_header_bytes + length;
    chunk.whole = true;
    return chunk;
}

Reader::Chunk Reader::read_chunk() {
    try {
        return read_whole_chunk();
    } catch (...) {
        Chunk chunk;
        chunk.error = std::current_exception();
        return chunk;
    }
}

/// Blocks, as many as may be ahead, up to what is none: that may give names, which later ones use.
void Reader::look_ahead() {
    while (coming_.size() < ahead_ && (coming_.empty() || coming_.back().work)) {
        Coming& next = coming_.emplace_back();
        next.chunk = read_chunk();
        if (next.chunk.whole && next.chunk.name == block_chunk)
            begin_decoding(next);
    }
}

void Reader::begin_decoding(Coming& coming) {
    if (idle_.empty()) {
        coming.work = std::make_unique<Work>();
    } else {
        coming.work = std::move(idle_.back());
        idle_.pop_back();
    }
    const Decoder::Limits limits{description_.structures.size(), description_.phases.size(),
                                 description_.work.size(),
                                 description_.site_addresses ? ~std::uint64_t{0} : description_.sites.size(),
                                 description_.picture.tiles()};
    const auto decode = [this, &coming, limits] {
        Work& w = *coming.work;
        w.decoder.decode(coming.chunk.bytes, limits, version_, place(coming.chunk.begin), w.block);
        const auto [first, last] = std::minmax_element(w.block.times.begin(), w.block.times.end());
        w.first_time = *first;
        w.last_time = *last;
    };
    if (ahead_ > 1)
        try {
            coming.done = std::async(std::launch::async, decode);
            return;
        } catch (const std::system_error&) { // no thread is to be had: when it is asked for
        }
    coming.done = std::async(std::launch::deferred, decode);
}

bool Reader::next(Block& block) {
    while (!ended_) {
        look_ahead();
        Coming& coming = coming_.front();
        if (coming.work) {
            take(coming, block);
            return true;
        }
        const Chunk chunk = std::move(coming.chunk);
        coming_.pop_front();
        if (chunk.error)
            std::rethrow_exception(chunk.error);
        see(chunk);
    }
    block.clear();
    return false;
}

/// Of the first of those that come.
void Reader::take(Coming& coming, Block& block) {
    coming.done.wait();
    std::future<void> done = std::exchange(coming.done, {});
    const std::uint64_t begin = coming.chunk.begin;
    at_ = coming.chunk.end;
    std::unique_ptr<Work> work = std::move(coming.work);
    coming_.pop_front();
    idle_.push_back(std::move(work));
    done.get();
    Work& w = *idle_.back();
    std::swap(block, w.block);
    seen_.blocks.push_back({begin, block.size(), w.first_time, w.last_time});
}

/// What is no block.
void Reader::see(const Chunk& chunk) {
    if (!chunk.whole) {
        ended_ = true;
        note_ = fmt::format("{}: was cut off; it has {} whole blocks, {} references", source_->name(),
                            seen_.blocks.size(), seen_.references());
        return;
    }
    at_ = chunk.end;
    if (chunk.name == names_chunk) {
        try {
            const auto names =
                nlohmann::json::parse(text(chunk, "a list of sites")).get<std::vector<std::string>>();
            description_.sites.insert(description_.sites.end(), names.begin(), names.end());
        } catch (const nlohmann::json::exception& e) {
            throw Error(fmt::format("{}: a list of sites is damaged ({}); record the trace again", place(at_),
                                    e.what()));
        }
    } else if (chunk.name == tables_chunk) {
        add_names(description_, text(chunk, "a list of names"), place(at_));
    } else if (chunk.name == index_chunk) {
        check_index(chunk);
    } else if (chunk.name == tail_chunk) {
        ended_ = true;
        if (!complete_)
            throw Error(fmt::format("{}: ends without its index; record the trace again", place(at_)));
        std::uint8_t more = 0;
        if (source_->read(&more, 1) != 0)
            note_ =
                fmt::format("{}: more bytes follow the end of the trace; they are not read", source_->name());
    }
}

void Reader::check_index(const Chunk& chunk) {
    const Index index = index_from_bytes(chunk.bytes, place(at_));
    if (index.version != (version_ < 7 ? 0 : version_))
        throw Error(fmt::format("{}: the index is not of the version that the file begins with; the file is "
                                "damaged, copy it again",
                                place(at_)));
    if (index.blocks != seen_.blocks)
        throw Error(fmt::format(
            "{}: the index has {} blocks, {} references, but the file {}, {}; the file is "
            "damaged, copy it again",
            place(at_), index.blocks.size(), index.references(), seen_.blocks.size(), seen_.references()));
    complete_ = true;
}

} // namespace traces
