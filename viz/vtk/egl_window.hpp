// A render window that needs no X server: Debian's VTK 9.1 has none, but vtkGenericOpenGLRenderWindow draws into any
// context that is current, so a surfaceless EGL one is made for it. Includes VTK: for viz/vtk only.
#pragma once
#include <vtkGenericOpenGLRenderWindow.h>

namespace understory {

class EglWindow : public vtkGenericOpenGLRenderWindow {
 public:
  static EglWindow* New();
  vtkTypeMacro(EglWindow, vtkGenericOpenGLRenderWindow);

  /// False where EGL gives no OpenGL 3.2 context without a surface.
  bool create_context();

  void MakeCurrent() override;
  bool IsCurrent() override;
  int SupportsOpenGL() override { return 1; }
  vtkTypeBool IsDirect() override { return 1; }
  void OpenGLInitContext() override;
  void Initialize() override;
  void Start() override;
  void Render() override;
  void Frame() override;
  void Finalize() override;

 protected:
  EglWindow();
  ~EglWindow() override;

 private:
  void* display_ = nullptr;  // EGLDisplay, EGLContext, EGLSurface
  void* context_ = nullptr;
  void* surface_ = nullptr;
};

}  // namespace understory
