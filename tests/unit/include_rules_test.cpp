// The dependency rules of the design, checked on every #include line of the tree, and on what the
// programs link.
#include <algorithm>
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
        {"processing/pictures", {}},
        {"processing/contouring", {}},
        {"processing/simplification", {}},
        {"processing/handles", {"mesh"}},
        {"processing/flatten", {"mesh"}},
        {"processing/flatten/tube", {"mesh", "flatten"}},
        {"processing/flatten/general", {"mesh", "flatten", "flatten/tube"}},
        {"processing/cad", {}},
        {"processing/coverage", {}},
        {"processing/organs", {}},
        {"processing/store", {}},
        {"processing/pipeline",
         {"dicom", "nifti", "cleansing", "segmentation", "topology", "centerline", "contouring",
          "simplification", "handles", "flatten/tube", "cad", "organs", "store"}},
        {"protocol", {}},
        {"shaders", {}},
        {"server/gpu", {}},
        {"server/render",
         {"gpu", "shaders", "render/flat", "render/gl", "render/hybrid", "render/native",
          "render/object_order", "render/optics", "render/overview", "render/polygon_assisted",
          "render/scene", "render/wall"}},
        {"server/render/optics", {"gpu", "shaders"}},
        {"server/render/scene", {"render/optics", "shaders"}},
        {"server/render/flat", {"render/optics", "render/scene", "shaders"}},
        {"server/render/gl", {"gpu", "render/flat", "render/optics", "render/scene", "shaders"}},
        {"server/render/native", {"render/flat", "render/optics", "render/scene", "shaders"}},
        {"server/render/overview", {"gpu", "render/optics", "render/scene", "shaders"}},
        {"server/render/wall",
         {"gpu", "render/flat", "render/gl", "render/optics", "render/scene", "shaders"}},
        {"server/render/polygon_assisted",
         {"gpu", "render/gl", "render/optics", "render/scene", "render/wall", "shaders"}},
        {"server/render/object_order",
         {"gpu", "render/gl", "render/optics", "render/scene", "shaders"}},
        {"server/render/hybrid",
         {"gpu", "render/gl", "render/native", "render/optics", "render/scene", "shaders"}},
        {"server/encode", {"render/scene", "protocol"}},
        {"server/records", {"protocol"}},
        {"server/session",
         {"gpu", "render", "render/optics", "render/scene", "render/wall", "encode", "records",
          "store", "protocol"}},
        {"server/net",
         {"gpu", "render", "render/optics", "encode", "records", "session", "store", "protocol"}},
        {"server/cli",
         {"dicom",
          "nifti",
          "pictures",
          "phantom",
          "mesh",
          "simplification",
          "handles",
          "flatten",
          "cad",
          "coverage",
          "flatten/tube",
          "flatten/general",
          "store",
          "pipeline",
          "gpu",
          "render",
          "render/object_order",
          "render/optics",
          "render/scene",
          "render/wall"}},
        {"client", {"protocol", "link", "tiles", "reader", "script", "window"}},
        {"client/link", {"protocol", "tiles"}},
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
                "processing/cleansing", "processing/handles", "processing/coverage",
                "processing/cad"}),
            of("^(ceres|glog)/.*", {"processing/coverage"}),
            of("^CGAL/.*", {"processing/handles"}),
            of("^OpenMesh/.*", {"processing/handles", "processing/flatten/tube"}),
            of("^OpenImageIO/.*", {"processing/pictures"}),
            of("^opencv2/.*", {"processing/pictures", "processing/cad", "processing/coverage"}),
            of("^png.h$", {}),
            of("^stb/.*", {"client/tiles"}),
            of("^sqlite3.h$", {"server/records"}),
            of("^turbojpeg.h$", {"server/encode", "client/tiles"}),
            of("^(EGL|GL|GLES.?|epoxy)/.*", {"server/gpu", "server/render"}),
            of("^embree3/.*", {"server/render/wall", "processing/coverage"}),
            of("^Q[A-Z].*", {"client/window"}),
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

// The folder of a header that an #include line names from one of the roots; empty where there is no
// such file.
std::string folderOf(const std::string& header) {
    for (const char* root : {"", "processing", "server", "client"})
        if (fs::exists(source() / root / header))
            return (root / fs::path(header)).parent_path().generic_string();
    return {};
}

// Folder -> the folders that it includes, with one #include line of each.
using FolderGraph = std::map<std::string, std::map<std::string, std::string>>;

