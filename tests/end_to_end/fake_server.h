// A server for tests of the client: speaks the protocol over TLS on the loopback, with synthetic
// pictures whose pixels can be computed, and misbehaves on request.
#pragma once

#include "core/centerline.h"
#include "core/view.h"
#include "end_to_end/fake_pictures.h"
#include "protocol/haustra.pb.h"

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <vector>

namespace haustra::tests {

/// A cleansed slice is drawn as one whose window lies so much higher.
inline constexpr double cleansedShiftHu = 1000.0;

/// What the fake server does wrong.
struct Misbehaviour {
    std::uint32_t protocolVersion = 1;
    bool garbageTiles = false;     ///< tiles whose JPEG or lossless bytes are noise
    bool closesAfterTile = false;  ///< closes the socket with its first picture
    bool noStills = false;         ///< never answers a camera at rest
    int dropAfterBookmarks = 0;    ///< stores so many, then closes the socket before acknowledging
    bool truncateWelcome = false;
    bool old = false;               ///< knows nothing that a capability announces, and says so
    bool anotherScanLater = false;  ///< after the first connection the case is of another scan
    bool anotherCertificateLater = false;  ///< from the second connection on
    bool notFlattened = false;             ///< the case has no strip
    bool silentAboutTheWall = false;     ///< never says where a place lies, nor how long a line is
    bool closesAtWallQuestions = false;  ///< closes the socket where it is asked about the wall
    int stopsWhileOpening = 0;           ///< says so to as many OpenCases, and closes the socket
    bool othersMarkToo = false;  ///< with each bookmark that is added, another session adds one
    double seenAtFirst = 0.0;    ///< share of the wall that each connection begins with
    int dropAtQuestions = 0;     ///< closes the socket at so many questions about the scan
    int refuseBookmarks = 0;     ///< refuses so many, then stores them
    int ignoreBookmarks = 0;     ///< says nothing to so many, then stores them
    /// Changes what is told, once it is right.
    std::function<void(protocol::ServerMessage&)> alters = {};
    int refuseCaseWith = 0;  ///< answers OpenCase with this ErrorReport::Code, which is not fatal
    /// Opens this case with the second list of cases after it was asked for, and refuses to open
    /// another meanwhile.
    std::string opensLate = {};
    bool anotherCase = false;  ///< has "second" beside "phantom"
};

/// What a viewport was told last, and how often it was asked for a picture.
struct AskedOfViewport {
    glm::ivec2 size{0};
    WindowLevel window;
    std::string optics;  ///< the preset's name; empty of a reader's own
    int pictures = 0;
    bool lens = false;
};

class FakeServer {
public:
    /// Listens on 127.0.0.1 with a port chosen by the system and a certificate made now.
    explicit FakeServer(Misbehaviour misbehaviour = {}, std::uint16_t port = 0);
    ~FakeServer();

    std::uint16_t port() const;
    std::string fingerprint() const;
    std::vector<std::string> storedBookmarkKeys() const;  ///< in order of storing, each key once
    int connections() const;
    int bookmarkMessages() const;
    int detectionMessages() const;
    /// How long pictures have been on screen, all together, as clients tell it.
    std::uint64_t onScreenMs() const;
    std::uint64_t onScreenMs(View view) const;
    int seenForgotten() const;  ///< how often what had been seen was to be forgotten
    AskedOfViewport askedOf(View view) const { return askedOf(int(view)); }
    AskedOfViewport askedOf(int viewport) const;
    /// Down: links are cut, and whoever connects is shut out, until it is up again.
    void setDown(bool down);
    static Centerline centerline();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace haustra::tests
