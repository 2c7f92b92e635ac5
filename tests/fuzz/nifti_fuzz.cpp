// Any bytes as a NIfTI file: read or refused with a message, never a crash.
#include "fuzz/memory_file.h"
#include "nifti/nifti_file.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace haustra;
    const tests::MemoryFile file(data, size);
    const auto read = nifti::readNifti<std::int16_t>(file.path());
    if (read ? !checkGrid(read->grid(), "") : read.error().message.empty()) std::abort();
    return 0;
}
