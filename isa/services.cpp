#include "isa/services.h"

namespace isa {

void throw_trapped(int code) { throw trapped(code); }

} // namespace isa
