#include "viz/vtk/egl_window.hpp"

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <GL/glew.h>

namespace understory {

EglWindow* EglWindow::New() {
  auto* window = new EglWindow;
  window->InitializeObjectBase();
  return window;
}

EglWindow::EglWindow() {
  this->MultiSamples = 0;  // under llvmpipe several samples cost three to five times as much
  this->SetOffScreenRendering(1);
}

EglWindow::~EglWindow() { this->EglWindow::Finalize(); }

bool EglWindow::create_context() {
  if (context_) return true;
  const auto platform_display =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(eglGetProcAddress("eglGetPlatformDisplayEXT"));
  if (!platform_display) return false;
  display_ = platform_display(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
  EGLint major = 0, minor = 0;
  if (!display_ || !eglInitialize(display_, &major, &minor)) return false;
  eglBindAPI(EGL_OPENGL_API);
  const EGLint wanted[] = {EGL_SURFACE_TYPE,
                           EGL_PBUFFER_BIT,
                           EGL_RENDERABLE_TYPE,
                           EGL_OPENGL_BIT,
                           EGL_RED_SIZE,
                           8,
                           EGL_GREEN_SIZE,
                           8,
                           EGL_BLUE_SIZE,
                           8,
                           EGL_ALPHA_SIZE,
                           8,
                           EGL_NONE};
  EGLConfig config = nullptr;
  EGLint found = 0;
  if (!eglChooseConfig(display_, wanted, &config, 1, &found) || found < 1) return false;
  const EGLint version[] = {
      EGL_CONTEXT_MAJOR_VERSION,           3,       EGL_CONTEXT_MINOR_VERSION, 2, EGL_CONTEXT_OPENGL_PROFILE_MASK,
      EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
  context_ = eglCreateContext(display_, config, EGL_NO_CONTEXT, version);
  if (!context_) return false;
  const EGLint size[] = {EGL_WIDTH, 16, EGL_HEIGHT, 16, EGL_NONE};
  surface_ = eglCreatePbufferSurface(display_, config, size);
  this->MakeCurrent();
  this->SetReadyForRendering(true);
  this->SetSupportsOpenGL(1);
  this->SetOwnContext(1);
  this->SetMapped(1);
  this->SetShowWindow(false);
  this->SetUseOffScreenBuffers(true);
  this->SetFrameBlitModeToNoBlit();
  return true;
}

void EglWindow::MakeCurrent() {
  if (context_) eglMakeCurrent(display_, surface_, surface_, context_);
}

bool EglWindow::IsCurrent() { return context_ && eglGetCurrentContext() == context_; }

void EglWindow::OpenGLInitContext() {
  this->ContextCreationTime.Modified();
  if (this->Initialized) return;
  // Debian's GLEW is made for GLX: it loads every entry point and then complains that there is no X display.
  glewExperimental = GL_TRUE;
  glewInit();
  this->GlewInitValid = GLEW_VERSION_3_2 != 0;
  this->Initialized = this->GlewInitValid;
}

void EglWindow::Initialize() {
  if (this->Initialized || !create_context()) return;
  this->MakeCurrent();
  this->OpenGLInit();
}

void EglWindow::Start() {
  this->Initialize();
  this->Superclass::Start();
}

void EglWindow::Render() {
  this->Initialize();
  this->MakeCurrent();
  vtkOpenGLRenderWindow::Render();
}

void EglWindow::Frame() { vtkOpenGLRenderWindow::Frame(); }

void EglWindow::Finalize() {
  if (!context_) return;
  this->MakeCurrent();
  this->ReleaseGraphicsResources(this);
  eglMakeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
  if (surface_) eglDestroySurface(display_, surface_);
  // The display stays: all windows share it.
  eglDestroyContext(display_, context_);
  context_ = surface_ = nullptr;
}

}  // namespace understory
