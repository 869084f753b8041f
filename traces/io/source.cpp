#include "traces/io/source.h"

#include "traces/error.h"
#include "traces/io/decompress.h"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
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
        file_ = path == "-" ? stdin : std::fopen(path.c_str(), "rb");
        if (file_ == nullptr)
            throw Error(fmt::format("{}: cannot be opened ({}); check the path", path, std::strerror(errno)));
    }
    ~FileSource() override {
        if (file_ != stdin)
            std::fclose(file_);
    }
    std::size_t read(void* to, std::size_t most) override {
        const std::size_t n = std::fread(to, 1, most, file_);
        if (n < most && std::ferror(file_) != 0)
            throw Error(fmt::format("{}: cannot be read ({}); check the disk", name_, std::strerror(errno)));
        return n;
    }

private:
    std::FILE* file_ = nullptr;
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
