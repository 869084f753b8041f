#include "razor/scene/models/ply_header.h"

#include "razor/scene/error.h"
#include "razor/scene/text_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <utility>

namespace razor {
namespace {

constexpr std::array<std::pair<std::string_view, PlyType>, 16> type_names{{
    {"char", PlyType::int8},
    {"uchar", PlyType::uint8},
    {"short", PlyType::int16},
    {"ushort", PlyType::uint16},
    {"int", PlyType::int32},
    {"uint", PlyType::uint32},
    {"float", PlyType::float32},
    {"double", PlyType::float64},
    {"int8", PlyType::int8},
    {"uint8", PlyType::uint8},
    {"int16", PlyType::int16},
    {"uint16", PlyType::uint16},
    {"int32", PlyType::int32},
    {"uint32", PlyType::uint32},
    {"float32", PlyType::float32},
    {"float64", PlyType::float64},
}};

std::vector<std::string_view> words_of(std::string_view line) {
    std::vector<std::string_view> words;
    constexpr std::string_view blanks = " \t\v\f";
    for (std::size_t begin = line.find_first_not_of(blanks); begin != std::string_view::npos;) {
        const std::size_t end = line.find_first_of(blanks, begin);
        words.push_back(line.substr(begin, end - begin));
        begin = line.find_first_not_of(blanks, end);
    }
    return words;
}

template <class Named> const Named* find_named(const std::vector<Named>& list, std::string_view name) {
    const auto found =
        std::find_if(list.begin(), list.end(), [&](const Named& entry) { return entry.name == name; });
    return found == list.end() ? nullptr : &*found;
}

class HeaderParser {
public:
    HeaderParser(std::string_view file, std::string_view file_name) : file_(file), file_name_(file_name) {}

    PlyHeader parse() {
        read_magic();
        bool ended = false, encoded = false;
        while (!ended) {
            const std::vector<std::string_view> words = words_of(next_line());
            if (words.empty() || words[0] == "comment" || words[0] == "obj_info") {
                continue;
            }
            if (words[0] == "format") {
                read_format(words);
                encoded = true;
            } else if (words[0] == "element") {
                read_element(words);
            } else if (words[0] == "property") {
                read_property(words);
            } else if (words[0] == "end_header") {
                ended = true;
            } else {
                fail(fmt::format("'{}' is not a statement of a PLY header; export the model anew",
                                 printable(words[0])));
            }
        }
        if (!encoded) {
            fail("the header ends without a format line; write format ascii 1.0 below ply");
        }
        header_.bytes = at_;
        header_.lines = line_;
        return std::move(header_);
    }

private:
    [[noreturn]] void fail(std::string_view message) const {
        throw UserError(fmt::format("{}:{}: {}", printable(file_name_, 1000), line_, message));
    }

    /// How its line ends is how all do: the first byte of a binary body may look like part of an end.
    void read_magic() {
        line_ = 1;
        if (!file_.starts_with("ply") || (file_.size() > 3 && file_[3] != '\n' && file_[3] != '\r')) {
            fail(fmt::format("begins with '{}', not with a line 'ply'; give a PLY file",
                             printable(file_.substr(0, 4))));
        }
        line_end_ = file_.substr(3, file_.substr(3).starts_with("\r\n") ? 2 : 1);
        at_ = 3 + line_end_.size();
    }

    std::string_view next_line() {
        const std::size_t end = line_end_.empty() ? std::string_view::npos : file_.find(line_end_, at_);
        if (end == std::string_view::npos) {
            fail("the file ends within its header; it is cut off, or has no end_header");
        }
        const std::string_view line = file_.substr(at_, end - at_);
        at_ = end + line_end_.size();
        ++line_;
        return line;
    }

    void read_format(const std::vector<std::string_view>& words) {
        constexpr std::array<std::string_view, 3> encodings{"ascii", "binary_little_endian",
                                                            "binary_big_endian"};
        const auto* const found =
            words.size() == 3 ? std::find(encodings.begin(), encodings.end(), words[1]) : encodings.end();
        if (found == encodings.end() || words[2] != "1.0") {
            fail("this format is not known; write format ascii 1.0, format binary_little_endian 1.0 or "
                 "format binary_big_endian 1.0");
        }
        header_.encoding = static_cast<PlyEncoding>(found - encodings.begin());
    }

    void read_element(const std::vector<std::string_view>& words) {
        PlyElement element;
        if (words.size() != 3 ||
            std::from_chars(words[2].data(), words[2].data() + words[2].size(), element.count) !=
                std::from_chars_result{words[2].data() + words[2].size(), std::errc()}) {
            fail("an element without a name and a number of them; write element vertex 8, or the like");
        }
        if (header_.find(words[1]) != nullptr) {
            fail(fmt::format("there are two elements '{}'; leave one out", printable(words[1])));
        }
        element.name = words[1];
        element.line = line_;
        header_.elements.push_back(std::move(element));
    }

    void read_property(const std::vector<std::string_view>& words) {
        if (header_.elements.empty()) {
            fail("a property before any element; write the element first");
        }
        PlyProperty property;
        const bool list = words.size() > 1 && words[1] == "list";
        if (words.size() != (list ? 5 : 3)) {
            fail("a property is not complete; write property float x or property list uchar int "
                 "vertex_indices, or the like");
        }
        if (list) {
            property.count = to_type(words[2]);
            if (is_real(*property.count)) {
                fail(fmt::format("'{}' counts its list by a {}, which is no whole number; export the model "
                                 "anew",
                                 printable(words[4]), words[2]));
            }
        }
        property.type = to_type(words[list ? 3 : 1]);
        property.name = words.back();
        PlyElement& element = header_.elements.back();
        if (element.find(property.name) != nullptr) {
            fail(fmt::format("element {} has two properties '{}'; leave one out", printable(element.name),
                             printable(property.name)));
        }
        element.properties.push_back(std::move(property));
    }

    PlyType to_type(std::string_view word) const {
        const auto* const found = std::find_if(type_names.begin(), type_names.end(),
                                               [&](const auto& known) { return known.first == word; });
        if (found == type_names.end()) {
            fail(fmt::format("'{}' is no type of PLY; write char, uchar, short, ushort, int, uint, float or "
                             "double",
                             printable(word)));
        }
        return found->second;
    }

    std::string_view file_, file_name_, line_end_;
    std::size_t at_ = 0;
    std::int64_t line_ = 0;
    PlyHeader header_;
};

} // namespace

const PlyProperty* PlyElement::find(std::string_view property) const {
    return find_named(properties, property);
}

std::size_t PlyElement::least_bytes(PlyEncoding encoding) const {
    if (encoding == PlyEncoding::ascii) { // a digit and a blank each
        return 2 * properties.size();
    }
    std::size_t bytes = 0;
    for (const PlyProperty& property : properties) {
        bytes += size_of(property.count.value_or(property.type));
    }
    return bytes;
}

const PlyElement* PlyHeader::find(std::string_view element) const {
    return find_named(elements, element);
}

PlyHeader parse_ply_header(std::string_view file, std::string_view file_name) {
    return HeaderParser(file, file_name).parse();
}

} // namespace razor
