// A balance for each reader of one case.
#pragma once

#include "render/hybrid/balance.h"
#include "render/scene/lru_cache.h"
#include "render/scene/raycaster.h"

#include <memory>

namespace haustra::render {

/// Pictures of several readers come mixed, in bands, and some are left unfinished. The balance
/// compares pictures that follow each other: so each reader has its own, and only whole pictures
/// count. Who a reader is is told by what is drawn: equal colours, sampling and size, and a camera
/// near the last one. A camera that leaps, or a picture of another size, begins anew with what was
/// known of the same colours; other colours begin with split 0, which is never far from a
/// single pass. The last `readersKept` are known. Belongs to one thread.
class ReaderBalances {
public:
    static constexpr std::size_t readersKept = 8;
    static constexpr double nearDegrees = 30.0;

    /// Cameras up to `nearMm` apart, in about the same direction, are one reader's.
    explicit ReaderBalances(double nearMm) : nearMm_(nearMm) {}

    /// What to draw this band with: the same for all bands of a picture.
    const HybridControls& controls(const CameraView& view, const Band& band, double stepMm);
    /// Of the band of the last call of controls(): as HybridBalance::drew.
    void drew(double cpuMs, double gpuMs, double bandMs);

private:
    struct Reader {
        Optics optics;
        double stepMm = 0.0;
        glm::ivec2 size{0};
        Camera camera;
        HybridBalance balance;
        int nextRow = 0;  // of the picture that is begun
        double cpuMs = 0.0, gpuMs = 0.0, ms = 0.0;
    };
    bool near(const Camera& a, const Camera& b) const;
    Reader& readerOf(const CameraView& view, const Band& band, double stepMm);

    double nearMm_;
    LruCache<std::unique_ptr<Reader>> readers_{readersKept};
    Reader* drawing_ = nullptr;  // of the last band, where it counts
    Band band_;
};

}  // namespace haustra::render
