// An OpenGL 4.5 context without a display (METHODS §15 "GL without a display").
#pragma once

#include "core/result.h"

#include <memory>
#include <string>

namespace haustra::gpu {

/// Owns an EGL display and a current context, for the thread that made it, from birth to death.
/// KHR_debug messages go to the log.
class Context {
public:
    /// Hardware devices first, then Mesa's surfaceless platform, then the software device.
    static Result<std::unique_ptr<Context>> create();
    ~Context();
    Context(const Context&) = delete;
    Context& operator=(const Context&) = delete;

    const std::string& renderer() const { return renderer_; }  ///< GL_RENDERER
    const std::string& platform() const {
        return platform_;
    }  ///< "device", "surfaceless", "software device"
    bool software() const { return software_; }
    /// GL errors that KHR_debug has reported since birth.
    int errorCount() const;

private:
    struct Impl;
    Context();
    std::unique_ptr<Impl> impl_;
    std::string renderer_, platform_;
    bool software_ = false;
};

}  // namespace haustra::gpu
