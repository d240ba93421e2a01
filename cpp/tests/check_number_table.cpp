// Tables of numbers: what is plain is read to the last bit, everything else is left alone. The
// tests in Python compare with the other parser on random tables.

#include <string>
#include <vector>

#include "base/random.hpp"
#include "check.hpp"
#include "text/control_character.hpp"
#include "text/number_table.hpp"

namespace jointid::tests {
namespace {

using text::number_table;

CHECK_CASE("number table: plain rows") {
  const auto table = number_table("a,b\n1, -2.5e-3\r\n\n+.5,3. ", 1, ',', 2);
  CHECK(table.has_value());
  if (!table) return;
  CHECK(table->rows() == 2);
  CHECK((*table)(0, 1) == -2.5e-3);
  CHECK((*table)(1, 0) == 0.5);
  CHECK((*table)(1, 1) == 3.0);
}

CHECK_CASE("number table: what is not plain is left to another parser") {
  for (const char* const rows :
       {"",         "\n",          "1",       "1,2,3",   "1,2\n3",    "1,",       ",1",
        "1,nan",    "1,-inf",      "1,0x1p3", "1,1_0",   "1,1e",      "1,1e999",  "1,1e-999",
        "1,--1",    "1,+-1",       "1,-+1",   "1,+",     "1,-",       "1,.",      "1,#",
        "#1,2",     "1,\"2\"",     "1,2 3",   "1\r2,3",  "1,2\r\r\n", "1,2\r3,4", "1,\t2",
        "1,2\n \n", "1,2\xc2\xa0", "1 ,",     "1,2\n//", "1;2",       "1,١"}) {
    CHECK_WITH(!number_table(rows, 0, ',', 2), rows);
  }
  CHECK(!number_table("a\rb\n1,2", 1, ',', 2));
  CHECK(!number_table("a\n", 3, ',', 2));
}

CHECK_CASE("number table: random bytes read nothing beyond the text") {
  const std::string signs = "0123456789.,+-eE \r\n#\"_xnaif;\t";
  base::Random draw(11, 0, 0, 0);
  for (int trial = 0; trial < 20000; ++trial) {
    std::string rows(static_cast<std::size_t>(draw.uniform() * 40.0), ' ');
    // On the heap and without a zero at its end, so that a sanitizer sees what is read beyond.
    for (char& sign : rows) {
      sign = signs[static_cast<std::size_t>(draw.uniform() * static_cast<double>(signs.size()))];
    }
    const std::vector<char> exact(rows.begin(), rows.end());
    const auto table =
        number_table({exact.data(), exact.size()}, static_cast<std::size_t>(draw.uniform() * 3.0),
                     ',', 1 + static_cast<std::size_t>(draw.uniform() * 3.0));
    CHECK(!table || table->allFinite());
  }
}

CHECK_CASE("control characters: each is found, wherever it stands") {
  for (int byte = 0; byte < 256; ++byte) {
    const bool text = byte > 31 ? byte != 127 : byte > 8 && byte < 14;
    for (const std::size_t place : {std::size_t{0}, std::size_t{4095}, std::size_t{4096}}) {
      std::string content(5000, 'a');
      content[place] = static_cast<char>(byte);
      CHECK_WITH(text::find_control_character(content) == (text ? std::string::npos : place),
                 std::to_string(byte));
    }
  }
}

}  // namespace
}  // namespace jointid::tests
