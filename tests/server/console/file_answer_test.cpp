// SPDX-License-Identifier: Apache-2.0
#include "server/console/file_answer.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>

namespace weft::server::testing {
namespace {

namespace http = boost::beast::http;

Answer answer_of(const std::string& text) {
  auto file = files::open_unlinked(std::filesystem::temp_directory_path());
  EXPECT_TRUE(file && files::write_all(file->get(), text.data(), text.size()));
  return {.head = make_page(http::status::ok, "text/plain", ""), .file = std::move(*file)};
}

std::string all_of(FileAnswer& answer) {
  std::string bytes;
  while (answer.has_next()) {
    const auto next = answer.next().value();
    for (const boost::asio::const_buffer& buffer : next)
      bytes.append(static_cast<const char*>(buffer.data()), buffer.size());
  }
  return bytes;
}

std::string body_of(const std::string& response) {
  return response.substr(response.find("\r\n\r\n") + 4);
}

TEST(FileAnswer, SendsThePartThatIsAskedFor) {
  const std::string text = std::string(200'000, 'a') + "bcd";
  Answer part = answer_of(text);
  part.file_first = 1;
  part.file_bytes = text.size() - 2;
  FileAnswer answer(std::move(part));
  const std::string sent = all_of(answer);
  EXPECT_NE(sent.find("Content-Length: 200001\r\n"), sent.npos) << sent.substr(0, 200);
  EXPECT_EQ(body_of(sent), text.substr(1, text.size() - 2));
  EXPECT_TRUE(answer.over());
}

TEST(FileAnswer, HasItsPlaceToTheEnd) {
  Answer waiting = answer_of("");
  waiting.place = std::make_shared<int>();
  const std::weak_ptr<const void> place = waiting.place;
  {
    FileAnswer answer(std::move(waiting));
    all_of(answer);
    EXPECT_FALSE(place.expired());
  }
  EXPECT_TRUE(place.expired());
}

TEST(FileAnswer, OfAFileThatGrowsIsInChunksWithTrailers) {
  Answer growing = answer_of("abcdef");
  growing.file_bytes = 2;
  growing.grows = true;
  FileAnswer answer(std::move(growing));
  const std::string sent = all_of(answer);
  EXPECT_NE(sent.find("Transfer-Encoding: chunked\r\n"), sent.npos) << sent;
  EXPECT_EQ(body_of(sent), "2\r\nab\r\n");
  EXPECT_FALSE(answer.has_next());
  EXPECT_FALSE(answer.over());
  answer.grow(3);
  EXPECT_EQ(all_of(answer), "3\r\ncde\r\n");
  answer.grow(1);
  http::fields trailers;
  trailers.insert("A", "1");
  trailers.insert("A", "2");
  answer.end(trailers);
  EXPECT_FALSE(answer.over());
  EXPECT_EQ(all_of(answer), "1\r\nf\r\n0\r\nA: 1\r\nA: 2\r\n\r\n");
  EXPECT_TRUE(answer.over());
}

TEST(FileAnswer, EndsIfTheFileIsShorterThanItShouldBe) {
  Answer cut = answer_of("abc");
  cut.file_bytes = 4;
  FileAnswer answer(std::move(cut));
  EXPECT_TRUE(answer.next());  // the head
  EXPECT_TRUE(answer.next());
  EXPECT_FALSE(answer.next());
}

}  // namespace
}  // namespace weft::server::testing
