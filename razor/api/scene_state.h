// What a scene of the library holds, for its own sources.
#pragma once

#include "razor/api/scene.h"
#include "razor/scene/description.h"

#include <utility>
#include <vector>

namespace razor::api {

/// What of a scene is other than when it was last rendered.
struct SceneEdits {
    bool view = false;                  // cameras, lights, light of the sky
    std::vector<PlacementName> objects; // their transforms: of group -1 those of none
    bool more = false;                  // anything

    bool any() const { return view || more || !objects.empty(); }
};

struct Scene::State {
    SceneDescription description;
    SceneEdits edits{};

    /// A scene that takes another one's place.
    static std::unique_ptr<State> of(SceneDescription description) {
        auto state = std::make_unique<State>(State{std::move(description)});
        state->edits.more = true;
        return state;
    }
};

} // namespace razor::api
