// Tables of numbers: plain ones are read to the last bit, all others are left alone. The tests in
// Python compare with the other parser on random tables.

#include <cstdlib>
#include <string>
#include <string_view>
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

CHECK_CASE("number table: digits by eights, with other characters among them") {
  const auto table =
      number_table("0.12345678,-9.423353971,1234567.00000001,0.1234567890123", 0, ',', 4);
  CHECK(table.has_value());
  if (!table) return;
  CHECK((*table)(0, 0) == 0.12345678);
  CHECK((*table)(0, 1) == -9.423353971);
  CHECK((*table)(0, 2) == 1234567.00000001);
  CHECK((*table)(0, 3) == 0.1234567890123);
  for (std::size_t place = 0; place < 8; ++place) {
    for (int byte = 1; byte < 256; ++byte) {
      const bool digit = byte >= '0' && byte <= '9';
      std::string row = "0.00000000";
      row[2 + place] = static_cast<char>(byte);
      const auto found = number_table(row, 0, ',', 1);
      if (digit) {
        CHECK(found && (*found)(0, 0) == std::strtod(row.c_str(), nullptr));
      } else if (std::string_view("\n\r eE").find(row[2 + place]) == std::string_view::npos) {
        CHECK_WITH(!found, row);  // the others end a number or continue it
      }
    }
  }
}

CHECK_CASE("number table: other tables are left to another parser") {
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
    // On the heap and without a final zero, so that a sanitizer detects reads beyond the end.
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

CHECK_CASE("control characters: each is found, at any place") {
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
