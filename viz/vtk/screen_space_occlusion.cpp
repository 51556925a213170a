#include "viz/vtk/screen_space_occlusion.hpp"

#include <sys/resource.h>
#include <vtkActor.h>
#include <vtkCamera.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkNew.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderStepsPass.h>
#include <vtkRenderer.h>
#include <vtkSSAOPass.h>
#include <vtkUnsignedCharArray.h>

#include <algorithm>
#include <glm/glm.hpp>
#include <limits>

#include "sim/error.hpp"
#include "viz/vtk/egl_window.hpp"

namespace understory {
namespace {

/// Milliseconds that this process has used on all its threads.
double processor_ms() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  const auto ms = [](const timeval& t) {
    return 1e3 * static_cast<double>(t.tv_sec) + 1e-3 * static_cast<double>(t.tv_usec);
  };
  return ms(usage.ru_utime) + ms(usage.ru_stime);
}

/// Triangles with vertices of their own and their face's normal: what the frame shades is flat too.
vtkNew<vtkPolyData> flat_triangles(const PosedGeometry& geometry) {
  const auto corners = static_cast<vtkIdType>(geometry.triangles.size());
  vtkNew<vtkFloatArray> points, normals;
  vtkNew<vtkCellArray> cells;
  for (const auto& array : {points.Get(), normals.Get()}) {
    array->SetNumberOfComponents(3);
    array->SetNumberOfTuples(corners);
  }
  cells->AllocateExact(corners / 3, corners);
  for (vtkIdType first = 0; first < corners; first += 3) {
    glm::vec3 p[3];
    for (int k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis)
        p[k][axis] = geometry.positions[3 * std::size_t{geometry.triangles[static_cast<std::size_t>(first + k)]} +
                                        static_cast<std::size_t>(axis)];
    const glm::vec3 face = glm::cross(p[1] - p[0], p[2] - p[0]);
    const glm::vec3 n = face / std::max(glm::length(face), 1e-30f);
    for (int k = 0; k < 3; ++k) {
      points->SetTypedTuple(first + k, &p[k].x);
      normals->SetTypedTuple(first + k, &n.x);
    }
    const vtkIdType ids[3] = {first, first + 1, first + 2};
    cells->InsertNextCell(3, ids);
  }
  vtkNew<vtkPoints> positions;
  positions->SetData(points);
  vtkNew<vtkPolyData> data;
  data->SetPoints(positions);
  data->SetPolys(cells);
  data->GetPointData()->SetNormals(normals);
  return data;
}

void look_like(const Frame& frame, vtkCamera& camera) {
  const glm::dmat4 to_world = glm::inverse(frame.world_to_camera);
  const glm::dvec3 eye(to_world[3]), ahead = eye - glm::dvec3(to_world[2]), up(to_world[1]);
  camera.SetPosition(eye.x, eye.y, eye.z);
  camera.SetFocalPoint(ahead.x, ahead.y, ahead.z);
  camera.SetViewUp(up.x, up.y, up.z);
  camera.SetViewAngle(glm::degrees(frame.vertical_fov));
}

}  // namespace

ScreenSpaceOcclusion vtk_screen_space_occlusion(const PosedGeometry& geometry, const Frame& frame, double radius,
                                                int samples, bool blur, int repetitions) {
  vtkNew<EglWindow> window;
  if (!window->create_context())
    throw Error(ErrorKind::no_device,
                "EGL gives no OpenGL context without a display; install libegl1 and libgl1-mesa-dri");
  window->SetSize(frame.width, frame.height);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(flat_triangles(geometry));
  vtkNew<vtkActor> actor;
  actor->SetMapper(mapper);
  // White however it is lit: what is darker than white is occluded. Without lighting there would be no normals.
  actor->GetProperty()->SetAmbient(1);
  actor->GetProperty()->SetDiffuse(0);
  vtkNew<vtkRenderer> renderer;
  renderer->AddActor(actor);
  renderer->SetBackground(1, 1, 1);
  window->AddRenderer(renderer);
  look_like(frame, *renderer->GetActiveCamera());
  renderer->ResetCameraClippingRange();

  vtkNew<vtkRenderStepsPass> steps;
  vtkNew<vtkSSAOPass> occlusion;
  occlusion->SetRadius(radius);
  occlusion->SetKernelSize(static_cast<unsigned>(samples));
  occlusion->SetBias(0.02 * radius);
  occlusion->SetBlur(blur);
  occlusion->SetDelegatePass(steps);

  ScreenSpaceOcclusion result;
  result.with_ms = result.without_ms = std::numeric_limits<double>::max();
  for (int round = 0; round <= repetitions; ++round)
    for (const bool with : {false, true}) {
      renderer->SetPass(with ? static_cast<vtkRenderPass*>(occlusion.Get()) : steps.Get());
      const double start = processor_ms();
      window->Render();
      window->WaitForCompletion();
      double& least = with ? result.with_ms : result.without_ms;
      if (round > 0) least = std::min(least, 0.5 * (processor_ms() - start));  // the first round compiles shaders
    }
  result.pass_ms = result.with_ms - result.without_ms;

  vtkNew<vtkUnsignedCharArray> pixels;
  window->GetPixelData(0, 0, frame.width - 1, frame.height - 1, 0, pixels.Get(), 0);
  for (int y = frame.height - 1; y >= 0; --y)
    for (int x = 0; x < frame.width; ++x)
      result.open.push_back(static_cast<float>(pixels->GetValue(3 * (static_cast<vtkIdType>(y) * frame.width + x))) /
                            255.0f);
  return result;
}

}  // namespace understory
