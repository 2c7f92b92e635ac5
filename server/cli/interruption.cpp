#include "cli/interruption.h"

namespace haustra::cli {
namespace {

constexpr int signals[] = {SIGINT, SIGTERM};

// What a signal's handler may write to is a variable of the whole program.
volatile sig_atomic_t noted = 0;

void note(int signal) {
    noted = signal;
}

}  // namespace

Interruption::Interruption() {
    noted = 0;
    struct sigaction noting {};
    noting.sa_handler = note;
    noting.sa_flags = SA_RESTART;
    for (int n = 0; n < 2; ++n) {
        sigaction(signals[n], nullptr, &before_[n]);
        // Who ignores a signal, as behind nohup, goes on doing so.
        if (before_[n].sa_handler != SIG_IGN) sigaction(signals[n], &noting, nullptr);
    }
}

Interruption::~Interruption() {
    for (int n = 0; n < 2; ++n)
        sigaction(signals[n], &before_[n], nullptr);
    if (came()) raise(noted);
}

bool Interruption::came() const {
    return noted != 0;
}

}  // namespace haustra::cli
