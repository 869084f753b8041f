// What of scenes studies may set: `scene` (a file, relative to the study's) and the options of `razor render`
// that choose and override one, with _ in place of -; --spp is `samples` here, as in scene files.
#pragma once

#include "analysis/study/settings.h"
#include "razor/program/study/checks.h"
#include "razor/scene/description.h"

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace razor {

/// One of them; of whole numbers, numbers (both in a range), words, texts and flags.
struct SceneKnob {
    enum Kind { whole, number, text, flag } kind;
    std::string_view key, option;
    double least = 0, most = 0;
    std::vector<std::string_view> words{}; // of texts that are one of some
};
const std::vector<SceneKnob>& scene_knobs();

/// What is wrong with a value (cause; mend), or an empty text; nothing where scenes have no such key. Numbers
/// become real ones where they may have fractions.
std::optional<std::string> wrong_scene_setting(std::string_view key, analysis::Value& value);
/// no_setting() of these keys and those of scenes.
std::string no_scene_setting(std::string_view key, const std::vector<std::string_view>& others);

/// The scene of these settings, posed; keys that are not of scenes are passed over. Files are found from
/// `folder`. Throws UserError.
SceneDescription describe_scene(const analysis::Settings& settings, const std::filesystem::path& folder);

/// What the scene itself says where the settings do not: samples, levels of detail and so on.
analysis::Settings with_defaults(analysis::Settings settings, const SceneDescription& scene);

/// Of the bytes of the scene's file and of those that it names, as a name (analysis::point_name()); of
/// sequences of files by their pattern alone.
std::string scene_digest(const analysis::Settings& settings, const std::filesystem::path& folder,
                         const SceneDescription& scene);

/// The file of the settings' scene, where the digest of what it and the files it names are now is another
/// one; else nothing.
std::string changed_scene(const analysis::Settings& settings, const std::filesystem::path& folder,
                          const std::string& digest);

} // namespace razor
