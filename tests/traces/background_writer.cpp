// A writer whose blocks another thread encodes writes what one alone does, and tells what failed.
#include "traces/background_writer.h"

#include "tests/traces/samples.h"
#include "traces/error.h"
#include "traces/reader.h"
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

/// Of many more windows than references, none of which is lost where there is a reference to be with.
TEST(BackgroundWriter, WindowsWithoutReferencesFit) {
    for (const char* level : {"core", "l2"}) {
        Description about = test::small_description();
        about.level = level;
        std::string bytes;
        BackgroundWriter writer(memory_sink(bytes), about, 1000);
        writer.add_sites({"a:1", "b:2", "c:3"});
        std::uint64_t time = 0, windows = 0;
        for (const Reference& r : mixed_references(20, 1, 3)) {
            for (std::size_t i = 0; i < most_idle_windows / 2; ++i, ++windows, time += 10)
                writer.mark({Turn::What::window, 0, 0, time + 10, time});
            writer.add(r);
        }
        for (std::size_t i = 0; i < 3 * most_idle_windows; ++i, time += 10) // no reference follows
            writer.mark({Turn::What::window, 0, 0, time + 10, time});
        writer.mark({Turn::What::end, 0, 0, time, time});
        writer.finish();
        Reader reader(memory_source(bytes, "idle"));
        Block block;
        std::uint64_t got = 0, references = 0;
        while (reader.next(block)) {
            references += block.size();
            for (const Turn& t : block.order)
                got += t.what == Turn::What::window ? 1 : 0;
        }
        EXPECT_TRUE(reader.complete()) << reader.note();
        EXPECT_EQ(references, 20U);
        EXPECT_GE(got, windows);
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
