// Materials as the kernels want them, and what kernels they want.
#pragma once

#include "razor/frame/kernel_table.h"
#include "razor/scene/scene.h"

namespace razor {

MaterialRecord material_record(const Material& material);

/// What shading of the scene must be compiled for, by the materials that some mesh or instance may have.
Look look_of(const Scene& scene);

} // namespace razor
