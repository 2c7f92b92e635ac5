#include "core/raycasters.h"

#include <algorithm>
#include <cstdlib>

namespace haustra {

namespace {

using enum RaycasterKind;

constexpr RaycasterEntry table[] = {
    // kind          name                wire  processor        volume on the GPU   wall's mesh
    {native, "native", 1, Processor::cpu, VolumeOnGpu::none, false},
    {singlePass, "single-pass", 2, Processor::gpu, VolumeOnGpu::whole, false},
    {polygonAssisted, "polygon-assisted", 3, Processor::gpu, VolumeOnGpu::whole, true},
    {objectOrder, "object-order", 4, Processor::gpu, VolumeOnGpu::cells, false},
    {hybrid, "hybrid", 5, Processor::both, VolumeOnGpu::whole, false},
};

}  // namespace

std::span<const RaycasterEntry> raycasters() {
    return table;
}

const RaycasterEntry& raycasterEntry(RaycasterKind kind) {
    for (const RaycasterEntry& entry : table)
        if (entry.kind == kind) return entry;
    std::abort();  // a kind without a row
}

const char* toString(RaycasterKind kind) {
    return raycasterEntry(kind).name;
}

Result<RaycasterKind> raycasterFromString(std::string_view text) {
    for (const RaycasterEntry& entry : table)
        if (text == entry.name) return entry.kind;
    return fail(ErrorKind::badInput,
                "no raycaster named '" + std::string(text) + "' (" + raycasterNames() + ")");
}

const char* raycasterName(std::uint8_t wireId) {
    for (const RaycasterEntry& entry : table)
        if (entry.wireId == wireId) return entry.name;
    return "";
}

std::string raycasterNames() {
    std::string names;
    for (const RaycasterEntry& entry : table)
        names += std::string(names.empty() ? "" : ", ") + entry.name;
    return names;
}

}  // namespace haustra
