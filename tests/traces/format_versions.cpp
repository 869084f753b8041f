// Files of earlier versions are read as they were.
#include "tests/traces/samples.h"
#include "traces/chunk.h"
#include "traces/codec.h"
#include "traces/error.h"
#include "traces/reader.h"
#include "traces/varint.h"

#include <gtest/gtest.h>

#include <string_view>

namespace traces {
namespace {

using test::equal;
using test::references_of;

/// Bytes of base64.
std::string decoded(std::string_view text) {
    constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    std::uint32_t bits = 0;
    int count = 0;
    for (const char c : text) {
        if (c == '=')
            break;
        bits = bits << 6U | static_cast<std::uint32_t>(digits.find(c));
        count += 6;
        if (count >= 8)
            out.push_back(static_cast<char>(bits >> (count -= 8)));
    }
    return out;
}

/// What version 1 of the program wrote of four references of two streams.
constexpr std::string_view of_version_1 =
    "iVJaVA0KGgoBAAAASEVBRPvgMSAbAQAAAAAAAHsKICJwcm9ncmFtIjogInVua25vd24iLAogImxldmVsIjogIiIsCiAidGlt"
    "ZSI6ICJjeWNsZXMiLAogImxpbmVfYnl0ZXMiOiAwLAogInNpdGVzIjogIm5hbWVzIiwKICJzYW1wbGUiOiAxLjAsCiAiZmls"
    "dGVycyI6ICIiLAogInN0cnVjdHVyZXMiOiBbCiAgIm5vZGVzIiwKICAibGlzdHMiCiBdLAogInBoYXNlcyI6IFsKICAiZ28i"
    "LAogICJzdG9wIgogXSwKICJ3b3JrIjogWwogICJ1bmtub3duIgogXSwKICJzdHJlYW1zIjogWwogICJ0aHJlYWQgMCIKIF0s"
    "CiAiY29uZmlndXJhdGlvbiI6ICIiCn1OQU1FXAjA2A0AAAAAAAAAWyJhOjEiLCJiOjIiXUJMQ0uWOKP6iAAAAAAAAAAEAAAA"
    "AgAAAAQAAAACAAAAAQAAAAAAAAAcAAAAJQAAAAQAAAANAAAACAAAABEAAAAEAAAADQAAACi1L/0gHOEAAAACAQIABAAAAAIB"
    "CAAAAAICBAABAAEHQAEBAAEotS/9IAQhAAAAAgEDKLUv/SAIQQAACAqg/wGg/wEotS/9IAQhAAAABAICSU5EWHudv+9WAAAA"
    "AAAAACi1L/0gWW0CAKJEEBeQtTpo3Rqg6TcmT+ZL/+eYSx60N3ZNCQF1kMk35uBF1vNVzfHn5RiE0o+pw0i+YjmiNNEWE5Lk"
    "n/Rb1dZtsc6AAwDnDA7yluWcVEFJTGrWJ4UIAAAAAAAAAOwBAAAAAAAA";

TEST(TraceFormat, FilesOfVersionOneAreRead) {
    Reader reader(memory_source(decoded(of_version_1), "old"));
    Block block;
    ASSERT_TRUE(reader.next(block));
    const std::vector<Reference> all = references_of(block);
    ASSERT_EQ(all.size(), 4U);
    EXPECT_TRUE(equal(all[0], {1, 0x10, 0, {1, 4, 0, 0, 0, Kind::read}}));
    EXPECT_TRUE(equal(all[1], {3, 0x14, 0, {1, 4, 0, 1, 0, Kind::modify}}));
    EXPECT_TRUE(equal(all[2], {2, 0xff40, 1, {2, 8, 0, 0, 0, Kind::write}}));
    EXPECT_TRUE(equal(all[3], {3, 0xff40, 1, {0, 64, 1, 1, 0, Kind::flush}}));
    EXPECT_TRUE(block.order.empty()); // it did not say
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete()) << reader.note();
    EXPECT_EQ(reader.description().structures, (std::vector<std::string>{"nodes", "lists"}));
    EXPECT_TRUE(reader.description().regions.empty());
    EXPECT_EQ(reader.description().window, 0U);
}

/// Likewise version 2.
constexpr std::string_view of_version_2 =
    "iVJaVA0KGgoCAAAASEVBRFX4dVA5AQAAAAAAAHsKICJwcm9ncmFtIjogInVua25vd24iLAogImxldmVsIjogIiIsCiAidGlt"
    "ZSI6ICJjeWNsZXMiLAogImxpbmVfYnl0ZXMiOiAwLAogInNpdGVzIjogIm5hbWVzIiwKICJzYW1wbGUiOiAxLjAsCiAid2lu"
    "ZG93IjogMCwKICJmaWx0ZXJzIjogIiIsCiAic3RydWN0dXJlcyI6IFsKICAibm9kZXMiLAogICJsaXN0cyIKIF0sCiAicGhh"
    "c2VzIjogWwogICJnbyIsCiAgInN0b3AiCiBdLAogIndvcmsiOiBbCiAgInVua25vd24iCiBdLAogInN0cmVhbXMiOiBbCiAg"
    "InRocmVhZCAwIgogXSwKICJyZWdpb25zIjogW10sCiAiY29uZmlndXJhdGlvbiI6ICIiCn1OQU1FXAjA2A0AAAAAAAAAWyJh"
    "OjEiLCJiOjIiXUJMQ0v1AuSDowAAAAAAAAAEAAAAAgAAAAQAAAACAAAAAQAAAAAAAAAcAAAAJQAAAAQAAAANAAAACAAAABEA"
    "AAAEAAAADQAAAAoAAAATAAAAKLUv/SAc4QAAAAIBAgAEAAAAAgEIAAAAAgIEAAEAAQhAAQEAASi1L/0gBCEAAAACAQMotS/9"
    "IAhBAAAICqD/AaD/ASi1L/0gBCEAAAAEAgIotS/9IApRAAAEBAIDAgMBAQEBSU5EWGC3NMtZAAAAAAAAACi1L/0gXYUCAMLE"
    "EBeQtTroImRv2YcmT+ZL/+cAt+1Be2PXlAO1kMk3ZuEFrOermuPPy2AQSj+mEiT5Wo7liNJGW4wIJP+k36q2bo91FgQDAMkZ"
    "HtStwDkBVEFJTOuQJtEIAAAAAAAAACUCAAAAAAAA";

TEST(TraceFormat, FilesOfVersionTwoAreRead) {
    Reader reader(memory_source(decoded(of_version_2), "old"));
    Block block;
    ASSERT_TRUE(reader.next(block));
    const Description& d = reader.description();
    const std::vector<Reference> all = references_of(block);
    ASSERT_EQ(all.size(), 4U);
    const auto is = [&](const Reference& r, std::uint64_t time, std::uint64_t address, Kind kind,
                        std::uint32_t size, const char* structure, const char* phase) {
        return r.time == time && r.address == address && r.what.kind == kind && r.what.size == size &&
               d.structures[r.what.structure] == structure && d.phases[r.what.phase] == phase &&
               r.what.detail == 0;
    };
    EXPECT_TRUE(is(all[0], 1, 0x10, Kind::read, 4, "nodes", "go"));
    EXPECT_TRUE(is(all[1], 3, 0x14, Kind::modify, 4, "nodes", "stop"));
    EXPECT_TRUE(is(all[2], 2, 0xff40, Kind::write, 8, "nodes", "go"));
    EXPECT_TRUE(is(all[3], 3, 0xff40, Kind::invalidate, 64, "lists", "stop"));
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete()) << reader.note();
}

