#include "core/colon_record.h"

namespace haustra {

const char* toString(ColonPart part) {
    static const char* const names[colonParts] = {
        "rectum",           "sigmoid",         "descending colon", "splenic flexure",
        "transverse colon", "hepatic flexure", "ascending colon",  "cecum"};
    return names[std::size_t(part)];
}

const char* toString(JunctionKind kind) {
    static const char* const names[] = {"open lumen", "air-fluid level", "thin wall", "collapse"};
    return names[std::size_t(kind)];
}

}  // namespace haustra
