#include "net/server.h"

#include "net/connection.h"
#include "net/file_limit.h"
#include "session/worker.h"

#include <charconv>
#include <csignal>
#include <map>
#include <set>
#include <utility>

#include <asio/io_context.hpp>
#include <asio/ip/address.hpp>
#include <asio/ip/tcp.hpp>
#include <asio/post.hpp>
#include <asio/signal_set.hpp>
#include <openssl/evp.h>
#include <openssl/ssl.h>
#include <openssl/x509.h>
#include <spdlog/spdlog.h>

namespace haustra::net {
namespace {

using asio::ip::tcp;

// Connections that have not said hello yet may come on top of the sessions.
constexpr int maxStrangers = 64;
constexpr std::chrono::milliseconds acceptPause{
    100};  // where the system has no file descriptor left
constexpr std::chrono::milliseconds stopPatience{3000};

Result<void> configureTls(asio::ssl::context& tls, const Identity& identity) {
    SSL_CTX* const context = tls.native_handle();
    SSL_CTX_set_min_proto_version(context, TLS1_3_VERSION);
    SSL_CTX_set_num_tickets(context, 0);  // sessions are not resumed
    SSL_CTX_set_default_passwd_cb(context, [](char*, int, int, void*) { return 0; });
    if (SSL_CTX_use_certificate_chain_file(context, identity.certificate.c_str()) != 1)
        return fail(ErrorKind::io, "the certificate cannot be read", identity.certificate);
    if (SSL_CTX_use_PrivateKey_file(context, identity.key.c_str(), SSL_FILETYPE_PEM) != 1)
        return fail(ErrorKind::io, "the key cannot be read, or is not the certificate's",
                    identity.key);
    return {};
}

std::string certificateFingerprint(asio::ssl::context& tls) {
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned bytes = 0;
    const X509* const certificate = SSL_CTX_get0_certificate(tls.native_handle());
    if (!certificate || X509_digest(certificate, EVP_sha256(), digest, &bytes) != 1) return {};
    static constexpr char digits[] = "0123456789abcdef";
    std::string text;
    for (unsigned n = 0; n < bytes; ++n) {
        text += digits[digest[n] >> 4];
        text += digits[digest[n] & 15];
    }
    return text;
}

Result<void> listen(tcp::acceptor& acceptor, ListenAddress& address) {
    const tcp::endpoint endpoint(asio::ip::make_address(address.ip), address.port);
    asio::error_code error;
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(tcp::acceptor::max_listen_connections, error);
    if (error)
        return fail(ErrorKind::device, "cannot listen: " + error.message(), toString(address));
    address.port = acceptor.local_endpoint().port();
    return {};
}

}  // namespace

Result<ListenAddress> parseListenAddress(const std::string& text) {
    const auto refuse = [&](const char* what) {
        return fail(ErrorKind::badInput, "\"" + text + "\" " + what, "listen address");
    };
    const std::size_t colon = text.rfind(':');
    if (colon == std::string::npos) return refuse("is not IP:PORT");
    std::string ip = text.substr(0, colon);
    if (ip.size() > 2 && ip.front() == '[' && ip.back() == ']')
        ip = ip.substr(1, ip.size() - 2);
    else if (ip.find(':') != std::string::npos)
        return refuse("needs brackets around its IPv6 address");
    if (ip == "localhost") ip = "127.0.0.1";
    asio::error_code error;
    asio::ip::make_address(ip, error);
    if (error) return refuse("has no numeric IP address before its port");

    ListenAddress address{ip, 0};
    const char* const first = text.data() + colon + 1;
    const char* const last = text.data() + text.size();
    const auto [end, code] = std::from_chars(first, last, address.port);
    if (code != std::errc{} || end != last) return refuse("has no port of 0 to 65535");
    return address;
}

std::string toString(const ListenAddress& address) {
    const bool v6 = address.ip.find(':') != std::string::npos;
    return (v6 ? "[" + address.ip + "]" : address.ip) + ":" + std::to_string(address.port);
}

// The io_context comes first: what other threads post to it outlives them.
struct Server::Impl {
    asio::io_context io{1};
    asio::ssl::context tls{asio::ssl::context::tls_server};
    tcp::acceptor acceptor{io};
    asio::signal_set signals{io};
    asio::steady_timer pause{io}, stopDeadline{io};
    ServerOptions options;
    std::string fingerprint;

    std::unique_ptr<session::RecordsThread> records;
    std::unique_ptr<session::RenderThread> renderer;
    std::unique_ptr<session::CaseLoader> loader;  // after the renderer, which it uses
    std::unique_ptr<session::EncoderThreads> encoders;
    std::unique_ptr<session::QuestionThread> questions;
    std::unique_ptr<session::PaintThread> painting;  // after the records, which it writes to
    std::optional<session::SeenLedgers> ledgers;
    session::News<session::BookmarkNews> bookmarks;
    session::News<std::shared_ptr<const session::OpenCase>> lostCases;
    session::OpenCounts readers;
    render::PresetLibrary presets;
    std::optional<session::Services> services;

    std::set<std::shared_ptr<Connection>> connections;
    // Of these, those that have not said hello, the oldest first.
    std::map<session::SessionId, std::shared_ptr<Connection>> strangers;
    session::SessionId lastId = 0;
    int sessions = 0;  // admitted connections
    bool stopping = false;

