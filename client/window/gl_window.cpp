#include "window/gl_window.h"

#include "tiles/png_file.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <SDL.h>
#include <SDL_opengl.h>
#include <imgui.h>
#include <imgui_impl_opengl3.h>
#include <imgui_impl_sdl.h>

namespace haustra::window {

struct GlWindow::Impl {
    SDL_Window* window = nullptr;
    SDL_GLContext context = nullptr;
    Uint32 wakeEvent = 0;
    bool imgui = false;
    double scale = 1.0;
    Fonts fonts;
    std::vector<KeyPress> keyPresses;
    std::optional<ImVec2> mouse;      // as the last event told it
    std::vector<SDL_Event> heldBack;  // releases that wait for the next frame

    ~Impl() {
        if (imgui) {
            ImGui_ImplOpenGL3_Shutdown();
            ImGui_ImplSDL2_Shutdown();
            ImGui::DestroyContext();
        }
        if (context) SDL_GL_DeleteContext(context);
        if (window) SDL_DestroyWindow(window);
        SDL_QuitSubSystem(SDL_INIT_VIDEO);
    }
};

namespace {

auto refuse(const char* what) {
    return fail(ErrorKind::device, std::string(what) + ": " + SDL_GetError(), "window");
}

// Quarter steps of 96 dpi; displays that lie about their size get 1.
double displayScale(SDL_Window* window) {
    float dpi = 0.0f;
    if (SDL_GetDisplayDPI(std::max(0, SDL_GetWindowDisplayIndex(window)), &dpi, nullptr, nullptr) !=
        0)
        return 1.0;
    return std::clamp(std::round(dpi / 96.0 * 4.0) / 4.0, 1.0, 3.0);
}

// Draws ImGui's last frame into the back buffer.
void drawFrame() {
    const ImGuiIO& io = ImGui::GetIO();
    glViewport(0, 0, int(io.DisplaySize.x * io.DisplayFramebufferScale.x),
               int(io.DisplaySize.y * io.DisplayFramebufferScale.y));
    glClearColor(0.05f, 0.06f, 0.08f, 1.0f);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL3_RenderDrawData(ImGui::GetDrawData());
}

}  // namespace

GlWindow::GlWindow(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
GlWindow::~GlWindow() = default;
const Fonts& GlWindow::fonts() const {
    return impl_->fonts;
}
const std::vector<KeyPress>& GlWindow::keyPresses() const {
    return impl_->keyPresses;
}
double GlWindow::scale() const {
    return impl_->scale;
}

Result<std::unique_ptr<GlWindow>> GlWindow::create(const std::string& title, int width, int height,
                                                   std::optional<double> scale) {
    SDL_SetHint(SDL_HINT_VIDEO_X11_NET_WM_BYPASS_COMPOSITOR, "0");
    auto impl = std::make_unique<Impl>();
    if (SDL_InitSubSystem(SDL_INIT_VIDEO) != 0)
        return refuse("no display to open a window on (--headless needs none)");
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_PROFILE_MASK, SDL_GL_CONTEXT_PROFILE_CORE);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MAJOR_VERSION, 3);
    SDL_GL_SetAttribute(SDL_GL_CONTEXT_MINOR_VERSION, 2);
    SDL_GL_SetAttribute(SDL_GL_DOUBLEBUFFER, 1);
    impl->window = SDL_CreateWindow(
        title.c_str(), SDL_WINDOWPOS_CENTERED, SDL_WINDOWPOS_CENTERED, width, height,
        SDL_WINDOW_OPENGL | SDL_WINDOW_RESIZABLE | SDL_WINDOW_ALLOW_HIGHDPI);
    if (!impl->window) return refuse("cannot open a window");
    SDL_SetWindowMinimumSize(impl->window, 900, 600);
    impl->context = SDL_GL_CreateContext(impl->window);
    if (!impl->context) return refuse("cannot make an OpenGL 3.2 context");
    SDL_GL_MakeCurrent(impl->window, impl->context);
    SDL_GL_SetSwapInterval(1);
    impl->wakeEvent = SDL_RegisterEvents(1);

    IMGUI_CHECKVERSION();
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr;  // the layout is fixed; nothing to remember
    ImGui_ImplSDL2_InitForOpenGL(impl->window, impl->context);
    ImGui_ImplOpenGL3_Init("#version 150");
    impl->imgui = true;
    impl->scale = scale.value_or(displayScale(impl->window));
    impl->fonts = applyTheme(impl->scale);
    return std::unique_ptr<GlWindow>(new GlWindow(std::move(impl)));
}

// ImGui sees keys only as they stand when a frame begins: the release of a key that went down since
// the last frame is held back, so that no press is lost.
bool GlWindow::beginFrame(bool busy) {
    impl_->keyPresses.clear();
    for (const SDL_Event& release : std::exchange(impl_->heldBack, {}))
        ImGui_ImplSDL2_ProcessEvent(&release);
    SDL_Event event;
    bool has = busy ? SDL_PollEvent(&event) : SDL_WaitEventTimeout(&event, 250);
    for (; has; has = SDL_PollEvent(&event)) {
        if (event.type == SDL_QUIT) return false;
        if (event.type == impl_->wakeEvent) continue;
        if (event.type == SDL_MOUSEMOTION)
            impl_->mouse = ImVec2(float(event.motion.x), float(event.motion.y));
        if (event.type == SDL_WINDOWEVENT && event.window.event == SDL_WINDOWEVENT_LEAVE)
            impl_->mouse.reset();
        const auto& key = event.key.keysym;
        if (event.type == SDL_KEYDOWN) {
            impl_->keyPresses.push_back({key.scancode, (key.mod & KMOD_SHIFT) != 0,
                                         (key.mod & KMOD_CTRL) != 0, (key.mod & KMOD_ALT) != 0});
        } else if (event.type == SDL_KEYUP &&
                   std::any_of(impl_->keyPresses.begin(), impl_->keyPresses.end(),
                               [&](const KeyPress& p) { return p.scancode == key.scancode; })) {
            impl_->heldBack.push_back(event);
            continue;
        }
        ImGui_ImplSDL2_ProcessEvent(&event);
    }
    ImGui_ImplOpenGL3_NewFrame();
    ImGui_ImplSDL2_NewFrame();
    // The backend asks SDL for the global pointer, which lags where the pointer is moved by
    // software (remote desktops): a drag would begin with a jump.
    if (impl_->mouse) ImGui::GetIO().MousePos = *impl_->mouse;
    ImGui::NewFrame();
    return true;
}

void GlWindow::endFrame() {
    ImGui::Render();
    drawFrame();
    SDL_GL_SwapWindow(impl_->window);
}

Result<void> GlWindow::writeScreenshot(const std::filesystem::path& file) {
    int width = 0, height = 0;
    SDL_GL_GetDrawableSize(impl_->window, &width, &height);
    const std::size_t row = std::size_t(width) * 3;
    std::vector<std::uint8_t> bottomUp(row * std::size_t(height)), rgb(bottomUp.size());
    drawFrame();  // anew: the swap left the back buffer undefined
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGB, GL_UNSIGNED_BYTE, bottomUp.data());
    for (int y = 0; y < height; ++y)
        std::copy_n(bottomUp.begin() + std::ptrdiff_t(row) * (height - 1 - y), row,
                    rgb.begin() + std::ptrdiff_t(row) * y);
    return tiles::writePng(file, rgb, width, height);
}

void GlWindow::wake() {
    SDL_Event event{};
    event.type = impl_->wakeEvent;
    SDL_PushEvent(&event);
}

}  // namespace haustra::window
