#include "core/large_pages.h"

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <system_error>

#include <unistd.h>

namespace haustra {
namespace {

// The choice in force stands in brackets: "always [madvise] never".
bool areLeftToPrograms() {
    std::ifstream choices("/sys/kernel/mm/transparent_hugepage/enabled");
    std::string line;
    return std::getline(choices, line) && line.find("[madvise]") != std::string::npos;
}

}  // namespace

void useLargePages(char** argv) {
    constexpr char tunables[] = "GLIBC_TUNABLES";
    if (std::getenv(tunables) || !areLeftToPrograms()) return;
    std::error_code failed;
    const auto program = std::filesystem::read_symlink("/proc/self/exe", failed);
    if (failed || ::setenv(tunables, "glibc.malloc.hugetlb=1", 0) != 0) return;
    ::execv(program.c_str(), argv);  // returns only where it cannot
}

}  // namespace haustra
