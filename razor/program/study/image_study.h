// Pictures of a scene against references: their errors, and what they cost.
#pragma once

#include "analysis/study/point.h"
#include "analysis/study/run.h"
#include "razor/program/study/study_options.h"

#include <atomic>
#include <filesystem>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace razor {

/// Settings, figures and plots that `razor study` knows.
StudyProgram image_study_program();

/// Which pictures the points of a study need and what each is compared with.
class ImageStudy {
public:
    /// `folder`: where files are named from. `cancel`: stops renders.
    ImageStudy(const analysis::Study& study, std::filesystem::path folder, const std::atomic<bool>& cancel);

    /// A point's body. Throws UserError where it is impossible.
    std::string body(const analysis::Point& point) const;
    /// Pictures that these points are compared with, each once.
    std::vector<analysis::Point> references(const std::vector<analysis::Point>& points) const;
    /// Renders one of them into the store's references/. Throws UserError, analysis::Stopped.
    analysis::Result make_reference(const analysis::Point& reference, const analysis::Store& store) const;
    /// Renders a point by all seeds, in this process, and compares it. Throws UserError, analysis::Stopped.
    analysis::Result measure(const analysis::Point& point, const analysis::Store& store) const;
    /// The file of a point's scene that is no more what the point's body says, or nothing.
    std::string changed(const analysis::Point& point) const;

private:
    /// What is known of a scene of these settings.
    struct Described {
        std::string digest;
        analysis::Settings settings; // all of them
    };
    const Described& described(const analysis::Settings& settings) const;
    analysis::Settings reference_settings(const analysis::Point& point) const;
    /// The point at the reference's levels of detail, all else as it is.
    analysis::Settings paired_settings(const analysis::Point& point) const;
    bool is_paired() const;
    /// A picture that others are compared with.
    analysis::Point picture(analysis::Settings settings, int seed) const;
    std::vector<analysis::Point> references_of(const analysis::Point& point) const;
    std::vector<analysis::Point> pairs_of(const analysis::Point& point) const;

    const analysis::Study& study_;
    std::filesystem::path folder_;
    const std::atomic<bool>& cancel_;
    mutable std::map<std::string, Described> described_; // by the settings' text: scenes take long to read
};

} // namespace razor
