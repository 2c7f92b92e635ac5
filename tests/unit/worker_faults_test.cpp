// One fault costs one piece of work, never a thread.
#include "core/thread_pool.h"
#include "protocol/view_message.h"
#include "session/picture_stream.h"
#include "session/worker.h"

#include <atomic>
#include <sstream>
#include <stdexcept>

#include <asio/io_context.hpp>
#include <gtest/gtest.h>
#include <spdlog/sinks/ostream_sink.h>
#include <spdlog/spdlog.h>

namespace haustra::session {
namespace {

TEST(WorkerFaults, AQueueGoesOn) {
    WorkQueue<int> queue;
    for (int n = 0; n < 5; ++n)
        queue.push(n);
    queue.close();
    std::vector<int> served;
    serveQueue(queue, 1, "test", [&](auto& taken) {
        if (taken.front() % 2 == 1) throw std::runtime_error("odd");
        served.push_back(taken.front());
    });
    EXPECT_EQ(served, (std::vector<int>{0, 2, 4}));
}

TEST(Worker, ServesAllThatWaitsBeforeItEnds) {
    std::atomic<int> sum = 0;
    {
        Worker<int> worker;
        for (int n = 1; n <= 1000; ++n)
            worker.push(n);
        for (int thread = 0; thread < 3; ++thread)
            worker.start("test", 7, [&](auto& taken) {
                for (const int n : taken)
                    sum += n;
            });
        worker.push(1001);
    }
    EXPECT_EQ(sum, 1001 * 1002 / 2);
}

TEST(WorkerFaults, GuardedWorkFailsWithWhatWasThrown) {
    const auto thrown = guarded([]() -> Result<int> { throw std::runtime_error("it broke"); });
    ASSERT_FALSE(thrown);
    EXPECT_EQ(thrown.error().kind, ErrorKind::device);
    EXPECT_EQ(thrown.error().message, "it broke");
    EXPECT_EQ(guarded([]() -> Result<int> { return 3; }), 3);
    EXPECT_FALSE(guarded([]() -> Result<int> { throw std::bad_alloc(); }));
}

TEST(WorkerFaults, ATileThatThrowsFailsThePictureAndTheNextIsDrawn) {
    for (const int threads : {1, 3}) {
        ThreadPool pool(threads);
        for (int round = 0; round < 50; ++round) {
            std::atomic<int> drawn{0};
            EXPECT_THROW(pool.run(100,
                                  [&](int tile) {
                                      ++drawn;
                                      if (tile % 10 == 3) throw std::runtime_error("a tile");
                                  }),
                         std::runtime_error);
            EXPECT_EQ(drawn, 100);
            drawn = 0;
            EXPECT_NO_THROW(pool.run(100, [&](int) { ++drawn; }));
            EXPECT_EQ(drawn, 100);
        }
    }
}

struct Owner {
    std::string told;
    void broken(const std::string& what) { told = what; }
};

TEST(WorkerFaults, WhatIsPostedBreaksItsOwnerAlone) {
    asio::io_context io;
    const auto owner = std::make_shared<Owner>();
    std::weak_ptr<Owner> gone = std::make_shared<Owner>();
    int ran = 0;
    postTo(io.get_executor(), std::weak_ptr<Owner>(owner),
           [](Owner&) { throw std::runtime_error("a fault"); });
    postTo(io.get_executor(), gone, [&](Owner&) { ++ran; });
    postTo(io.get_executor(), std::weak_ptr<Owner>(owner), [&](Owner&) { ++ran; });
    io.run();
    EXPECT_EQ(owner->told, "a fault");
    EXPECT_EQ(ran, 1);
}

// A case that is not on the GPU cannot be drawn, which is a fault of the device.
TEST(WorkerFaults, APictureThatFailedIsDrawnOnceMoreAndThenReported) {
    std::ostringstream log;
    spdlog::set_default_logger(std::make_shared<spdlog::logger>(
        "test", std::make_shared<spdlog::sinks::ostream_sink_mt>(log)));
    const auto again = [&] {
        int count = 0;
        const std::string text = log.str(), line = "drawn once more";
        for (auto at = text.find(line); at != std::string::npos; at = text.find(line, at + 1))
            ++count;
        return count;
    };
    asio::io_context io;
    auto renderer = RenderThread::start({}, [](auto) {});
    ASSERT_TRUE(renderer) << renderer.error().message;
    auto encoders = EncoderThreads::start(1);
    ASSERT_TRUE(encoders);
    render::PresetLibrary presets;
    presets.presets = render::builtInPresets();
    int reported = 0;
    PictureStream::Outlet outlet;
    outlet.send = [](auto) { FAIL() << "nothing can be drawn"; };
    outlet.failed = [&](const Error&) { ++reported; };
    outlet.broken = [](const std::string& what) { FAIL() << what; };
    const auto stream = std::make_shared<PictureStream>(1, io.get_executor(), **renderer,
                                                        **encoders, presets, outlet);
    auto facts = std::make_shared<OpenCase>();
    facts->grid = axisAlignedGrid({32, 32, 32}, {1.0, 1.0, 1.0});
    stream->setCase(facts);
    for (int n = 1; n <= 3; ++n) {
        const auto before = std::uint64_t(2 * n - 1);
        ASSERT_TRUE(stream->input(protocol::viewportMessage({before, 0}, View::axial, 64, 64)));
        ASSERT_TRUE(stream->input(
            protocol::stateMessage({before + 1, 0}, SliceView{View::axial, {16.0, 0.0, 0.0}})));
        const auto until = std::chrono::steady_clock::now() + std::chrono::seconds(60);
        while (reported < n && std::chrono::steady_clock::now() < until) {
            io.restart();
            io.run_for(std::chrono::milliseconds(5));
        }
        EXPECT_EQ(reported, n);
        EXPECT_EQ(again(), n);
    }
    stream->stop();
}

}  // namespace
}  // namespace haustra::session
