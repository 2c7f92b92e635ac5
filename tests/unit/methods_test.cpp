// processing/METHODS.md is numbered, names files that are there, and is cited truly.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace {

namespace fs = std::filesystem;

fs::path source() {
    const char* set = std::getenv("HAUSTRA_SOURCE");
    return set ? set : ".";
}

std::string textOf(const fs::path& file) {
    std::ifstream in(file);
    EXPECT_TRUE(in) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

struct Section {
    std::string number, title, rest;  // rest: the files it is about
};

std::vector<Section> sections() {
    std::vector<Section> found;
    std::ifstream in(source() / "processing/METHODS.md");
    const std::regex heading("##+ ([0-9.]*[0-9])\\.? ([^(]*[^( ])( \\((.*)\\))?");
    for (std::string line; std::getline(in, line);) {
        if (!line.starts_with("##")) continue;
        std::smatch parts;
        if (std::regex_match(line, parts, heading))
            found.push_back({parts[1], parts[2], parts[4]});
        else
            ADD_FAILURE() << "a heading without a number: " << line;
    }
    return found;
}

// The text of a file in one line: a citation may go on in the comment's next line.
std::string inOneLine(const std::string& text) {
    return std::regex_replace(text, std::regex("\\s*\n\\s*(///?|#|\\*)?\\s*"), " ");
}

std::vector<fs::path> sourceFiles() {
    std::vector<fs::path> files{source() / "README.md", source() / "CMakeLists.txt"};
    for (const char* folder :
         {"server", "client", "protocol", "shaders", "processing", "tests", "deploy"})
        for (const auto& entry : fs::recursive_directory_iterator(source() / folder))
            if (entry.is_regular_file()) files.push_back(entry.path());
    return files;
}

TEST(Methods, SectionsAreNumberedInOrder) {
    int section = 0, part = 0;
    for (const Section& each : sections()) {
        if (each.number.find('.') == std::string::npos) {
            EXPECT_EQ(each.number, std::to_string(++section)) << each.title;
            part = 0;
        } else {
            EXPECT_EQ(each.number, std::to_string(section) + "." + std::to_string(++part))
                << each.title;
        }
    }
    EXPECT_GT(section, 0);
}

TEST(Methods, FilesThatItNamesAreThere) {
    std::set<std::string> names;
    for (const fs::path& file : sourceFiles())
        names.insert(file.filename());
    const std::string text = textOf(source() / "processing/METHODS.md");
    const std::regex path("`((server|client|protocol|shaders|processing|tests|deploy)/[^` ]+)`");
    const std::regex name("`([a-z0-9_-]+\\.(h|cpp|glsl|comp|vert|frag))`");
    for (std::sregex_iterator at(text.begin(), text.end(), path), end; at != end; ++at) {
        const fs::path named = source() / (*at)[1].str();
        EXPECT_TRUE(fs::exists(named) || fs::exists(named.string() + ".cpp")) << at->str();
    }
    for (std::sregex_iterator at(text.begin(), text.end(), name), end; at != end; ++at)
        EXPECT_TRUE(names.contains((*at)[1])) << at->str();
    const std::regex paths("(`[^` ]+`)(, `[^` ]+`)*");
    for (const Section& each : sections())
        EXPECT_TRUE(each.rest.empty() || std::regex_match(each.rest, paths)) << each.title;
}

// A number alone would go on naming a section when its subject has moved: the title goes with it.
TEST(Methods, CitationsNameASectionByNumberAndTitle) {
    std::map<std::string, std::string> titles;
    for (const Section& each : sections())
        titles[each.number] = each.title;
    const std::regex mention("METHODS(\\.md\\)?)?( §([0-9.]*[0-9]) \"([^\"]*)\")?");
    int citations = 0;
    for (const fs::path& file : sourceFiles()) {
        if (file.filename() == "methods_test.cpp") continue;
        std::string text = textOf(file);
        if (text.find("METHODS") == std::string::npos) continue;
        text = inOneLine(text);
        for (std::sregex_iterator at(text.begin(), text.end(), mention), end; at != end; ++at) {
            const std::smatch& cited = *at;
            const std::string around = text.substr(std::size_t(cited.position()), 60);
            if (!cited[2].matched) {
                // A page, or a list of files, may name the whole file.
                EXPECT_TRUE(file.extension() == ".md" || file.extension() == ".cmake")
                    << file << " cites no section, as in METHODS §1 \"Import\": " << around;
                EXPECT_FALSE(around.starts_with("METHODS §")) << file << ": " << around;
                continue;
            }
            ++citations;
            const auto section = titles.find(cited[3]);
            if (section == titles.end())
                ADD_FAILURE() << file << ": there is no section " << cited[3];
            else
                EXPECT_EQ(section->second, cited[4]) << file << " cites section " << cited[3];
        }
    }
    EXPECT_GT(citations, 0);
}

}  // namespace
