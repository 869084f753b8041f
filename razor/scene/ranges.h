// Least and greatest values of settings, the same in scene files and on the command line.
#pragma once

namespace razor {

struct Range {
    double least = 0, most = 0; // both allowed
};

inline constexpr Range size_range{1, 32768};          // pixels, width and height
inline constexpr Range crop_range{0, 32768};          // pixels
inline constexpr Range filter_radius_range{0.01, 32}; // pixels
inline constexpr Range samples_range{1, 65536};       // a pixel
inline constexpr Range noise_threshold_range{0, 1e3}; // 0: all take as many
inline constexpr Range target_error_range{1e-4, 10};  // relative
inline constexpr Range shadow_samples_range{0, 4096}; // a hit, to the light or the sky
inline constexpr Range light_choices_range{0, 64};    // a hit, to lights that are chosen
inline constexpr Range stops_range{-64, 64};          // stops
inline constexpr Range bounces_range{0, 64};          // in a row
inline constexpr Range seed_range{0, 2147483647};
inline constexpr Range edge_pixels_range{0.01, 1e4};
inline constexpr Range coordinate_range{-1e30, 1e30};
inline constexpr Range fov_range{1e-3, 179};      // degrees
inline constexpr Range height_range{1e-30, 1e30}; // of an orthographic camera's film
inline constexpr Range unit_range{0, 1};          // of what is a part of all
inline constexpr Range ior_range{1, 3};
inline constexpr Range normal_scale_range{-100, 100};
inline constexpr Range texcoord_range{-1e6, 1e6}; // of what maps texture coordinates
inline constexpr Range pattern_size_range{1e-12, 1e12};
inline constexpr Range octaves_range{1, 24};
inline constexpr Range gain_range{0, 1};
inline constexpr Range amount_range{0, 1e3};
inline constexpr Range displacement_range{-1e12, 1e12}; // heights, and world units of one
inline constexpr Range radiance_range{0, 1e9};
inline constexpr Range intensity_range{0, 1e30};    // W / sr: of large scenes, as squared lengths
inline constexpr Range light_radius_range{0, 1e30}; // of disks and spheres
inline constexpr Range cone_range{0, 180};          // degrees
inline constexpr Range angular_radius_range{0, 89}; // degrees
inline constexpr Range signed_scale_range{-1e30, 1e30};
inline constexpr Range time_range{0, 1e6};          // seconds, of keys
inline constexpr Range frame_rate_range{1e-3, 1e6}; // frames a second
inline constexpr Range frame_range{0, 9999999};
inline constexpr Range aperture_range{0, 1e30};
inline constexpr Range focus_range{0, 1e30};     // 0: at the camera's target
inline constexpr Range angle_range{-1e6, 1e6};   // degrees
inline constexpr Range scale_range{1e-30, 1e30}; // of what is not mirrored
inline constexpr Range rate_range{1e-3, 1e3};    // factor on a target edge length
inline constexpr Range level_offset_range{-32, 32};
inline constexpr Range copies_range{1, 1000000}; // of an array, along one axis

} // namespace razor
