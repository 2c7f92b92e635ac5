#include "end_to_end/self_signed.h"

#include "link/fingerprint.h"

#include <random>

#include <openssl/rsa.h>

namespace haustra::tests {

SelfSigned makeSelfSigned() {
    SelfSigned identity;
    identity.key.reset(EVP_EC_gen("P-256"), EVP_PKEY_free);
    identity.certificate.reset(X509_new(), X509_free);
    X509* certificate = identity.certificate.get();
    X509_set_version(certificate, 2);
    ASN1_INTEGER_set(X509_get_serialNumber(certificate), long(std::random_device{}() >> 1));
    X509_gmtime_adj(X509_getm_notBefore(certificate), 0);
    X509_gmtime_adj(X509_getm_notAfter(certificate), 24 * 3600);
    X509_NAME_add_entry_by_txt(X509_get_subject_name(certificate), "CN", MBSTRING_ASC,
                               reinterpret_cast<const unsigned char*>("test"), -1, -1, 0);
    X509_set_issuer_name(certificate, X509_get_subject_name(certificate));
    X509_set_pubkey(certificate, identity.key.get());
    X509_sign(certificate, identity.key.get(), EVP_sha256());
    unsigned char* der = nullptr;
    const int bytes = i2d_X509(certificate, &der);
    identity.fingerprint = link::fingerprintOf({der, std::size_t(bytes)});
    OPENSSL_free(der);
    return identity;
}

}  // namespace haustra::tests
