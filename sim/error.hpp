// The one exception of the project: what went wrong, where, and what is allowed, in one line for a person.
// Libraries throw it and never print or exit; `main` catches it once and turns the kind into the exit code.
#pragma once
#include <stdexcept>
#include <string>

namespace understory {

/// Exit codes of the program (DESIGN.md, "The program").
enum class ErrorKind {
  unexpected = 1,
  usage = 2,
  invalid_input = 3,
  no_device = 4,
  input_output = 5,
};

class Error : public std::runtime_error {
 public:
  Error(ErrorKind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}
  ErrorKind kind() const { return kind_; }

 private:
  ErrorKind kind_;
};

}  // namespace understory
