#include "tests/fuzz/target.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t max_size);

/// Whatever seeds are refused would teach nothing.
extern "C" int LLVMFuzzerInitialize(int*, char***) {
    for (const std::string& seed : fuzz::seeds()) {
        const bool read = fuzz::try_bytes(seed);
        if (!read || !fuzz::refusal.empty()) {
            std::fprintf(stderr, "a seed is refused: %s\n%s\n", fuzz::refusal.c_str(), seed.c_str());
            std::abort();
        }
    }
    return 0;
}

extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t max_size,
                                               unsigned int seed) {
    if (size <= 1 || seed % 512 == 0) {
        const std::string& bytes = fuzz::seeds()[seed / 512 % fuzz::seeds().size()];
        size = std::min(bytes.size(), max_size);
        std::memcpy(data, bytes.data(), size);
        if (seed % 2 == 0)
            return size;
    }
    return LLVMFuzzerMutate(data, size, max_size);
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    return fuzz::try_bytes({reinterpret_cast<const char*>(data), size}) ? 0 : -1;
}

namespace fuzz {

File::File(std::string_view name, std::string_view bytes) {
    // In memory where that can be: files are written thousands of times a second.
    const std::filesystem::path memory = "/dev/shm";
    const auto base = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
    std::string folder = (base / "fuzz_XXXXXX").string();
    require(mkdtemp(folder.data()) != nullptr);
    folder_ = folder;
    path_ = folder_ + "/" + std::string(name);
    if (!bytes.empty())
        write(bytes);
}

File::~File() {
    std::error_code ignored;
    std::filesystem::remove_all(folder_, ignored);
}

void File::write(std::string_view bytes) const {
    write_beside(std::filesystem::path(path_).filename().string(), bytes);
}

void File::write_beside(std::string_view name, std::string_view bytes) const {
    std::ofstream out(std::filesystem::path(folder_) / name, std::ios::binary | std::ios::trunc);
    out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    require(static_cast<bool>(out));
}

} // namespace fuzz
