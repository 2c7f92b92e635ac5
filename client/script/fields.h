// One line of a script: its keys, checked.
#pragma once

#include "core/optics.h"
#include "reader/case_info.h"

#include <set>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace haustra::reader {

/// Thrown by Fields, and caught by parseScript: what is wrong with a line, in a sentence.
struct ScriptRefusal {
    std::string message;
};

/// One line's object, which must outlive it. Remembers which keys were asked for, so that a
/// misspelt one is not passed over. All fail by ScriptRefusal, naming the key.
class Fields {
public:
    explicit Fields(const nlohmann::json& object) : object_(object) { asked_.insert("do"); }

    bool has(const char* key);
    double number(const char* key, double low, double high);
    int integer(const char* key, int low, int high);
    std::string text(const char* key, std::size_t maxBytes = 1000);
    bool flag(const char* key);
    /// A plain name with this extension: a script writes only into its output folder.
    std::string fileName(const char* key, const char* extension);
    std::vector<double> numbers(const char* key, std::size_t count, double low, double high);
    glm::dvec2 flat(const char* key);
    std::vector<glm::dvec2> flats(const char* key, std::size_t least, std::size_t most);
    glm::dvec3 position(const char* key);
    /// A list of [hu, red, green, blue, opacity], all else being the usual; an object as in a
    /// preset's file, which may lack the name; or the name of such a file.
    Optics opticsOfPoints(const char* key);
    Optics opticsOfObject(const char* key);
    Optics opticsOfFile(const char* key);
    glm::ivec2 size(const char* key);
    View view(const char* key);
    int viewport();

    [[noreturn]] static void refuse(const std::string& key, const std::string& what);
    void allMustBeKnown() const;

private:
    const nlohmann::json& at(const char* key) const;
    template <class T>
    T get(const char* key, bool (nlohmann::json::*is)() const noexcept, const char* what);
    std::vector<double> numbersOf(const char* key, const nlohmann::json& list, std::size_t count,
                                  double low, double high) const;

    const nlohmann::json& object_;
    std::set<std::string> asked_;
};

}  // namespace haustra::reader
