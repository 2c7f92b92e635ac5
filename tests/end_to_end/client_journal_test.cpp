// What a reader wrote outlives a crash, a closed window and a refusal.
#include "end_to_end/fake_server.h"
#include "reader/session.h"
#include "temporary_folder.h"

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

namespace haustra::reader {
namespace {

namespace fs = std::filesystem;
using tests::FakeServer;
using tests::Misbehaviour;
using Keys = std::vector<std::string>;

class ClientJournal : public ::testing::Test {
protected:
    /// A session, as a window has it; the case is open when it is returned.
    std::unique_ptr<Session> opened(const FakeServer& server) {
        link::ConnectionOptions options;
        options.address = {"127.0.0.1", server.port()};
        options.pinning.knownServersFile = temporary_.path() / "known_servers";
        options.reconnect = true;
        auto session = std::make_unique<Session>(options, "phantom", journal_);
        EXPECT_TRUE(pollUntil(*session, [&] { return session->phase() == Phase::open; }))
            << session->failure().message;
        return session;
    }
    template <class Done>
    static bool pollUntil(Session& session, Done done) {
        const auto deadline = Clock::now() + std::chrono::seconds(20);
        while (!done()) {
            if (Clock::now() > deadline) return false;
            session.poll(std::chrono::milliseconds(20));
        }
        return true;
    }
    static bool settled(Session& session) {
        return pollUntil(session, [&] { return session.owedBookmarks() == 0; });
    }
    static bool listed(Session& session) {
        const auto request = session.requestBookmarks();
        return pollUntil(session, [&] { return session.answeredBookmarkRequest() >= request; });
    }
    static std::string add(Session& session, const std::string& note) {
        Camera camera;
        camera.positionMm = {0.1, -20.0 / 3.0, 1e-7};
        return session.addBookmark(camera, 12.3456789, note);
    }
    Keys onDisk() const {
        Keys keys;
        for (const JournalEntry& entry : journal_.read().entries)
            keys.push_back(entry.bookmark.clientKey);
        return keys;
    }
    JournalEntry entryOf(const FakeServer& server, const std::string& key) const {
        JournalEntry entry;
        entry.server = "127.0.0.1:" + std::to_string(server.port());
        entry.fingerprint = server.fingerprint();
        entry.caseName = "phantom";
        entry.scan = "A";
        entry.notedMs = 1;
        entry.bookmark.clientKey = key;
        entry.bookmark.note = "of " + key;
        return entry;
    }

