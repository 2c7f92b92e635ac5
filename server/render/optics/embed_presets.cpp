// embed_presets OUT.cpp PRESET.json…: writes builtInPresetTexts() of optics_presets.cpp. Run while
// building, so that a preset that is not sound never gets into a program.
#include "core/optics_preset.h"
#include "core/text_file.h"

#include <cstdio>
#include <filesystem>
#include <fstream>

namespace {

namespace fs = std::filesystem;

int fail(const std::string& what) {
    std::fprintf(stderr, "embed_presets: %s\n", what.c_str());
    return 1;
}

}  // namespace

int main(int count, char** arguments) {
    if (count < 3) return fail("OUT.cpp and presets are needed");
    std::string rows;
    for (int n = 2; n < count; ++n) {
        const fs::path path = arguments[n];
        const auto text = haustra::readTextFile(path);
        if (!text) return fail(describe(text.error()));
        const auto preset = haustra::parsePreset(*text, path.filename().string());
        if (!preset) return fail(describe(preset.error()));
        if (preset->name != path.stem())
            return fail(path.filename().string() + " has another name");
        if (preset->description.empty()) return fail(preset->name + " has no description");
        rows +=
            "        {\"" + path.filename().string() + "\", R\"preset(" + *text + ")preset\"},\n";
    }
    std::ofstream out(arguments[1], std::ios::binary);
    out << "// Made by embed_presets.\n#include <utility>\n#include <vector>\n\n"
           "namespace haustra::render {\n\n"
           "using PresetTexts = std::vector<std::pair<const char*, const char*>>;\n"
           "const PresetTexts& builtInPresetTexts();\n"
           "const PresetTexts& builtInPresetTexts() {\n"
           "    static const PresetTexts texts = {\n"
        << rows << "    };\n    return texts;\n}\n\n}  // namespace haustra::render\n";
    return out.flush() ? 0 : fail(std::string("cannot write ") + arguments[1]);
}
