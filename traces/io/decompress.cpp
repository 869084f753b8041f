#include "traces/io/decompress.h"

#include "traces/error.h"

#include <fmt/format.h>
#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

#include <cstdint>
#include <string_view>
#include <utility>
#include <vector>

namespace traces {
namespace {

constexpr std::size_t chunk = std::size_t{1} << 16;
constexpr std::uint64_t most_memory = std::uint64_t{256} << 20; // of a decoder's window

/// What all three have in common: compressed bytes come in chunks, a step turns some of them into others.
class Decompressor : public Source {
public:
    std::size_t read(void* to, std::size_t most) final {
        std::size_t made = 0;
        while (made < most && !ended_) {
            if (in_ == in_end_) {
                in_ = buffer_.data();
                in_end_ = in_ + from_->read(buffer_.data(), buffer_.size());
            }
            const std::uint8_t* in_before = in_;
            const std::size_t before = made;
            step(static_cast<std::uint8_t*>(to), made, most);
            if (in_ == in_before && made == before && in_ == in_end_)
                end();
        }
        return made;
    }

protected:
    Decompressor(std::unique_ptr<Source> from, const char* kind)
        : from_(std::move(from)), kind_(kind), buffer_(chunk) {
        name_ = from_->name();
        in_ = in_end_ = buffer_.data();
    }
    /// Takes from [in_, in_end_), which is empty at the end, and writes to `to` from `made` to `most`.
    virtual void step(std::uint8_t* to, std::size_t& made, std::size_t most) = 0;
    [[noreturn]] void damaged(const char* why) const {
        throw Error(fmt::format("{}: the {} data are damaged ({}); copy the file again", name_, kind_, why));
    }
    bool whole_ = false; // nothing is missing if the bytes end here

    const std::uint8_t *in_ = nullptr, *in_end_ = nullptr;

private:
    void end() {
        if (!whole_)
            throw Error(fmt::format("{}: the {} data end too early; copy the file again", name_, kind_));
        ended_ = true;
    }

    std::unique_ptr<Source> from_;
    const char* kind_;
    std::vector<std::uint8_t> buffer_;
    bool ended_ = false;
};

class Gzip final : public Decompressor {
public:
    explicit Gzip(std::unique_ptr<Source> from) : Decompressor(std::move(from), "gzip") {
        if (inflateInit2(&z_, 15 + 16) != Z_OK)
            throw std::bad_alloc();
    }
    ~Gzip() override { inflateEnd(&z_); }

private:
    void step(std::uint8_t* to, std::size_t& made, std::size_t most) override {
        if (whole_) { // another member may follow, or zeros that fill up a block of a tape up to the end
            for (; in_ != in_end_ && *in_ == 0; ++in_)
                padded_ = true;
            if (in_ == in_end_)
                return;
            if (padded_)
                damaged("something follows zeros behind its end");
            inflateReset(&z_);
            whole_ = false;
        }
        z_.next_in = const_cast<std::uint8_t*>(in_);
        z_.avail_in = static_cast<uInt>(in_end_ - in_);
        z_.next_out = to + made;
        const std::size_t room = std::min(most - made, chunk);
        z_.avail_out = static_cast<uInt>(room);
        const int result = inflate(&z_, Z_NO_FLUSH);
        made += room - z_.avail_out;
        in_ = z_.next_in;
        if (result == Z_STREAM_END)
            whole_ = true;
        else if (result != Z_OK && result != Z_BUF_ERROR)
            damaged(z_.msg != nullptr ? z_.msg : "not of this format");
    }

    z_stream z_{};
    bool padded_ = false; // zeros were met behind a member
};

class Xz final : public Decompressor {
public:
    explicit Xz(std::unique_ptr<Source> from) : Decompressor(std::move(from), "xz") {
        if (lzma_stream_decoder(&z_, most_memory, LZMA_CONCATENATED) != LZMA_OK)
            throw std::bad_alloc();
    }
    ~Xz() override { lzma_end(&z_); }

private:
    void step(std::uint8_t* to, std::size_t& made, std::size_t most) override {
        z_.next_in = in_;
        z_.avail_in = static_cast<std::size_t>(in_end_ - in_);
        z_.next_out = to + made;
        z_.avail_out = most - made;
        const lzma_ret result = lzma_code(&z_, in_ == in_end_ ? LZMA_FINISH : LZMA_RUN);
        made = most - z_.avail_out;
        in_ = z_.next_in;
        if (result == LZMA_STREAM_END)
            whole_ = true;
        else if (result == LZMA_MEMLIMIT_ERROR)
            damaged("they ask for more than 256 MiB of memory");
        else if (result != LZMA_OK && result != LZMA_BUF_ERROR)
            damaged("not of this format");
    }

    lzma_stream z_ = LZMA_STREAM_INIT;
};

class Zstd final : public Decompressor {
public:
    explicit Zstd(std::unique_ptr<Source> from)
        : Decompressor(std::move(from), "zstd"), context_(ZSTD_createDCtx()) {
        ZSTD_DCtx_setParameter(context_, ZSTD_d_windowLogMax, 28); // most_memory
    }
    ~Zstd() override { ZSTD_freeDCtx(context_); }

private:
    void step(std::uint8_t* to, std::size_t& made, std::size_t most) override {
        ZSTD_inBuffer in{in_, static_cast<std::size_t>(in_end_ - in_), 0};
        ZSTD_outBuffer out{to, most, made};
        const std::size_t result = ZSTD_decompressStream(context_, &out, &in);
        if (ZSTD_isError(result) != 0)
            damaged(ZSTD_getErrorName(result));
        if (in.pos != 0 || out.pos != made)
            whole_ = result == 0;
        made = out.pos;
        in_ += in.pos;
    }

    ZSTD_DCtx* context_;
};

} // namespace

std::unique_ptr<PeekingSource> decompressed(std::unique_ptr<PeekingSource> source) {
    using std::string_view_literals::operator""sv;
    const std::string first = source->peek(6);
    std::unique_ptr<Source> out;
    if (first.starts_with("\x1f\x8b"sv))
        out = std::make_unique<Gzip>(std::move(source));
    else if (first.starts_with("\xfd"
                               "7zXZ\0"sv))
        out = std::make_unique<Xz>(std::move(source));
    else if (first.starts_with("\x28\xb5\x2f\xfd"sv))
        out = std::make_unique<Zstd>(std::move(source));
    else
        return source;
    return std::make_unique<PeekingSource>(std::move(out));
}

} // namespace traces
