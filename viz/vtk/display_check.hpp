// Whether an X display can be used, asked before VTK does: VTK aborts the process when there is none.
#pragma once

namespace understory {

/// Throws Error(no_device) naming DISPLAY when it is unset, cannot be opened, or has no GLX.
void check_display();

}  // namespace understory
