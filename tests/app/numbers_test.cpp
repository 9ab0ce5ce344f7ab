// Numbers and tables as people write and read them.
#include "numbers.h"

#include <catch2/catch.hpp>

#include "table.h"

using gnomon::app::format_bytes;
using gnomon::app::parse_count;
using gnomon::app::parse_numbers;

TEST_CASE("counts may be written plainly, with a suffix or an exponent") {
  CHECK(parse_count("0") == 0);
  CHECK(parse_count("010") == 10);
  CHECK(parse_count("250000") == 250'000);
  CHECK(parse_count("250k") == 250'000);
  CHECK(parse_count("1.5M") == 1'500'000);
  CHECK(parse_count("2G") == 2'000'000'000);
  CHECK(parse_count("1e6") == 1'000'000);
  CHECK(parse_count("9223372036854775807") == 9223372036854775807ULL);
}

TEST_CASE("what is not a whole number in range is no count") {
  for (const char* text : {"", "-1", "+1", "k", "1.5", "1x", "1 ", " 1", "1e-3", "nan", "inf", "0x10", "1e30",
                           "9223372036854775808", "1kk", "1,5k"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_count(text).has_value());
  }
}

TEST_CASE("numbers with commas between are read, and nothing else") {
  using Numbers = std::vector<double>;
  CHECK(parse_numbers("0.5,-1,2e1") == Numbers{0.5, -1.0, 20.0});
  CHECK(parse_numbers("7") == Numbers{7.0});
  for (const char* text :
       {"", ",", "1,", ",1", "1,,2", "1 ,2", "1, 2", "x", "1,x", "nan", "1,inf", "1;2", "0x10"}) {
    CAPTURE(text);
    CHECK_FALSE(parse_numbers(text).has_value());
  }
}

TEST_CASE("sizes are shown in the unit that keeps them short") {
  CHECK(format_bytes(0) == "0 bytes");
  CHECK(format_bytes(1023) == "1023 bytes");
  CHECK(format_bytes(1024) == "1.0 KiB");
  CHECK(format_bytes(1536ULL * 1024) == "1.5 MiB");
  CHECK(format_bytes(5ULL << 40U) == "5.0 TiB");
}

TEST_CASE("a table aligns its first column left and the others right") {
  gnomon::app::Table table({"kind", "rays"});
  table.add({"primary", "5"});
  table.add({"any", "12345"});
  CHECK(table.text() == "kind      rays\nprimary      5\nany      12345\n");
  gnomon::app::Facts facts;
  facts.add("a", "1");
  facts.add("long", "2");
  CHECK(facts.text() == "a     1\nlong  2\n");
}