    Result<void> start();
    Result<void> readPresets();
    void accept();
    void serve(tcp::socket socket);
    void stop();
};

Result<void> Server::Impl::readPresets() {
    presets.presets = render::builtInPresets();
    if (!options.presets) return {};
    auto read = TRY(render::readPresets(*options.presets));
    presets = std::move(read);
    for (const Error& refused : presets.refused)
        spdlog::warn("a preset is not used: {}", describe(refused));
    return {};
}

Result<void> Server::Impl::start() {
    auto cases = TRY(store::CaseStore::open(options.store, false));
    const auto identity = TRY(options.identity ? Result<Identity>(*options.identity)
                                               : identityIn(options.store / "tls"));
    TRY(configureTls(tls, identity));
    fingerprint = certificateFingerprint(tls);
    const auto recordsFile = options.store / "records.sqlite3";
    auto kept = TRY(records::BookmarkStore::open(recordsFile));
    auto seen = TRY(records::SeenStore::open(recordsFile));
    TRY(readPresets());
    auto rendering = TRY(session::RenderThread::start(options.drawing, [this](auto of) {
        asio::post(io, [this, of = std::move(of)] { lostCases.tell(of); });
    }));
    auto encoding = TRY(session::EncoderThreads::start(options.encoders));
    TRY(makeRoomForSockets(options.maxSessions, maxStrangers));
    TRY(listen(acceptor, options.listen));

    loader = std::make_unique<session::CaseLoader>(cases, *rendering);
    records = std::make_unique<session::RecordsThread>(std::move(kept), std::move(seen),
                                                       std::move(cases));
    renderer = std::move(rendering);
    encoders = std::move(encoding);
    questions = std::make_unique<session::QuestionThread>();
    painting = std::make_unique<session::PaintThread>();
    ledgers.emplace(io.get_executor(), *painting, *records);
    services.emplace(session::Services{*renderer, *loader, *encoders, *records, *questions,
                                       *painting, *ledgers, bookmarks, lostCases, readers, presets,
                                       options.software});
    signals.add(SIGTERM);
    signals.add(SIGINT);
    signals.async_wait([this](const asio::error_code& error, int) {
        if (!error) stop();
    });
    accept();
    return {};
}

void Server::Impl::accept() {
    acceptor.async_accept([this](const asio::error_code& error, tcp::socket socket) {
        if (stopping) return;
        if (!error) {
            try {
                serve(std::move(socket));
            } catch (const std::exception& fault) {
                spdlog::error("a connection cannot be served: {}", fault.what());
            }
            return accept();
        }
        spdlog::warn("cannot accept a connection: {}", error.message());
        pause.expires_after(acceptPause);
        pause.async_wait([this](const asio::error_code& cancelled) {
            if (!cancelled && !stopping) accept();
        });
    });
}

void Server::Impl::serve(tcp::socket socket) {
    if (connections.size() >= std::size_t(options.maxSessions + maxStrangers)) {
        if (strangers.empty()) return;
        // Who has said nothing for longest makes room for another.
        const auto oldest = strangers.extract(strangers.begin());
        oldest.mapped()->abort();
    }
    const session::SessionId id = ++lastId;
    const auto connection =
        std::make_shared<Connection>(std::move(socket), tls, *services, id, Connection::Patience{});
    connections.insert(connection);
    strangers.emplace(id, connection);
    const auto admitted = std::make_shared<bool>(false);
    const auto admit = [this, admitted, id] {
        strangers.erase(id);
        *admitted = sessions < options.maxSessions;
        if (*admitted) ++sessions;
        return *admitted;
    };
    connection->start(admit, [this, admitted, connection, id] {
        if (*admitted) --sessions;
        strangers.erase(id);
        connections.erase(connection);
        if (stopping && connections.empty()) stopDeadline.cancel();
    });
}

void Server::Impl::stop() {
    spdlog::info("stopping, with {} connections", connections.size());
    stopping = true;
    asio::error_code ignored;
    acceptor.close(ignored);
    pause.cancel();
    const auto all = connections;  // stop() may erase
    for (const auto& connection : all)
        connection->stop();
    if (connections.empty()) return;
    stopDeadline.expires_after(stopPatience);
    stopDeadline.async_wait([this](const asio::error_code&) { io.stop(); });
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;

Result<std::unique_ptr<Server>> Server::create(const ServerOptions& options) {
    auto impl = std::make_unique<Impl>();
    impl->options = options;
    try {
        TRY(impl->start());
    } catch (const std::exception& error) {
        return fail(ErrorKind::device, error.what(), "server");
    }
    return std::unique_ptr<Server>(new Server(std::move(impl)));
}

const ListenAddress& Server::address() const {
    return impl_->options.listen;
}
const std::string& Server::fingerprint() const {
    return impl_->fingerprint;
}
const std::string& Server::renderer() const {
    return impl_->renderer->renderer();
}
void Server::run() {
    for (;;) {
        try {
            impl_->io.run();
            return;
        } catch (const std::exception& error) {
            session::logFault("io", error);
        }
    }
}

}  // namespace haustra::net
