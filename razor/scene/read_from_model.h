// [camera] and [[light]] of scene files with `from`: what a model's file brings. Keys: from, name; clip,
// cycle, start, speed, moment as of [[mesh]]; scale (one number), rotate, translate; of lights
// lumens_per_watt.
#pragma once

#include "razor/scene/from_model.h"
#include "razor/scene/toml_table.h"

#include <filesystem>

namespace razor {

/// `table` has a key `from`, a file's name relative to `folder`; of a camera if `camera`, else of lights. The
/// caller reads what else it may have. Throws UserError naming the place.
FromModel read_from_model(TomlTable& table, const std::filesystem::path& folder, bool camera);

/// As it is read, without the table's header.
std::string to_toml(const FromModel& from, bool camera);

} // namespace razor
