// A server's key and certificate, made now.
#pragma once

#include <memory>
#include <string>

#include <openssl/evp.h>
#include <openssl/x509.h>

namespace haustra::tests {

struct SelfSigned {
    std::shared_ptr<EVP_PKEY> key;
    std::shared_ptr<X509> certificate;
    std::string fingerprint;
};
SelfSigned makeSelfSigned();

}  // namespace haustra::tests
