// DynamoRIO's drmemtrace as its tool `view` prints it, a record a line:
//   RECORD INSTRUCTION: THREAD ifetch       SIZE byte(s) @ 0xADDRESS ...
//   RECORD INSTRUCTION: THREAD read         SIZE byte(s) @ 0xADDRESS by PC 0xADDRESS
// likewise `write` and several kinds of prefetch (pref...). Read threads are numbers, or W0.T1234 of
// workloads. Flushes of lines (dflush, iflush) keep what is written, which no kind of ours says: they are
// left out, as are markers and what an instruction does.
#include "traces/formats/text.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace traces {
namespace {

constexpr std::string_view rule = "------------------------------------------------------------\n";
constexpr std::uint64_t first_site = 0x400000, site_step = 4; // addresses for sites that have names

class DrmemtraceInput final : public TextInput {
public:
    explicit DrmemtraceInput(std::unique_ptr<Source> source) : TextInput(std::move(source)) {
        description_.site_addresses = true;
        description_.streams.clear();
    }
    std::string note() const override {
        return flushes_ == 0 ? "" : fmt::format("{}: {} flushes of lines are left out", name(), flushes_);
    }

private:
    void parse(std::string_view line) override {
        // Further bytes of a long instruction stand far to the right below it.
        if (line.empty() || line.starts_with("----") || line.find_first_not_of(' ') >= 24 ||
            line.starts_with("Output format") || line.starts_with("<--record#->") ||
            line.starts_with("View tool results"))
            return;
        number(next_word(line), 10, "number of a record");
        std::string_view instruction = next_word(line);
        if (instruction == ":") // a total at the end
            return;
        if (!instruction.ends_with(':'))
            refuse("is no record of drmemtrace", "write it by drrun -t drmemtrace -tool view");
        instruction.remove_suffix(1);
        number(instruction, 10, "number of an instruction");
        Reference r;
        r.time = count();
        r.stream = thread(next_word(line));
        const std::string_view name = next_word(line);
        if (name.starts_with('<'))
            return;
        if (name == "dflush" || name == "iflush") {
            ++flushes_;
            return;
        }
        r.what.kind = name == "ifetch"           ? Kind::fetch
                      : name == "write"          ? Kind::write
                      : name.starts_with("pref") ? Kind::prefetch
                                                 : Kind::read;
        if (r.what.kind == Kind::read && name != "read")
            refuse("is of no kind that there is", "kinds are ifetch, read, write, pref..., dflush, iflush");
        r.what.size = static_cast<std::uint32_t>(number(next_word(line), 10, "size", 0xFFFFFFFF));
        if (next_word(line) != "byte(s)" || next_word(line) != "@")
            refuse("has no address", "write it by drrun -t drmemtrace -tool view");
        r.address = number(next_word(line), 16, "address");
        if (r.what.kind != Kind::fetch) {
            if (next_word(line) != "by" || next_word(line) != "PC")
                refuse("does not say by which instruction", "write it by drrun -t drmemtrace -tool view");
            r.what.site = number(next_word(line), 16, "address of an instruction");
        }
        add(r);
    }
    /// Of workloads, their numbers above 24 bits.
    std::uint32_t thread(std::string_view word) const {
        std::uint64_t workload = 0;
        if (const std::size_t dot = word.find(".T"); word.starts_with('W') && dot != std::string_view::npos) {
            workload = number(word.substr(1, dot - 1), 10, "workload", 0xFF);
            word.remove_prefix(dot + 2);
        }
        const std::uint64_t most = workload == 0 ? 0xFFFFFFFF : 0xFFFFFF;
        return static_cast<std::uint32_t>(workload << 24U | number(word, 10, "thread", most));
    }

    std::uint64_t flushes_ = 0;
};

class DrmemtraceOutput final : public BufferedOutput {
public:
    explicit DrmemtraceOutput(std::unique_ptr<Sink> sink) : BufferedOutput(std::move(sink)) {}
    void describe(const Description& d) override {
        addresses_ = d.site_addresses;
        if (records_ == 0 && !begun_)
            room() += fmt::format(
                "Output format:\n<--record#-> <--instr#->: <---tid---> <record details>\n{}", rule);
        begun_ = true;
    }
    void write(const Reference& r) override {
        if (records_ != 0 && r.stream != stream_)
            room() += rule;
        stream_ = r.stream;
        const Kind kind = r.what.kind;
        instructions_ += kind == Kind::fetch ? 1 : 0;
        const char* name = kind == Kind::fetch      ? "ifetch"
                           : kind == Kind::write    ? "write"
                           : kind == Kind::prefetch ? "pref"
                                                    : "read";
        auto to = std::back_inserter(room());
        fmt::format_to(to, "{:12}{:12}: {:11} {:<12}{:2} byte(s) @ 0x{:016x}", ++records_, instructions_,
                       r.stream, name, r.what.size, r.address);
        if (kind == Kind::fetch)
            fmt::format_to(to, " non-branch\n");
        else
            fmt::format_to(to, " by PC 0x{:016x}\n",
                           addresses_ || r.what.site == 0 ? r.what.site
                                                          : first_site + site_step * r.what.site);
    }

private:
    bool addresses_ = false, begun_ = false;
    std::uint64_t records_ = 0, instructions_ = 0;
    std::uint32_t stream_ = 0;
};

} // namespace

std::unique_ptr<Input> read_drmemtrace(std::unique_ptr<Source> source) {
    return std::make_unique<DrmemtraceInput>(std::move(source));
}
std::unique_ptr<Output> write_drmemtrace(std::unique_ptr<Sink> sink) {
    return std::make_unique<DrmemtraceOutput>(std::move(sink));
}

} // namespace traces
