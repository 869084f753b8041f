#include "razor/scene/models/ply_body.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <bit>
#include <charconv>
#include <cmath>
#include <limits>
#include <type_traits>

namespace razor {
namespace {

bool is_blank(char c) {
    return c == ' ' || (c >= '\t' && c <= '\r');
}

/// Calls visit(a value of the type).
template <class Visit> auto with_type(PlyType type, Visit visit) {
    switch (type) {
    case PlyType::int8:
        return visit(std::int8_t{});
    case PlyType::uint8:
        return visit(std::uint8_t{});
    case PlyType::int16:
        return visit(std::int16_t{});
    case PlyType::uint16:
        return visit(std::uint16_t{});
    case PlyType::int32:
        return visit(std::int32_t{});
    case PlyType::uint32:
        return visit(std::uint32_t{});
    case PlyType::float32:
        return visit(float{});
    case PlyType::float64:
        break;
    }
    return visit(double{});
}

template <class Value> Value from_bits(std::uint64_t bits) {
    if constexpr (std::is_same_v<Value, float>) {
        return std::bit_cast<float>(static_cast<std::uint32_t>(bits));
    } else if constexpr (std::is_same_v<Value, double>) {
        return std::bit_cast<double>(bits);
    } else {
        return static_cast<Value>(bits);
    }
}

} // namespace

PlyBody::PlyBody(std::string_view file, const PlyHeader& header, std::string_view file_name)
    : at_(file.data() + header.bytes), end_(file.data() + file.size()), header_(header),
      file_name_(file_name), line_(header.lines + 1) {}

void PlyBody::begin(const PlyElement& element) {
    element_ = &element;
    number_ = 0;
    const std::size_t least = element.least_bytes(header_.encoding);
    const bool text = header_.encoding == PlyEncoding::ascii;
    const auto left = static_cast<std::size_t>(end_ - at_) + (text ? 1 : 0); // no blank after the last one
    if (least != 0 && element.count > left / least) {
        throw UserError(fmt::format(
            "{}:{}: element {} {} does not fit into the {} bytes that are left of the "
            "file; it is cut off, or mend the number",
            printable(file_name_, 1000), element.line, printable(element.name), element.count, end_ - at_));
    }
}

void PlyBody::fail(std::string_view message) const {
    if (header_.encoding == PlyEncoding::ascii) {
        throw UserError(fmt::format("{}:{}: {}", printable(file_name_, 1000), line_, message));
    }
    throw UserError(fmt::format("{}: {} {}: {}", printable(file_name_, 1000), printable(element_->name),
                                number_, message));
}

void PlyBody::fail_at_end() const {
    fail(fmt::format("the file ends at {} {} of {}; it is cut off, or mend the number in its header",
                     printable(element_->name), number_, element_->count));
}

std::string_view PlyBody::word() {
    while (at_ != end_ && is_blank(*at_)) {
        if (*at_ == '\n' || (*at_ == '\r' && !(at_ + 1 != end_ && at_[1] == '\n'))) {
            ++line_;
        }
        ++at_;
    }
    if (at_ == end_) {
        fail_at_end();
    }
    const char* const first = at_;
    while (at_ != end_ && !is_blank(*at_)) {
        ++at_;
    }
    return {first, static_cast<std::size_t>(at_ - first)};
}

std::uint64_t PlyBody::bits(std::size_t bytes) {
    if (static_cast<std::size_t>(end_ - at_) < bytes) {
        fail_at_end();
    }
    std::uint64_t result = 0;
    for (std::size_t i = 0; i < bytes; ++i) {
        const std::size_t next = header_.encoding == PlyEncoding::little_endian ? bytes - 1 - i : i;
        result = result << 8 | static_cast<unsigned char>(at_[next]);
    }
    at_ += bytes;
    return result;
}

double PlyBody::number(PlyType type) {
    if (header_.encoding != PlyEncoding::ascii) {
        const std::uint64_t value = bits(size_of(type));
        return with_type(type,
                         [&](auto zero) { return static_cast<double>(from_bits<decltype(zero)>(value)); });
    }
    if (!is_real(type)) {
        return static_cast<double>(whole(type));
    }
    const std::string_view text = word();
    const std::string_view digits = text.substr(text.starts_with('+') ? 1 : 0);
    double value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size() || error == std::errc::invalid_argument) {
        fail(fmt::format("'{}' is not a number; write one", printable(text)));
    }
    if (error == std::errc::result_out_of_range) { // beyond the largest, or nearer to zero than the least
        value = std::strtod(std::string(digits).c_str(), nullptr);
    }
    if (type == PlyType::float32 && std::abs(value) > double{std::numeric_limits<float>::max()}) {
        fail(fmt::format("{} is beyond single precision; make it smaller, or its type double",
                         printable(text)));
    }
    return type == PlyType::float32 ? double{static_cast<float>(value)} : value;
}

std::int64_t PlyBody::whole(PlyType type) {
    if (header_.encoding != PlyEncoding::ascii) {
        const std::uint64_t value = bits(size_of(type));
        return with_type(
            type, [&](auto zero) { return static_cast<std::int64_t>(from_bits<decltype(zero)>(value)); });
    }
    const std::string_view text = word();
    const std::string_view digits = text.substr(text.starts_with('+') ? 1 : 0);
    std::int64_t value = 0;
    const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
    if (end != digits.data() + digits.size() || error != std::errc()) {
        fail(fmt::format("'{}' is not a whole number; write one", printable(text)));
    }
    return value;
}

std::size_t PlyBody::length(const PlyProperty& list) {
    const std::int64_t count = whole(*list.count);
    if (count < 0) {
        fail(fmt::format("the list '{}' has {} values; mend the number", printable(list.name), count));
    }
    const bool text = header_.encoding == PlyEncoding::ascii;
    if (static_cast<std::uint64_t>(count) >
        static_cast<std::size_t>(end_ - at_) / (text ? 2 : size_of(list.type))) {
        fail(
            fmt::format("the list '{}' has {} values, more than are left in the file; it is cut off, or mend "
                        "the number",
                        printable(list.name), count));
    }
    return static_cast<std::size_t>(count);
}

void PlyBody::skip_values(std::size_t count, PlyType type) {
    if (header_.encoding == PlyEncoding::ascii) {
        for (std::size_t i = 0; i < count; ++i) {
            word();
        }
        return;
    }
    if (static_cast<std::size_t>(end_ - at_) / size_of(type) < count) {
        fail_at_end();
    }
    at_ += count * size_of(type);
}

void PlyBody::skip(const PlyProperty& property) {
    skip_values(property.count ? length(property) : 1, property.type);
}

void PlyBody::finish() {
    while (at_ != end_ && (is_blank(*at_) || *at_ == '\0')) {
        line_ += *at_ == '\n' ? 1 : 0;
        ++at_;
    }
    if (at_ != end_) {
        const std::string place = header_.encoding == PlyEncoding::ascii ? fmt::format(":{}", line_) : "";
        throw UserError(fmt::format("{}{}: the file goes on after its last element, by {} bytes; mend the "
                                    "numbers of elements in its header",
                                    printable(file_name_, 1000), place, end_ - at_));
    }
}

} // namespace razor
