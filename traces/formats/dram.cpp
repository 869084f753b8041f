// What simulators of memory read. DRAMsim3: "ADDRESS READ|WRITE CYCLE"; Ramulator's DRAM traces: "ADDRESS
// R|W". Addresses are hexadecimal.
#include "traces/formats/text.h"

#include <fmt/format.h>

#include <iterator>

namespace traces {
namespace {

class DramInput final : public TextInput {
public:
    DramInput(std::unique_ptr<Source> source, bool cycles) : TextInput(std::move(source)), cycles_(cycles) {
        description_.level = "dram";
        if (cycles_)
            description_.time = "clocks";
    }

private:
    void parse(std::string_view line) override {
        const std::string_view place = next_word(line);
        if (place.empty() || place.starts_with('#'))
            return;
        Reference r;
        r.address = number(place, 16, "address");
        const std::string_view word = next_word(line);
        if (word == "WRITE" || word == "W" || word == "write")
            r.what.kind = Kind::write;
        else if (word != "READ" && word != "R" && word != "read")
            refuse("says neither READ nor WRITE after its address",
                   cycles_ ? "write ADDRESS READ CYCLE" : "write ADDRESS R");
        r.time = cycles_ ? number(next_word(line), 10, "cycle") : count();
        add(r);
    }
    bool cycles_;
};

class DramOutput final : public BufferedOutput {
public:
    DramOutput(std::unique_ptr<Sink> sink, bool cycles) : BufferedOutput(std::move(sink)), cycles_(cycles) {}
    void write(const Reference& r) override {
        const bool write = r.what.kind == Kind::write;
        auto to = std::back_inserter(room());
        if (cycles_)
            fmt::format_to(to, "0x{:X} {} {}\n", r.address, write ? "WRITE" : "READ", r.time);
        else
            fmt::format_to(to, "0x{:x} {}\n", r.address, write ? 'W' : 'R');
    }

private:
    bool cycles_;
};

} // namespace

std::unique_ptr<Input> read_dramsim3(std::unique_ptr<Source> source) {
    return std::make_unique<DramInput>(std::move(source), true);
}
std::unique_ptr<Output> write_dramsim3(std::unique_ptr<Sink> sink) {
    return std::make_unique<DramOutput>(std::move(sink), true);
}
std::unique_ptr<Input> read_ramulator(std::unique_ptr<Source> source) {
    return std::make_unique<DramInput>(std::move(source), false);
}
std::unique_ptr<Output> write_ramulator(std::unique_ptr<Sink> sink) {
    return std::make_unique<DramOutput>(std::move(sink), false);
}

} // namespace traces
