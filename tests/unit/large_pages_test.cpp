// A program that starts itself anew, and what it is then.
#include "core/large_pages.h"

#include <cstdlib>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace haustra {
namespace {

// As the program finds out, so that the test passes on any system.
bool areLeftToPrograms() {
    std::ifstream choices("/sys/kernel/mm/transparent_hugepage/enabled");
    std::string line;
    return std::getline(choices, line) && line.find("[madvise]") != std::string::npos;
}

// Set for the program that a test starts anew, and for no other.
constexpr char startedByTest[] = "HAUSTRA_LARGE_PAGES_TEST";

/// The exit code of this program, which calls useLargePages with GLIBC_TUNABLES as `before` (null:
/// not set): 77 where that returns, else StartedAnew's.
int exitCodeWith(const char* before) {
    const pid_t child = ::fork();
    if (child == 0) {
        if (before)
            ::setenv("GLIBC_TUNABLES", before, 1);
        else
            ::unsetenv("GLIBC_TUNABLES");
        ::setenv(startedByTest, "1", 1);
        std::string program = "large_pages_test", filter = "--gtest_filter=*.StartedAnew";
        char* argv[] = {program.data(), filter.data(), nullptr};
        useLargePages(argv);
        ::_exit(77);  // it has returned
    }
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(LargePages, AProgramIsStartedAnewOnceWhereTheSystemLeavesThemToIt) {
    EXPECT_EQ(exitCodeWith(nullptr), areLeftToPrograms() ? 0 : 77);
}

TEST(LargePages, WhoeverHasChosenIsLeftAlone) {
    EXPECT_EQ(exitCodeWith("glibc.malloc.hugetlb=0"), 77);
    EXPECT_EQ(exitCodeWith(""), 77);
}

// What the first one starts, where it fails unless the allocator has been told; by itself it has
// nothing to say.
TEST(LargePages, StartedAnew) {
    if (!std::getenv(startedByTest)) return;
    EXPECT_STREQ(std::getenv("GLIBC_TUNABLES"), "glibc.malloc.hugetlb=1");
    char* argv[] = {nullptr};
    useLargePages(argv);  // returns: it has been done
}

}  // namespace
}  // namespace haustra
