#include "reader/case_info.h"

#include <array>

namespace haustra::reader {
namespace {

constexpr std::array<const char*, viewCount> viewNames = {
    "endoscopic", "axial",          "coronal", "sagittal",
    "flattened",  "flattened-zoom", "oblique", "overview"};

}  // namespace

const char* toString(View view) {
    return viewNames[std::size_t(view)];
}

std::optional<View> viewFromString(const std::string& text) {
    for (const View view : allViews)
        if (text == toString(view)) return view;
    return std::nullopt;
}

}  // namespace haustra::reader
