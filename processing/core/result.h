// Expected failures as values: Result<T> is T or an Error that says what is wrong and where.
#pragma once

#include <string>
#include <tl/expected.hpp>

namespace haustra {

enum class ErrorKind {
    badInput,     ///< a file, message or argument is not what it must be
    notFound,     ///< a named file, case or product does not exist
    unsupported,  ///< well formed, but of a kind that Haustra does not read
    io,           ///< the operating system refused to read, write or publish
    device,       ///< EGL, OpenGL or the network failed
    noResult,     ///< the input is sound, but holds nothing to find (no colon, no air …)
};

/// One failure. `message` is one clear sentence for a person; `place` is the file, field or
/// stage it speaks of (may be empty). Neither ever holds a patient's name or ID.
struct Error {
    ErrorKind kind = ErrorKind::badInput;
    std::string message;
    std::string place;
};

template <class T>
using Result = tl::expected<T, Error>;

/// `return fail(ErrorKind::io, "cannot write", path)` from any function returning Result<T>.
inline tl::unexpected<Error> fail(ErrorKind kind, std::string message, std::string place = {}) {
    return tl::make_unexpected(Error{kind, std::move(message), std::move(place)});
}

/// "place: message", or the message alone where there is no place.
std::string describe(const Error& error);

}  // namespace haustra
