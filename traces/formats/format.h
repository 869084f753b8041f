// Formats of memory traces as streams of references: what reads one, what writes one, and the table of all.
#pragma once

#include "traces/codec.h"
#include "traces/description.h"
#include "traces/io/sink.h"
#include "traces/io/source.h"
#include "traces/reference.h"

#include <memory>
#include <span>
#include <string>
#include <string_view>

namespace traces {

class Input {
public:
    Input() = default;
    Input(const Input&) = delete;
    Input& operator=(const Input&) = delete;
    virtual ~Input() = default;

    /// What the file says of itself; grows by sites while it is read.
    virtual const Description& description() const = 0;
    /// Replaces `block` by the next references; false: there are none. Throws Error.
    virtual bool next(Block& block) = 0;
    /// After the last block: what of the file is not there, "FILE: ..." in a line; empty: nothing.
    virtual std::string note() const { return {}; }
};

class Output {
public:
    Output() = default;
    Output(const Output&) = delete;
    Output& operator=(const Output&) = delete;
    virtual ~Output() = default;

    /// The description, whose sites grow: before the first reference, and before those with new sites.
    virtual void describe(const Description& description) = 0;
    /// In order of time, or in that in which they were made if the format holds it. The kind is one that the
    /// format holds. Throws Error.
    virtual void write(const Reference& reference) = 0;
    /// A window, or the end, before the references that follow: of formats that hold the order.
    virtual void mark(const Turn& /*turn*/) {}
    /// All is written: gives the file its name. Throws Error.
    virtual void finish() = 0;
};

/// What of a reference a format holds besides its address.
struct Holds {
    bool time = false, streams = false, size = false, sites = false, names = false; // structure, phase, work
    std::array<bool, kind_names.size()> kinds{};                                    // by number
    bool parts = false; // of which operation a reference is, and the details of its class
    bool order =
        false; // in which all streams' references were made, and the windows in which streams went on
    bool tiles = false;          // of the picture
    bool description = false;    // what a trace says of itself
    std::string_view unit = "";  // of its times; empty: any
    std::string_view level = ""; // where all its references are seen; empty: anywhere
    bool zero = true;            // address 0 is one
    bool holds(Kind kind) const { return kinds[static_cast<std::size_t>(kind)]; }
};

struct Format {
    std::string_view name, meaning;
    std::string_view suffixes; // of file names, with spaces between: ".din .xdin"
    Holds holds;
    std::unique_ptr<Input> (*read)(std::unique_ptr<Source> source);
    std::unique_ptr<Output> (*write)(std::unique_ptr<Sink> sink);
};

/// All of them, our own first.
std::span<const Format> formats();
/// By its name: "din". Throws Error, which begins with `option`.
const Format& format_by_name(std::string_view option, std::string_view name);
/// By a file's name, also if it ends in .gz, .xz or .zst; null: unknown.
const Format* format_by_suffix(std::string_view path);
/// By a name if there is one, else by the first bytes, else by the file's name. Throws Error.
const Format& format_of_input(std::string_view name, const std::string& path, PeekingSource& source);
/// By a name if there is one, else by the file's name. Throws Error.
const Format& format_of_output(std::string_view name, const std::string& path);

/// Of a file that is written as this project's own: throws Error where its name is another format's.
void check_own_name(const std::string& path);

std::unique_ptr<Input> read_own(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_own(std::unique_ptr<Sink> sink);
std::unique_ptr<Output> write_own(std::unique_ptr<Sink> sink, Coding coding);
std::unique_ptr<Input> read_din(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_din(std::unique_ptr<Sink> sink);
std::unique_ptr<Input> read_csv(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_csv(std::unique_ptr<Sink> sink);
std::unique_ptr<Input> read_lackey(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_lackey(std::unique_ptr<Sink> sink);
std::unique_ptr<Input> read_dramsim3(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_dramsim3(std::unique_ptr<Sink> sink);
std::unique_ptr<Input> read_ramulator(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_ramulator(std::unique_ptr<Sink> sink);
std::unique_ptr<Input> read_champsim(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_champsim(std::unique_ptr<Sink> sink);
std::unique_ptr<Input> read_oracle_general(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_oracle_general(std::unique_ptr<Sink> sink);
std::unique_ptr<Input> read_drmemtrace(std::unique_ptr<Source> source);
std::unique_ptr<Output> write_drmemtrace(std::unique_ptr<Sink> sink);

} // namespace traces
