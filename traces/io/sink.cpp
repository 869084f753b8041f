#include "traces/io/sink.h"

#include "traces/error.h"
#include "traces/io/compress.h"
#include "traces/io/interrupt.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <set>
#include <sys/stat.h>
#include <unistd.h>

namespace traces {
namespace {

namespace fs = std::filesystem;

class FileSink final : public Sink {
public:
    explicit FileSink(const std::string& path) : path_(path) {
        std::error_code ignored;
        if (fs::is_symlink(path_, ignored) && fs::is_regular_file(path_, ignored)) // it stays a link
            path_ = fs::canonical(path_, ignored);
        const fs::file_status status = fs::status(path_, ignored);
        if (fs::exists(status) && !fs::is_regular_file(status)) {
            if (fs::is_directory(status))
                throw Error(fmt::format("{}: is a folder; name a file", path));
            temporary_ = path_; // a pipe or device is written as it is
            file_ = std::fopen(temporary_.c_str(), "wb");
        } else {
            temporary_ = path_;
            temporary_ += fmt::format(".part{}", getpid());
            file_ = nameless(path_.has_parent_path() ? path_.parent_path() : fs::path("."));
            nameless_ = file_ != nullptr;
            if (!nameless_) // file systems of all kinds
                file_ = std::fopen(temporary_.c_str(), "wb");
        }
        if (file_ == nullptr) {
            check_interrupts(); // while it waited for who reads a pipe
            throw Error(
                fmt::format("{}: cannot be written ({}); check the folder", path, std::strerror(errno)));
        }
    }
    ~FileSink() override {
        if (file_ != nullptr)
            std::fclose(file_);
        std::error_code ignored;
        if (!committed_ && temporary_ != path_ && !nameless_)
            fs::remove(temporary_, ignored);
    }
    void write(std::string_view bytes) override {
        check_interrupts();
        if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size())
            fail();
    }
    void commit() override {
        if (std::fflush(file_) != 0)
            fail();
        std::error_code none;
        if (nameless_) // left by a killed process of the same number
            fs::remove(temporary_, none);
        if (nameless_ && linkat(AT_FDCWD, fmt::format("/proc/self/fd/{}", fileno(file_)).c_str(), AT_FDCWD,
                                temporary_.c_str(), AT_SYMLINK_FOLLOW) != 0)
            fail();
        nameless_ = false;
        const int closed = std::fclose(file_);
        file_ = nullptr;
        if (closed != 0)
            fail();
        std::error_code error;
        if (temporary_ != path_)
            fs::rename(temporary_, path_, error);
        if (error)
            throw Error(
                fmt::format("{}: cannot be named ({}); check the folder", path_.string(), error.message()));
        committed_ = true;
    }

private:
    /// A file in a folder that has no name yet, so that nothing is left of it whatever ends the program;
    /// null: the file system has none of these.
    static std::FILE* nameless(const fs::path& folder) {
        if (access("/proc/self/fd", X_OK) != 0) // by which it gets its name
            return nullptr;
        const int file = open(folder.c_str(), O_TMPFILE | O_WRONLY | O_CLOEXEC, 0666); // NOLINT: as of POSIX
        return file < 0 ? nullptr : fdopen(file, "wb");
    }
    [[noreturn]] void fail() const {
        check_interrupts();
        throw Error(
            fmt::format("{}: cannot be written ({}); check the disk", path_.string(), std::strerror(errno)));
    }

    fs::path path_, temporary_;
    std::FILE* file_ = nullptr;
    bool committed_ = false, nameless_ = false;
};

class StandardOutput final : public Sink {
public:
    void write(std::string_view bytes) override {
        check_interrupts();
        if (std::fwrite(bytes.data(), 1, bytes.size(), stdout) != bytes.size())
            fail();
    }
    void commit() override {
        if (std::fflush(stdout) != 0)
            fail();
    }

    [[noreturn]] static void fail() {
        check_interrupts();
        throw Error(
            fmt::format("standard output: cannot be written ({}); check who reads it", std::strerror(errno)));
    }
};

class MemorySink final : public Sink {
public:
    explicit MemorySink(std::string& bytes) : bytes_(bytes) {}
    void write(std::string_view bytes) override { bytes_ += bytes; }
    void commit() override {}

private:
    std::string& bytes_;
};

/// By another name, say /dev/stdout: a new file in its place would be lost.
bool is_standard_output(const std::string& path) {
    struct stat file, standard; // NOLINT: as of POSIX
    return stat(path.c_str(), &file) == 0 && fstat(STDOUT_FILENO, &standard) == 0 && S_ISREG(file.st_mode) &&
           file.st_dev == standard.st_dev && file.st_ino == standard.st_ino;
}

} // namespace

std::unique_ptr<Sink> open_sink(const std::string& path) {
    if (path == "-" || is_standard_output(path))
        return std::make_unique<StandardOutput>();
    return compressing(std::make_unique<FileSink>(path), path);
}

void check_apart(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs) {
    std::set<fs::path> seen;
    for (const std::string& output : outputs) {
        if (output.empty())
            continue;
        std::error_code error;
        const fs::path name =
            output == "-" ? fs::path(output) : fs::weakly_canonical(fs::absolute(output), error);
        if (!seen.insert(error ? fs::path(output) : name).second)
            throw Error(output == "-"
                            ? std::string("-: standard output is for one; name files for others")
                            : fmt::format("{}: is the name of two outputs; name two files", output));
        for (const std::string& input : inputs)
            if (output != "-" && fs::is_regular_file(output, error) && fs::equivalent(output, input, error))
                throw Error(fmt::format("{}: is read; name another output", output));
    }
}

void write_files(const std::vector<OutputFile>& files) {
    std::vector<std::unique_ptr<Sink>> sinks;
    for (const OutputFile& file : files)
        sinks.push_back(open_sink(file.name));
    for (std::size_t i = 0; i < files.size(); ++i)
        sinks[i]->write(files[i].text);
    for (const std::unique_ptr<Sink>& sink : sinks)
        sink->commit();
}

void finish_standard_output() {
    if (std::fflush(stdout) != 0 || std::ferror(stdout) != 0)
        StandardOutput::fail();
}

std::unique_ptr<Sink> memory_sink(std::string& bytes) {
    return std::make_unique<MemorySink>(bytes);
}

} // namespace traces