/// Likewise version 3, of five.
constexpr std::string_view of_version_3 =
    "iVJaVA0KGgoDAAAASEVBRFX4dVA5AQAAAAAAAHsKICJwcm9ncmFtIjogInVua25vd24iLAogImxldmVsIjogIiIsCiAidGltZSI6"
    "ICJjeWNsZXMiLAogImxpbmVfYnl0ZXMiOiAwLAogInNpdGVzIjogIm5hbWVzIiwKICJzYW1wbGUiOiAxLjAsCiAid2luZG93Ijog"
    "MCwKICJmaWx0ZXJzIjogIiIsCiAic3RydWN0dXJlcyI6IFsKICAibm9kZXMiLAogICJsaXN0cyIKIF0sCiAicGhhc2VzIjogWwog"
    "ICJnbyIsCiAgInN0b3AiCiBdLAogIndvcmsiOiBbCiAgInVua25vd24iCiBdLAogInN0cmVhbXMiOiBbCiAgInRocmVhZCAwIgog"
    "XSwKICJyZWdpb25zIjogW10sCiAiY29uZmlndXJhdGlvbiI6ICIiCn1OQU1FB21VOhEAAAAAAAAAWyJhOjEiLCJiOjIiLCIwIl1C"
    "TENLisImxLEAAAAAAAAABQAAAAIAAAAFAAAAAgAAAAEAAAAAAAAAKAAAADEAAAAFAAAADgAAAAkAAAASAAAABAAAAA0AAAAKAAAA"
    "EwAAACi1L/0gKEEBAAADAQIABAAAAAIHAQgAAAACAAIEAAEAAQAiBAABAAAAOkABAQAEgAIotS/9IAUpAAAAAgMBBCi1L/0gCUkA"
    "AAgKFqD/AaD/ASi1L/0gBCEAAAAEAgIotS/9IApRAAAEBAIDAgMBAQIBSU5EWOEcuoFcAAAAAAAAACi1L/0ga50CACKFEReQGeq4"
    "aAAsPH8BGyoxM8MnvxG3N3ZNCQv18E3w+D4cOBGp+arld3NAoGSim0IHw/H1xsnvl2jCSkqQOL5Bt0Vr2RaWWREDADkh+Atx1eGe"
    "VEFJTL2muO8IAAAAAAAAADcCAAAAAAAA";

