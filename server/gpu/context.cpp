#include "gpu/context.h"

#include <array>
#include <atomic>
#include <cstring>
#include <vector>

#include <spdlog/spdlog.h>

// clang-format off: epoxy's khronos types must come before EGL's.
#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <epoxy/gl.h>
// clang-format on

namespace haustra::gpu {

namespace {

constexpr int wantedMajor = 4, wantedMinor = 5;

bool lists(const char* extensions, const char* name) {
    if (!extensions) return false;
    const std::size_t length = std::strlen(name);
    for (const char* at = std::strstr(extensions, name); at; at = std::strstr(at + length, name)) {
        const bool begins = at == extensions || at[-1] == ' ';
        if (begins && (at[length] == ' ' || at[length] == '\0')) return true;
    }
    return false;
}

template <class Function>
Function eglFunction(const char* name) {
    return reinterpret_cast<Function>(eglGetProcAddress(name));
}

struct Candidate {
    EGLenum platform;
    void* native;
    const char* name;
};

/// Hardware devices, the surfaceless platform, software devices: the order in which to try.
std::vector<Candidate> candidates() {
    std::vector<Candidate> hardware, software;
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const auto queryDevices = eglFunction<PFNEGLQUERYDEVICESEXTPROC>("eglQueryDevicesEXT");
    const auto queryDevice = eglFunction<PFNEGLQUERYDEVICESTRINGEXTPROC>("eglQueryDeviceStringEXT");
    const bool enumerates =
        lists(client, "EGL_EXT_device_enumeration") || lists(client, "EGL_EXT_device_base");
    if (enumerates && queryDevices && queryDevice && lists(client, "EGL_EXT_platform_device")) {
        std::array<EGLDeviceEXT, 32> devices{};
        EGLint count = 0;
        if (queryDevices(EGLint(devices.size()), devices.data(), &count)) {
            for (EGLint i = 0; i < count; ++i) {
                const bool soft =
                    lists(queryDevice(devices[i], EGL_EXTENSIONS), "EGL_MESA_device_software");
                (soft ? software : hardware)
                    .push_back(
                        {EGL_PLATFORM_DEVICE_EXT, devices[i], soft ? "software device" : "device"});
            }
        }
    }
    std::vector<Candidate> all = std::move(hardware);
    if (lists(client, "EGL_MESA_platform_surfaceless"))
        all.push_back({EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, "surfaceless"});
    all.insert(all.end(), software.begin(), software.end());
    return all;
}

void GLAPIENTRY onMessage(GLenum source, GLenum type, GLuint id, GLenum severity, GLsizei,
                          const GLchar* text, const void* errors) {
    (void)source;
    if (type == GL_DEBUG_TYPE_ERROR) {
        static_cast<std::atomic<int>*>(const_cast<void*>(errors))
            ->fetch_add(1, std::memory_order_relaxed);
        spdlog::error("OpenGL {}: {}", id, text);
    } else if (severity == GL_DEBUG_SEVERITY_HIGH) {
        spdlog::warn("OpenGL {}: {}", id, text);
    } else {
        spdlog::trace("OpenGL {}: {}", id, text);
    }
}

}  // namespace

struct Context::Impl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::atomic<int> errors{0};

    /// Makes a current context on one display, or says why not.
    Result<void> open(const Candidate& candidate) {
        const auto getDisplay =
            eglFunction<PFNEGLGETPLATFORMDISPLAYEXTPROC>("eglGetPlatformDisplayEXT");
        if (!getDisplay) return fail(ErrorKind::device, "EGL has no platform displays");
        display = getDisplay(candidate.platform, candidate.native, nullptr);
        EGLint major = 0, minor = 0;
        if (display == EGL_NO_DISPLAY || !eglInitialize(display, &major, &minor))
            return fail(ErrorKind::device, "the display does not initialise");
        const char* extensions = eglQueryString(display, EGL_EXTENSIONS);
        if (!lists(extensions, "EGL_KHR_surfaceless_context"))
            return fail(ErrorKind::device, "the display has no surfaceless contexts");
        if (!eglBindAPI(EGL_OPENGL_API)) return fail(ErrorKind::device, "EGL has no OpenGL");
        const EGLint configAttributes[] = {EGL_SURFACE_TYPE, EGL_PBUFFER_BIT, EGL_RENDERABLE_TYPE,
                                           EGL_OPENGL_BIT, EGL_NONE};
        EGLConfig config = nullptr;
        EGLint configs = 0;
        if (!eglChooseConfig(display, configAttributes, &config, 1, &configs) || configs == 0)
            return fail(ErrorKind::device, "the display has no OpenGL configuration");
        const EGLint contextAttributes[] = {EGL_CONTEXT_MAJOR_VERSION,
                                            wantedMajor,
                                            EGL_CONTEXT_MINOR_VERSION,
                                            wantedMinor,
                                            EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                            EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                            EGL_CONTEXT_OPENGL_DEBUG,
                                            EGL_TRUE,
                                            EGL_NONE};
        context = eglCreateContext(display, config, EGL_NO_CONTEXT, contextAttributes);
        if (context == EGL_NO_CONTEXT) return fail(ErrorKind::device, "OpenGL 4.5 core is refused");
        if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context)) {
            close();
            return fail(ErrorKind::device, "the context does not become current");
        }
        return {};
    }

    /// The display stays initialised: EGL hands every caller in the process the same one, and
    /// terminating it would take the contexts of other threads along.
    void close() {
        if (context == EGL_NO_CONTEXT) return;
        eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
        context = EGL_NO_CONTEXT;
    }
};

Context::Context() : impl_(std::make_unique<Impl>()) {}

Context::~Context() {
    impl_->close();
}

int Context::errorCount() const {
    return impl_->errors.load(std::memory_order_relaxed);
}

Result<std::unique_ptr<Context>> Context::create() {
    std::unique_ptr<Context> made(new Context);
    std::string refusals;
    for (const Candidate& candidate : candidates()) {
        if (Result<void> opened = made->impl_->open(candidate); !opened) {
            refusals += std::string(refusals.empty() ? "" : "; ") + candidate.name + ": " +
                        opened.error().message;
            continue;
        }
        made->renderer_ = reinterpret_cast<const char*>(glGetString(GL_RENDERER));
        made->platform_ = candidate.name;
        made->software_ = made->renderer_.find("llvmpipe") != std::string::npos ||
                          made->renderer_.find("softpipe") != std::string::npos;
        // Synchronous: an error is counted before the call that caused it returns.
        glEnable(GL_DEBUG_OUTPUT);
        glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
        glDebugMessageCallback(onMessage, &made->impl_->errors);
        spdlog::debug("OpenGL on {} ({}): {}", made->renderer_, made->platform_,
                      reinterpret_cast<const char*>(glGetString(GL_VERSION)));
        return made;
    }
    return fail(ErrorKind::device, "no EGL display gives an OpenGL 4.5 context" +
                                       (refusals.empty() ? std::string() : " (" + refusals + ")"));
}

}  // namespace haustra::gpu
