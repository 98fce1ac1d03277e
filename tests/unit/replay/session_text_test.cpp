#include "gravure/replay/session_text.hpp"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

namespace gravure::replay {
namespace {

/// The example of docs/formats/session.md.
std::string documented() {
  std::ifstream page(GRAVURE_SESSION_DOC);
  const std::string text{std::istreambuf_iterator<char>(page), std::istreambuf_iterator<char>()};
  const std::string begin = "```text\n";
  const std::size_t at = text.find(begin) + begin.size();
  return text.substr(at, text.find("```", at) - at);
}

std::string text_of(const Session& session) {
  std::string text = head_text(session.identity);
  for (const Exchange& exchange : session.exchanges) {
    text += exchange_text(exchange);
  }
  return text;
}

TEST(SessionText, TheDocumentedExampleIsReadAndWrittenAgain) {
  const auto session = parse_session(documented(), "page");
  ASSERT_TRUE(session) << session.error().message;
  EXPECT_EQ(session.value().identity.serial, "A-17");
  ASSERT_EQ(session.value().exchanges.size(), 7U);
  EXPECT_EQ(session.value().exchanges[1].value, 4321U);
  EXPECT_EQ(session.value().exchanges[6].error->message, "reading register 0xff: the board refused (stalled)");
  EXPECT_EQ(session.value().exchanges[6].line, 13);
  EXPECT_EQ(text_of(session.value()), documented());
}

TEST(SessionText, AnythingThatABoardSaysSurvives) {
  Session session;
  session.identity.serial = "back\\slash \x01 and \xC3\xA4";
  Exchange status{.request = Request::status, .status = BoardStatus{}};
  status.status->protocol_version = 1;
  status.status->tick = 12345678901234ULL;
  Exchange failed{.request = Request::drain};
  failed.error = Error{ErrorCode::timeout, "two\nlines -> with an arrow"};
  session.exchanges = {status, failed, {.request = Request::drain, .drained = true}};
  const auto again = parse_session(text_of(session), "again");
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again.value().identity.serial, session.identity.serial);
  EXPECT_EQ(again.value().exchanges[0].status->tick, 12345678901234ULL);
  EXPECT_EQ(again.value().exchanges[1].error->code, ErrorCode::timeout);
  EXPECT_EQ(again.value().exchanges[1].error->message, "two\nlines -> with an arrow");
  EXPECT_EQ(text_of(again.value()), text_of(session));
}

TEST(SessionText, AnotherVersionIsNamedBesideOurs) {
  const auto session = parse_session("gravure session 2\n", "new.txt");
  ASSERT_FALSE(session);
  EXPECT_EQ(session.error().code, ErrorCode::version_mismatch);
  EXPECT_NE(session.error().message.find("version 2 of session files, this program reads version 1"),
            std::string::npos);
}

TEST(SessionText, EveryLineThatIsWrongIsNamed) {
  const std::string head = head_text({});
  for (const std::string line :
       {"read", "read 0x1 -> 0x00000000", "read 0x01 -> 0x0000000", "read 0x01", "read 0x01 -> 0x00000000 ",
        "write 0x01 -> done", "write 0x01 = 0x00000001 -> drained", "send 3 bytes 0x00000000 -> 4",
        "send -3 bytes 0x00000000 -> 0", "drain -> ", "status -> 00", "status -> error", "drain -> error odd why",
        "drain -> error io \\q", "jump -> done"}) {
    const auto session = parse_session(head + "# a comment\n\ndrain -> not yet\n" + line + "\n", "s.txt");
    ASSERT_FALSE(session) << line;
    EXPECT_EQ(session.error().code, ErrorCode::bad_file);
    EXPECT_NE(session.error().message.find("s.txt, line 10: "), std::string::npos) << session.error().message;
  }
  for (std::size_t cut = 0; cut < head.size() - 1; ++cut) {
    EXPECT_FALSE(parse_session(head.substr(0, cut), "s.txt") && cut + 2 < head.size()) << cut;
  }
}

}  // namespace
}  // namespace gravure::replay
