#include "store/notes.h"

#include <sstream>

namespace haustra::store {

void setNotes(Attributes& attributes, const std::vector<std::string>& notes) {
    std::string text;
    for (const std::string& note : notes)
        text += text.empty() ? note : "\n" + note;
    if (!text.empty()) attributes["notes"] = text;
}

std::vector<std::string> notesOf(const Attributes& attributes) {
    std::vector<std::string> notes;
    if (const auto found = attributes.find("notes"); found != attributes.end()) {
        std::istringstream lines(found->second);
        for (std::string line; std::getline(lines, line);)
            notes.push_back(line);
    }
    return notes;
}

}  // namespace haustra::store