// The strongly connected components of more than one folder [Tarjan 1972].
class Cycles {
public:
    explicit Cycles(const FolderGraph& graph) : graph_(graph) {
        for (const auto& [folder, targets] : graph)
            if (!visits_.count(folder)) visit(folder);
    }
    const std::vector<Names>& found() const { return found_; }

private:
    struct Visit {
        int number;
        bool open;
    };
    int visit(const std::string& folder) {
        const int number = int(visits_.size());
        visits_[folder] = {number, true};
        open_.push_back(folder);
        int lowest = number;
        if (const auto targets = graph_.find(folder); targets != graph_.end()) {
            for (const auto& [target, line] : targets->second) {
                const auto known = visits_.find(target);
                if (known == visits_.end())
                    lowest = std::min(lowest, visit(target));
                else if (known->second.open)
                    lowest = std::min(lowest, known->second.number);
            }
        }
        if (lowest == number) close(folder);
        return lowest;
    }
    void close(const std::string& root) {
        Names component;
        while (!component.count(root)) {
            component.insert(open_.back());
            visits_[open_.back()].open = false;
            open_.pop_back();
        }
        if (component.size() > 1) found_.push_back(component);
    }

    const FolderGraph& graph_;
    std::map<std::string, Visit> visits_;
    std::vector<std::string> open_;
    std::vector<Names> found_;
};

TEST(IncludeRules, NoFolderIsInACycle) {
    FolderGraph graph;
    for (const Include& include : includesOfTheTree()) {
        if (!include.quoted || include.header.ends_with(".pb.h")) continue;  // made by the build
        const std::string target = folderOf(include.header);
        ASSERT_FALSE(target.empty()) << include.file << " includes \"" << include.header << "\"";
        if (target != include.folder)
            graph[include.folder][target] = include.file.string() + " includes " + include.header;
    }
    EXPECT_GT(graph.size(), 30u);
    const Cycles cycles(graph);
    for (const Names& cycle : cycles.found()) {
        std::string includes;
        for (const std::string& folder : cycle)
            for (const auto& [target, line] : graph[folder])
                if (cycle.count(target)) includes += "\n  " + line;
        ADD_FAILURE() << "folders that include each other:" << includes;
    }
}

// The test above sees a cycle where there is one.
TEST(IncludeRules, CyclesAreFound) {
    const FolderGraph graph = {
        {"a", {{"b", ""}}}, {"b", {{"c", ""}, {"d", ""}}}, {"c", {{"b", ""}}},
        {"d", {{"e", ""}}}, {"f", {{"a", ""}, {"g", ""}}}, {"g", {{"f", ""}}}};
    EXPECT_EQ(Cycles(graph).found(), (std::vector<Names>{{"b", "c"}, {"f", "g"}}));
}

TEST(IncludeRules, ForeignLibrariesStayInTheirFolders) {
    for (const Include& include : includesOfTheTree()) {
        if (include.quoted) continue;
        for (const Foreign& foreign : foreignHeaders()) {
            if (!std::regex_match(include.header, foreign.header)) continue;
            EXPECT_TRUE(foreign.folders.count(include.folder))
                << include.file << " must not include <" << include.header << ">";
            const bool looseInHeaders = include.header.rfind("asio", 0) == 0 ||
                                        include.header.rfind("epoxy", 0) == 0 ||
                                        include.folder == "client/window";  // its parts are widgets
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
TEST(IncludeRules, TheServerAndTheClientLinkNoImageOrMeshLibrary) {
    for (const char* program : {"haustra-server", "haustra-client"}) {
        const std::string linked = told("ldd", program);
        EXPECT_NE(linked.find("libssl"), std::string::npos) << linked;
        for (const char* library : {"libdcm", "libCGAL", "libOpenMesh", "libopenjp2", "libnifti",
                                    "libOpenImageIO", "libopencv", "libglog"}) {
            EXPECT_EQ(linked.find(library), std::string::npos) << program << " links " << library;
        }
    }
    EXPECT_EQ(told("ldd", "haustra-server").find("libpng"), std::string::npos);
}

// They cost every start a quarter of a second: haustra loads them with its first picture, or board.
TEST(IncludeRules, OnlyTheModulesLinkTheImageLibrariesAndTheSolver) {
    const std::string program = told("ldd", "haustra");
    for (const auto& [module, libraries] :
         {std::pair<const char*, Names>{"haustra-pictures",
                                        {"libOpenImageIO", "libopencv_imgproc"}},
          {"haustra-calibration", {"libglog", "libopencv_imgproc"}}}) {
        const std::string linked =
            told("ldd", (std::string("../lib/haustra/") + module + ".so").c_str());
        for (const std::string& library : libraries) {
            EXPECT_NE(linked.find(library), std::string::npos) << module << " " << library;
            EXPECT_EQ(program.find(library), std::string::npos) << library;
        }
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
