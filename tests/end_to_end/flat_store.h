// A store whose case "tube" has been flattened, and whose case "scan" has not.
#pragma once

#include "end_to_end/server_process.h"
#include "flat_tube.h"
#include "store/case_store.h"

#include <stdexcept>

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

}  // namespace haustra::tests
