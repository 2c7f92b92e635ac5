// The operating system's window with an OpenGL context and Dear ImGui in it.
#pragma once

#include "core/result.h"
#include "window/theme.h"

#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace haustra::window {

/// A key that went down (or repeated) since the last frame. ImGui loses presses that are shorter
/// than a frame.
struct KeyPress {
    int scancode;  ///< SDL_Scancode
    bool shift, ctrl, alt;
};

/// One per program, on the main thread. Destroying it closes the window.
class GlWindow {
public:
    /// `scale` of controls; default: what the display's resolution asks for. Fails where there is
    /// no display or no OpenGL 3.
    static Result<std::unique_ptr<GlWindow>> create(const std::string& title, int width, int height,
                                                    std::optional<double> scale);
    ~GlWindow();
    GlWindow(const GlWindow&) = delete;
    GlWindow& operator=(const GlWindow&) = delete;

    /// Handles what the hand did and begins a frame. Where `busy` is false it first sleeps until
    /// something happens, at most a quarter of a second. False: the user closed the window.
    bool beginFrame(bool busy);
    /// Keys pressed between the last two frames, in order.
    const std::vector<KeyPress>& keyPresses() const;
    /// Draws and shows the frame.
    void endFrame();
    /// The last drawn frame as a PNG file.
    Result<void> writeScreenshot(const std::filesystem::path& file);

    /// Ends the sleep of beginFrame; from any thread.
    void wake();

    const Fonts& fonts() const;
    double scale() const;

private:
    struct Impl;
    explicit GlWindow(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::window
