// What does not fit in one message is told as an error of the request that it would have answered.
#include "protocol/framing.h"
#include "session/messages.h"

#include <gtest/gtest.h>

namespace haustra::session {
namespace {

protocol::ServerMessage parsed(const std::vector<std::uint8_t>& frame) {
    protocol::ServerMessage message;
    EXPECT_TRUE(message.ParseFromArray(frame.data() + protocol::frameHeaderBytes,
                                       int(frame.size() - protocol::frameHeaderBytes)));
    return message;
}

TEST(AnswerFrame, OneThatIsTooLongIsAnErrorOfItsRequest) {
    protocol::ServerMessage bookmarks, cases;
    bookmarks.mutable_bookmark_list()->set_request(7);
    bookmarks.mutable_bookmark_list()->add_bookmarks()->set_note("polyp?");
    EXPECT_TRUE(parsed(frameOf(bookmarks)).has_bookmark_list());
    bookmarks.mutable_bookmark_list()->add_bookmarks()->set_note(
        std::string(protocol::maxServerControlBytes, 'x'));
    cases.mutable_case_list()->set_request(8);
    cases.mutable_case_list()->add_names(std::string(protocol::maxServerControlBytes, 'x'));
    for (const auto& [message, request] : {std::pair{bookmarks, 7u}, {cases, 8u}}) {
        const auto told = parsed(frameOf(message));
        ASSERT_TRUE(told.has_error());
        EXPECT_EQ(told.error().code(), protocol::ErrorReport::INTERNAL);
        EXPECT_EQ(told.error().request(), request);
        EXPECT_FALSE(told.error().fatal());
    }
}

}  // namespace
}  // namespace haustra::session
