// The context and the owners of GL objects.
#include "gpu/context.h"

#include "gpu/buffer.h"
#include "gpu/program.h"
#include "gpu/texture.h"
#include "shaders/shader_source.h"

#include <thread>
#include <vector>

#include <gtest/gtest.h>

namespace haustra::gpu {
namespace {

TEST(Context, OpensWithoutADisplayAndSaysWhatItIs) {
    const auto context = Context::create();
    ASSERT_TRUE(context) << describe(context.error());
    EXPECT_FALSE((*context)->renderer().empty());
    EXPECT_FALSE((*context)->platform().empty());
    EXPECT_EQ((*context)->errorCount(), 0);
}

TEST(Context, OneOutlivesAnotherOnTheSameDisplay) {
    auto first = Context::create();
    ASSERT_TRUE(first);
    std::thread([] { ASSERT_TRUE(Context::create()); }).join();
    const auto texture = Texture::create(2, {8, 8, 1}, TexelFormat::rgba8, Filter::nearest, "test");
    EXPECT_TRUE(texture);
    EXPECT_EQ((*first)->errorCount(), 0);
}

TEST(Context, TexelsComeBackAsTheyWere) {
    const auto context = Context::create();
    ASSERT_TRUE(context);
    auto texture = Texture::create(3, {5, 3, 4}, TexelFormat::r16, Filter::linear, "test");
    ASSERT_TRUE(texture);
    std::vector<std::uint16_t> texels(5 * 3 * 4), back(texels.size());
    for (std::size_t i = 0; i < texels.size(); ++i)
        texels[i] = std::uint16_t(i * 997);
    texture->uploadSlices(0, 2, texels.data());
    texture->uploadSlices(2, 2, texels.data() + 5 * 3 * 2);
    texture->read(back.data(), texture->bytes());
    EXPECT_EQ(back, texels);
    EXPECT_EQ((*context)->errorCount(), 0);
}

TEST(Context, RefusalsAreResults) {
    const auto context = Context::create();
    ASSERT_TRUE(context);
    const auto tooLong = Texture::create(3, {maxTextureSide3d() + 1, 1, 1}, TexelFormat::r16,
                                         Filter::linear, "scan");
    ASSERT_FALSE(tooLong);
    EXPECT_EQ(tooLong.error().kind, ErrorKind::device);
    EXPECT_EQ(tooLong.error().place, "scan");
    const auto wrong = ComputeProgram::create(
        "wrong.comp", {"layout(local_size_x = 1) in;\n", "void main() { nothing(); }\n"});
    ASSERT_FALSE(wrong);
    EXPECT_NE(wrong.error().message.find("nothing"), std::string::npos) << wrong.error().message;
}

}  // namespace
}  // namespace haustra::gpu