TEST(TraceFormat, FilesOfVersionThreeAreRead) {
    Reader reader(memory_source(decoded(of_version_3), "old"));
    Block block;
    ASSERT_TRUE(reader.next(block));
    const std::vector<Reference> all = references_of(block);
    ASSERT_EQ(all.size(), 5U);
    EXPECT_TRUE(equal(all[0], {1, 0x10, 0, {1, 4, 0, 0, 0, Kind::read, Part::operation, 7}}));
    EXPECT_TRUE(equal(all[1], {3, 0x14, 0, {1, 4, 0, 1, 0, Kind::modify}}));
    EXPECT_TRUE(equal(all[2], {3, 0x40, 0, {1, 4, 0, 1, 0, Kind::modify, Part::piece}}));
    EXPECT_TRUE(equal(all[3], {2, 0xff40, 1, {2, 8, 0, 0, 0, Kind::write}}));
    EXPECT_TRUE(equal(all[4], {3, 0xff40, 1, {3, 64, 1, 1, 0, Kind::upgrade, Part::aside, 256}}));
    EXPECT_EQ(block.order.size(), 4U);
    EXPECT_FALSE(reader.next(block));
    EXPECT_TRUE(reader.complete()) << reader.note();
    EXPECT_EQ(reader.description().sites, (std::vector<std::string>{"a:1", "b:2", "0"}));
}

