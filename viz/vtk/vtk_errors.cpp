// An object with an observer for ErrorEvent does not print.
#include "viz/vtk/vtk_errors.hpp"

namespace understory {

class VtkErrors::Listener : public vtkCommand {
 public:
  static Listener* New() { return new Listener; }
  void Execute(vtkObject*, unsigned long, void* text) override {
    if (first_.empty() && text != nullptr) first_ = static_cast<const char*>(text);
    if (first_.empty()) first_ = "unnamed error";
  }
  const std::string& first() const { return first_; }

 private:
  std::string first_;
};

VtkErrors::VtkErrors(vtkObject* object)
    : object_(object), listener_(Listener::New()), tag_(object->AddObserver(vtkCommand::ErrorEvent, listener_)) {}

VtkErrors::~VtkErrors() {
  object_->RemoveObserver(tag_);
  listener_->Delete();
}

void VtkErrors::rethrow(ErrorKind kind, const std::filesystem::path& path) const {
  if (listener_->first().empty()) return;
  std::string text = listener_->first();
  // "ERROR: In file, line N\nvtkClass (0x...): what" becomes "what", on one line.
  if (const auto start = text.find("): "); start != std::string::npos) text = text.substr(start + 3);
  for (char& c : text)
    if (c == '\n') c = ' ';
  throw Error(kind, path.string() + ": " + text);
}

}  // namespace understory
