// numbers.hpp: rows of a table as text, each number as a stream of nine digits writes it ("%.9g").
#pragma once
#include <charconv>
#include <string>
#include "call.hpp"

namespace numbers {

static void write(std::ostream *&out, Table A, long rows, std::string &between) {
  std::string text;
  char digits[32];
  for (long i = 0; i < rows; i++) for (long j = 0; j < A.M(); j++) {
    text.append(digits, std::to_chars(digits, digits + sizeof digits, A(i, j), std::chars_format::general, 9).ptr);
    text += j + 1 < A.M() ? between : "\n";
  }
  *out << text;
}

}
