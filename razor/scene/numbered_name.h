// File names with the place of a number in them: picture_%d.png, walk_%03d.obj.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace razor {

/// Whether a name has %d, or %0Nd with N from 1 to 9.
bool has_number(std::string_view name);

/// The name with `number` in place of %d, or of %0Nd with zeros before it up to N digits. Without a place for
/// it, the name.
std::string numbered(std::string_view name, int number);

/// The name without the place of a number, and without `_`, `-` or `.` left at its end.
std::string without_number(std::string_view name);

/// All numbers for which there is such a file, in order. The number's place must be in the name, not in its
/// folder's.
std::vector<int> numbers_there(const std::string& name);

} // namespace razor
