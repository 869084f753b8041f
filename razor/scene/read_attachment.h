// `attach` and `tag` or `node` of [[object]] in scene files.
#pragma once

#include "razor/scene/description.h"
#include "razor/scene/toml_table.h"

#include <optional>
#include <span>
#include <vector>

namespace razor {

/// The names alone, if they are stated. Throws UserError unless there are two, or none.
std::optional<Attachment> read_attachment(TomlTable& table);

/// Finds what the names in a list of objects stand for, `tables` being where each was read. Throws UserError
/// for names that are not there or not clear, carriers without usable tags or nodes, and objects that hang on
/// each other.
void resolve_attachments(std::span<const TomlTable> tables, const SceneDescription& scene,
                         std::vector<ObjectDescription>& objects);

} // namespace razor
