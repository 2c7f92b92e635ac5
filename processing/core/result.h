// Expected failures as values: Result<T> is T or an Error that says what is wrong and where.
#pragma once

#include <string>
#include <utility>

#include <tl/expected.hpp>

namespace haustra {

enum class ErrorKind {
    badInput,     ///< a file, message or argument is not what it must be
    notFound,     ///< a named file, case or product does not exist
    unsupported,  ///< well formed, but of a kind that Haustra does not read
    io,           ///< the operating system refused to read, write or publish
    device,       ///< EGL, OpenGL or the network failed
    wrongState,   ///< sound, but not now: what it speaks of is not open, or already there
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

namespace detail {
template <class T>
T valueOf(Result<T>&& result) {
    return *std::move(result);
}
inline void valueOf(Result<void>&&) {}
inline void valueOf(const Result<void>&) {}
}  // namespace detail

/// The value of a Result; where it has none, the function is left with its error:
///     const Volume<float> hu = TRY(readVolume(file));
/// Of a Result<void> a statement: TRY(writeIndex(folder)). A variable is given up:
/// TRY(std::move(x)). For functions and lambdas that return a Result of whatever type; not for
/// coroutines.
#define TRY(...) HAUSTRA_TRY_AS(__COUNTER__, __VA_ARGS__)
#define HAUSTRA_TRY_AS(number, ...) HAUSTRA_TRY_IN(number, __VA_ARGS__)
#define HAUSTRA_TRY_IN(number, ...)                                                       \
    __extension__({                                                                       \
        auto&& tried##number = (__VA_ARGS__);                                             \
        if (!tried##number)                                                               \
            return tl::make_unexpected(                                                   \
                std::forward<decltype(tried##number)>(tried##number).error());            \
        ::haustra::detail::valueOf(std::forward<decltype(tried##number)>(tried##number)); \
    })

/// "place: message", or the message alone where there is no place.
std::string describe(const Error& error);

}  // namespace haustra
