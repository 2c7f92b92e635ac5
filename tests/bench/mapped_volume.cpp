#include "mapped_volume.h"

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

namespace haustra::bench {

namespace {

struct Mapping {
    void* memory = MAP_FAILED;
    std::size_t bytes = 0;
    ~Mapping() {
        if (memory != MAP_FAILED) munmap(memory, bytes);
    }
};

}  // namespace

Result<Volume<std::int16_t>> sparseVolume(const std::string& file, const Volume<std::int16_t>& part,
                                          glm::ivec3 size, glm::ivec3 corner) {
    const auto refused = [&] { return fail(ErrorKind::io, std::strerror(errno), file); };
    Grid grid = part.grid();
    grid.size = size;
    const int descriptor = open(file.c_str(), O_RDWR | O_CREAT | O_TRUNC, 0600);
    if (descriptor < 0) return refused();
    unlink(file.c_str());
    auto mapping = std::make_shared<Mapping>();
    mapping->bytes = grid.voxelCount() * sizeof(std::int16_t);
    bool sound = ftruncate(descriptor, off_t(mapping->bytes)) == 0;
    const glm::ivec3 voxels = part.grid().size;
    for (int k = 0; sound && k < voxels.z; ++k)
        for (int j = 0; sound && j < voxels.y; ++j) {
            const std::size_t row = std::size_t(voxels.x) * sizeof(std::int16_t);
            const std::size_t at = grid.index(corner.x, corner.y + j, corner.z + k);
            sound = pwrite(descriptor, &part.voxels()[part.grid().index(0, j, k)], row,
                           off_t(at * sizeof(std::int16_t))) == ssize_t(row);
        }
    if (sound)
        mapping->memory = mmap(nullptr, mapping->bytes, PROT_READ, MAP_SHARED, descriptor, 0);
    const int error = errno;
    close(descriptor);
    errno = error;
    if (mapping->memory == MAP_FAILED) return refused();
    const auto* values = static_cast<const std::int16_t*>(mapping->memory);
    return Volume<std::int16_t>::view(grid, values, std::move(mapping));
}

}  // namespace haustra::bench
