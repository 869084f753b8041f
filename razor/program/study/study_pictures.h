// Pictures of a point: rendered with their times, compared with references.
#pragma once

#include "analysis/images/image_file.h"
#include "analysis/metrics/error_parts.h"
#include "analysis/study/settings.h"
#include "analysis/study/store.h"
#include "razor/image/image.h"
#include "razor/native/render.h"

#include <atomic>
#include <filesystem>
#include <string>
#include <vector>

namespace razor {

struct StudyPicture {
    Film film;
    RenderStatistics statistics;
};

/// The keys of how the host renders, which change no picture: threads, isa, share, memory, eager.
const std::vector<std::string_view>& host_keys();
/// What is wrong with one of them, likewise as wrong_scene_setting().
std::optional<std::string> wrong_host_setting(std::string_view key, analysis::Value& value);

/// `frames` times in a row, as `razor render --repeat` does, with layers of picks if asked. Throws UserError,
/// analysis::Stopped.
StudyPicture render_study_picture(const analysis::Settings& settings, const std::filesystem::path& folder,
                                  int seed, int frames, bool picks, const std::atomic<bool>& cancel);

/// The planes of these names.
analysis::ImageFile image_of(const Film& film, const std::vector<std::string>& planes);

/// What a point's pictures are compared with.
struct StudyReferences {
    std::vector<analysis::ImageFile> pictures; // independent ones
    /// As many as the point has seeds: with its own samples at the references' levels; or none.
    std::vector<analysis::ImageFile> pairs;
};

/// RMSE, relative MSE, MAPE and HDR-FLIP of each picture against the mean of the references; bias and noise
/// apart; hits of the first picture, where it has such layers. Throws UserError.
void add_errors(analysis::Samples& values, const std::vector<analysis::ImageFile>& pictures,
                const StudyReferences& references);

/// Times and sizes of a run: first and later frames apart.
void add_times(analysis::Samples& host, const RenderStatistics& statistics);

} // namespace razor
