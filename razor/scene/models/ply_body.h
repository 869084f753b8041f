// Walks over the values of a PLY file, of any encoding.
#pragma once

#include "razor/scene/models/ply_header.h"

namespace razor {

class PlyBody {
public:
    /// All must outlive it.
    PlyBody(std::string_view file, const PlyHeader& header, std::string_view file_name);

    /// What is read now, for messages. Throws UserError where so many elements cannot be in what is left.
    void begin(const PlyElement& element);
    /// ... and which of them, from 0.
    void at(std::uint64_t number) { number_ = number; }

    // The next value, of this type. Those of an encoding by text are as exact as the type is. Throw UserError
    // where there is none, or none of this type.
    double number(PlyType type);
    std::int64_t whole(PlyType type);
    /// The length of a list that comes next, whose values are in what is left.
    std::size_t length(const PlyProperty& list);
    void skip(const PlyProperty& property);

    /// Throws UserError where more than blanks is left.
    void finish();

    /// Throws UserError "file:line: message", of binary files "file: vertex 3: message".
    [[noreturn]] void fail(std::string_view message) const;

private:
    std::string_view word();
    std::uint64_t bits(std::size_t bytes);
    void skip_values(std::size_t count, PlyType type);
    [[noreturn]] void fail_at_end() const;

    const char* at_;
    const char* end_;
    const PlyHeader& header_;
    std::string_view file_name_;
    const PlyElement* element_ = nullptr;
    std::uint64_t number_ = 0;
    std::int64_t line_; // of text
};

} // namespace razor
