// A scene as the CPU's raycasters read it.
#pragma once

#include "core/thread_pool.h"
#include "render/native/packets.h"
#include "render/optics/transfer_table.h"
#include "render/scene/lru_cache.h"
#include "render/scene/picture.h"
#include "render/scene/scene.h"

#include <memory>
#include <vector>

namespace haustra::render {

/// A volume that packets read where it lies.
class PacketVolume {
public:
    explicit PacketVolume(Volume<std::int16_t> volume);
    const Volume<std::int16_t>& volume() const { return volume_; }
    /// Sets what tells of voxels; valid as long as this lives.
    void describe(PacketScene& scene) const;

private:
    Volume<std::int16_t> volume_;
    std::vector<std::int16_t> twice_;  // each voxel, of a volume that is one voxel wide
};

/// The volume, the classifications lately asked for, and the threads that draw.
/// Belongs to one thread.
class NativeScene {
public:
    /// `threads` ≤ 0: all cores; changes no pixel.
    NativeScene(std::shared_ptr<const Scene> scene, int threads);

    const Scene& scene() const { return *scene_; }
    const PacketVolume& volume() const { return volume_; }
    ThreadPool& pool() { return pool_; }

    /// The transfer function's table for one step length, and the leap map that follows from it.
    struct Classified {
        Optics optics;
        double stepMm = 0.0;
        bool leaping = true;
        TransferTable table;
        std::vector<std::uint8_t> leap;  ///< with three bytes behind the last block
    };
    /// As GlScene's. Fails (badInput) on bad optics or sampling. Valid until the next call.
    Result<const Classified*> classification(const Optics& optics, const MarchOptions& march);

    /// All that packets read; valid as long as `classified`.
    PacketScene packetScene(const shaders::MarchUniforms& uniforms,
                            const Classified& classified) const;

private:
    std::shared_ptr<const Scene> scene_;
    PacketVolume volume_;
    ThreadPool pool_;
    LruCache<Classified> recent_;
};

}  // namespace haustra::render
