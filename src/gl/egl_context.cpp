// SPDX-License-Identifier: Apache-2.0
#define EGL_NO_X11
#include <EGL/egl.h>
#include <EGL/eglext.h>

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

#include "gl/backends.h"
#include "gl/shared_library.h"
#include "umbrick/core/error.h"

namespace umbrick {
namespace {

bool hasExtension(const char* list, std::string_view name) {
  std::string_view rest = list ? list : "";
  while (!rest.empty()) {
    const auto end = rest.find(' ');
    if (rest.substr(0, end) == name) return true;
    if (end == std::string_view::npos) break;
    rest.remove_prefix(end + 1);
  }
  return false;
}

// The functions of EGL that are used here, from a library that is loaded at run time.
struct Egl {
  explicit Egl(const SharedLibrary& library)
      : getProcAddress(library.function<PFNEGLGETPROCADDRESSPROC>("eglGetProcAddress")),
        getDisplay(library.function<PFNEGLGETDISPLAYPROC>("eglGetDisplay")),
        queryString(library.function<PFNEGLQUERYSTRINGPROC>("eglQueryString")),
        initialize(library.function<PFNEGLINITIALIZEPROC>("eglInitialize")),
        bindApi(library.function<PFNEGLBINDAPIPROC>("eglBindAPI")),
        chooseConfig(library.function<PFNEGLCHOOSECONFIGPROC>("eglChooseConfig")),
        createContext(library.function<PFNEGLCREATECONTEXTPROC>("eglCreateContext")),
        destroyContext(library.function<PFNEGLDESTROYCONTEXTPROC>("eglDestroyContext")),
        makeCurrent(library.function<PFNEGLMAKECURRENTPROC>("eglMakeCurrent")),
        getCurrentContext(library.function<PFNEGLGETCURRENTCONTEXTPROC>("eglGetCurrentContext")) {}

