// Bytes to files that are whole or not there (written under a temporary name, then renamed), and to standard
// output; compressed where the name ends so.
#pragma once

#include <cstddef>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace traces {

class Sink {
public:
    Sink() = default;
    Sink(const Sink&) = delete;
    Sink& operator=(const Sink&) = delete;
    virtual ~Sink() = default;

    /// Throws Error, Interrupted.
    virtual void write(std::string_view bytes) = 0;
    /// All is written: gives the file its name. Without it nothing is left of it. Throws Error.
    virtual void commit() = 0;
};

/// A file by its path, compressed by gzip, xz or zstd where it ends in .gz, .xz or .zst, or "-" for standard
/// output. Throws Error where it cannot be written.
std::unique_ptr<Sink> open_sink(const std::string& path);
/// Throws Error where two outputs are one file, or both standard output, or one is an input; empty names are
/// none.
void check_apart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);
struct OutputFile {
    std::string name, text;
};
/// Writes all before the first gets its name. Throws Error.
void write_files(const std::vector<OutputFile>& files);
/// All that was printed is written. Throws Error where it cannot be.
void finish_standard_output();
/// Into a string of the caller's, which outlives the sink.
std::unique_ptr<Sink> memory_sink(std::string& bytes);

} // namespace traces
