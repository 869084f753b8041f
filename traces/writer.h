// Writes a trace, streaming: what was written can be read if the rest never comes.
#pragma once

#include "traces/codec.h"
#include "traces/description.h"
#include "traces/index.h"
#include "traces/io/sink.h"

#include <memory>
#include <optional>

namespace traces {

class Writer {
public:
    /// Begins the file with the description, whose sites are left out: add_sites() gives them. `coding`: of
    /// blocks; without it, as coding_for() has it of the description's level.
    Writer(std::unique_ptr<Sink> sink, const Description& description, std::optional<Coding> coding = {});

    /// Names of sites, which get the next numbers, 1 being the first. Before the blocks that use them.
    void add_sites(const std::vector<std::string>& names);
    /// Names that the description's tables have got since the last call, or the beginning. Likewise.
    void add_names(const Description& description);
    /// Writes a block, if it is not empty.
    void write(const Block& block);
    /// Ends the file with its index. Throws Error.
    void finish();

    std::uint64_t bytes() const { return at_; }
    std::uint64_t references() const { return index_.references(); }

private:
    void chunk(std::string_view name, std::string_view bytes);

    std::unique_ptr<Sink> sink_;
    Encoder encoder_;
    Index index_;
    TableSizes tables_; // written so far
    std::uint64_t at_ = 0;
    std::string bytes_; // of the block at hand
};

} // namespace traces
