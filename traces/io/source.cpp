#include "traces/io/source.h"

#include "traces/error.h"
#include "traces/io/decompress.h"
#include "traces/io/interrupt.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <unistd.h>
#include <utility>

namespace traces {
namespace {

class FileSource final : public Source {
public:
    explicit FileSource(const std::string& path) {
        name_ = path == "-" ? "standard input" : path;
        std::error_code ignored;
        if (path != "-" && std::filesystem::is_directory(path, ignored))
            throw Error(fmt::format("{}: is a folder; name a file", path));
        file_ = path == "-" ? STDIN_FILENO : open(path.c_str(), O_RDONLY | O_CLOEXEC); // NOLINT: as of POSIX
        if (file_ < 0) {
            check_interrupts(); // while it waited for who writes a pipe
            throw Error(fmt::format("{}: cannot be opened ({}); check the path", path, std::strerror(errno)));
        }
    }
    ~FileSource() override {
        if (file_ != STDIN_FILENO)
            close(file_);
    }
    std::size_t read(void* to, std::size_t most) override {
        std::size_t n = 0;
        while (n < most && !ended_) {
            check_interrupts();
            const ssize_t got = ::read(file_, static_cast<char*>(to) + n, most - n);
            if (got < 0 && errno != EINTR)
                throw Error(
                    fmt::format("{}: cannot be read ({}); check the disk", name_, std::strerror(errno)));
            ended_ = got == 0;
            n += got > 0 ? static_cast<std::size_t>(got) : 0;
        }
        return n;
    }

private:
    int file_ = -1;
    bool ended_ = false; // a terminal ends once
};

class MemorySource final : public Source {
public:
    MemorySource(std::string bytes, const std::string& name) : bytes_(std::move(bytes)) { name_ = name; }
    std::size_t read(void* to, std::size_t most) override {
        const std::size_t n = std::min(most, bytes_.size() - at_);
        std::memcpy(to, bytes_.data() + at_, n);
        at_ += n;
        return n;
    }

private:
    std::string bytes_;
    std::size_t at_ = 0;
};

} // namespace

PeekingSource::PeekingSource(std::unique_ptr<Source> source) : source_(std::move(source)) {
    name_ = source_->name();
}

std::size_t PeekingSource::read(void* to, std::size_t most) {
    const std::size_t n = std::min(most, ahead_.size());
    std::memcpy(to, ahead_.data(), n);
    ahead_.erase(0, n);
    return n == most ? n : n + source_->read(static_cast<char*>(to) + n, most - n);
}

const std::string& PeekingSource::peek(std::size_t wanted) {
    if (const std::size_t have = ahead_.size(); have < wanted) {
        ahead_.resize(wanted);
        ahead_.resize(have + source_->read(ahead_.data() + have, wanted - have));
    }
    return ahead_;
}

std::unique_ptr<Source> open_raw_source(const std::string& path) {
    return std::make_unique<FileSource>(path);
}

std::unique_ptr<PeekingSource> open_source(const std::string& path) {
    return decompressed(std::make_unique<PeekingSource>(open_raw_source(path)));
}

std::unique_ptr<PeekingSource> memory_source(std::string bytes, const std::string& name) {
    return decompressed(
        std::make_unique<PeekingSource>(std::make_unique<MemorySource>(std::move(bytes), name)));
}

} // namespace traces
