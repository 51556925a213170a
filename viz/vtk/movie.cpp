// vtkOggTheoraWriter behind our temporary names.
#include "viz/vtk/movie.hpp"

#include <fmt/format.h>
#include <unistd.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkOggTheoraWriter.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <fstream>
#include <utility>

#include "sim/error.hpp"
#include "sim/files/atomic_file.hpp"
#include "viz/vtk/ogg_serial.hpp"
#include "viz/vtk/picture_image.hpp"
#include "viz/vtk/vtk_errors.hpp"

namespace understory {

struct MovieWriter::Impl {
  std::filesystem::path path, temporary;
  vtkNew<vtkImageData> image;
  vtkNew<vtkOggTheoraWriter> writer;
  VtkErrors errors{writer};
  bool started = false;

  void close() {
    if (std::exchange(started, false)) writer->End();
  }
  void check() const {
    errors.rethrow(ErrorKind::input_output, path);
    if (writer->GetError() != 0) throw Error(ErrorKind::input_output, path.string() + ": cannot write the movie");
  }
};

MovieWriter::MovieWriter(const std::filesystem::path& path, double frames_per_second) : impl_(new Impl) {
  impl_->path = path;
  impl_->temporary =
      path.parent_path() / ("." + path.stem().string() + ".movie-" + std::to_string(::getpid()) + ".ogv");
  impl_->writer->SetFileName(impl_->temporary.c_str());
  impl_->writer->SetQuality(2);
  impl_->writer->SetRate(std::max(1, static_cast<int>(std::lround(frames_per_second))));
  impl_->writer->SetInputData(impl_->image);
}

MovieWriter::~MovieWriter() {
  impl_->close();
  std::error_code ignored;
  std::filesystem::remove(impl_->temporary, ignored);
}

void MovieWriter::add(const Picture& picture) {
  int dimensions[3];
  impl_->image->GetDimensions(dimensions);
  if (impl_->started && (dimensions[0] != picture.width || dimensions[1] != picture.height))
    throw Error(ErrorKind::unexpected,
                fmt::format("{}: a picture of {} x {} in a movie of {} x {}", impl_->path.string(), picture.width,
                            picture.height, dimensions[0], dimensions[1]));
  copy_to_image(picture, impl_->image);
  if (!impl_->started) {
    // VTK prints a warning of its own for a file that it cannot open.
    if (!std::ofstream(impl_->temporary))
      throw Error(ErrorKind::input_output, impl_->path.string() + ": cannot create: " + std::strerror(errno));
    impl_->writer->Start();
    impl_->check();
    impl_->started = true;
  }
  impl_->writer->Write();
  impl_->check();
}

void MovieWriter::finish() {
  if (!impl_->started) throw Error(ErrorKind::input_output, impl_->path.string() + ": a movie without pictures");
  impl_->close();
  impl_->check();
  set_ogg_serial_number(impl_->temporary, 1);
  write_atomically(impl_->path, [&](const std::filesystem::path& temporary) {
    std::filesystem::rename(impl_->temporary, temporary);
  });
}

}  // namespace understory
