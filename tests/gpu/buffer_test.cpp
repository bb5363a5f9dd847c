#include "framework/gpu/buffer.h"

#include <type_traits>

#include "framework/base/error.h"
#include "tests/gpu/gpu_test.h"

namespace aftershade::gpu {
namespace {

static_assert(std::is_nothrow_move_constructible_v<Buffer> && std::is_nothrow_move_assignable_v<Buffer>);
static_assert(!std::is_copy_constructible_v<Buffer> && !std::is_copy_assignable_v<Buffer>);

class BufferOn : public SoftwareTest {};
ON_EACH_BACKEND(BufferOn);

TEST_P(BufferOn, StartsZeroFilled) {
    const Buffer buffer(context(), 7, "odd size");
    EXPECT_EQ(buffer.size(), 7U);
    EXPECT_EQ(buffer.read(), std::vector<std::byte>(7));
}

TEST_P(BufferOn, ReadsWhatWasWrittenAtAnOffset) {
    Buffer buffer(context(), 4, "bytes");
    const std::byte two[] = {std::byte{7}, std::byte{9}};
    buffer.write(two, 1);
    EXPECT_EQ(buffer.read(),
              (std::vector<std::byte>{std::byte{0}, std::byte{7}, std::byte{9}, std::byte{0}}));
}

TEST_P(BufferOn, ClearsToAWord) {
    Buffer buffer(context(), 12, "words");
    buffer.clear(0x01010101U);
    EXPECT_EQ(buffer.read(), std::vector<std::byte>(12, std::byte{1}));
}

TEST_P(BufferOn, RefusesToHoldNothing) {
    const std::string message = error_of([&] { Buffer(context(), 0, "tiles"); });
    EXPECT_NE(message.find("buffer 'tiles'"), std::string::npos) << message;
}

}  // namespace
}  // namespace aftershade::gpu
