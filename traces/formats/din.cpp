// Dinero IV (Edler and Hill): "LABEL ADDRESS [SIZE]", a line a reference. Labels 0 or r read, 1 or w write, 2
// or i fetch of an instruction; 3 or m (unknown), 4 or c (copy back) and 5 or v (invalidate) are read as
// read, write_back and flush; they are not written, as older Dineros do not know them. Addresses are
// hexadecimal, sizes decimal as in traces of x86 programs.
#include "traces/formats/text.h"

#include <fmt/format.h>

#include <iterator>

namespace traces {
namespace {

class DinInput final : public TextInput {
public:
    explicit DinInput(std::unique_ptr<Source> source) : TextInput(std::move(source)) {}

private:
    void parse(std::string_view line) override {
        const std::string_view label = next_word(line);
        if (label.empty())
            return;
        constexpr std::string_view digits = "012345", letters = "rwimcv", capitals = "RWIMCV";
        std::size_t n = label.size() == 1 ? digits.find(label[0]) : std::string_view::npos;
        if (n == std::string_view::npos && label.size() == 1)
            n = std::min(letters.find(label[0]), capitals.find(label[0]));
        if (n == std::string_view::npos)
            refuse("begins with no label of Dinero's", "labels are 0 to 5 or r, w, i, m, c, v");
        constexpr Kind kinds[] = {Kind::read, Kind::write,      Kind::fetch,
                                  Kind::read, Kind::write_back, Kind::flush};
        Reference r;
        r.time = count();
        r.what.kind = kinds[n];
        r.address = number(next_word(line), 16, "address");
        if (const std::string_view size = next_word(line); !size.empty())
            r.what.size = static_cast<std::uint32_t>(number(size, 10, "size", 0xFFFFFFFF));
        add(r);
    }
};

class DinOutput final : public BufferedOutput {
public:
    explicit DinOutput(std::unique_ptr<Sink> sink) : BufferedOutput(std::move(sink)) {}
    void write(const Reference& r) override {
        const int label = r.what.kind == Kind::write ? 1 : r.what.kind == Kind::fetch ? 2 : 0;
        auto to = std::back_inserter(room());
        if (r.what.size == 0)
            fmt::format_to(to, "{} {:x}\n", label, r.address);
        else
            fmt::format_to(to, "{} {:x} {}\n", label, r.address, r.what.size);
    }
};

} // namespace

std::unique_ptr<Input> read_din(std::unique_ptr<Source> source) {
    return std::make_unique<DinInput>(std::move(source));
}
std::unique_ptr<Output> write_din(std::unique_ptr<Sink> sink) {
    return std::make_unique<DinOutput>(std::move(sink));
}

} // namespace traces
