// Bytes from files, pipes and standard input; those of gzip, xz and zstd are decompressed, by their content.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>

namespace traces {

class Source {
public:
    Source() = default;
    Source(const Source&) = delete;
    Source& operator=(const Source&) = delete;
    virtual ~Source() = default;

    /// Fills `to` with the next `most` bytes, fewer where they end. Throws Error, Interrupted.
    virtual std::size_t read(void* to, std::size_t most) = 0;
    /// What to call it in messages.
    const std::string& name() const { return name_; }

protected:
    std::string name_;
};

/// The next bytes of a source without taking them; afterwards it still gives all.
class PeekingSource final : public Source {
public:
    explicit PeekingSource(std::unique_ptr<Source> source);
    std::size_t read(void* to, std::size_t most) override;
    /// The next bytes, at least `wanted` unless fewer are left.
    const std::string& peek(std::size_t wanted);

private:
    std::unique_ptr<Source> source_;
    std::string ahead_;
};

/// A file by its path, or "-" for standard input. Throws Error where it cannot be read.
std::unique_ptr<Source> open_raw_source(const std::string& path);
/// ... decompressed.
std::unique_ptr<PeekingSource> open_source(const std::string& path);
/// Bytes in memory.
std::unique_ptr<PeekingSource> memory_source(std::string bytes, const std::string& name);

} // namespace traces
