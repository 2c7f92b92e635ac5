#include "store/lost_pages.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstdint>
#include <cstring>
#include <mutex>

#include <fcntl.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace haustra::store {
namespace {

// What the signal handler reads: [begin, end) of a mapping, 0 where the slot is free.
struct Slot {
    std::atomic<std::uintptr_t> begin{0}, end{0};
    std::atomic<bool> lost{false};
};
static_assert(std::atomic<std::uintptr_t>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free);

std::array<Slot, 4096> slots;
std::atomic<std::size_t> slotsUsed{0};  // from the first on; never falls
std::uintptr_t pageBytes = 4096;

std::mutex mutex;  // who takes and frees slots, and the paths
std::array<const std::filesystem::path*, slots.size()> paths{};
std::optional<std::filesystem::path> lostFile;

Slot* slotOf(std::uintptr_t address) {
    const std::size_t used = slotsUsed.load(std::memory_order_acquire);
    for (std::size_t n = 0; n < used; ++n) {
        const std::uintptr_t begin = slots[n].begin.load(std::memory_order_acquire);
        if (begin != 0 && begin <= address && address < slots[n].end.load()) return &slots[n];
    }
    return nullptr;
}

// Calls what a signal handler may: mmap is a plain system call on Linux.
void onBusError(int, siginfo_t* info, void*) {
    const int error = errno;
    const auto address = reinterpret_cast<std::uintptr_t>(info->si_addr);
    Slot* const slot = slotOf(address);
    void* const page = reinterpret_cast<void*>(address / pageBytes * pageBytes);
    if (!slot || ::mmap(page, pageBytes, PROT_READ, MAP_PRIVATE | MAP_ANONYMOUS | MAP_FIXED, -1,
                        0) == MAP_FAILED) {
        ::signal(SIGBUS, SIG_DFL);
        ::raise(SIGBUS);  // ends the program when this returns
        return;
    }
    slot->lost = true;
    errno = error;
}

std::optional<std::size_t> takeSlot(const std::byte* address, std::size_t bytes,
                                    const std::filesystem::path& file) {
    const std::lock_guard lock(mutex);
    const auto free = std::find_if(slots.begin(), slots.end(),
                                   [](const Slot& slot) { return slot.begin.load() == 0; });
    if (free == slots.end()) return std::nullopt;
    const auto n = std::size_t(free - slots.begin());
    const auto begin = reinterpret_cast<std::uintptr_t>(address);
    paths[n] = &file;
    free->lost = false;
    free->end = begin + bytes;
    free->begin.store(begin, std::memory_order_release);
    slotsUsed = std::max(slotsUsed.load(), n + 1);
    return n;
}

void freeSlot(std::size_t n) {
    const std::lock_guard lock(mutex);
    if (slots[n].lost && !lostFile) lostFile = *paths[n];
    slots[n].begin = 0;
    paths[n] = nullptr;
}

}  // namespace

void surviveLostPages() {
    pageBytes = std::uintptr_t(::sysconf(_SC_PAGESIZE));
    struct sigaction action {};
    action.sa_sigaction = onBusError;
    action.sa_flags = SA_SIGINFO;
    ::sigemptyset(&action.sa_mask);
    ::sigaction(SIGBUS, &action, nullptr);
}

Result<std::shared_ptr<const MappedFile>> MappedFile::open(const std::filesystem::path& file,
                                                           std::size_t leastBytes) {
    const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0) {
        const ErrorKind kind = errno == ENOENT ? ErrorKind::notFound : ErrorKind::io;
        return fail(kind, std::string("cannot open: ") + std::strerror(errno), file.string());
    }
    struct stat status {};
    if (::fstat(descriptor, &status) != 0 || std::size_t(status.st_size) < leastBytes) {
        ::close(descriptor);
        return fail(ErrorKind::badInput, "the product is damaged: it is shorter than a header",
                    file.string());
    }
    const auto size = std::size_t(status.st_size);
    void* const address = ::mmap(nullptr, size, PROT_READ, MAP_SHARED, descriptor, 0);
    const int error = errno;
    ::close(descriptor);
    if (address == MAP_FAILED)
        return fail(ErrorKind::io, std::string("cannot map: ") + std::strerror(error),
                    file.string());
    std::shared_ptr<MappedFile> mapped(new MappedFile);
    mapped->address_ = static_cast<const std::byte*>(address);
    mapped->size_ = size;
    mapped->file_ = file;
    const auto slot = takeSlot(mapped->address_, size, mapped->file_);
    if (!slot) {
        ::munmap(address, size);
        mapped->address_ = nullptr;
        return fail(ErrorKind::io, "too many files are mapped", file.string());
    }
    mapped->slot_ = *slot;
    return mapped;
}

MappedFile::~MappedFile() {
    if (!address_) return;
    freeSlot(slot_);
    ::munmap(const_cast<std::byte*>(address_), size_);
}

bool isWhole(const void* address) {
    const Slot* const slot = slotOf(reinterpret_cast<std::uintptr_t>(address));
    return !slot || !slot->lost;
}

std::optional<std::filesystem::path> firstLostFile() {
    const std::lock_guard lock(mutex);
    for (std::size_t n = 0; n < slotsUsed && !lostFile; ++n)
        if (slots[n].begin != 0 && slots[n].lost) lostFile = *paths[n];
    return lostFile;
}

}  // namespace haustra::store
