#include "end_to_end/fake_server.h"

#include "end_to_end/fake_wall.h"
#include "end_to_end/self_signed.h"
#include "protocol/capabilities.h"
#include "protocol/framing.h"
#include "protocol/haustra.pb.h"
#include "protocol/optics_message.h"
#include "protocol/view_message.h"

#include <array>
#include <cmath>
#include <map>

#include <asio.hpp>
#include <asio/ssl.hpp>
#include <openssl/ssl.h>

namespace haustra::tests {
namespace {

using asio::ip::tcp;
using Stream = asio::ssl::stream<tcp::socket>;
using protocol::ClientMessage;
using protocol::ServerMessage;

struct Viewport {
    protocol::View view = protocol::VIEW_UNSPECIFIED;
    int width = 0, height = 0;
    double centerHu = 0.0;
};

}  // namespace

struct FakeServer::Impl {
    Misbehaviour misbehaviour;
    SelfSigned identity = makeSelfSigned(), otherIdentity = makeSelfSigned();
    asio::io_context io;
    asio::ssl::context tls{asio::ssl::context::tls_server},
        otherTls{asio::ssl::context::tls_server};
    tcp::acceptor acceptor;
    std::atomic<bool> stopping{false}, down{false};
    std::atomic<int> connections{0}, bookmarkMessages{0}, seenForgotten{0}, detectionMessages{0};
    mutable std::mutex mutex;
    std::vector<protocol::Bookmark> bookmarks;  // guarded by mutex
    std::set<std::shared_ptr<Stream>> streams;  // guarded by mutex
    std::map<int, AskedOfViewport> asked;       // guarded by mutex
    std::map<int, std::uint64_t> onScreenMs;    // by viewport; guarded by mutex
    std::map<std::uint32_t, int> viewportOf;    // by picture; guarded by mutex
    std::vector<std::thread> conversations;
    std::thread listener;

    Impl(Misbehaviour wrong, std::uint16_t port)
        : misbehaviour(wrong), acceptor(io, tcp::endpoint(asio::ip::address_v4::loopback(), port)) {
        const auto identify = [](asio::ssl::context& as, const SelfSigned& by) {
            SSL_CTX_set_min_proto_version(as.native_handle(), TLS1_3_VERSION);
            SSL_CTX_use_certificate(as.native_handle(), by.certificate.get());
            SSL_CTX_use_PrivateKey(as.native_handle(), by.key.get());
        };
        identify(tls, identity), identify(otherTls, otherIdentity);
        listener = std::thread([this] { listen(); });
    }
    ~Impl() {
        stopping = true;
        asio::error_code ignored;
        // A blocked accept() does not see its socket closed: knock instead.
        tcp::socket knock(io);
        knock.connect(acceptor.local_endpoint(), ignored);
        listener.join();
        cut();
        for (std::thread& conversation : conversations)
            conversation.join();
    }

    void cut() {
        asio::error_code ignored;
        const std::lock_guard lock(mutex);
        for (const auto& stream : streams)
            stream->lowest_layer().shutdown(tcp::socket::shutdown_both, ignored);
    }

    void listen() {
        for (int accepted = 0; !stopping;) {
            const bool other = misbehaviour.anotherCertificateLater && accepted > 0;
            auto stream = std::make_shared<Stream>(io, other ? otherTls : tls);
            asio::error_code error;
            acceptor.accept(stream->lowest_layer(), error);
            if (stopping || error || down) continue;  // closed with the stream
            ++accepted;
            {
                const std::lock_guard lock(mutex);
                streams.insert(stream);
            }
            conversations.emplace_back([this, stream] {
                try {
                    stream->lowest_layer().set_option(tcp::no_delay(true));
                    stream->handshake(Stream::server);
                    ++connections;
                    converse(*stream);
                } catch (const std::exception&) {
                    // The client went away, which is how every conversation ends.
                }
                const std::lock_guard lock(mutex);
                streams.erase(stream);
                asio::error_code ignored;
                stream->lowest_layer().close(ignored);
            });
        }
    }

