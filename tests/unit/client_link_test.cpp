// Addresses, fingerprints and the file of pinned certificates.
#include "link/fingerprint.h"
#include "link/known_servers.h"
#include "link/peer_text.h"
#include "link/server_address.h"
#include "temporary_folder.h"

#include <fstream>
#include <sstream>

#include <gtest/gtest.h>

namespace haustra::link {
namespace {

const std::string one(64, '1'), two(64, '2');

class KnownServersTest : public ::testing::Test {
protected:
    std::filesystem::path file() const { return folder_ / "haustra" / "known_servers"; }
    std::string content() const {
        std::ifstream in(file());
        std::ostringstream text;
        text << in.rdbuf();
        return text.str();
    }
    void write(const std::string& text) const {
        std::filesystem::create_directories(file().parent_path());
        std::ofstream(file()) << text;
    }
    const tests::TemporaryFolder temporary_;
    const std::filesystem::path folder_ = temporary_.path() / "none";
};

TEST(ServerAddress, ReadsWhatPeopleWrite) {
    const auto check = [](const char* text, const char* host, int port) {
        const auto address = parseServerAddress(text);
        ASSERT_TRUE(address) << text;
        EXPECT_EQ(address->host, host) << text;
        EXPECT_EQ(address->port, port) << text;
    };
    check("ct.example.org", "ct.example.org", defaultPort);
    check("127.0.0.1:4321", "127.0.0.1", 4321);
    check("[::1]", "::1", defaultPort);
    check("[fe80::2]:65535", "fe80::2", 65535);
    EXPECT_EQ(toString(*parseServerAddress("[::1]:9")), "[::1]:9");
    EXPECT_EQ(toString(*parseServerAddress("a:9")), "a:9");
    for (const char* wrong : {"", ":80", "a:", "a:0", "a:65536", "a:x", "a:80x", "::1", "[::1",
                              "[::1]80", "a b", "https://a"})
        EXPECT_FALSE(parseServerAddress(wrong)) << wrong;
}

TEST(PeerText, IsOneShortLineWithoutControls) {
    EXPECT_EQ(peerText("the disk is full"), "the disk is full");
    EXPECT_EQ(peerText("a\nb\tc\x1b[31m\x7f"), "a b c [31m ");
    EXPECT_EQ(peerText("a\nb\tc\r", 400, true), "a\nb\tc ");
    EXPECT_EQ(peerText("\u202Edrawkcab\u2066 \u0085\u2028"), " drawkcab    ");
    EXPECT_EQ(peerText("größer · 大"), "größer · 大");
    EXPECT_EQ(peerText("größer", 3), "gr…");
    EXPECT_EQ(peerText("größer", 4), "grö…");
    EXPECT_LE(peerText(std::string(4'000'000, 'x')).size(), maxPeerTextBytes + 3);
    for (const char* broken : {"\xc3", "a\xe2\x82", "\xff\xff", "\x80"})
        EXPECT_LE(peerText(broken).size(), 3u);
}

TEST(Fingerprint, IsSha256OfTheBytes) {
    const std::string abc = "abc";
    EXPECT_EQ(fingerprintOf({reinterpret_cast<const std::uint8_t*>(abc.data()), abc.size()}),
              "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
}

TEST(Fingerprint, IsReadInAnyCommonSpelling) {
    EXPECT_EQ(*normalizeFingerprint("SHA256:" + std::string(64, 'A')), std::string(64, 'a'));
    std::string colons;
    for (int n = 0; n < 32; ++n)
        colons += n ? ":1F" : "1F";
    EXPECT_EQ(normalizeFingerprint(colons)->size(), 64u);
    EXPECT_FALSE(normalizeFingerprint(std::string(63, 'a')));
    EXPECT_FALSE(normalizeFingerprint(std::string(64, 'g')));
    EXPECT_FALSE(normalizeFingerprint(""));
}

TEST_F(KnownServersTest, PinsOnFirstUseAcceptsTheSameAndRefusesAnother) {
    const Pinning pinning{file(), {}};
    EXPECT_EQ(*checkPin(pinning, "a:1", one), Trust::firstUse);
    EXPECT_EQ(*checkPin(pinning, "a:1", one), Trust::known);
    EXPECT_EQ(*checkPin(pinning, "a:2", two), Trust::firstUse);
    const auto refused = checkPin(pinning, "a:1", two);
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find(one), std::string::npos);
    EXPECT_NE(refused.error().message.find(two), std::string::npos);
    EXPECT_NE(refused.error().message.find("--fingerprint"), std::string::npos);
    EXPECT_EQ(*checkPin(pinning, "a:1", one), Trust::known);  // a refusal changes nothing
}

// Whoever took that for a first meeting would trust anybody, and write over the other pins.
TEST_F(KnownServersTest, AFileThatCannotBeLookedForIsNoFirstMeeting) {
    std::filesystem::create_directories(file().parent_path());
    std::filesystem::create_symlink(file(), file());  // leads nowhere, but is there
    const auto trust = checkPin({file(), {}}, "a:1", one);
    ASSERT_FALSE(trust);
    EXPECT_EQ(trust.error().kind, ErrorKind::io);
    EXPECT_TRUE(std::filesystem::is_symlink(file()));
}

TEST_F(KnownServersTest, AGivenFingerprintMustMatchAndReplacesThePin) {
    ASSERT_TRUE(checkPin({file(), {}}, "a:1", one));
    EXPECT_FALSE(checkPin({file(), two}, "a:1", one));
    EXPECT_TRUE(checkPin({file(), two}, "a:1", two));
    EXPECT_EQ(*checkPin({file(), {}}, "a:1", two), Trust::known);
    EXPECT_FALSE(checkPin({file(), {}}, "a:1", one));
}

TEST_F(KnownServersTest, KeepsCommentsAndOtherServersAndLeavesNoOtherFile) {
    write("# our reading room\n\nb:7117 " + two + "\n");
    ASSERT_TRUE(KnownServers(file()).pin("a:1", one));
    EXPECT_EQ(content(), "# our reading room\n\nb:7117 " + two + "\na:1 " + one + "\n");
    int files = 0;
    for ([[maybe_unused]] const auto& entry :
         std::filesystem::directory_iterator(file().parent_path()))
        ++files;
    EXPECT_EQ(files, 1);
}

TEST_F(KnownServersTest, ADamagedFileIsNeverAFirstMeeting) {
    for (const std::string& damage :
         {std::string("a:1\n"), "a:1 " + one.substr(1) + "\n", "a:1 " + one + " more\n"}) {
        write("# header\n" + damage);
        const auto refused = checkPin({file(), {}}, "a:1", two);
        ASSERT_FALSE(refused) << damage;
        EXPECT_NE(refused.error().place.find("known_servers:2"), std::string::npos)
            << refused.error().place;
        EXPECT_EQ(content(), "# header\n" + damage);
    }
}

}  // namespace
}  // namespace haustra::link
