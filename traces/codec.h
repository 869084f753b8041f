// A block as bytes and back (README.md says which).
#pragma once

#include "traces/block_layout.h"
#include "traces/reference.h"

#include <memory>
#include <string>

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace traces {

class ReferenceModel;

/// How references are written: as columns, which zstd makes smaller; or each predicted by what came before
/// (predicted.h), in five eighths of the room where hardly anything repeats itself, which takes some hundred
/// times as long.
enum class Coding { columns, predicted };
/// By Description::level: what L2s and later caches pass on is little, and repeats itself little.
Coding coding_for(const std::string& level);

class Encoder {
public:
    explicit Encoder(Coding coding = Coding::columns, int zstd_level = 3);
    ~Encoder();
    /// Appends the block to `out`. It holds at least one and at most most_references references.
    void encode(const Block& block, std::string& out);

private:
    struct Free {
        void operator()(ZSTD_CCtx_s* c) const;
    };
    void compress(const std::string& column, int level, std::string& out);
    char* put_leaving(const Block& block, const std::vector<std::uint32_t>& first_of, unsigned shift,
                      unsigned set_bits, char* to);
    void put_columns(const Block& block, const std::vector<std::uint32_t>& order,
                     const std::vector<std::uint32_t>& rank, unsigned shift, unsigned set_bits);

    std::unique_ptr<ZSTD_CCtx_s, Free> context_;
    std::unique_ptr<ReferenceModel> model_; // where it is needed
    int level_;
    std::string table_, classes_, addresses_, times_, order_, tiles_; // columns
    // By reference: numbers in the table that is written; whether it leaves a cache for the next one.
    std::vector<std::uint32_t> ranks_;
    std::vector<char> makes_room_;
    ByClass by_class_;
};

class Decoder {
public:
    Decoder();
    ~Decoder();
    /// How many names a trace has of each.
    struct Limits {
        std::size_t structures, phases, work;
        std::uint64_t sites;     // the last number; unbounded where they are addresses
        std::uint32_t tiles = 0; // of the picture
    };
    /// Replaces `block`, which keeps these limits. Throws Error where the bytes are no block of this version
    /// of the format, whatever they are: "`place`: ...".
    void decode(const std::string& bytes, const Limits& limits, std::uint32_t version,
                const std::string& place, Block& block);

private:
    struct Free {
        void operator()(ZSTD_DCtx_s* c) const;
    };
    void get_table(const Limits& limits, std::uint32_t version, std::size_t segments, std::size_t classes,
                   const std::string& place, Block& block);
    void get_columns(std::uint32_t version, const std::string& place, unsigned shift, unsigned set_bits,
                     std::uint64_t first_time, Block& block);
    void get_classes(bool beside, const std::string& place, Block& block);
    void get_addresses(bool beside, const std::string& place, unsigned shift, unsigned set_bits,
                       Block& block);
    void get_order(const std::string& place, Block& block);

    std::unique_ptr<ZSTD_DCtx_s, Free> context_;
    std::unique_ptr<ReferenceModel> model_;                           // likewise
    std::string table_, classes_, addresses_, times_, order_, tiles_; // columns
    std::vector<std::uint64_t> last_;                                 // address, by class
    std::vector<char> makes_room_; // by reference: of a line that leaves a cache, for the next one
    ByClass by_class_;
};

} // namespace traces