  PFNEGLGETPROCADDRESSPROC getProcAddress;
  PFNEGLGETDISPLAYPROC getDisplay;
  PFNEGLQUERYSTRINGPROC queryString;
  PFNEGLINITIALIZEPROC initialize;
  PFNEGLBINDAPIPROC bindApi;
  PFNEGLCHOOSECONFIGPROC chooseConfig;
  PFNEGLCREATECONTEXTPROC createContext;
  PFNEGLDESTROYCONTEXTPROC destroyContext;
  PFNEGLMAKECURRENTPROC makeCurrent;
  PFNEGLGETCURRENTCONTEXTPROC getCurrentContext;
};

struct Candidate {
  std::string name;
  EGLDisplay display;
};

// A device that EGL lists, with its number.
struct Device {
  int number = 0;
  EGLDeviceEXT device = nullptr;
  bool software = false;
};

std::vector<Device> devicesOf(const Egl& egl) {
  std::vector<Device> devices;
  const auto queryDevices = reinterpret_cast<PFNEGLQUERYDEVICESEXTPROC>(egl.getProcAddress("eglQueryDevicesEXT"));
  const auto queryDevice =
      reinterpret_cast<PFNEGLQUERYDEVICESTRINGEXTPROC>(egl.getProcAddress("eglQueryDeviceStringEXT"));
  if (!queryDevices || !queryDevice ||
      !hasExtension(egl.queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), "EGL_EXT_platform_device"))
    return devices;
  EGLDeviceEXT found[16];
  EGLint count = 0;
  if (!queryDevices(16, found, &count)) count = 0;
  for (int i = 0; i < count; ++i)
    devices.push_back({i, found[i], hasExtension(queryDevice(found[i], EGL_EXTENSIONS), "EGL_MESA_device_software")});
  return devices;
}

// Lists displays that need no screen, GPUs first: devices with hardware, Mesa's surfaceless platform, software devices,
// and what the environment calls its default.
std::vector<Candidate> candidates(const Egl& egl) {
  std::vector<Candidate> hardware, software;
  const char* client = egl.queryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
  const auto getPlatformDisplay =
      reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(egl.getProcAddress("eglGetPlatformDisplayEXT"));
  if (getPlatformDisplay)
    for (const Device& device : devicesOf(egl)) {
      const EGLDisplay display = getPlatformDisplay(EGL_PLATFORM_DEVICE_EXT, device.device, nullptr);
      (device.software ? software : hardware).push_back({"device " + std::to_string(device.number), display});
    }
  std::vector<Candidate> all = hardware;
  if (getPlatformDisplay && hasExtension(client, "EGL_MESA_platform_surfaceless"))
    all.push_back({"surfaceless", getPlatformDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
  all.insert(all.end(), software.begin(), software.end());
  all.push_back({"default display", egl.getDisplay(EGL_DEFAULT_DISPLAY)});
  return all;
}

class EglContext : public GlContext {
 public:
  EglContext() : library_({"libEGL.so.1", "libEGL.so"}), egl_(library_) {
    std::string reasons;
    for (const Candidate& candidate : candidates(egl_)) {
      const std::string reason = open(candidate.display);
      if (reason.empty()) return;
      reasons += (reasons.empty() ? "" : ", ") + candidate.name + ": " + reason;
    }
    throw GlError(reasons);
  }
  ~EglContext() override { close(); }

  void makeCurrent() override {
    // EGL does nothing for a context that it takes for current, though OSMesa may have put another one in its place. So
    // EGL is told first that none is current.
    if (egl_.getCurrentContext() == context_)
      egl_.makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (!egl_.makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, context_))
      throw GlError("cannot make the context current");
  }

 private:
  // Makes the context. @return empty, or what failed
  std::string open(EGLDisplay display) {
    if (display == EGL_NO_DISPLAY) return "no display";
    EGLint major = 0, minor = 0;
    if (!egl_.initialize(display, &major, &minor)) return "cannot be initialised";
    display_ = display;
    try {
      if (!hasExtension(egl_.queryString(display, EGL_EXTENSIONS), "EGL_KHR_surfaceless_context"))
        throw GlError("no EGL_KHR_surfaceless_context");
      if (!egl_.bindApi(EGL_OPENGL_API)) throw GlError("no desktop OpenGL");
      const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_NONE};
      EGLConfig config = nullptr;
      EGLint count = 0;
      if (!egl_.chooseConfig(display, wanted, &config, 1, &count) || count < 1)
        throw GlError("no OpenGL configuration");
      const EGLint attributes[] = {
          EGL_CONTEXT_MAJOR_VERSION,           4,       EGL_CONTEXT_MINOR_VERSION, 5, EGL_CONTEXT_OPENGL_PROFILE_MASK,
          EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT, EGL_NONE};
      context_ = egl_.createContext(display, config, EGL_NO_CONTEXT, attributes);
      if (context_ == EGL_NO_CONTEXT) throw GlError("no OpenGL 4.5 core context");
      makeCurrent();
      initialise(Backend::egl, std::make_unique<GlFunctions>(loadGlFunctions([&](const char* name) {
                   return reinterpret_cast<GlProcedure>(egl_.getProcAddress(name));
                 })));
      return {};
    } catch (const GlError& error) {
      close();
      return error.what();
    }
  }
  void close() {
    if (display_ == EGL_NO_DISPLAY) return;
    // If another context is current by now, it stays so.
    if (context_ != EGL_NO_CONTEXT && egl_.getCurrentContext() == context_)
      egl_.makeCurrent(display_, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    if (context_ != EGL_NO_CONTEXT) egl_.destroyContext(display_, context_);
    // The display belongs to the process and another context may still use it, so it is not terminated.
    context_ = EGL_NO_CONTEXT;
    display_ = EGL_NO_DISPLAY;
  }

  SharedLibrary library_;
  Egl egl_;
  EGLDisplay display_ = EGL_NO_DISPLAY;
  EGLContext context_ = EGL_NO_CONTEXT;
};

}  // namespace

bool hasGpu() {
  try {
    const SharedLibrary library({"libEGL.so.1", "libEGL.so"});
    const std::vector<Device> devices = devicesOf(Egl(library));
    return std::any_of(devices.begin(), devices.end(), [](const Device& device) { return !device.software; });
  } catch (const GlError&) {  // no EGL
    return false;
  }
}

std::unique_ptr<GlContext> createEglContext() { return std::make_unique<EglContext>(); }

}  // namespace umbrick
