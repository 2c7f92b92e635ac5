// haustra-server: everything from the store to the sockets.
#pragma once

#include "core/result.h"
#include "net/identity.h"
#include "session/gpu_cases.h"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>

namespace haustra::net {

/// Where the server listens.
struct ListenAddress {
    std::string ip = "127.0.0.1";
    std::uint16_t port = 7117;  ///< 0: any that is free
};

/// "127.0.0.1:7117", "[::1]:7117", "localhost:0". Only numeric addresses and localhost: what a
/// server listens on must not depend on a name service. Fails (badInput) with a sentence on what
/// is wrong.
Result<ListenAddress> parseListenAddress(const std::string& text);

/// As parseListenAddress reads it.
std::string toString(const ListenAddress& address);

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
    /// Opens the store, the records, the GPU and the socket, and raises the process's limit of open
    /// files for its sessions. Fails where one of them cannot be had, or so many sessions do not
    /// fit.
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
