#include "core/thread_pool.h"

#include "core/parallel.h"

#include <utility>

namespace haustra {

namespace {

std::uint64_t packed(std::uint32_t first, std::uint32_t end) {
    return std::uint64_t(first) << 32 | end;
}
std::uint32_t firstOf(std::uint64_t range) {
    return std::uint32_t(range >> 32);
}
std::uint32_t endOf(std::uint64_t range) {
    return std::uint32_t(range);
}

}  // namespace

ThreadPool::ThreadPool(int threads) : rests_(std::size_t(threadCount(threads))) {
    for (std::size_t self = 1; self < rests_.size(); ++self)
        threads_.emplace_back([this, self] { serve(self); });
}

ThreadPool::~ThreadPool() {
    {
        const std::lock_guard lock(mutex_);
        ending_ = true;
    }
    begin_.notify_all();
    for (std::thread& thread : threads_)
        thread.join();
}

void ThreadPool::run(int tasks, const std::function<void(int)>& body) {
    const std::uint64_t count = std::uint64_t(tasks), threads = rests_.size();
    for (std::size_t i = 0; i < threads; ++i)
        rests_[i].range =
            packed(std::uint32_t(count * i / threads), std::uint32_t(count * (i + 1) / threads));
    {
        const std::lock_guard lock(mutex_);
        body_ = &body;
        working_ = threads - 1;
        ++round_;
    }
    begin_.notify_all();
    work(0);
    std::unique_lock lock(mutex_);
    done_.wait(lock, [this] { return working_ == 0; });
    body_ = nullptr;
    if (const auto failure = std::exchange(failure_, nullptr)) std::rethrow_exception(failure);
}

void ThreadPool::serve(std::size_t self) {
    std::uint64_t served = 0;
    std::unique_lock lock(mutex_);
    while (true) {
        begin_.wait(lock, [&] { return ending_ || round_ != served; });
        if (ending_) return;
        served = round_;
        lock.unlock();
        work(self);
        lock.lock();
        if (--working_ == 0) done_.notify_one();
    }
}

void ThreadPool::work(std::size_t self) {
    std::atomic<std::uint64_t>& mine = rests_[self].range;
    do {
        std::uint64_t range = mine.load();
        while (firstOf(range) < endOf(range)) {
            // A thief may change the end meanwhile; then the exchange fails and tells the new one.
            if (!mine.compare_exchange_weak(range, packed(firstOf(range) + 1, endOf(range))))
                continue;
            try {
                (*body_)(int(firstOf(range)));
            } catch (...) {
                const std::lock_guard lock(mutex_);
                if (!failure_) failure_ = std::current_exception();
            }
            range = mine.load();
        }
    } while (steal(self));
}

bool ThreadPool::steal(std::size_t self) {
    for (std::size_t i = 1; i < rests_.size(); ++i) {
        std::atomic<std::uint64_t>& other = rests_[(self + i) % rests_.size()].range;
        std::uint64_t range = other.load();
        while (firstOf(range) < endOf(range)) {
            const std::uint32_t middle =
                firstOf(range) + (endOf(range) - firstOf(range)) / 2;  // all of a single task
            if (!other.compare_exchange_weak(range, packed(firstOf(range), middle))) continue;
            rests_[self].range = packed(middle, endOf(range));
            return true;
        }
    }
    return false;
}

}  // namespace haustra
