// The dependency rules of the design, checked on every #include line of the tree, and on what the
// programs link.
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;
using Names = std::set<std::string>;

fs::path source() {
    const char* set = std::getenv("HAUSTRA_SOURCE");
    return set ? set : ".";
}

// Folder -> the folders, from the root that its #include lines start from, whose headers it may
// include. core is open to all.
const std::map<std::string, Names>& allowed() {
    static const std::map<std::string, Names> rules = {
        {"processing/core", {}},
        {"processing/dicom", {}},
        {"processing/nifti", {}},
        {"processing/phantom", {}},
        {"processing/cleansing", {}},
        {"processing/centerline", {}},
        {"processing/topology", {"centerline"}},    // in which order pieces are joined
        {"processing/segmentation", {"topology"}},  // distances to the boundary
        {"processing/mesh", {}},
        {"processing/contouring", {}},
        {"processing/simplification", {}},
        {"processing/handles", {"mesh"}},
        {"processing/flatten", {"mesh"}},
        {"processing/flatten/tube", {"mesh", "flatten"}},
        {"processing/flatten/general", {"mesh", "flatten", "flatten/tube"}},
        {"processing/organs", {}},
        {"processing/store", {}},
        {"processing/pipeline",
         {"dicom", "nifti", "cleansing", "segmentation", "topology", "centerline", "contouring",
          "simplification", "handles", "flatten/tube", "organs", "store"}},
        {"protocol", {}},
        {"shaders", {}},
        {"server/gpu", {}},
        {"server/render",
         {"gpu", "shaders", "render/flat", "render/gl", "render/hybrid", "render/native",
          "render/object_order", "render/optics", "render/overview", "render/wall"}},
        {"server/render/flat",
         {"gpu", "render", "render/gl", "render/optics", "render/wall", "shaders"}},
        {"server/render/gl",
         {"gpu", "render", "render/flat", "render/optics", "render/overview", "render/wall",
          "shaders"}},
        {"server/render/hybrid",
         {"gpu", "render", "render/gl", "render/native", "render/optics", "render/wall",
          "shaders"}},
        {"server/render/native",
         {"render", "render/flat", "render/optics", "render/wall", "shaders"}},
        {"server/render/object_order",
         {"gpu", "render", "render/gl", "render/optics", "render/wall", "shaders"}},
        {"server/render/optics", {"gpu", "render", "shaders"}},
        {"server/render/overview",
         {"gpu", "render", "render/gl", "render/optics", "render/wall", "shaders"}},
        {"server/render/wall",
         {"gpu", "render", "render/flat", "render/gl", "render/optics", "shaders"}},
        {"server/encode", {"render", "protocol"}},
        {"server/records", {}},
        {"server/session",
         {"gpu", "render", "render/flat", "render/hybrid", "render/optics", "render/wall", "encode",
          "records", "store", "protocol"}},
        {"server/net",
         {"gpu", "render", "render/optics", "encode", "records", "session", "store", "protocol"}},
        {"server/cli",
         {"dicom", "nifti", "phantom", "mesh", "simplification", "handles", "flatten",
          "flatten/tube", "flatten/general", "store", "pipeline", "gpu", "render", "render/flat",
          "render/hybrid", "render/native", "render/object_order", "render/optics", "render/wall"}},
        {"client", {"protocol", "link", "tiles", "reader", "script", "window"}},
        {"client/link", {"protocol"}},
        {"client/tiles", {"protocol"}},
        {"client/reader", {"protocol", "link", "tiles"}},
        {"client/script", {"protocol", "link", "tiles", "reader"}},
        {"client/window", {"protocol", "link", "tiles", "reader"}},
    };
    return rules;
}

// Libraries that stay in the .cpp files of the folders that wrap them.
struct Foreign {
    std::regex header;
    Names folders;
};
const std::vector<Foreign>& foreignHeaders() {
    static const std::vector<Foreign> rules = [] {
        auto of = [](const char* pattern, Names folders) {
            return Foreign{std::regex(pattern), std::move(folders)};
        };
        return std::vector<Foreign>{
            of("^dcmtk/.*", {"processing/dicom"}),
            of("^openjpeg.*", {"processing/dicom"}),
            of("^nifti.*", {"processing/nifti"}),
            of("^(Eigen|suitesparse|cholmod).*",
               {"processing/flatten", "processing/flatten/tube", "processing/flatten/general",
                "processing/cleansing", "processing/handles"}),
            of("^(CGAL|OpenMesh)/.*", {"processing/mesh", "processing/handles"}),
            of("^opencv2/.*", {"processing/cad", "processing/coverage"}),
            of("^sqlite3.h$", {"server/records"}),
            of("^turbojpeg.h$", {"server/encode", "client/tiles"}),
            of("^(EGL|GL|GLES.?|epoxy)/.*", {"server/gpu", "server/render", "client/window"}),
            of("^embree3/.*", {"server/render/wall"}),
            of("^SDL.*", {"client", "client/window"}),
            of("^(asio|openssl)[./].*", {"server/net", "server/session", "client/link",
                                         "processing/store", "processing/pipeline"}),
        };
    }();
    return rules;
}

