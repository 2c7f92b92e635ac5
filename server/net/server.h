// haustra-server: everything from the store to the sockets.
#pragma once

#include "core/result.h"
#include "net/identity.h"
#include "net/listen_address.h"
#include "session/gpu_cases.h"

#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace haustra::net {

struct ServerOptions {
    std::filesystem::path store;
    ListenAddress listen;
    std::optional<Identity> identity;  ///< none: the store's own, made on first start
    int maxSessions = 32;
    int encoders = 1;  ///< threads
    session::DrawingOptions drawing;
    std::optional<std::filesystem::path> presets;  ///< folder of more than the built-in ones
    std::string software;                          ///< name and version, for the welcome
};

/// server/THREADS.md draws its threads. Belongs to the thread that made it.
class Server {
public:
    /// Opens the store, the records, the GPU and the socket. Fails where one of them cannot be had.
    static Result<std::unique_ptr<Server>> create(const ServerOptions& options);
    ~Server();

    const ListenAddress& address() const;    ///< with the port that is really bound
    const std::string& fingerprint() const;  ///< SHA-256 of the certificate, 64 hexadecimal digits
    const std::string& renderer() const;     ///< GL_RENDERER

    /// Serves until SIGTERM or SIGINT; then says farewell to the clients and returns. What
    /// bookmarks it has taken are stored.
    void run();

private:
    struct Impl;
    explicit Server(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::net
