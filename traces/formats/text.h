// Text formats: lines in, lines out.
#pragma once

#include "traces/block_builder.h"
#include "traces/formats/format.h"

#include <optional>

namespace traces {

/// The next word of a line, which it leaves; empty: there is none.
std::string_view next_word(std::string_view& line);
/// The whole text as a number of the base; hexadecimal ones may begin with 0x.
std::optional<std::uint64_t> whole_number(std::string_view text, int base);

/// A file of lines. Where it says no times, a reference's is its number from 0 on.
class TextInput : public Input {
public:
    const Description& description() const final { return description_; }
    bool next(Block& block) final;

protected:
    explicit TextInput(std::unique_ptr<Source> source);
    /// One line without its end: add()s what it says.
    virtual void parse(std::string_view line) = 0;
    void add(const Reference& r) {
        builder_.add(r);
        ++count_;
    }
    std::uint64_t count() const { return count_; }
    const std::string& name() const { return source_->name(); }
    /// "FILE, line N: cause; mend".
    [[noreturn]] void refuse(std::string_view cause, std::string_view mend) const;
    /// A field as a number, or refuse().
    std::uint64_t number(std::string_view field, int base, const char* what,
                         std::uint64_t most = ~std::uint64_t{0}) const;

    Description description_;

private:
    bool line(std::string_view& line);

    std::unique_ptr<Source> source_;
    BlockBuilder builder_;
    std::string buffer_;
    std::size_t at_ = 0; // in the buffer
    std::uint64_t count_ = 0, line_ = 0;
    bool ended_ = false;
};

/// Lines are gathered before they are written.
class BufferedOutput : public Output {
public:
    void describe(const Description&) override {}
    void finish() override {
        flush();
        sink_->commit();
    }

protected:
    explicit BufferedOutput(std::unique_ptr<Sink> sink) : sink_(std::move(sink)) {}
    /// To be appended to.
    std::string& room() {
        if (buffer_.size() >= std::size_t{1} << 16)
            flush();
        return buffer_;
    }

private:
    void flush() {
        sink_->write(buffer_);
        buffer_.clear();
    }
    std::unique_ptr<Sink> sink_;
    std::string buffer_;
};

} // namespace traces
