#include "traces/chunk.h"
#include "traces/error.h"
#include "traces/formats/format.h"

#include <fmt/format.h>

#include <algorithm>

namespace traces {
namespace {

// Kinds:                                               read  write modif fetch prefe w.bac w.thr flush
constexpr std::array<bool, kind_names.size()> all =
                                                  [] {
                                                      std::array<bool, kind_names.size()> a{};
                                                      a.fill(true);
                                                      return a;
                                                  }(),
                                              din = {true, true, false, true},
                                              lackey = {true, true, true, true}, plain = {true, true},
                                              requests = {true}, drmemtrace = {true, true, false, true, true};

// time, streams, size, sites, names, kinds, parts, order, tiles, description, unit
constexpr Format table[] = {
    {"rzt",
     "this project's own, by blocks",
     ".rzt",
     {true, true, true, true, true, all, true, true, true, true},
     read_own,
     write_own},
    {"din",
     "Dinero IV: label, hexadecimal address, size",
     ".din .xdin",
     {false, false, true, false, false, din},
     read_din,
     write_din},
    {"csv",
     "a row a reference, columns by name",
     ".csv",
     {true, true, true, true, true, all, true},
     read_csv,
     write_csv},
    {"lackey",
     "valgrind --tool=lackey --trace-mem=yes",
     ".lackey",
     {false, false, true, false, false, lackey},
     read_lackey,
     write_lackey},
    {"dramsim3",
     "DRAMsim3: address, READ or WRITE, clock of memory",
     ".dramsim3",
     {.time = true, .kinds = plain, .unit = "clocks", .level = "dram"},
     read_dramsim3,
     write_dramsim3},
    {"ramulator",
     "Ramulator's DRAM traces: address, R or W",
     ".ramulator",
     {.kinds = plain, .level = "dram"},
     read_ramulator,
     write_ramulator},
    {"champsim",
     "ChampSim: 64 bytes an instruction, as many as references",
     ".champsim .champsimtrace",
     {.sites = true, .kinds = plain, .zero = false},
     read_champsim,
     write_champsim},
    {"oraclegeneral",
     "libCacheSim's oracleGeneral: 24 bytes a request for an object",
     ".oracleGeneral .oracleGeneral.bin",
     {.time = true, .size = true, .kinds = requests, .unit = "seconds"},
     read_oracle_general,
     write_oracle_general},
    {"drmemtrace",
     "DynamoRIO's drmemtrace as its tool `view` prints it",
     ".drmemtrace .view",
     {false, true, true, true, false, drmemtrace},
     read_drmemtrace,
     write_drmemtrace},
};

std::string names() {
    std::string out;
    for (const Format& f : table)
        out += (out.empty() ? "" : ", ") + std::string(f.name);
    return out;
}

} // namespace

std::span<const Format> formats() {
    return table;
}

const Format& format_by_name(std::string_view option, std::string_view name) {
    const auto* const found =
        std::find_if(std::begin(table), std::end(table), [&](const Format& f) { return f.name == name; });
    if (found == std::end(table))
        throw Error(fmt::format("{} {}: there is no such format; choose of {}", option, name, names()));
    return *found;
}

const Format* format_by_suffix(std::string_view path) {
    for (const std::string_view packed : {".gz", ".xz", ".zst"})
        if (path.ends_with(packed)) {
            path.remove_suffix(packed.size());
            break;
        }
    for (const Format& f : table)
        for (std::string_view rest = f.suffixes; !rest.empty();) {
            const std::size_t end = std::min(rest.find(' '), rest.size());
            if (path.ends_with(rest.substr(0, end)))
                return &f;
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
    return nullptr;
}

const Format& format_of_input(std::string_view name, const std::string& path, PeekingSource& source) {
    const Format* const given = name.empty() ? nullptr : &format_by_name("--from", name);
    if (source.peek(1).empty())
        throw Error(fmt::format("{}: is empty; record the trace again", source.name()));
    if (given != nullptr)
        return *given;
    if (source.peek(magic.size()).starts_with(magic))
        return table[0];
    if (const Format* f = format_by_suffix(path))
        return *f;
    throw Error(fmt::format("{}: its format shows neither in its name nor at its beginning; say which by "
                            "--from: {}",
                            source.name(), names()));
}

const Format& format_of_output(std::string_view name, const std::string& path) {
    if (!name.empty())
        return format_by_name("--to", name);
    if (const Format* f = format_by_suffix(path))
        return *f;
    throw Error(fmt::format("{}: its name does not show a format; say which by --to: {}",
                            path == "-" ? "standard output" : path, names()));
}

void check_own_name(const std::string& path) {
    const Format* const named = format_by_suffix(path);
    if (named != nullptr && named != &table[0])
        throw Error(fmt::format("{}: is a name of {}'s, and what is recorded is this project's own; name a "
                                ".rzt file, of which razor-trace convert makes others",
                                path, named->name));
}

} // namespace traces
