// A store whose case "tube" has been flattened, and whose case "scan" has not; and a server of it.
#pragma once

#include "end_to_end/server_process.h"
#include "flat_tube.h"
#include "store/case_store.h"

#include <memory>
#include <stdexcept>

#include <gtest/gtest.h>

namespace haustra::tests {

inline void makeFlatStore(const std::filesystem::path& folder, const FlatTube& tube) {
    const auto orThrow = [](auto result) {
        if (!result) throw std::runtime_error(describe(result.error()));
        if constexpr (!std::is_void_v<typename decltype(result)::value_type>)
            return std::move(*result);
    };
    const auto store = orThrow(store::CaseStore::open(folder, true));
    const auto key = [](const char* stage) { return store::makeKey(stage, 1, "", {}); };
    auto flattened = orThrow(store.createCase(smallCaseName));
    orThrow(flattened.publishVolume("ct", key("ct"), tube.scan()));
    orThrow(flattened.publishCenterline("centerline", key("centerline"), tube.centerline()));
    orThrow(flattened.publishFlatMap("flatmap", key("flatmap"), tube.map()));
    auto bare = orThrow(store.createCase("scan"));
    orThrow(bare.publishVolume("ct", key("another scan"), makeSmallCase().ct));
}

/// One server of such a store for all tests of a suite; none may end it.
class FlatServer : public testing::Test {
protected:
    static void SetUpTestSuite() {
        folder_ = std::make_unique<TemporaryFolder>();
        makeFlatStore(folder_->path(), tube());
        server_ = std::make_unique<ServerProcess>(folder_->path());
    }
    static void TearDownTestSuite() {
        server_.reset();
        folder_.reset();
    }
    void TearDown() override { ASSERT_TRUE(server_->running()) << server_->log(); }

    static const FlatTube& tube() {
        static const FlatTube made;
        return made;
    }

    static inline std::unique_ptr<TemporaryFolder> folder_;
    static inline std::unique_ptr<ServerProcess> server_;
};

}  // namespace haustra::tests