    static ClientMessage read(Stream& stream) {
        std::array<std::uint8_t, protocol::frameHeaderBytes> head;
        asio::read(stream, asio::buffer(head));
        const auto header = protocol::parseFrameHeader(head, protocol::serverReceives);
        if (!header) throw std::runtime_error("bad frame");
        std::vector<std::uint8_t> payload(header->payloadBytes);
        asio::read(stream, asio::buffer(payload));
        ClientMessage message;
        if (!message.ParseFromArray(payload.data(), int(payload.size())))
            throw std::runtime_error("bad message");
        return message;
    }
    void write(Stream& stream, ServerMessage message) const {
        if (misbehaviour.alters) misbehaviour.alters(message);
        asio::write(stream, asio::buffer(protocol::controlFrame(message)));
    }

    template <class Input>
    void sendPicture(Stream& stream, std::uint32_t number, const Input& input,
                     const std::map<int, Viewport>& viewports, glm::dvec3 positionMm,
                     double shiftHu = 0.0) {
        const int id = int(input.viewport());
        const Viewport& viewport = viewports.at(id);
        {
            const std::lock_guard lock(mutex);
            ++asked[id].pictures;
            viewportOf[number] = id;
        }
        asio::write(stream, asio::buffer(framesOf({id, viewport.width, viewport.height, number,
                                                   input.sequence(), !input.moving(), positionMm,
                                                   viewport.centerHu + shiftHu,
                                                   misbehaviour.garbageTiles})));
        if (misbehaviour.closesAfterTile) throw std::runtime_error("closes with its first picture");
    }

    ServerMessage caseOpened(const std::string& name) {
        ServerMessage message;
        auto* opened = message.mutable_case_opened();
        opened->set_name(name);
        opened->set_scan(misbehaviour.anotherScanLater && connections > 1 ? "B" : "A");
        opened->set_size_x(256);
        opened->set_size_y(256);
        opened->set_size_z(200);
        opened->set_cleansed(true);
        for (const double number :
             {0.7, 0.0, 0.0, -90.0, 0.0, 0.7, 0.0, -90.0, 0.0, 0.0, 1.0, -20.0})
            opened->add_patient_from_voxel(number);
        for (const CenterlinePoint& point : centerline().points)
            for (const double number : {point.positionMm.x, point.positionMm.y, point.positionMm.z,
                                        point.arcMm, point.radiusMm})
                opened->add_centerline(number);
        for (std::uint32_t n = 200; n < 220; ++n)
            opened->add_gap_samples(n);
        opened->set_patient_position("supine");
        for (const char* offered : {"mucosa", "translucent", "biopsy"}) {
            haustra::OpticsPreset preset{offered, "as a test has it", {}};
            preset.optics.transferFunction.points = {{-700.0, {0.9, 0.6, 0.5}, 0.0},
                                                     {-500.0, {0.9, 0.6, 0.5}, 1.0}};
            fill(*opened->add_presets(), preset);
        }
        if (!misbehaviour.notFlattened) *opened->mutable_flat() = fakeStrip();
        if (!misbehaviour.old) opened->set_detection(protocol::CaseOpened::THERE);
        return message;
    }

    void fillCases(protocol::CaseList& list) {
        list.add_names("phantom");
        if (misbehaviour.old) return;
        auto* entry = list.add_entries();
        entry->set_name("phantom");
        entry->set_state(protocol::CaseEntry::READY);
        entry->set_prepared_utc("2020-02-20T20:20:20Z");
        entry->set_size_x(256);
        entry->set_size_y(256);
        entry->set_size_z(200);
        entry->set_cleansed(true);
        entry->set_flattened(!misbehaviour.notFlattened);
        entry->set_confidence(0.75);
        entry->set_warnings(2);
        entry->set_readers(1);
        {
            const std::lock_guard lock(mutex);
            entry->set_bookmarks(std::uint32_t(bookmarks.size()));
        }
        if (!misbehaviour.anotherCase) return;
        list.add_names("second");
        auto* second = list.add_entries();
        second->set_name("second");
        second->set_state(protocol::CaseEntry::READY);
        second->set_size_z(200);
    }

