// What all fuzz targets do: a run without a corpus starts from seeds of the target's own, and whatever the
// bytes, they are read or refused in one line.
#pragma once

#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

namespace fuzz {

/// Of a target: small sound inputs of every kind.
const std::vector<std::string>& seeds();
/// Of a target: reads the bytes, requires what must hold of what was read. False: they are not worth keeping.
bool try_bytes(std::string_view bytes);

inline void require(bool condition) {
    if (!condition)
        std::abort();
}

/// Why the last input that was refused was; empty: none was yet.
inline std::string refusal;

/// A mistake of the user's is one line that begins with the file's name.
inline void require_line(std::string_view message, std::string_view begin = "fuzz") {
    refusal = message;
    require(message.starts_with(begin));
    require(message.find_first_of("\n\r") == std::string_view::npos);
}

/// A file of this process, removed when it ends: for readers that open files themselves.
class File {
public:
    /// `name`: without folders.
    explicit File(std::string_view name, std::string_view bytes = {});
    ~File();
    File(const File&) = delete;
    File& operator=(const File&) = delete;

    /// Puts the bytes there.
    void write(std::string_view bytes) const;
    /// Puts other bytes beside it.
    void write_beside(std::string_view name, std::string_view bytes) const;
    const std::string& path() const { return path_; }
    const std::string& folder() const { return folder_; }

private:
    std::string folder_, path_;
};

} // namespace fuzz
