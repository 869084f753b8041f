// Output files that are whole or not there: written in the same folder without a name (or under a temporary
// one, where the file system can't do that), then named.
#pragma once

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

class OutputFile {
public:
    /// Opens a file beside `path`. Throws UserError where that is impossible.
    explicit OutputFile(const std::filesystem::path& path);
    /// Nothing is left of it unless it was committed.
    ~OutputFile();
    OutputFile(const OutputFile&) = delete;
    OutputFile& operator=(const OutputFile&) = delete;

    void write(const void* bytes, std::size_t count);
    void seek(std::uint64_t position);
    std::uint64_t position();
    /// Closes the file and gives it its name. Throws UserError, for example where the disk is full, or was
    /// when something before failed.
    void commit();

private:
    [[noreturn]] void fail(std::string_view action);

    /// Of the first that failed: libraries that write in destructors may have passed over its exception.
    std::string failure_;
    std::filesystem::path path_, temporary_;
    std::FILE* file_ = nullptr;
    bool nameless_ = false;
};

/// Throws UserError if a file could not be written to `path` later: wrong kind of file, no such folder, no
/// permission.
void check_writable(const std::filesystem::path& path);

/// Throws UserError where two of them are one file; empty names are none.
void check_apart(const std::vector<std::filesystem::path>& outputs);

/// Writes a text file, whole or not at all.
void write_text_file(const std::filesystem::path& path, std::string_view text);

/// Likewise of nlohmann::json. What is no UTF-8 in names of files is replaced: readers of JSON refuse it.
template <class Json> void write_json_file(const std::filesystem::path& path, const Json& json) {
    write_text_file(path, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

} // namespace razor
