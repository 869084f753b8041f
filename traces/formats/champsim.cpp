// ChampSim's traces of instructions, 64 bytes each, little-endian: address of the instruction (8 bytes),
// whether it branches and did (1 + 1), registers (2 written, 4 read, a byte each), memory (2 written, 4 read,
// 8 bytes each); 0 is none. Read are the references to memory alone, time being the instruction's number;
// written is an instruction for each reference, at the address of its site or, of a site with a name, at
// 0x400000 + 4 x number.
#include "traces/block_builder.h"
#include "traces/error.h"
#include "traces/formats/text.h"

#include <fmt/format.h>

namespace traces {
namespace {

constexpr std::size_t record_bytes = 64, written_at = 16, read_at = 32, memory_bytes = 8;
constexpr std::size_t records_of_block = std::size_t{1} << 14;

std::uint64_t number_at(const char* bytes) {
    std::uint64_t out = 0;
    for (std::size_t i = 0; i < 8; ++i)
        out |= std::uint64_t{static_cast<unsigned char>(bytes[i])} << 8 * i;
    return out;
}
void put_at(char* bytes, std::uint64_t n) {
    for (std::size_t i = 0; i < 8; ++i)
        bytes[i] = static_cast<char>(n >> 8 * i & 0xFFU);
}

class ChampsimInput final : public Input {
public:
    explicit ChampsimInput(std::unique_ptr<Source> source) : source_(std::move(source)) {
        description_.program = "unknown";
        description_.streams = {"thread 0"};
        description_.time = "instructions";
        description_.site_addresses = true;
    }
    const Description& description() const override { return description_; }
    bool next(Block& block) override {
        std::string bytes(records_of_block * record_bytes, '\0');
        while (builder_.size() == 0) {
            const std::size_t got = source_->read(bytes.data(), bytes.size());
            if (got % record_bytes != 0)
                throw Error(fmt::format("{}, instruction {}: is cut off after {} of 64 bytes; copy the file "
                                        "again, or give the right format by --from",
                                        source_->name(), count_ + got / record_bytes, got % record_bytes));
            if (got == 0)
                return false;
            for (const char* at = bytes.data(); at != bytes.data() + got; at += record_bytes)
                instruction(at);
        }
        builder_.take(block);
        return true;
    }

private:
    void instruction(const char* bytes) {
        if (const auto branch = static_cast<unsigned char>(bytes[8]) | static_cast<unsigned char>(bytes[9]);
            branch > 1)
            throw Error(fmt::format("{}, instruction {}: says neither that it branches nor that it does not; "
                                    "give the right format by --from",
                                    source_->name(), count_));
        for (std::size_t at = read_at; at < record_bytes; at += memory_bytes)
            add(bytes, at, Kind::read);
        for (std::size_t at = written_at; at < read_at; at += memory_bytes)
            add(bytes, at, Kind::write);
        ++count_;
    }
    void add(const char* bytes, std::size_t at, Kind kind) {
        const std::uint64_t address = number_at(bytes + at);
        if (address != 0)
            builder_.add({count_, address, 0, {.site = number_at(bytes), .kind = kind}});
    }

    std::unique_ptr<Source> source_;
    Description description_;
    BlockBuilder builder_;
    std::uint64_t count_ = 0; // of instructions
};

class ChampsimOutput final : public BufferedOutput {
public:
    explicit ChampsimOutput(std::unique_ptr<Sink> sink) : BufferedOutput(std::move(sink)) {}
    void describe(const Description& d) override { addresses_ = d.site_addresses; }
    void write(const Reference& r) override {
        std::array<char, record_bytes> bytes{};
        put_at(bytes.data(), addresses_ ? r.what.site : 0x400000 + 4 * r.what.site);
        put_at(bytes.data() + (r.what.kind == Kind::write ? written_at : read_at), r.address);
        room().append(bytes.data(), bytes.size());
    }

private:
    bool addresses_ = false;
};

} // namespace

std::unique_ptr<Input> read_champsim(std::unique_ptr<Source> source) {
    return std::make_unique<ChampsimInput>(std::move(source));
}
std::unique_ptr<Output> write_champsim(std::unique_ptr<Sink> sink) {
    return std::make_unique<ChampsimOutput>(std::move(sink));
}

} // namespace traces