    void note(const protocol::SetViewport& set) {
        const std::lock_guard lock(mutex);
        asked[int(set.viewport())].size = {int(set.width()), int(set.height())};
        asked[int(set.viewport())].lens = set.lens();
    }

    // False: the socket is to be closed.
    bool addBookmark(Stream& stream, const protocol::AddBookmark& add) {
        ++bookmarkMessages;
        ServerMessage answer;
        bool drop = false, refuse = false;
        {
            const std::lock_guard lock(mutex);
            if (misbehaviour.ignoreBookmarks > 0) {
                --misbehaviour.ignoreBookmarks;
                return true;
            }
            refuse = misbehaviour.refuseBookmarks > 0;
            misbehaviour.refuseBookmarks -= refuse;
        }
        if (refuse) {
            answer.mutable_error()->set_code(protocol::ErrorReport::INTERNAL);
            answer.mutable_error()->set_request(add.request());
            answer.mutable_error()->set_message("the disk is full");
            write(stream, answer);
            return true;
        }
        {
            const std::lock_guard lock(mutex);
            protocol::Bookmark* stored = nullptr;
            for (auto& bookmark : bookmarks)
                if (bookmark.client_key() == add.client_key()) stored = &bookmark;
            if (!stored) {
                stored = &bookmarks.emplace_back();
                stored->set_id(bookmarks.size());
                *stored->mutable_position_mm() = add.position_mm();
                *stored->mutable_forward() = add.forward();
                *stored->mutable_up() = add.up();
                stored->set_arc_mm(add.arc_mm());
                stored->set_note(add.note());
                stored->set_client_key(add.client_key());
                stored->set_created_utc("2020-02-20T20:20:20Z");
                if (!misbehaviour.old && !misbehaviour.notFlattened)
                    *stored->mutable_mark() = fakeMark(add.arc_mm());
            }
            drop = misbehaviour.dropAfterBookmarks > 0 &&
                   int(bookmarks.size()) == misbehaviour.dropAfterBookmarks;
            if (drop) misbehaviour.dropAfterBookmarks = 0;
            answer.mutable_bookmark_added()->set_request(add.request());
            *answer.mutable_bookmark_added()->mutable_bookmark() = *stored;
        }
        if (!drop && misbehaviour.othersMarkToo) {
            ServerMessage theirs = answer;
            theirs.mutable_bookmark_added()->set_request(0);
            auto* bookmark = theirs.mutable_bookmark_added()->mutable_bookmark();
            bookmark->set_id(1000 + bookmark->id());
            bookmark->set_client_key("another's");
            bookmark->set_note("another's");
            write(stream, theirs);
        }
        if (!drop) write(stream, answer);
        return !drop;
    }

