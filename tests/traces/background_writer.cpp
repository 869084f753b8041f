// A writer whose blocks another thread encodes writes what one alone does, and tells what failed.
#include "traces/background_writer.h"

#include "tests/traces/samples.h"
#include "traces/error.h"
#include "traces/writer.h"

#include <gtest/gtest.h>

#include <memory>

namespace traces {
namespace {

using test::mixed_references;

/// Takes some bytes, then no more.
class FullSink final : public Sink {
public:
    explicit FullSink(std::size_t room) : room_(room) {}
    void write(std::string_view bytes) override {
        if (bytes.size() > room_)
            throw Error("no room");
        room_ -= bytes.size();
    }
    void commit() override { ADD_FAILURE() << "what is not whole was committed"; }

private:
    std::size_t room_;
};

TEST(BackgroundWriter, WritesWhatAWriterWrites) {
    for (const std::size_t size : {1U, 7U, 1000U, 5000U}) {
        std::string plain, background;
        Writer writer(memory_sink(plain), test::small_description());
        BackgroundWriter other(memory_sink(background), test::small_description(), size);
        BlockBuilder builder;
        Block block;
        const std::vector<Reference> all = mixed_references(3000, 1, 9);
        writer.add_sites({"a:1", "b:2", "c:3"});
        other.add_sites({"a:1", "b:2", "c:3"});
        for (const Reference& r : all) {
            builder.add(r);
            other.add(r);
            if (builder.size() == size) {
                builder.take(block);
                writer.write(block);
            }
        }
        builder.take(block);
        writer.write(block);
        writer.finish();
        other.finish();
        EXPECT_TRUE(plain == background) << size;
        EXPECT_EQ(other.references(), all.size());
        EXPECT_EQ(other.bytes(), background.size());
    }
}

TEST(BackgroundWriter, TellsWhatFailedAndCommitsNothing) {
    const std::vector<Reference> all = mixed_references(100000, 1, 9);
    for (const std::size_t block : {1000U, 100000U}) {
        BackgroundWriter writer(std::make_unique<FullSink>(5000), test::small_description(), block);
        for (const Reference& r : all)
            writer.add(r); // by those who cannot be interrupted
        EXPECT_THROW(writer.finish(), Error);
    }
    BackgroundWriter left(std::make_unique<FullSink>(1 << 30), test::small_description(), 1000);
    for (const Reference& r : all)
        left.add(r);
}

} // namespace
} // namespace traces
