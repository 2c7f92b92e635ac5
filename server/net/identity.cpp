#include "net/identity.h"

#include "core/durable_file.h"
#include "store/file_lock.h"

#include <memory>
#include <string_view>

#include <openssl/bio.h>
#include <openssl/ec.h>
#include <openssl/evp.h>
#include <openssl/pem.h>
#include <openssl/rand.h>
#include <openssl/x509.h>

namespace haustra::net {
namespace {

namespace fs = std::filesystem;

template <auto function>
struct FreeWith {
    template <class T>
    void operator()(T* object) const {
        function(object);
    }
};
using Key = std::unique_ptr<EVP_PKEY, FreeWith<EVP_PKEY_free>>;
using Certificate = std::unique_ptr<X509, FreeWith<X509_free>>;
using Memory = std::unique_ptr<BIO, FreeWith<BIO_free_all>>;

constexpr long validSeconds = 10L * 365 * 24 * 3600;

Certificate selfSigned(EVP_PKEY* key) {
    Certificate certificate(X509_new());
    unsigned char random[8];
    if (!certificate || RAND_bytes(random, sizeof random) != 1) return nullptr;
    std::uint64_t serial = 0;
    for (const unsigned char byte : random)
        serial = serial << 8 | byte;
    X509* const x = certificate.get();
    X509_NAME* const name = X509_get_subject_name(x);
    const bool made =
        X509_set_version(x, X509_VERSION_3) == 1 &&
        ASN1_INTEGER_set_uint64(X509_get_serialNumber(x), serial | 1) == 1 &&
        X509_gmtime_adj(X509_getm_notBefore(x), -24L * 3600) &&  // clients' clocks differ
        X509_gmtime_adj(X509_getm_notAfter(x), validSeconds) &&
        X509_NAME_add_entry_by_txt(name, "CN", MBSTRING_ASC,
                                   reinterpret_cast<const unsigned char*>("haustra-server"), -1, -1,
                                   0) == 1 &&
        X509_set_issuer_name(x, name) == 1 && X509_set_pubkey(x, key) == 1 &&
        X509_sign(x, key, EVP_sha256()) > 0;
    return made ? std::move(certificate) : nullptr;
}

std::string_view content(BIO* memory) {
    char* data = nullptr;
    const long bytes = BIO_get_mem_data(memory, &data);
    return {data, std::size_t(bytes)};
}

}  // namespace

Result<Identity> identityIn(const fs::path& folder) {
    const Identity identity{folder / "certificate.pem", folder / "key.pem"};
    std::error_code error;
    if (fs::exists(identity.certificate, error)) return identity;
    fs::create_directories(folder, error);
    if (error) return fail(ErrorKind::io, "cannot make the folder: " + error.message(), folder);
    fs::permissions(folder, fs::perms::owner_all, error);
    const auto alone = TRY(store::lockFile(folder / ".lock", store::WhereLocked::wait));
    if (fs::exists(identity.certificate, error)) return identity;  // another server's

    const Key key(EVP_EC_gen("P-256"));
    const Certificate certificate = key ? selfSigned(key.get()) : nullptr;
    const Memory keyText(BIO_new(BIO_s_mem())), certificateText(BIO_new(BIO_s_mem()));
    if (!certificate || !keyText || !certificateText ||
        PEM_write_bio_PrivateKey(keyText.get(), key.get(), nullptr, nullptr, 0, nullptr, nullptr) !=
            1 ||
        PEM_write_bio_X509(certificateText.get(), certificate.get()) != 1)
        return fail(ErrorKind::device, "OpenSSL cannot make a certificate", folder);

    // The key first: a certificate that is there has its key.
    TRY(writeDurably(identity.key, content(keyText.get()), 0600));
    TRY(writeDurably(identity.certificate, content(certificateText.get()), 0644));
    return identity;
}

}  // namespace haustra::net
