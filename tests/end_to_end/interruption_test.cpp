// What is left where writing a file is cut short.
#include "end_to_end/flat_store.h"
#include "end_to_end/run_program.h"

#include <gtest/gtest.h>

namespace haustra::tests {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::size_t filesIn(const fs::path& folder) {
    return std::size_t(std::distance(fs::directory_iterator(folder), {}));
}

TEST(Interruption, TakesBackAStripThatIsHalfWritten) {
    const TemporaryFolder folder;
    makeFlatStore(folder.path() / "store", FlatTube());
    const fs::path pictures = folder.path() / "pictures";
    fs::create_directory(pictures);
    for (const int signal : {SIGINT, SIGTERM}) {
        bool begun = false;
        const Outcome outcome =
            runProgram("haustra",
                       {"export", smallCaseName, "flat-image", pictures / "strip.png", "--width",
                        "20000", "--store", folder.path() / "store"},
                       [&](pid_t child) {
                           const auto end = std::chrono::steady_clock::now() + 60s;
                           while (!begun && std::chrono::steady_clock::now() < end) {
                               std::this_thread::sleep_for(5ms);
                               begun = filesIn(pictures) > 0;
                           }
                           ::kill(child, signal);
                       });
        EXPECT_TRUE(begun);
        EXPECT_EQ(outcome.signal, signal) << outcome.err;
        EXPECT_EQ(filesIn(pictures), 0u);
    }
}

// Past the greatest size that the shell lets a file have.
TEST(Interruption, TakesBackWhatOutgrowsItsBound) {
    const TemporaryFolder folder;
    makeFlatStore(folder.path() / "store", FlatTube());
    const fs::path pictures = folder.path() / "pictures";
    fs::create_directory(pictures);
    for (const auto& [product, name] : {std::pair{"flat-image", "strip.png"}, {"ct", "ct.nii"}}) {
        const fs::path file = pictures / name;
        const Outcome outcome = runProgram(
            "/bin/sh",
            {"-c", R"(ulimit -f 8; exec "$0" export "$1" "$2" "$3" --store "$4")",
             programPath("haustra"), smallCaseName, product, file, folder.path() / "store"});
        EXPECT_EQ(outcome.signal, 0) << product;
        EXPECT_EQ(outcome.exitCode, 1) << product;
        EXPECT_NE(outcome.err.find("haustra: " + file.string() + ": "), std::string::npos)
            << outcome.err;
        EXPECT_EQ(filesIn(pictures), 0u) << product;
    }
}

}  // namespace
}  // namespace haustra::tests
