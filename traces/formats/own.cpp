// This project's format, between other formats.
#include "traces/block_builder.h"
#include "traces/formats/format.h"
#include "traces/reader.h"
#include "traces/writer.h"

#include <optional>

namespace traces {
namespace {

class OwnInput final : public Input {
public:
    explicit OwnInput(std::unique_ptr<Source> source) : reader_(std::move(source)) {}
    const Description& description() const override { return reader_.description(); }
    bool next(Block& block) override { return reader_.next(block); }
    std::string note() const override { return reader_.note(); }

private:
    Reader reader_;
};

class OwnOutput final : public Output {
public:
    OwnOutput(std::unique_ptr<Sink> sink, std::optional<Coding> coding)
        : sink_(std::move(sink)), coding_(coding) {}
    void describe(const Description& d) override {
        if (!writer_)
            writer_.emplace(std::move(sink_), d, coding_);
        writer_->add_names(d);
        if (d.sites.size() == sites_)
            return;
        writer_->add_sites({d.sites.begin() + static_cast<std::ptrdiff_t>(sites_), d.sites.end()});
        sites_ = d.sites.size();
    }
    void write(const Reference& r) override {
        if (!BlockBuilder::continues(r.what) || builder_.full())
            begin_block_if_full();
        builder_.add(r);
    }
    void mark(const Turn& turn) override {
        if (turn.what != Turn::What::end) // which belongs to what was before
            begin_block_if_full();
        builder_.mark(turn);
    }
    void finish() override {
        write_block();
        writer_->finish();
    }

private:
    static constexpr std::size_t references_of_block = std::size_t{1} << 18;
    void begin_block_if_full() {
        if (builder_.size() >= references_of_block || (builder_.size() != 0 && builder_.idle()))
            write_block();
    }
    void write_block() {
        builder_.take(block_);
        writer_->write(block_);
    }

    std::unique_ptr<Sink> sink_;
    std::optional<Coding> coding_;
    std::optional<Writer> writer_;
    std::size_t sites_ = 0;
    BlockBuilder builder_;
    Block block_;
};

} // namespace

std::unique_ptr<Input> read_own(std::unique_ptr<Source> source) {
    return std::make_unique<OwnInput>(std::move(source));
}
std::unique_ptr<Output> write_own(std::unique_ptr<Sink> sink) {
    return std::make_unique<OwnOutput>(std::move(sink), std::nullopt);
}
std::unique_ptr<Output> write_own(std::unique_ptr<Sink> sink, Coding coding) {
    return std::make_unique<OwnOutput>(std::move(sink), coding);
}

} // namespace traces
