// libCacheSim's oracleGeneral: requests of 24 bytes each, little-endian: time in seconds (4), object (8), its
// size in bytes (4), and the number of the next request for the same object, from 1 on, -1 if there is none
// (8). That number is not read; to write it, the requests are kept until the end.
#include "traces/block_builder.h"
#include "traces/error.h"
#include "traces/formats/text.h"
#include "traces/io/interrupt.h"
#include "traces/varint.h"

#include <fmt/format.h>

#include <limits>
#include <unordered_map>

namespace traces {
namespace {

constexpr std::size_t record_bytes = 24, object_at = 4, size_at = 12;
constexpr std::size_t records_of_block = std::size_t{1} << 14;

class OracleGeneralInput final : public Input {
public:
    explicit OracleGeneralInput(std::unique_ptr<Source> source) : source_(std::move(source)) {
        description_.program = "unknown";
        description_.streams = {"thread 0"};
        description_.time = "seconds";
    }
    const Description& description() const override { return description_; }
    bool next(Block& block) override {
        std::string bytes(records_of_block * record_bytes, '\0');
        const std::size_t got = source_->read(bytes.data(), bytes.size());
        if (got % record_bytes != 0)
            throw Error(fmt::format(
                "{}, request {}: is cut off after {} of {} bytes; copy the file again, or "
                "give the right format by --from",
                source_->name(), count_ + got / record_bytes + 1, got % record_bytes, record_bytes));
        for (const char* at = bytes.data(); at != bytes.data() + got; at += record_bytes, ++count_)
            builder_.add({fixed_at<std::uint32_t>(at),
                          fixed_at<std::uint64_t>(at + object_at),
                          0,
                          {.size = fixed_at<std::uint32_t>(at + size_at)}});
        if (got != 0)
            builder_.take(block);
        return got != 0;
    }

private:
    std::unique_ptr<Source> source_;
    Description description_;
    BlockBuilder builder_;
    std::uint64_t count_ = 0;
};

class OracleGeneralOutput final : public BufferedOutput {
public:
    explicit OracleGeneralOutput(std::unique_ptr<Sink> sink) : BufferedOutput(std::move(sink)) {}
    void describe(const Description&) override {}
    void write(const Reference& r) override {
        if (r.time > std::numeric_limits<std::uint32_t>::max())
            throw Error(fmt::format("oraclegeneral: time {} of request {} does not fit 32 bits; record fewer "
                                    "cycles, or choose another format",
                                    r.time, requests_.size() + 1));
        requests_.push_back({r.address, static_cast<std::uint32_t>(r.time), r.what.size});
    }
    void finish() override {
        std::vector<std::int64_t> next(requests_.size());
        std::unordered_map<std::uint64_t, std::int64_t> after;
        for (std::size_t i = requests_.size(); i-- > 0;) {
            check_interrupts();
            std::int64_t& number = after.try_emplace(requests_[i].object, -1).first->second;
            next[i] = number;
            number = static_cast<std::int64_t>(i) + 1;
        }
        for (std::size_t i = 0; i < requests_.size(); ++i) {
            std::string& out = room();
            append_fixed(out, requests_[i].time);
            append_fixed(out, requests_[i].object);
            append_fixed(out, requests_[i].size);
            append_fixed(out, static_cast<std::uint64_t>(next[i]));
        }
        BufferedOutput::finish();
    }

private:
    struct Request {
        std::uint64_t object;
        std::uint32_t time, size;
    };
    std::vector<Request> requests_;
};

} // namespace

std::unique_ptr<Input> read_oracle_general(std::unique_ptr<Source> source) {
    return std::make_unique<OracleGeneralInput>(std::move(source));
}
std::unique_ptr<Output> write_oracle_general(std::unique_ptr<Sink> sink) {
    return std::make_unique<OracleGeneralOutput>(std::move(sink));
}

} // namespace traces
