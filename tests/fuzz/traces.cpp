// Readers of traces: the first byte chooses the format, the rest gives blocks that
// keep their promises, or an Error in a line. Checksums of our own format are set right first, else hardly
// any bytes would pass.
#include "tests/fuzz/target.h"
#include "tests/traces/old_files.h"
#include "tests/traces/samples.h"
#include "traces/chunk.h"
#include "traces/error.h"
#include "traces/formats/format.h"
#include "traces/varint.h"
#include "traces/writer.h"

#include <algorithm>

namespace {

using namespace traces;
using fuzz::require;

/// Of cores, as columns; of caches, predicted.
std::string own_seed(const char* level) {
    std::string out;
    Description description = test::small_description();
    description.level = level;
    Writer writer(memory_sink(out), description);
    writer.add_sites({"a:1", "b:2", "c:3"});
    BlockBuilder builder;
    for (const Reference& r : test::with_tiles(test::mixed_references(40, 1, 3)))
        builder.add(r);
    Block block;
    builder.take(block);
    writer.write(block);
    writer.finish();
    return out;
}

std::string old_seed(std::string_view base64) {
    return std::string(1, '\0') + test::decoded(base64);
}

/// Sets right the checksums of all chunks that lie whole in the bytes.
void sign(std::string& bytes) {
    for (std::size_t at = prologue_bytes; bytes.size() >= at + chunk_header_bytes;) {
        const auto length = fixed_at<std::uint64_t>(bytes.data() + at + 8);
        if (length > bytes.size() - at - chunk_header_bytes)
            return;
        const std::string name = bytes.substr(at, 4), content = bytes.substr(at + chunk_header_bytes, length);
        bytes.replace(at, chunk_header_bytes, chunk_header(name, content));
        at += chunk_header_bytes + length;
    }
}

void check(const Block& block, const Description& d, bool own) {
    require(block.size() != 0 && block.size() <= most_references);
    require(block.times.size() == block.size() && block.classes.size() == block.size());
    std::size_t at = 0;
    for (const Segment& s : block.segments) {
        require(s.begin == at && s.end > at);
        at = s.end;
    }
    require(at == block.size());
    require(std::all_of(block.classes.begin(), block.classes.end(),
                        [&](std::uint32_t c) { return c < block.table.size(); }));
    require(block.tiles.empty() || block.tiles.size() == block.size());
    require(std::all_of(block.tiles.begin(), block.tiles.end(),
                        [&](std::uint32_t tile) { return tile <= d.picture.tiles(); }));
    std::vector<std::size_t> taken(block.segments.size(), 0);
    for (const Turn& t : block.order)
        if (t.what == Turn::What::references)
            taken.at(t.segment) += t.count;
    for (std::size_t s = 0; s < taken.size(); ++s)
        require(block.order.empty() || taken[s] == block.segments[s].end - block.segments[s].begin);
    for (const Class& c : block.table) {
        require(static_cast<std::size_t>(c.part) < parts);
        require(static_cast<std::size_t>(c.kind) < kind_names.size());
        require(c.structure < d.structures.size() && c.phase < d.phases.size() && c.work < d.work.size());
        require(!own || d.site_addresses || c.site <= d.sites.size());
    }
}

} // namespace

const std::vector<std::string>& fuzz::seeds() {
    static const std::vector<std::string> all{
        std::string(1, '\0') + own_seed("core"),
        std::string(1, '\0') + own_seed("l2"),
        old_seed(test::of_version_1),
        old_seed(test::of_version_2),
        old_seed(test::of_version_3),
        old_seed(test::of_version_5),
        old_seed(test::predicted_of_version_5),
        old_seed(test::of_version_6),
        old_seed(test::predicted_of_version_6),
        std::string("\1") + "0 10 4\n1 7fff 8\n2 401000 3\n",
        std::string("\2") + "cycles,address,kind,size,site,stream\n1,10,read,4,1,0\n2,ff,write,8,0,1\n",
        std::string("\3") + "I  04000000,3\n L 1ffe80,8\n S 1ffe78,8\n M 1ffe70,4\n",
        std::string("\4") + "0x10 READ 1\n0x20 WRITE 2\n",
        std::string("\5") + "0x10 R\n0x20 W\n",
        std::string("\6") + std::string(128, '\1'),
        std::string("\7") + std::string(48, '\2'),
        std::string("\10") +
            "Output format:\n           1           0:        1234 <marker: version 6>\n"
            "           2           1:        1234 ifetch       3 byte(s) @ 0x0000000000401000 "
            "89 c3 90 mov %eax -> %ebx\n"
            "           3           1:    W0.T1234 write        8 byte(s) @ 0x00007fff00000010 by "
            "PC 0x0000000000401000\n",
    };
    return all;
}

bool fuzz::try_bytes(std::string_view given) {
    if (given.empty())
        return false;
    const Format& format = formats()[static_cast<unsigned char>(given[0]) % formats().size()];
    std::string bytes(given.substr(1));
    if (format.name == "rzt")
        sign(bytes);
    try {
        const auto input = format.read(memory_source(bytes, "fuzz"));
        for (Block block; input->next(block);)
            check(block, input->description(), format.name == "rzt");
    } catch (const Error& error) {
        require_line(error.what());
    }
    return true;
}