    const tests::TemporaryFolder temporary_;
    const BookmarkJournal journal_{temporary_.path() / "data" / "haustra" / "bookmarks"};
};

TEST_F(ClientJournal, AnEntryComesBackAsItWasAndNobodyElseReadsIt) {
    JournalEntry entry;
    entry.server = "host:7117";
    entry.fingerprint = "ab:cd";
    entry.caseName = "a \"case\"";
    entry.scan = "scan";
    entry.notedMs = 1'700'000'000'123;
    entry.bookmark.camera.positionMm = {0.1, -1e-300, 20.0 / 3.0};
    entry.bookmark.camera.forward = {0.0, 1.0, 0.0};
    entry.bookmark.camera.up = {1.0, 0.0, 0.0};
    entry.bookmark.arcMm = 1.0 / 3.0;
    entry.bookmark.note = "sessile, 8 mm – \n\t\\ \"zwei\"";
    entry.bookmark.clientKey = "0123456789abcdef";
    entry.refusal = "the disk is full";
    ASSERT_TRUE(journal_.write(entry));
    const auto contents = journal_.read();
    EXPECT_TRUE(contents.errors.empty());
    ASSERT_EQ(contents.entries.size(), 1u);
    const JournalEntry& back = contents.entries[0];
    EXPECT_EQ(back.server, entry.server);
    EXPECT_EQ(back.fingerprint, entry.fingerprint);
    EXPECT_EQ(back.caseName, entry.caseName);
    EXPECT_EQ(back.scan, entry.scan);
    EXPECT_EQ(back.notedMs, entry.notedMs);
    EXPECT_EQ(back.refusal, entry.refusal);
    EXPECT_EQ(back.bookmark.camera, entry.bookmark.camera);
    EXPECT_EQ(back.bookmark.arcMm, entry.bookmark.arcMm);
    EXPECT_EQ(back.bookmark.note, entry.bookmark.note);
    EXPECT_EQ(back.bookmark.clientKey, entry.bookmark.clientKey);
    struct stat file {};
    ASSERT_EQ(::stat((journal_.folder() / "0123456789abcdef.json").c_str(), &file), 0);
    EXPECT_EQ(file.st_mode & 0777, 0600u);
    ASSERT_EQ(::stat(journal_.folder().c_str(), &file), 0);
    EXPECT_EQ(file.st_mode & 0777, 0700u);

    entry.refusal.reset();
    ASSERT_TRUE(journal_.write(entry));  // in place of the former
    EXPECT_FALSE(journal_.read().entries.at(0).refusal);
    ASSERT_TRUE(journal_.erase(entry.bookmark.clientKey));
    ASSERT_TRUE(journal_.erase(entry.bookmark.clientKey));
    EXPECT_TRUE(journal_.read().entries.empty());
    entry.bookmark.clientKey = "../outside";
    EXPECT_FALSE(journal_.write(entry));
}

TEST_F(ClientJournal, WhatWasNotAcknowledgedIsSentByTheNextSessionUnderTheSameKey) {
    Misbehaviour silent;
    silent.ignoreBookmarks = 2;
    const FakeServer server(silent);
    auto session = opened(server);
    const Keys keys = {add(*session, "first"), add(*session, "second")};
    ASSERT_TRUE(pollUntil(*session, [&] { return server.bookmarkMessages() == 2; }));
    EXPECT_EQ(onDisk().size(), 2u);
    session.reset();  // killed, as far as the journal can tell: it is never told of an end

    session = opened(server);
    ASSERT_TRUE(settled(*session));
    EXPECT_EQ(server.storedBookmarkKeys(), keys);
    EXPECT_EQ(server.bookmarkMessages(), 4);
    EXPECT_TRUE(onDisk().empty());
    const Bookmark* second = session->acknowledgedBookmark(keys[1]);
    ASSERT_TRUE(second);
    EXPECT_EQ(second->note, "second");
    EXPECT_EQ(second->arcMm, 12.3456789);
    EXPECT_EQ(second->camera.positionMm, glm::dvec3(0.1, -20.0 / 3.0, 1e-7));

    session = opened(server);  // nothing is left to send
    ASSERT_TRUE(listed(*session));
    EXPECT_EQ(server.bookmarkMessages(), 4);
    EXPECT_EQ(session->bookmarks().size(), 2u);
}

TEST_F(ClientJournal, StoredButNeverAcknowledgedIsKeptOnce) {
    Misbehaviour dropping;
    dropping.dropAfterBookmarks = 1;
    const FakeServer server(dropping);
    auto session = opened(server);
    const std::string key = add(*session, "first");
    ASSERT_TRUE(pollUntil(*session, [&] { return server.storedBookmarkKeys().size() == 1; }));
    session.reset();
    session = opened(server);
    ASSERT_TRUE(settled(*session));
    EXPECT_EQ(server.storedBookmarkKeys(), Keys{key});
    EXPECT_TRUE(onDisk().empty());
}

TEST_F(ClientJournal, WhatIsNotedBeforeTheCaseIsOpenIsOfTheCase) {
    const FakeServer server;
    link::ConnectionOptions options;
    options.address = {"127.0.0.1", server.port()};
    options.pinning.knownServersFile = temporary_.path() / "known_servers";
    Session session(options, "phantom", journal_);
    const std::string key = add(session, "early");
    EXPECT_EQ(session.owedBookmarks(), 1u);
    ASSERT_TRUE(settled(session));
    EXPECT_EQ(server.storedBookmarkKeys(), Keys{key});
    EXPECT_TRUE(session.takeRefusals().empty());
    EXPECT_TRUE(onDisk().empty());
}

TEST_F(ClientJournal, ARefusedBookmarkStaysUntilItIsSentAgainOrDismissed) {
    Misbehaviour full;
    full.refuseBookmarks = 3;
    const FakeServer server(full);
    auto session = opened(server);
    const std::string same = add(*session, "as it is"), other = add(*session, "to be changed"),
                      gone = add(*session, "to be dismissed");
    ASSERT_TRUE(settled(*session));
    const auto expectAll = [&] {
        const auto refused = session->refusedBookmarks();
        ASSERT_EQ(refused.size(), 3u);
        for (const std::string& key : {same, other, gone})
            EXPECT_TRUE(std::any_of(refused.begin(), refused.end(), [&](const auto& r) {
                return r.bookmark.clientKey == key && r.reason == "the disk is full";
            }));
    };
    expectAll();
    session = opened(server);
    ASSERT_TRUE(listed(*session));
    expectAll();
    EXPECT_EQ(session->owedBookmarks(), 0u);
    EXPECT_EQ(server.bookmarkMessages(), 3);  // none is sent by itself

    EXPECT_EQ(session->sendRefusedAgain(same, "as it is"), same);
    const std::string changed = session->sendRefusedAgain(other, "changed");
    EXPECT_NE(changed, other);
    session->dismissRefused(gone);
    EXPECT_TRUE(session->refusedBookmarks().empty());
    EXPECT_EQ(session->sendRefusedAgain(gone, "dismissed"), "");
    EXPECT_EQ(onDisk().size(), 2u);
    ASSERT_TRUE(settled(*session));
    EXPECT_EQ(server.storedBookmarkKeys(), (Keys{same, changed}));
    EXPECT_EQ(session->acknowledgedBookmark(changed)->note, "changed");
    EXPECT_TRUE(onDisk().empty());
}

TEST_F(ClientJournal, OthersEntriesAreNeitherSentNorTouched) {
    const FakeServer server;
    JournalEntry ours = entryOf(server, "a0"), case2 = entryOf(server, "a1"),
                 scan2 = entryOf(server, "a2"), server2 = entryOf(server, "a3"),
                 certificate2 = entryOf(server, "a4"), refusedScan2 = entryOf(server, "a5");
    case2.caseName = "another";
    scan2.scan = refusedScan2.scan = "former";
    server2.server = "elsewhere:7117";
    certificate2.fingerprint = "00";
    refusedScan2.refusal = "no";
    for (const auto& entry : {ours, case2, scan2, server2, certificate2, refusedScan2})
        ASSERT_TRUE(journal_.write(entry));
    auto session = opened(server);
    ASSERT_TRUE(settled(*session));
    ASSERT_TRUE(listed(*session));
    EXPECT_EQ(server.storedBookmarkKeys(), Keys{"a0"});
    EXPECT_EQ(session->bookmarks().size(), 1u);
    EXPECT_TRUE(session->refusedBookmarks().empty());
    EXPECT_EQ(session->sendRefusedAgain("a5", "no"), "");
    EXPECT_EQ(onDisk(), (Keys{"a1", "a2", "a3", "a4", "a5"}));
    const auto told = session->takeRefusals();
    ASSERT_EQ(told.size(), 2u);
    EXPECT_NE(told[0].message.find("another certificate"), std::string::npos);
    EXPECT_NE(told[1].message.find("another scan now: 2 "), std::string::npos) << told[1].message;
}

TEST_F(ClientJournal, ADamagedFileIsSetAsideAndToldOnce) {
    const FakeServer server;
    ASSERT_TRUE(journal_.write(entryOf(server, "a0")));
    ASSERT_TRUE(journal_.write(entryOf(server, "a1")));
    const auto file = [&](const char* name) { return journal_.folder() / name; };
    const auto textOf = [](const fs::path& path) {
        std::stringstream text;
        text << std::ifstream(path).rdbuf();
        return text.str();
    };
    const std::string whole = textOf(file("a1.json"));
    for (std::size_t bytes = 0; bytes + 1 < whole.size(); bytes += 7) {
        std::ofstream(file("a1.json")) << whole.substr(0, bytes);
        const auto contents = journal_.read();
        EXPECT_EQ(contents.entries.size(), 1u);
        ASSERT_EQ(contents.errors.size(), 1u);
        EXPECT_EQ(textOf(contents.errors[0].place), whole.substr(0, bytes));
    }
    fs::copy_file(file("a0.json"), file("a2.json"));  // says another key than its name
    std::ofstream(file("a3.json")) << "{\"format\":2,\"what\":\"a later client knows\"}\n";

    auto session = opened(server);
    ASSERT_TRUE(settled(*session));
    EXPECT_EQ(server.storedBookmarkKeys(), Keys{"a0"});
    EXPECT_EQ(session->takeRefusals().size(), 2u);
    EXPECT_FALSE(fs::exists(file("a2.json")));
    EXPECT_TRUE(fs::exists(file("a2.json.damaged")));
    EXPECT_TRUE(fs::exists(file("a3.json")));
    fs::remove(file("a3.json"));
    session = opened(server);
    EXPECT_TRUE(session->takeRefusals().empty());
}

TEST_F(ClientJournal, TwoClientsAtOnceKeepOneAnothersEntries) {
    Misbehaviour silent;
    silent.ignoreBookmarks = 20;
    const FakeServer server(silent);
    auto one = opened(server), other = opened(server);
    Keys keys;
    for (int n = 0; n < 10; ++n) {
        keys.push_back(add(*one, "one"));
        keys.push_back(add(*other, "other"));
    }
    ASSERT_TRUE(pollUntil(*one, [&] { return server.bookmarkMessages() == 20; }));
    EXPECT_EQ(onDisk().size(), 20u);
    one = opened(server);  // takes up what the other is still waiting for
    ASSERT_TRUE(settled(*one));
    ASSERT_TRUE(listed(*other));
    EXPECT_EQ(other->owedBookmarks(), 0u);  // the list tells it
    Keys stored = server.storedBookmarkKeys();
    std::sort(keys.begin(), keys.end());
    std::sort(stored.begin(), stored.end());
    EXPECT_EQ(stored, keys);
    EXPECT_TRUE(onDisk().empty());
}

TEST_F(ClientJournal, WithoutADiskABookmarkIsSentAllTheSameAndTheReaderTold) {
    const FakeServer server;
    auto session = opened(server);
    fs::create_directories(journal_.folder().parent_path());
    std::ofstream(journal_.folder()) << "a file where the folder should be";
    const std::string first = add(*session, "no folder");
    const auto expectTold = [&] {
        const auto told = session->takeRefusals();
        ASSERT_GE(told.size(), 1u);
        EXPECT_EQ(told[0].kind, ErrorKind::io);
        EXPECT_NE(told[0].message.find("not on this computer's disk"), std::string::npos);
    };
    expectTold();
    ASSERT_TRUE(settled(*session));
    EXPECT_EQ(session->takeRefusals().size(), 0u);

    fs::remove(journal_.folder());
    ::signal(SIGXFSZ, SIG_IGN);
    rlimit before{};
    ASSERT_EQ(::getrlimit(RLIMIT_FSIZE, &before), 0);
    rlimit full = before;
    full.rlim_cur = 10;
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &full), 0);
    const std::string second = add(*session, "a full disk");
    ASSERT_EQ(::setrlimit(RLIMIT_FSIZE, &before), 0);
    expectTold();
    ASSERT_TRUE(settled(*session));
    EXPECT_EQ(server.storedBookmarkKeys(), (Keys{first, second}));
    EXPECT_TRUE(fs::is_empty(journal_.folder()));  // no half of a file either
}

}  // namespace
}  // namespace haustra::reader
