// How fast traces are written and read, and what a reference takes: of a file (razor-sim run --trace FILE).
//   trace_speed FILE [--runs N]
#include "traces/block_builder.h"
#include "traces/chunk.h"
#include "traces/error.h"
#include "traces/reader.h"
#include "traces/writer.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <vector>

namespace {

template <class Work> double seconds(Work work) {
    const auto begin = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// Median, and least and most, of million references a second.
void print(const char* what, std::vector<double> all) {
    std::sort(all.begin(), all.end());
    fmt::print("{:<40} {:8.1f} million references a second ({:.1f} to {:.1f} in {} runs)\n", what,
               all[all.size() / 2], all.front(), all.back(), all.size());
}

int run(const std::string& file, int runs) {
    std::vector<double> reading, decoding, building, encoding;
    for (int i = 0; i < runs; ++i) {
        std::uint64_t references = 0, bytes = 0, encoded = 0, sum = 0;
        double decode = 0, build = 0, encode = 0;
        traces::Reader reader(traces::open_raw_source(file));
        traces::Encoder encoder(traces::coding_for(reader.description().level));
        traces::Decoder decoder;
        traces::BlockBuilder builder;
        traces::Block block, again;
        std::string text;
        double read = 0;
        for (bool more = true; more;) {
            read += seconds([&] { more = reader.next(block); });
            if (!more)
                break;
            references += block.size();
            build += seconds([&] {
                for (const traces::Segment& s : block.segments)
                    for (std::size_t k = s.begin; k < s.end; ++k)
                        builder.add({block.times[k], block.addresses[k], s.stream, block.what(k)});
                builder.take(again);
            });
            text.clear();
            encode += seconds([&] { encoder.encode(again, text); });
            encoded += text.size();
            const traces::Description& d = reader.description();
            decode += seconds([&] {
                decoder.decode(text, {d.structures.size(), d.phases.size(), d.work.size(), ~std::uint64_t{0}},
                               traces::format_version, file, again);
            });
            sum += again.addresses.back();
        }
        bytes = reader.bytes();
        const double million = static_cast<double>(references) * 1e-6;
        if (i == 0)
            fmt::print("{}: {} references, {:.3f} bytes each in the file, {:.3f} in blocks (sum {:x})\n",
                       file, references, static_cast<double>(bytes) / static_cast<double>(references),
                       static_cast<double>(encoded) / static_cast<double>(references), sum);
        reading.push_back(million / read);
        decoding.push_back(million / decode);
        building.push_back(million / build);
        encoding.push_back(million / encode);
    }
    print("read a file: bytes, checksum, decode", reading);
    print("decode blocks", decoding);
    print("collect references into blocks", building);
    print("encode blocks", encoding);
    return 0;
}

} // namespace

int main(int argc, char** argv) {
    CLI::App app("Measures how fast a trace is read and written.", "trace_speed");
    std::string file;
    int runs = 3;
    app.add_option("file", file, "a trace")->required();
    app.add_option("--runs", runs, "so often; medians are printed")->check(CLI::PositiveNumber);
    CLI11_PARSE(app, argc, argv);
    try {
        return run(file, runs);
    } catch (const traces::Error& e) {
        fmt::print(stderr, "trace_speed: {}\n", e.what());
        return 2;
    }
}
