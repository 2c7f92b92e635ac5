#include "core/result.h"

namespace haustra {

std::string describe(const Error& error) {
    return error.place.empty() ? error.message : error.place + ": " + error.message;
}

}  // namespace haustra