/// What a cache of 64 lines passed on: version 5 of it, of which the first is columns, the second predicted.
constexpr std::string_view of_version_5 =
    "iVJaVA0KGgoFAAAASEVBRCBDLiTKAAAAAAAAACi1L/1gSgAFBgACih8ccKd1QYPRFF4RMpKnzy+Kj+j/rcbCQOheVv3vsgfmQANQFHhY"
    "xr3tuEubcCPuTeqqoIPWUW+/eL9OfxR2oMlXpDmRX/PCLhFNgLuGnLd/16Y2eY3wvgKh2Dr/ug7nvgGNfG0FAwLK64p469pGKKUEqhIN"
    "IRONXMdTO0s0BgEbKCBCgi07EFhppmo3uUFqrihBlGGk/fCDlx/67vINEBSyI15J3n2QlDgcb4a+mMKcNboFDqv6i2khmeKCuzFOQU1F"
    "mhpgVhYAAAAAAAAAKLUv/SANaQAAWyJhOjEiLCJiOjIiXUJMQ0vmpPl5YwEAAAAAAABQAQAAAQAAABIAAAAGBgAAAAAAAAAAAACBAAAA"
    "QgAAAFABAABZAAAAUAEAAC8AAABQAQAAFgAAADgAAAAjAAAADwAAABgAAAAotS/9IIHNAQDwANACAEABAAACAQADAAIBBQEABQMCAwEB"
    "AAAEAQEEDqAQsNPtUJM9xOAIDcrJGnoM1kF8zO9oQDIotS/9YFAAfQIApAMMAAEDBA0CAAEDDgUCAAEPBAUCABADBAUCEQEDBAUGBAcN"
    "CAIJAAoBCwMGDgcFDwYEEAsDEQoBDAkABwDOrygAeYA8QB4gDy/ZMjjKCSi1L/1gUAAtAQDAAAIEBggKDAwMDBQWDAwMHhgMDAwoMjwB"
    "BAAEHCUmQAeMhVXuKLUv/WBQAGUAABgABgACAAs5VVACWCi1L/0gONUAAIgPBwACATIk0A+8D7AT1AfnBwMQAqnhwnFEKLUv/SAPeQAA"
    "BSg4UFBQAQACAAIAAgACSU5EWCUtR95kAAAAAAAAACi1L/0gct0CADIFExqAqW1Y/HkxbHGFYD/KI7K7gZBv26aOhRk4Ag01wuT7YMGp"
    "QJavGhgA7IJDmeiVqAQi+Wp+dm6OmzuJNihIQlgk/8zQa5Wyyx52MSMEAFkIJKkrAPTY4MhUQUlM5X/"
    "AFQgAAAAAAAAAfwIAAAAAAAA=";
constexpr std::string_view predicted_of_version_5 =
    "iVJaVA0KGgoFAAAASEVBRLT+d9PLAAAAAAAAACi1L/1gSgANBgACyh8dYGfrY9Vti21k/+Tp84uM5RZFNRWPMcIEmQRfgxUH5kADUBSY"
    "WMa97bhLm3Aj7k3qqqCD1lFvv3i/Tn8UdqDJV6Q5kV/zwi4RTYC7hpy3f9emNnmN8L7CQbF1/nUdzn0DGvnaCgYElNcV8da1DaGUEqhK"
    "NIRMNHIdT+0s0RgEGyggQoItOxBYaaZqN7lBaq4oQZRhpP3wg5cf+u7yDRAUsiNeSd59kJQ4HG+GvpjCnDW6BQ6r+otpIZnigrsxTkFN"
    "RZoaYFYWAAAAAAAAACi1L/0gDWkAAFsiYToxIiwiYjoyIl1CTENLt7Jh9BMBAAAAAAAAUAEAAAEAAAASAAAABgYHAAAAAAAAAAAAgQAA"
    "AEIAAACJAAAAiQAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAKLUv/SCBzQEA8ADQAgBAAQAAAgEAAwACAQUBAAUDAgMB"
    "AQAABAEBBA6gELDT7VCTPcTgCA3KyRp6DNZBfMzvaEAytWPhJShdTqn0w0iWGu+b7iaW0Ix8BeuNmJhURmJkzTta6rU/4DE9Ks97GPZz"
    "WmPjQaC2wUTh1uMSQf3R9QxxCvXzEQ4MmpJhOE4IdOS31y2zViNQZxti56ZcAQvu71QWwE/nGL4zPISeso/drUwA+GBBpNd1KH0W+177"
    "vCJ8PHO2FnrfG+VWC4BJTkRYr7PiQWMAAAAAAAAAKLUv/SBy1QIAMsUSGXBp2+Ctg5vY5xB80P30X5Eagi+dUlb6/4ULNULl++DAiUCW"
    "rxpIAHs6lIleyXEwKF/Nz86NcXMn0QQFSQQJ5Z8Zeu2h7LKFXawIBABZCCSpKwD02ODIVEFJTKSvfeUIAAAAAAAAADACAAAAAAAA";