struct Include {
    fs::path file;
    std::string folder;  // "processing/core"
    std::string header;
    bool quoted;
};

std::vector<Include> includesOfTheTree() {
    static const std::regex line(R"(^\s*#\s*include\s*([<"])([^>"]+)[>"].*)");
    std::vector<Include> includes;
    for (const char* top : {"processing", "protocol", "shaders", "server", "client"}) {
        for (const auto& entry : fs::recursive_directory_iterator(source() / top)) {
            const std::string extension = entry.path().extension().string();
            if (extension != ".h" && extension != ".cpp") continue;
            const fs::path relative = fs::relative(entry.path(), source());
            std::ifstream in(entry.path());
            std::smatch match;
            for (std::string text; std::getline(in, text);) {
                if (!std::regex_match(text, match, line)) continue;
                includes.push_back({relative, relative.parent_path().generic_string(), match[2],
                                    match[1] == "\""});
            }
        }
    }
    return includes;
}

TEST(IncludeRules, TheTreeIsSeen) {
    EXPECT_GT(includesOfTheTree().size(), 100u);
}

TEST(IncludeRules, FoldersIncludeOnlyWhatTheyMay) {
    for (const Include& include : includesOfTheTree()) {
        if (!include.quoted) continue;
        const auto rule = allowed().find(include.folder);
        ASSERT_NE(rule, allowed().end()) << include.folder << " has no rule";
        const std::string target = fs::path(include.header).parent_path().generic_string();
        ASSERT_FALSE(target.empty())
            << include.file << " includes \"" << include.header << "\" without a folder";
        const bool own = include.folder == target || include.folder.ends_with("/" + target);
        EXPECT_TRUE(target == "core" || own || rule->second.count(target))
            << include.file << " must not include \"" << include.header << "\"";
    }
}

TEST(IncludeRules, ForeignLibrariesStayInTheirFolders) {
    for (const Include& include : includesOfTheTree()) {
        if (include.quoted) continue;
        for (const Foreign& foreign : foreignHeaders()) {
            if (!std::regex_match(include.header, foreign.header)) continue;
            EXPECT_TRUE(foreign.folders.count(include.folder))
                << include.file << " must not include <" << include.header << ">";
            const bool looseInHeaders =
                include.header.rfind("asio", 0) == 0 || include.header.rfind("epoxy", 0) == 0;
            if (!looseInHeaders) {
                EXPECT_EQ(include.file.extension(), ".cpp")
                    << include.file << " shows <" << include.header << "> to its users";
            }
        }
    }
}

// What a command prints about a program of the build.
std::string told(const std::string& command, const char* program) {
    const char* bin = std::getenv("HAUSTRA_BIN");
    if (!bin) throw std::runtime_error("HAUSTRA_BIN is not set");
    const fs::path file = fs::path(bin) / program;
    if (!fs::exists(file)) throw std::runtime_error(file.string() + " is not built");
    std::string text;
    FILE* pipe = popen((command + " '" + file.string() + "'").c_str(), "r");
    for (char buffer[512]; pipe && std::fgets(buffer, sizeof buffer, pipe);)
        text += buffer;
    if (!pipe || pclose(pipe) != 0) throw std::runtime_error(command + " fails");
    return text;
}

// A hostile DICOM file, or an abort in a mesh library, must cost one preparation, never a session.
TEST(IncludeRules, TheServerLinksNoImageOrMeshLibrary) {
    const std::string linked = told("ldd", "haustra-server");
    EXPECT_NE(linked.find("libssl"), std::string::npos) << linked;
    for (const char* library : {"libdcm", "libCGAL", "libOpenMesh", "libopenjp2", "libnifti"}) {
        EXPECT_EQ(linked.find(library), std::string::npos) << "haustra-server links " << library;
    }
}

// Sanitizers bring their own checks, and no stack protector.
TEST(IncludeRules, ProgramsAreHardened) {
    for (const char* program : {"haustra", "haustra-server", "haustra-client"}) {
        const std::string symbols = told("readelf --wide --dyn-syms", program);
        if (symbols.find("__asan_init") != std::string::npos ||
            symbols.find("__tsan_init") != std::string::npos)
            GTEST_SKIP() << "a sanitizer's build";
        const std::string file = told("readelf --wide --file-header --segments --dynamic", program);
        EXPECT_NE(file.find("DYN (Position-Independent Executable"), std::string::npos) << program;
        EXPECT_NE(file.find("GNU_RELRO"), std::string::npos) << program;
        EXPECT_NE(file.find("Flags: NOW"), std::string::npos) << program;
        EXPECT_NE(symbols.find("__stack_chk_fail"), std::string::npos) << program;
        EXPECT_NE(symbols.find("_chk@GLIBC"), std::string::npos) << program << ", _FORTIFY_SOURCE";
        EXPECT_NE(symbols.find("__glibcxx_assert_fail"), std::string::npos) << program;
    }
}

}  // namespace
