// Asks a window whether it is alive: window_ping WINDOW SECONDS sends what a window manager sends
// (_NET_WM_PING), and waits for the answer. Exit code 0: it came; 1: it did not; 2: no such window.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <thread>

#include <X11/Xlib.h>

int main(int argc, char** argv) {
    if (argc != 3) return 2;
    Display* display = XOpenDisplay(nullptr);
    if (!display) return 2;
    XSetErrorHandler([](Display*, XErrorEvent*) -> int { std::exit(2); });
    const Window window = std::strtoul(argv[1], nullptr, 0);
    const double seconds = std::atof(argv[2]);
    const Window root = DefaultRootWindow(display);
    XSelectInput(display, root, StructureNotifyMask | SubstructureNotifyMask);
    const Atom protocols = XInternAtom(display, "WM_PROTOCOLS", False),
               ping = XInternAtom(display, "_NET_WM_PING", False);
    const long stamp = long(std::chrono::steady_clock::now().time_since_epoch().count() & 0xffffff);
    XEvent event{};
    event.xclient.type = ClientMessage;
    event.xclient.window = window;
    event.xclient.message_type = protocols;
    event.xclient.format = 32;
    event.xclient.data.l[0] = long(ping);
    event.xclient.data.l[1] = stamp;
    event.xclient.data.l[2] = long(window);
    XSendEvent(display, window, False, NoEventMask, &event);
    XSync(display, False);
    const auto start = std::chrono::steady_clock::now();
    const auto elapsed = [&] {
        return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
    };
    while (elapsed() < seconds) {
        while (XPending(display) > 0) {
            XNextEvent(display, &event);
            if (event.type == ClientMessage && event.xclient.message_type == protocols &&
                event.xclient.data.l[0] == long(ping) && event.xclient.data.l[1] == stamp) {
                std::printf("%.3f\n", elapsed());
                return 0;
            }
        }
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    return 1;
}