std::vector<Reference> passed_on() {
    std::vector<Reference> all;
    for (std::uint32_t k = 0; k < 200; ++k) {
        Reference r{3 * k, 0, 0, {k % 3, 64, 1, 0, 0, Kind::write_back, Part::operation, k % 2}, k / 40};
        r.address = (std::uint64_t{k} - 64) * 64;
        if (k >= 64)
            all.push_back(r);
        r.what.kind = k % 5 == 0 ? Kind::write : Kind::read;
        r.address = std::uint64_t{k} * 64;
        all.push_back(r);
    }
    return all;
}

void expect_passed_on(const Block& block, bool tiles) {
    const std::vector<Reference> got = references_of(block);
    std::vector<Reference> want = passed_on();
    ASSERT_EQ(got.size(), want.size());
    for (std::size_t i = 0; i < got.size(); ++i) {
        want[i].tile = tiles ? want[i].tile : 0;
        EXPECT_TRUE(equal(got[i], want[i])) << i;
    }
    ASSERT_EQ(block.order.size(), 15U); // seven windows, and the end
    EXPECT_EQ(block.order[2], (Turn{Turn::What::window, 0, 0, 2250, 2240}));
    EXPECT_EQ(block.order[3].count, 50U);
    EXPECT_EQ(block.order[14], (Turn{Turn::What::end, 0, 0, 9000, 8000}));
}

TEST(TraceFormat, FilesOfVersionFiveAreRead) {
    for (const std::string_view text : {of_version_5, predicted_of_version_5}) {
        Reader reader(memory_source(decoded(text), "old"));
        Block block;
        ASSERT_TRUE(reader.next(block));
        expect_passed_on(block, true);
        EXPECT_FALSE(reader.next(block));
        EXPECT_TRUE(reader.complete()) << reader.note();
    }
}

