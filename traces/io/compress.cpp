#include "traces/io/compress.h"

#include <lzma.h>
#include <zlib.h>
#include <zstd.h>

#include <new>
#include <stdexcept>
#include <utility>
#include <vector>

namespace traces {
namespace {

/// What all three have in common: a step takes bytes and fills a buffer.
class Compressor : public Sink {
public:
    void write(std::string_view bytes) final {
        while (!bytes.empty())
            step(bytes, false);
    }
    void commit() final {
        std::string_view none;
        while (!step(none, true)) {
        }
        to_->commit();
    }

protected:
    explicit Compressor(std::unique_ptr<Sink> to) : to_(std::move(to)), buffer_(std::size_t{1} << 16) {}
    /// Takes some of the bytes, which are the last ones or not; sends on what it makes. Returns whether it
    /// has ended.
    virtual bool step(std::string_view& bytes, bool last) = 0;
    void send(std::size_t count) { to_->write({buffer_.data(), count}); }
    char* room() { return buffer_.data(); }
    std::size_t room_bytes() const { return buffer_.size(); }

private:
    std::unique_ptr<Sink> to_;
    std::vector<char> buffer_;
};

class Gzip final : public Compressor {
public:
    explicit Gzip(std::unique_ptr<Sink> to) : Compressor(std::move(to)) {
        if (deflateInit2(&z_, Z_DEFAULT_COMPRESSION, Z_DEFLATED, 15 + 16, 8, Z_DEFAULT_STRATEGY) != Z_OK)
            throw std::bad_alloc();
    }
    ~Gzip() override { deflateEnd(&z_); }

private:
    bool step(std::string_view& bytes, bool last) override {
        const std::size_t taken = std::min(bytes.size(), std::size_t{1} << 30);
        z_.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
        z_.avail_in = static_cast<uInt>(taken);
        z_.next_out = reinterpret_cast<Bytef*>(room());
        z_.avail_out = static_cast<uInt>(room_bytes());
        const int result = deflate(&z_, last ? Z_FINISH : Z_NO_FLUSH);
        bytes.remove_prefix(taken - z_.avail_in);
        send(room_bytes() - z_.avail_out);
        return result == Z_STREAM_END;
    }

    z_stream z_{};
};

class Xz final : public Compressor {
public:
    explicit Xz(std::unique_ptr<Sink> to) : Compressor(std::move(to)) {
        if (lzma_easy_encoder(&z_, LZMA_PRESET_DEFAULT, LZMA_CHECK_CRC64) != LZMA_OK)
            throw std::bad_alloc();
    }
    ~Xz() override { lzma_end(&z_); }

private:
    bool step(std::string_view& bytes, bool last) override {
        z_.next_in = reinterpret_cast<const std::uint8_t*>(bytes.data());
        z_.avail_in = bytes.size();
        z_.next_out = reinterpret_cast<std::uint8_t*>(room());
        z_.avail_out = room_bytes();
        const lzma_ret result = lzma_code(&z_, last ? LZMA_FINISH : LZMA_RUN);
        if (result != LZMA_OK && result != LZMA_STREAM_END)
            throw std::runtime_error("xz: cannot compress");
        bytes.remove_prefix(bytes.size() - z_.avail_in);
        send(room_bytes() - z_.avail_out);
        return result == LZMA_STREAM_END;
    }

    lzma_stream z_ = LZMA_STREAM_INIT;
};

class Zstd final : public Compressor {
public:
    explicit Zstd(std::unique_ptr<Sink> to) : Compressor(std::move(to)), context_(ZSTD_createCCtx()) {
        ZSTD_CCtx_setParameter(context_, ZSTD_c_checksumFlag, 1);
    }
    ~Zstd() override { ZSTD_freeCCtx(context_); }

private:
    bool step(std::string_view& bytes, bool last) override {
        ZSTD_inBuffer in{bytes.data(), bytes.size(), 0};
        ZSTD_outBuffer out{room(), room_bytes(), 0};
        const std::size_t left =
            ZSTD_compressStream2(context_, &out, &in, last ? ZSTD_e_end : ZSTD_e_continue);
        if (ZSTD_isError(left) != 0)
            throw std::runtime_error(ZSTD_getErrorName(left));
        bytes.remove_prefix(in.pos);
        send(out.pos);
        return last && left == 0;
    }

    ZSTD_CCtx* context_;
};

} // namespace

std::unique_ptr<Sink> compressing(std::unique_ptr<Sink> sink, const std::string& name) {
    if (name.ends_with(".gz"))
        return std::make_unique<Gzip>(std::move(sink));
    if (name.ends_with(".xz"))
        return std::make_unique<Xz>(std::move(sink));
    if (name.ends_with(".zst"))
        return std::make_unique<Zstd>(std::move(sink));
    return sink;
}

} // namespace traces
