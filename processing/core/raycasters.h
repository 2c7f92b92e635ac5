// The raycasters: the one table that the protocol, help texts, the choice of the fastest and the
// accounts of the GPU's memory read.
#pragma once

#include "core/result.h"

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

namespace haustra {

enum class RaycasterKind {
    native,           ///< ray packets on the CPU's vector units; needs no GPU
    singlePass,       ///< image order, one compute pass, leaping over empty blocks
    polygonAssisted,  ///< rays start at the wall's rasterised mesh (§6.3.1)
    objectOrder,      ///< cells in layers, resident in a bounded GPU pool (§5.2)
    hybrid,           ///< rays found and ended on the CPU, integrated in slabs on the GPU (§5.3)
};

/// What a raycaster keeps of the volume in the GPU's memory.
enum class VolumeOnGpu {
    none,
    whole,
    cells,  ///< those that are seen, within a budget: it draws a scan of any size
};

enum class Processor { cpu, gpu, both };

struct RaycasterEntry {
    RaycasterKind kind;
    const char* name;     ///< in options, messages and reports; lower case, with hyphens
    std::uint8_t wireId;  ///< in tile headers (PROTOCOL.md), 1…255; never given to another
    Processor processor;
    VolumeOnGpu volume;
    bool needsWallMesh;

    bool needsWholeVolume() const { return volume == VolumeOnGpu::whole; }
};

/// All of them. render/case_renderer.cpp makes them.
std::span<const RaycasterEntry> raycasters();
const RaycasterEntry& raycasterEntry(RaycasterKind kind);

const char* toString(RaycasterKind kind);
/// By its name; fails (badInput) and names them all.
Result<RaycasterKind> raycasterFromString(std::string_view text);
/// The name of the one with this wireId; empty where there is none, as for 0, "not told".
const char* raycasterName(std::uint8_t wireId);
/// "native, single-pass, …", as help texts and messages list them.
std::string raycasterNames();

}  // namespace haustra