/// Likewise version 6.
constexpr std::string_view of_version_6 =
    "iVJaVA0KGgoGAAAASEVBRF3FCGvHAAAAAAAAACi1L/1gRwDtBQDSSR8cgKdt6HtjhcimkH+C1tK7wsYMonErig9AbCzXLAkGOSNAGIWu"
    "Zf3TbFFlGS3rkq1O9ruhuW3jNSzzY7CQM+jvCS/emYFmj1h/5ydV7sDGyWoDKBRpqePqLKoHGHeg5x8KCHLVM6EDSqVfpJQHmfAMge/5"
    "eAeq0wv3wjMIARogIEKiMQ95masTZLJhm6S/rdkAVyiuEuAzCSBNNnoLNEae1CxCYGslypkxvEEnmQSDmaCMU0SQ4XBlGSdOQU1Fmhpg"
    "VhYAAAAAAAAAKLUv/SANaQAAWyJhOjEiLCJiOjIiXUJMQ0tCOIbMbQEAAAAAAABQAQAAAQAAABIAAAAGBgAAAAAAAAAAAACBAAAAQgAA"
    "AFABAABZAAAAUAEAAD0AAADIAAAAEgAAADgAAAAjAAAADwAAABgAAAAotS/9IIHNAQDwANACAEABAAACAQADAAIBBQEABQMCAwEBAAAE"
    "AQEEDqAQsNPtUJM9xOAIDcrJGnoM1kF8zO9oQDIotS/9YFAAfQIApAMMAAEDBA0CAAEDDgUCAAEPBAUCABADBAUCEQEDBAUGBAcNCAIJ"
    "AAoBCwMGDgcFDwYEEAsDEQoBDAkABwDOrygAeYA8QB4gDy/ZMjjKCSi1L/1gUACdAQCgAgwMDBgEDAYIGBYMADwKFB4oMgENoBDAZBzQ"
    "AjM7BKTUigYGcY6rBjNAzELPdtt6vVIotS/9IMhNAAAQAAYBAEMKYAEotS/9IDjVAACIDwcAAgEyJLgXpBfIC9wuoB8DEAKp4cJxRCi1"
    "L/0gD3kAAAUoOFBQUAEAAgACAAIAAklORFhRPjPRYwAAAAAAAAAotS/9IHLVAgAyxRIZcGnb4K2Dm9jnEHzQ/fRfGYpCL51SVvr/hQs1"
    "QuX74MCJQJavCggkezqUiV7JcTAoX83Pzo1xcyfRBAVJBAnlnxl67aHssoVdrAgEAFkIJKkrAPTY4MhUQUlMhHDk9QgAAAAAAAAAhgIA"
    "AAAAAAA=";
constexpr std::string_view predicted_of_version_6 =
    "iVJaVA0KGgoGAAAASEVBRFwXeq/HAAAAAAAAACi1L/1gRwDtBQDSSR8ccEnbyGdjhcymkC9RM7HdWASqaLE1UNF+Vv371QsGOUNAGIWu"
    "Zf3TbFFlGS3rkq1O9ruhuW3jNSzzg7CQM+jvCS/emYJmj1h/5ydV7sDGyWoLACjSUsfVWVQfMO5Azz8cGOSqZ0IHlEpfIKVMyIRnCHzP"
    "xztQnV64F55RCBogIEKiMQ95masTZLJhm6S/rdkAVyiuEuAzCSBNNnoLNEae1CxCYGslypkxvEEnmQSDmaCMU0SQ4XBlGSdOQU1Fmhpg"
    "VhYAAAAAAAAAKLUv/SANaQAAWyJhOjEiLCJiOjIiXUJMQ0sFOc+RFAEAAAAAAABQAQAAAQAAABIAAAAGBgcAAAAAAAAAAACBAAAAQgAA"
    "AIoAAACKAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAotS/9IIHNAQDwANACAEABAAACAQADAAIBBQEABQMCAwEBAAAE"
    "AQEEDqAQsNPtUJM9xOAIDcrJGnoM1kF8zO9oQDK1Y2FEq53/VzXzMWTg2WKisOgzCH7QuDck35fYT7vjUNuckHgBhSpQJBoEzgVpfknh"
    "qgTDtEIclP/tKg9R/XPK0+GdRnT2i16lePatH+YQckW0YErABgNviGcPr1RZGsWKOJqOQa2UDUGK9lW6UlcmFlSQMHK6zO5ozAk185hV"
    "t3sIEPfPeW2lpABJTkRYUT4z0WMAAAAAAAAAKLUv/SBy1QIAMsUSGXBp2+Ctg5vY5xB80P30XxmKQi+dUlb6/4ULNULl++DAiUCWrwoI"
    "JHs6lIleyXEwKF/Nz86NcXMn0QQFSQQJ5Z8Zeu2h7LKFXawIBABZCCSpKwD02ODIVEFJTF6LwwIIAAAAAAAAAC0CAAAAAAAA";

