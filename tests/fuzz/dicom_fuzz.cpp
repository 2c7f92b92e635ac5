// Any bytes as a DICOM file: imported or refused with a message, never a crash.
#include "dicom/import_series.h"
#include "fuzz/memory_file.h"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace haustra;
    const tests::MemoryFile file(data, size);
    dicom::ImportOptions options;
    options.threads = 1;
    const auto imported = dicom::importSeries(file.path(), options);
    if (imported ? !checkGrid(imported->scan.hu.grid(), "") : imported.error().message.empty())
        std::abort();
    return 0;
}
