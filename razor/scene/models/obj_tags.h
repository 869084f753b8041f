// The tag lines of an OBJ cage: `t NAME nInts/nFloats/nStrings ints floats strings`; points and faces count
// from 0.
#pragma once

#include "razor/scene/models/obj_cursor.h"
#include "razor/scene/scene.h"

#include <cstdint>
#include <vector>

namespace razor {

class ObjTags {
public:
    /// Reads one tag into `mesh`; the cursor stands behind the `t`. Tags may come before what they name.
    void read(ObjCursor& cursor, Mesh& mesh);

    /// Checks the numbers of all tags against the finished cage. Throws UserError naming the tag's line.
    void finish(const ObjCursor& cursor, const Mesh& mesh) const;

private:
    std::vector<std::int64_t> crease_lines_, corner_lines_, hole_lines_; // one an entry of the mesh's lists
};

} // namespace razor
