#include "traces/formats/text.h"

#include "traces/error.h"

#include <fmt/format.h>

#include <charconv>

namespace traces {
namespace {

constexpr std::size_t chunk = std::size_t{1} << 16, longest_line = chunk;
constexpr std::size_t references_of_block = std::size_t{1} << 16;

/// Of strange bytes a message shows that they are strange.
std::string shown(std::string_view text) {
    std::string out;
    for (const char c : text.substr(0, 40))
        out += c >= ' ' && c <= '~' ? c : '?';
    return text.size() > 40 ? out + "..." : out;
}

} // namespace

std::string_view next_word(std::string_view& line) {
    const std::size_t begin = std::min(line.find_first_not_of(" \t"), line.size());
    const std::size_t end = std::min(line.find_first_of(" \t", begin), line.size());
    const std::string_view word = line.substr(begin, end - begin);
    line.remove_prefix(end);
    return word;
}

std::optional<std::uint64_t> whole_number(std::string_view text, int base) {
    if (base == 16 && (text.starts_with("0x") || text.starts_with("0X")))
        text.remove_prefix(2);
    std::uint64_t out = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out, base);
    if (error != std::errc{} || end != text.data() + text.size())
        return std::nullopt;
    return out;
}

TextInput::TextInput(std::unique_ptr<Source> source) : source_(std::move(source)) {
    description_.program = "unknown";
    description_.streams = {"thread 0"};
}

void TextInput::refuse(std::string_view cause, std::string_view mend) const {
    throw Error(fmt::format("{}, line {}: {}; {}", source_->name(), line_, cause, mend));
}

std::uint64_t TextInput::number(std::string_view field, int base, const char* what,
                                std::uint64_t most) const {
    const std::optional<std::uint64_t> n = whole_number(field, base);
    if (!n || *n > most)
        refuse(fmt::format("'{}' is no {}", shown(field), what),
               fmt::format("give {} number up to {:#x}, or the right format by --from",
                           base == 16 ? "a hexadecimal" : "a decimal", most));
    return *n;
}

bool TextInput::line(std::string_view& line) {
    for (std::size_t searched = at_;;) {
        const std::size_t end = buffer_.find('\n', searched);
        if (end != std::string::npos || ended_) {
            if (at_ == buffer_.size())
                return false;
            const std::size_t stop = std::min(end, buffer_.size());
            line = std::string_view(buffer_).substr(at_, stop - at_);
            at_ = std::min(stop + 1, buffer_.size());
            ++line_;
            if (line.ends_with('\r'))
                line.remove_suffix(1);
            return true;
        }
        if (buffer_.size() - at_ > longest_line) {
            ++line_;
            refuse("has no end within 64 KiB", "this is no text trace; give its format by --from");
        }
        buffer_.erase(0, at_);
        at_ = 0;
        searched = buffer_.size();
        buffer_.resize(searched + chunk);
        const std::size_t got = source_->read(buffer_.data() + searched, chunk);
        buffer_.resize(searched + got);
        ended_ = got < chunk;
    }
}

bool TextInput::next(Block& block) {
    std::string_view text;
    while (builder_.size() < references_of_block && line(text))
        parse(text);
    if (builder_.size() == 0)
        return false;
    builder_.take(block);
    return true;
}

} // namespace traces
