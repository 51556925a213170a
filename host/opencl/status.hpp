// OpenCL status codes in words.
#pragma once
#include <string>

namespace understory {

/// "CL_INVALID_ARG_SIZE (-51)"; just the number for a code that has no name here.
std::string status_text(int code);

}  // namespace understory
