// valgrind --tool=lackey --trace-mem=yes: "I  ADDRESS,SIZE", " L ADDRESS,SIZE" and likewise S and M;
// addresses hexadecimal, sizes decimal. What valgrind says otherwise ("==1234== ...") is skipped.
#include "traces/formats/text.h"

#include <fmt/format.h>

#include <iterator>

namespace traces {
namespace {

class LackeyInput final : public TextInput {
public:
    explicit LackeyInput(std::unique_ptr<Source> source) : TextInput(std::move(source)) {}

private:
    void parse(std::string_view line) override {
        const std::string_view word = next_word(line);
        if (word.empty() || word.starts_with("=="))
            return;
        Reference r;
        r.time = count();
        if (word == "I")
            r.what.kind = Kind::fetch;
        else if (word == "L")
            r.what.kind = Kind::read;
        else if (word == "S")
            r.what.kind = Kind::write;
        else if (word == "M")
            r.what.kind = Kind::modify;
        else
            refuse("begins with none of I, L, S, M", "write it by valgrind --tool=lackey --trace-mem=yes");
        const std::string_view place = next_word(line);
        const std::size_t comma = std::min(place.find(','), place.size());
        r.address = number(place.substr(0, comma), 16, "address");
        r.what.size = static_cast<std::uint32_t>(
            number(place.substr(std::min(comma + 1, place.size())), 10, "size", 0xFFFFFFFF));
        add(r);
    }
};

class LackeyOutput final : public BufferedOutput {
public:
    explicit LackeyOutput(std::unique_ptr<Sink> sink) : BufferedOutput(std::move(sink)) {}
    void write(const Reference& r) override {
        const char* label = r.what.kind == Kind::fetch    ? "I "
                            : r.what.kind == Kind::write  ? " S"
                            : r.what.kind == Kind::modify ? " M"
                                                          : " L";
        fmt::format_to(std::back_inserter(room()), "{} {:08x},{}\n", label, r.address, r.what.size);
    }
};

} // namespace

std::unique_ptr<Input> read_lackey(std::unique_ptr<Source> source) {
    return std::make_unique<LackeyInput>(std::move(source));
}
std::unique_ptr<Output> write_lackey(std::unique_ptr<Sink> sink) {
    return std::make_unique<LackeyOutput>(std::move(sink));
}

} // namespace traces
