// Work that clears up after itself when it is interrupted.
#pragma once

#include <signal.h>

namespace haustra::cli {

/// While it lives, SIGINT and SIGTERM are noted instead of ending the program, so that the work at
/// hand can end by itself and clear up; at its end they take their usual course. One at a time.
class Interruption {
public:
    Interruption();
    ~Interruption();
    Interruption(const Interruption&) = delete;
    Interruption& operator=(const Interruption&) = delete;

    bool came() const;  ///< any thread

private:
    struct sigaction before_[2];
};

}  // namespace haustra::cli
