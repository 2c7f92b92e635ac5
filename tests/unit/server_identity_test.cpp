// The certificate that a new store is given.
#include "net/identity.h"
#include "temporary_folder.h"

#include <barrier>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include <gtest/gtest.h>
#include <openssl/ssl.h>

namespace haustra::net {
namespace {

std::string content(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// The law: however many start at once, each has, as soon as it has any, the one pair that fits.
TEST(ServerIdentity, ServersThatStartAtOnceHaveOne) {
    constexpr int servers = 8;
    for (int round = 0; round < 20; ++round) {
        const tests::TemporaryFolder folder;
        std::vector<std::string> pairs(servers);
        std::barrier together(servers);
        {
            std::vector<std::jthread> starting;
            for (std::string& pair : pairs)
                starting.emplace_back([&] {
                    together.arrive_and_wait();
                    const auto identity = identityIn(folder.path() / "tls");
                    ASSERT_TRUE(identity) << describe(identity.error());
                    pair = content(identity->certificate) + content(identity->key);
                });
        }
        for (const std::string& pair : pairs)
            EXPECT_EQ(pair, pairs.front());
        SSL_CTX* const tls = SSL_CTX_new(TLS_server_method());
        const auto certificate = folder.path() / "tls" / "certificate.pem";
        const auto key = folder.path() / "tls" / "key.pem";
        EXPECT_EQ(SSL_CTX_use_certificate_chain_file(tls, certificate.c_str()), 1);
        EXPECT_EQ(SSL_CTX_use_PrivateKey_file(tls, key.c_str(), SSL_FILETYPE_PEM), 1);
        SSL_CTX_free(tls);
        EXPECT_EQ(std::filesystem::status(key).permissions(), std::filesystem::perms(0600));
    }
}

}  // namespace
}  // namespace haustra::net
