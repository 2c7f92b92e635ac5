// From a rendered picture to the frames that go over the wire.
#pragma once

#include "core/result.h"
#include "protocol/framing.h"
#include "render/scene/picture.h"

#include <memory>

namespace haustra::encode {

/// JPEG while moving: 42 dB at 25 kB for 512² (METHODS §21 "Pictures on the wire").
inline constexpr int jpegQuality = 80;

/// Codes pictures. Belongs to one thread (libjpeg-turbo keeps state between pictures).
class TileEncoder {
public:
    static Result<TileEncoder> create();

    /// All frames of one picture, ready to be sent in order. Of `header`, the caller has set what
    /// concerns the whole picture: viewport, codec, exact, picture, sequence, renderMicroseconds
    /// and queueMicroseconds; the rest is filled in here. Fails (badInput) where the image's size
    /// is out of the protocol's bounds, or where libjpeg-turbo refuses it. Some 1 ms (JPEG) or
    /// 3 ms (lossless) for 512².
    Result<std::vector<std::uint8_t>> encode(const Image& image, protocol::TileHeader header);

private:
    struct Jpeg;
    struct Free {
        void operator()(Jpeg* jpeg) const;
    };
    explicit TileEncoder(std::unique_ptr<Jpeg, Free> jpeg) : jpeg_(std::move(jpeg)) {}
    std::unique_ptr<Jpeg, Free> jpeg_;
};

}  // namespace haustra::encode