TEST(TraceFormat, FilesOfVersionSixAreRead) {
    for (const std::string_view text : {of_version_6, predicted_of_version_6}) {
        Reader reader(memory_source(decoded(text), "old"));
        Block block;
        ASSERT_TRUE(reader.next(block));
        expect_passed_on(block, true);
        EXPECT_FALSE(reader.next(block));
        EXPECT_TRUE(reader.complete()) << reader.note();
    }
}

/// Of version 6, which is that of version 4 but for the last column.
constexpr std::string_view predicted_without_tiles =
    "iVJaVA0KGgoGAAAASEVBRNwE4dG4AAAAAAAAACi1L/1gJQB1BQCSSR4cgLVtYX1jhYil0D4ZbWkpCT8GVvO//v0osalcsQUG8Q4u66Nm"
    "iB7LaVmR7IWy35Pmto03WeZIQFmcQX83ePHOKJp9Yv2dr/S4g42N1VYgGJSykC+0qI5I3EHPXwIActVTpSXl0j8olQOp8MwA3/PxDi7U"
    "CLeCZwgCFiAwgs4dtkYDvFCcSoBnUkDa2Ggu0BB5olmEwNpKlDNjeINOMwmD2aDMU2SQebiyphNOQU1FmhpgVhYAAAAAAAAAKLUv/SAN"
    "aQAAWyJhOjEiLCJiOjIiXUJMQ0upHkMdDAEAAAAAAABQAQAAAQAAABIAAAAGBgMAAAAAAAAAAACBAAAAQgAAAIIAAACCAAAAAAAAAAAA"
    "AAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAotS/9IIHNAQDwANACAEABAAACAQADAAIBBQEABQMCAwEBAAAEAQEEDqAQsNPtUJM9xOAI"
    "DcrJGnoM1kF8zO9oQDK1Y2FEq54xjb/pxPGaFuMCawm3XbpICf4jDoz1u2d8DWyXQQZJpzEB3CnknNb+bhdkVWkCmSYRFZfzhHJSNMHD"
    "Yqo7ECLrQ+9sAtX43y37X3D4STmRomE9BRfxoQblxVT8pc3IkyKfD/x4vsQrnJyWbt8960fzlab92amuWRAQTqjaSU5EWEAvnR5kAAAA"
    "AAAAACi1L/0gct0CADIFExpwadvgrYOb2OcQfND99F8ZikQm3aCs9P8LAQv1QeXb4MCJQJavCgigu6GTiV7JcTAoX+3pzM24JZNogoIk"
    "goTy0x167aHssoVdrAgEAFkIJKkrAPTY4MhUQUlMdcRk2ggAAAAAAAAAFgIAAAAAAAA=";

/// The first block of a file.
std::string without_last_column(const std::string& file) {
    const std::size_t chunk = file.find(block_chunk);
    std::string bytes =
        file.substr(chunk + chunk_header_bytes, fixed_at<std::uint64_t>(file.data() + chunk + 8));
    constexpr std::size_t sizes = 24 + 5 * 8; // of the last column
    bytes.resize(bytes.size() - fixed_at<std::uint32_t>(bytes.data() + sizes + 4));
    return bytes.erase(sizes, 8);
}

/// Blocks of version 4 are those of version 5 without the last column, of tiles.
TEST(TraceFormat, BlocksOfVersionFourAreRead) {
    std::string bytes = without_last_column(decoded(of_version_5));
    Block back;
    Decoder().decode(bytes, {2, 1, 1, 2}, 4, "old", back);
    expect_passed_on(back, false);
    EXPECT_THROW(Decoder().decode(bytes, {2, 1, 1, 2}, format_version, "new", back), Error);

    bytes = without_last_column(decoded(predicted_without_tiles));
    Decoder().decode(bytes, {2, 1, 1, 2}, 4, "old", back);
    expect_passed_on(back, false);
    EXPECT_THROW(Decoder().decode(bytes, {2, 1, 1, 2}, format_version, "new", back), Error);
}

} // namespace
} // namespace traces