    void converse(Stream& stream) {
        std::map<int, Viewport> viewports;
        std::uint32_t pictures = 0;
        double seen = misbehaviour.seenAtFirst;
        int opensAfterLists = 0;
        protocol::SetDetection detection;
        const ClientMessage hello = read(stream);
        if (!hello.has_hello()) return;
        protocol::SeenLimits limits;
        limits.set_pixels_per_mm(2.0 / 3.0);
        limits.set_least_ms(300);
        std::uint64_t shown = 0;
        const auto fillSeen = [&](protocol::WallSeen& message, std::uint64_t request) {
            message.set_request(request);
            message.set_share(seen);
            if (misbehaviour.old) return;
            *message.mutable_limits() = limits;
            message.set_recorded(!hello.hello().reader().empty());
            if (message.recorded()) message.set_kept(shown);
        };
        ServerMessage welcome;
        welcome.mutable_welcome()->set_protocol_version(misbehaviour.protocolVersion);
        welcome.mutable_welcome()->set_software("fake-server 1");
        welcome.mutable_welcome()->set_renderer("none");
        if (!misbehaviour.old)
            for (const char* known :
                 {protocol::capability::caseEntries, protocol::capability::bookmarkPush,
                  protocol::capability::marks, protocol::capability::slabs,
                  protocol::capability::scanValues, protocol::capability::pick,
                  protocol::capability::lens, protocol::capability::findings,
                  protocol::capability::ledger})
                welcome.mutable_welcome()->add_capabilities(known);
        if (misbehaviour.truncateWelcome) {
            std::vector<std::uint8_t> frame;
            protocol::appendFrameHeader(frame, {3, protocol::FrameType::control});
            frame.insert(frame.end(), {0x0a, 0x7f, 0x00});
            asio::write(stream, asio::buffer(frame));
            return;
        }
        write(stream, welcome);
        while (!stopping) {
            const ClientMessage message = read(stream);
            ServerMessage answer;
            switch (message.body_case()) {
                case ClientMessage::kListCases:
                    fillCases(*answer.mutable_case_list());
                    if (!misbehaviour.old)
                        answer.mutable_case_list()->set_request(message.list_cases().request());
                    write(stream, answer);
                    if (opensAfterLists > 0 && --opensAfterLists == 0)
                        write(stream, caseOpened(misbehaviour.opensLate));
                    break;
                case ClientMessage::kOpenCase:
                    if (connections <= misbehaviour.stopsWhileOpening) {
                        answer.mutable_error()->set_code(protocol::ErrorReport::BUSY);
                        answer.mutable_error()->set_message("the server stops");
                        answer.mutable_error()->set_fatal(true);
                        write(stream, answer);
                        return;
                    }
                    if (opensAfterLists > 0) {
                        answer.mutable_error()->set_code(protocol::ErrorReport::BAD_STATE);
                        answer.mutable_error()->set_message("another case is being opened");
                        write(stream, answer);
                        break;
                    }
                    if (message.open_case().name() == misbehaviour.opensLate) {
                        opensAfterLists = 2;
                        break;
                    }
                    if (misbehaviour.refuseCaseWith != 0) {
                        answer.mutable_error()->set_code(
                            protocol::ErrorReport::Code(misbehaviour.refuseCaseWith));
                        answer.mutable_error()->set_message("the scan's file is damaged");
                        write(stream, answer);
                    } else if (message.open_case().name() != "phantom" &&
                               !(misbehaviour.anotherCase &&
                                 message.open_case().name() == "second")) {
                        answer.mutable_error()->set_code(protocol::ErrorReport::NO_SUCH_CASE);
                        answer.mutable_error()->set_message("there is no such case");
                        write(stream, answer);
                    } else {
                        write(stream, caseOpened(message.open_case().name()));
                    }
                    break;
                case ClientMessage::kSetViewport: {
                    const auto& set = message.set_viewport();
                    viewports[int(set.viewport())] = {set.view(), int(set.width()),
                                                      int(set.height()), 0.0};
                    note(set);
                    break;
                }
                case ClientMessage::kSetWindowLevel: {
                    const auto& set = message.set_window_level();
                    viewports[int(set.viewport())].centerHu = set.window().center_hu();
                    const std::lock_guard lock(mutex);
                    asked[int(set.viewport())].window = {set.window().center_hu(),
                                                         set.window().width_hu()};
                    break;
                }
                case ClientMessage::kSetCamera: {
                    const auto& set = message.set_camera();
                    if (!set.moving() && misbehaviour.noStills) break;
                    sendPicture(stream, ++pictures, set, viewports,
                                protocol::vectorFrom(set.position_mm()));
                    break;
                }
                case ClientMessage::kSetSlice: {
                    const auto& set = message.set_slice();
                    sendPicture(stream, ++pictures, set, viewports,
                                protocol::vectorFrom(set.position_mm()),
                                set.cleansed() ? cleansedShiftHu : 0.0);
                    break;
                }
                case ClientMessage::kSetFlat: {
                    const auto& set = message.set_flat();
                    sendPicture(stream, ++pictures, set, viewports,
                                syntheticPosition({set.center().x(), set.center().y()},
                                                  set.pixels_per_circumference()));
                    break;
                }
                case ClientMessage::kSetOblique: {
                    const auto& set = message.set_oblique();
                    sendPicture(stream, ++pictures, set, viewports,
                                protocol::vectorFrom(set.position_mm()),
                                set.cleansed() ? cleansedShiftHu : 0.0);
                    break;
                }
                case ClientMessage::kSetOverview: {
                    const auto& set = message.set_overview();
                    sendPicture(stream, ++pictures, set, viewports,
                                protocol::vectorFrom(set.camera().position_mm()),
                                set.has_reader() ? set.reader().position_mm().z() : 0.0);
                    break;
                }
                case ClientMessage::kLocateFlat:
                case ClientMessage::kLocatePoint:
                case ClientMessage::kMeasureFlat:
                    if (misbehaviour.closesAtWallQuestions) return;
                    if (!misbehaviour.silentAboutTheWall) write(stream, aboutFakeWall(message));
                    break;
                case ClientMessage::kPickWall:
                    if (misbehaviour.old) return;
                    write(stream, fakePick(message.pick_wall(), !misbehaviour.notFlattened));
                    break;
                case ClientMessage::kAskSeen:
                    seenForgotten += message.ask_seen().forget();
                    if (message.ask_seen().forget()) seen = 0.0;
                    fillSeen(*answer.mutable_wall_seen(), message.ask_seen().request());
                    write(stream, answer);
                    break;
                case ClientMessage::kTellShown: {
                    if (misbehaviour.old) return;
                    shown = message.tell_shown().number();
                    const std::lock_guard lock(mutex);
                    for (const auto& time : message.tell_shown().pictures())
                        onScreenMs[viewportOf[time.picture()]] += time.ms();
                    break;
                }
                case ClientMessage::kSetSeenLimits:
                    if (misbehaviour.old) return;
                    limits = message.set_seen_limits().limits();
                    fillSeen(*answer.mutable_wall_seen(), message.set_seen_limits().request());
                    write(stream, answer);
                    break;
                case ClientMessage::kListMissed:
                    if (misbehaviour.old) return;
                    *answer.mutable_missed_list() = fakeMissed();
                    answer.mutable_missed_list()->set_request(message.list_missed().request());
                    write(stream, answer);
                    break;
                case ClientMessage::kAskLedger:
                    if (misbehaviour.old) return;
                    answer.mutable_ledger()->set_request(message.ask_ledger().request());
                    *answer.mutable_ledger()->mutable_limits() = limits;
                    answer.mutable_ledger()->set_wall("0123");
                    answer.mutable_ledger()->set_triangles(12);
                    answer.mutable_ledger()->set_shown("\x05\x01");
                    answer.mutable_ledger()->set_seen("\x07\x01");
                    write(stream, answer);
                    break;
                case ClientMessage::kAskSeenReport: {
                    if (misbehaviour.old) return;
                    protocol::SeenReport& report = *answer.mutable_seen_report();
                    report.set_request(message.ask_seen_report().request());
                    report.set_least_mm2(300.0);
                    report.set_wall("0123");
                    protocol::ReaderSeen& reader = *report.add_readers();
                    reader.set_reader("ada");
                    *reader.mutable_limits() = limits;
                    reader.set_share(0.75);
                    const protocol::MissedList missed = fakeMissed();
                    reader.set_missed(missed.count());
                    reader.set_missed_mm2(missed.area_mm2());
                    for (const auto& patch : missed.patches()) {
                        *reader.add_patches() = patch;
                        reader.mutable_patches()->rbegin()->clear_view();
                    }
                    write(stream, answer);
                    break;
                }
                case ClientMessage::kMeasureScan:
                    if (misbehaviour.old) return;
                    if (misbehaviour.dropAtQuestions > 0) {
                        --misbehaviour.dropAtQuestions;
                        return;
                    }
                    *answer.mutable_scan_statistics() = fakeStatistics(message.measure_scan());
                    write(stream, answer);
                    break;
                case ClientMessage::kSetWallPaint:
                    break;
                case ClientMessage::kSetDetection: {
                    if (misbehaviour.old) return;
                    detection = message.set_detection();
                    ++detectionMessages;
                    break;
                }
                case ClientMessage::kListFindings:
                    if (misbehaviour.old) return;
                    *answer.mutable_finding_list() = fakeFindings(detection);
                    answer.mutable_finding_list()->set_request(message.list_findings().request());
                    write(stream, answer);
                    break;
                case ClientMessage::kSetTransferFunction: {
                    {
                        const std::lock_guard lock(mutex);
                        asked[int(message.set_transfer_function().viewport())].optics =
                            message.set_transfer_function().preset();
                    }
                    if (!message.set_transfer_function().has_optics() &&
                        message.set_transfer_function().preset() != "mucosa" &&
                        message.set_transfer_function().preset() != "translucent" &&
                        message.set_transfer_function().preset() != "biopsy") {
                        answer.mutable_error()->set_code(protocol::ErrorReport::BAD_VALUE);
                        answer.mutable_error()->set_message("no such transfer function");
                        write(stream, answer);
                    }
                    break;
                }
                case ClientMessage::kAddBookmark:
                    if (!addBookmark(stream, message.add_bookmark())) return;
                    break;
                case ClientMessage::kListBookmarks: {
                    const std::lock_guard lock(mutex);
                    answer.mutable_bookmark_list()->set_request(message.list_bookmarks().request());
                    for (const auto& bookmark : bookmarks)
                        *answer.mutable_bookmark_list()->add_bookmarks() = bookmark;
                    write(stream, answer);
                    break;
                }
                case ClientMessage::kPing:
                    answer.mutable_pong()->set_request(message.ping().request());
                    write(stream, answer);
                    break;
                default:
                    return;
            }
        }
    }
};

FakeServer::FakeServer(Misbehaviour misbehaviour, std::uint16_t port)
    : impl_(std::make_unique<Impl>(misbehaviour, port)) {}
FakeServer::~FakeServer() = default;
std::uint16_t FakeServer::port() const {
    return impl_->acceptor.local_endpoint().port();
}
std::string FakeServer::fingerprint() const {
    return impl_->identity.fingerprint;
}
int FakeServer::connections() const {
    return impl_->connections;
}
int FakeServer::seenForgotten() const {
    return impl_->seenForgotten;
}
std::uint64_t FakeServer::onScreenMs() const {
    const std::lock_guard lock(impl_->mutex);
    std::uint64_t sum = 0;
    for (const auto& [viewport, ms] : impl_->onScreenMs)
        sum += ms;
    return sum;
}
std::uint64_t FakeServer::onScreenMs(View view) const {
    const std::lock_guard lock(impl_->mutex);
    return impl_->onScreenMs[int(view)];
}
int FakeServer::detectionMessages() const {
    return impl_->detectionMessages;
}
int FakeServer::bookmarkMessages() const {
    return impl_->bookmarkMessages;
}

std::vector<std::string> FakeServer::storedBookmarkKeys() const {
    const std::lock_guard lock(impl_->mutex);
    std::vector<std::string> keys;
    for (const auto& bookmark : impl_->bookmarks)
        keys.push_back(bookmark.client_key());
    return keys;
}

AskedOfViewport FakeServer::askedOf(int viewport) const {
    const std::lock_guard lock(impl_->mutex);
    const auto found = impl_->asked.find(viewport);
    return found == impl_->asked.end() ? AskedOfViewport{} : found->second;
}

void FakeServer::setDown(bool down) {
    impl_->down = down;
    if (down) impl_->cut();
}

Centerline FakeServer::centerline() {
    return fakeCenterline();
}

}  // namespace haustra::tests
